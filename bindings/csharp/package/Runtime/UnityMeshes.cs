#if UNITY_5_3_OR_NEWER
using System;
using System.Collections.Generic;
using System.Threading;
using Unity.Collections;
using Unity.Collections.LowLevel.Unsafe;
using UnityEngine;
using UnityEngine.Rendering;

namespace Beltrami
{
    /// <summary>Unity's arrays and meshes in and out.</summary>
    public static unsafe class UnityMeshes
    {
        /// <summary>Triangles in native arrays, which are read in place: they must stay there for
        /// the time of a call. The library's axes are right-handed, and Unity's left-handed: a
        /// texture on these UVs is seen mirrored, which lightmaps do not mind.</summary>
        public static Surface SurfaceOf(NativeArray<Vector3> positions, NativeArray<int> indices)
        {
            return new Surface(Memory(positions), Scalar.F32, 0, positions.Length, Memory(indices),
                               Scalar.U32, 0, indices.Length / 3);
        }

        /// <summary>The same with 16-bit indices.</summary>
        public static Surface SurfaceOf(NativeArray<Vector3> positions, NativeArray<ushort> indices)
        {
            return new Surface(Memory(positions), Scalar.F32, 0, positions.Length, Memory(indices),
                               Scalar.U16, 0, indices.Length / 3);
        }

        /// <summary>UVs of the UV vertices of an atlas in a native array, which the caller
        /// disposes of.</summary>
        public static NativeArray<Vector2> UvsOf(Atlas atlas, Allocator allocator)
        {
            NativeArray<Vector2> uvs = new NativeArray<Vector2>(atlas.Origins.Length, allocator);
            for (int i = 0; i < uvs.Length; ++i) {
                uvs[i] = new Vector2(atlas.Uvs[2 * i], atlas.Uvs[2 * i + 1]);
            }
            return uvs;
        }

        /// <summary>A copy of a mesh with UVs in a channel (0 to 7; lightmaps take 1), vertices
        /// split along the seams. All else of its vertices is kept: normals, tangents, colours,
        /// other channels, bone weights, blend shapes. Seams are drawn to where submeshes differ.
        /// Throws ArgumentException for meshes that cannot be read or are not of triangles, and
        /// what Context.Unwrap throws.</summary>
        public static Mesh Unwrapped(Mesh mesh, Context context, int channel = 0,
                                     Func<double, string, bool> progress = null,
                                     CancellationToken cancel = default(CancellationToken))
        {
            if (mesh == null) throw new ArgumentNullException("mesh");
            if (context == null) throw new ArgumentNullException("context");
            if (channel < 0 || channel > 7) throw new ArgumentOutOfRangeException("channel");
            if (!mesh.isReadable) {
                throw new ArgumentException(
                    "the mesh cannot be read: switch on Read/Write in its import settings");
            }
            Vector3[] vertices = mesh.vertices;
            List<int> indices = new List<int>(), materials = new List<int>();
            for (int part = 0; part < mesh.subMeshCount; ++part) {
                if (mesh.GetTopology(part) != MeshTopology.Triangles) {
                    throw new ArgumentException("submesh " + part + " is not of triangles");
                }
                int[] own = mesh.GetIndices(part);
                indices.AddRange(own);
                for (int face = 0; face < own.Length / 3; ++face) materials.Add(part);
            }
            Surface surface = new Surface(Mirrored(vertices), Reversed(indices.ToArray()));
            surface.Materials = mesh.subMeshCount > 1 ? materials.ToArray() : null;
            return Split(mesh, context.Unwrap(surface, progress, cancel), channel);
        }

        static IntPtr Memory<T>(NativeArray<T> array) where T : struct
        {
            return (IntPtr)NativeArrayUnsafeUtility.GetUnsafeReadOnlyPtr(array);
        }

        /// <summary>From Unity's left-handed axes to right-handed ones: with faces reversed, too,
        /// charts are seen as the surface is.</summary>
        static float[] Mirrored(Vector3[] vectors)
        {
            float[] numbers = new float[3 * vectors.Length];
            for (int i = 0; i < vectors.Length; ++i) {
                numbers[3 * i] = -vectors[i].x;
                numbers[3 * i + 1] = vectors[i].y;
                numbers[3 * i + 2] = vectors[i].z;
            }
            return numbers;
        }

        /// <summary>The corners of triangles, two of each exchanged; twice is as before.</summary>
        static int[] Reversed(int[] corners)
        {
            int[] reversed = (int[])corners.Clone();
            for (int c = 0; c + 2 < corners.Length; c += 3) {
                reversed[c + 1] = corners[c + 2];
                reversed[c + 2] = corners[c + 1];
            }
            return reversed;
        }

        static Mesh Split(Mesh mesh, Atlas atlas, int channel)
        {
            Mesh made = new Mesh();
            made.name = mesh.name;
            made.indexFormat = atlas.Origins.Length > 65535 ? IndexFormat.UInt32 : mesh.indexFormat;
            made.vertices = atlas.Split(mesh.vertices);
            if (mesh.normals.Length > 0) made.normals = atlas.Split(mesh.normals);
            if (mesh.tangents.Length > 0) made.tangents = atlas.Split(mesh.tangents);
            if (mesh.colors.Length > 0) made.colors = atlas.Split(mesh.colors);
            for (int other = 0; other < 8; ++other) {
                if (other != channel) CopyChannel(mesh, made, atlas, other);
            }
            List<Vector2> uvs = new List<Vector2>(atlas.Origins.Length);
            for (int i = 0; i < atlas.Origins.Length; ++i) {
                uvs.Add(new Vector2(atlas.Uvs[2 * i], atlas.Uvs[2 * i + 1]));
            }
            made.SetUVs(channel, uvs);
            if (mesh.boneWeights.Length > 0) {
                made.boneWeights = atlas.Split(mesh.boneWeights);
                made.bindposes = mesh.bindposes;
            }
            made.subMeshCount = mesh.subMeshCount;
            int[] uvOfCorner = Reversed(atlas.UvOfCorner);
            int corner = 0;
            for (int part = 0; part < mesh.subMeshCount; ++part) {
                int[] indices = new int[mesh.GetIndices(part).Length];
                Array.Copy(uvOfCorner, corner, indices, 0, indices.Length);
                made.SetIndices(indices, MeshTopology.Triangles, part);
                corner += indices.Length;
            }
            CopyBlendShapes(mesh, made, atlas);
            made.RecalculateBounds();
            return made;
        }

        static void CopyChannel(Mesh mesh, Mesh made, Atlas atlas, int channel)
        {
            List<Vector4> old = new List<Vector4>();
            mesh.GetUVs(channel, old);
            if (old.Count > 0) made.SetUVs(channel, new List<Vector4>(atlas.Split(old.ToArray())));
        }

        static void CopyBlendShapes(Mesh mesh, Mesh made, Atlas atlas)
        {
            Vector3[] moves = new Vector3[mesh.vertexCount], normals = new Vector3[mesh.vertexCount];
            Vector3[] tangents = new Vector3[mesh.vertexCount];
            for (int shape = 0; shape < mesh.blendShapeCount; ++shape) {
                for (int frame = 0; frame < mesh.GetBlendShapeFrameCount(shape); ++frame) {
                    mesh.GetBlendShapeFrameVertices(shape, frame, moves, normals, tangents);
                    made.AddBlendShapeFrame(
                        mesh.GetBlendShapeName(shape), mesh.GetBlendShapeFrameWeight(shape, frame),
                        atlas.Split(moves), atlas.Split(normals), atlas.Split(tangents));
                }
            }
        }
    }
}
#endif
