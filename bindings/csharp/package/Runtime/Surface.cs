using System;

namespace Beltrami
{
    /// <summary>Any mesh: positions, and the vertices of the corners of its faces. It keeps the
    /// arrays that it is given, and copies nothing.</summary>
    public sealed class Surface
    {
        readonly Array positions, indices;
        readonly NativeBuffer rawPositions, rawIndices;
        readonly long vertexCount, indexCount;

        /// <summary>Triangles: three numbers for each vertex, in any unit of length; three indices
        /// from 0 for each face, counter-clockwise.</summary>
        public Surface(float[] positions, int[] indices) : this((Array)positions, indices, null) { }
        /// <summary>The same in double precision.</summary>
        public Surface(double[] positions, int[] indices) : this((Array)positions, indices, null) { }
        /// <summary>The same with 16-bit indices.</summary>
        public Surface(float[] positions, ushort[] indices) : this((Array)positions, indices, null) { }
        /// <summary>Polygons: the indices of their corners, one face after another, and how many
        /// corners each has, three or more.</summary>
        public Surface(float[] positions, int[] indices, int[] faceSizes)
            : this((Array)positions, indices, faceSizes) { }
        /// <summary>The same in double precision.</summary>
        public Surface(double[] positions, int[] indices, int[] faceSizes)
            : this((Array)positions, indices, faceSizes) { }

        /// <summary>Triangles in memory of the caller, which must stay there for the time of a
        /// call. Strides are in bytes from one vertex, or one face, to the next; 0: packed.</summary>
        public Surface(IntPtr positions, Scalar positionType, long positionStride, long vertexCount,
                       IntPtr indices, Scalar indexType, long indexStride, long faceCount)
        {
            if (vertexCount < 0) throw new ArgumentOutOfRangeException("vertexCount");
            if (faceCount < 0) throw new ArgumentOutOfRangeException("faceCount");
            rawPositions = Raw(positions, positionType, positionStride);
            rawIndices = Raw(indices, indexType, indexStride);
            this.vertexCount = vertexCount;
            indexCount = 3 * faceCount;
        }

        Surface(Array positions, Array indices, int[] faceSizes)
        {
            if (positions == null) throw new ArgumentNullException("positions");
            if (indices == null) throw new ArgumentNullException("indices");
            if (positions.Length % 3 != 0) {
                throw new ArgumentException("positions has " + positions.Length +
                                            " numbers: give three for each vertex");
            }
            if (faceSizes == null && indices.Length % 3 != 0) {
                throw new ArgumentException("indices has " + indices.Length +
                                            " numbers: give three for each triangle, or faceSizes");
            }
            this.positions = positions;
            this.indices = indices;
            FaceSizes = faceSizes;
            vertexCount = positions.Length / 3;
            indexCount = indices.Length;
        }

        /// <summary>How many corners each face has; null where all are triangles.</summary>
        public int[] FaceSizes { get; private set; }
        /// <summary>Two numbers for each corner: with Cut.Islands the charts of these UVs
        /// stay.</summary>
        public float[] CornerUvs { get; set; }
        /// <summary>A number for each face: seams run where they differ.</summary>
        public int[] FaceLabels { get; set; }
        /// <summary>A number above 0 for each face: how much larger it is to be.</summary>
        public float[] Densities { get; set; }
        /// <summary>Two vertices for each edge that is to be cut.</summary>
        public int[] Seams { get; set; }
        /// <summary>A factor for each vertex of what a seam costs there.</summary>
        public float[] VertexPaint { get; set; }
        /// <summary>A number for each face: seams are drawn to where they differ.</summary>
        public int[] Materials { get; set; }

        public long VertexCount { get { return vertexCount; } }
        public long FaceCount
        {
            get { return FaceSizes == null ? indexCount / 3 : FaceSizes.Length; }
        }
        /// <summary>Corners of all faces.</summary>
        public long CornerCount { get { return indexCount; } }

        static NativeBuffer Raw(IntPtr data, Scalar type, long stride)
        {
            if (data == IntPtr.Zero) throw new ArgumentException("the memory is a null pointer");
            if (stride < 0) throw new ArgumentException("a stride is negative: give bytes, 0 or more");
            return new NativeBuffer { Data = data, Type = (int)type, Stride = (ulong)stride };
        }

        static void Require(Array array, long count, string name)
        {
            if (array == null || array.Length == count) return;
            throw new ArgumentException(name + " has " + array.Length + " numbers: give " + count);
        }

        /// <summary>What the library reads; good as long as `held` is. Throws ArgumentException
        /// where arrays have other lengths than they are to have.</summary>
        internal NativeSurface Describe(Held held, IntPtr cancel)
        {
            Require(CornerUvs, 2 * CornerCount, "CornerUvs");
            Require(FaceLabels, FaceCount, "FaceLabels");
            Require(Densities, FaceCount, "Densities");
            Require(VertexPaint, VertexCount, "VertexPaint");
            Require(Materials, FaceCount, "Materials");
            if (Seams != null && Seams.Length % 2 != 0) {
                throw new ArgumentException("Seams has an odd number of vertices: give two an edge");
            }
            NativeSurface surface = new NativeSurface();
            surface.StructSize = Context.SizeOf<NativeSurface>();
            surface.VertexCount = (ulong)VertexCount;
            surface.FaceCount = (ulong)FaceCount;
            surface.Positions = positions == null ? rawPositions : held.Buffer(positions);
            surface.Indices = indices == null ? rawIndices : held.Buffer(indices);
            if (FaceSizes != null) {
                surface.CornerCount = (ulong)CornerCount;
                surface.FaceSizes = held.Buffer(FaceSizes);
            }
            surface.CornerUvs = held.Buffer(CornerUvs);
            surface.FaceLabels = held.Buffer(FaceLabels);
            surface.Densities = held.Buffer(Densities);
            if (Seams != null && Seams.Length > 0) {
                surface.Seams = held.Buffer(Seams);
                surface.SeamCount = (ulong)Seams.Length / 2;
            }
            surface.VertexPaint = held.Buffer(VertexPaint);
            surface.Materials = held.Buffer(Materials);
            surface.Cancel = cancel;
            return surface;
        }

        /// <summary>The same as one disk of triangles, without what comes with it.</summary>
        internal NativeMesh DescribeDisk(Held held, IntPtr cancel)
        {
            if (FaceSizes != null) {
                throw new ArgumentException("a disk is flattened as triangles: leave faceSizes out");
            }
            NativeMesh mesh = new NativeMesh();
            mesh.StructSize = Context.SizeOf<NativeMesh>();
            mesh.VertexCount = (ulong)VertexCount;
            mesh.FaceCount = (ulong)FaceCount;
            mesh.Positions = positions == null ? rawPositions : held.Buffer(positions);
            mesh.Indices = indices == null ? rawIndices : held.Buffer(indices);
            mesh.Cancel = cancel;
            return mesh;
        }
    }
}
