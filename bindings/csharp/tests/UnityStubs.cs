// As much of Unity's interface as the package uses, so that it is compiled and run without Unity.
// Meshes copy what goes in and out, as Unity's do.
using System;
using System.Collections.Generic;
using System.Linq;
using System.Runtime.InteropServices;

namespace Unity.Collections
{
    public enum Allocator { Temp, TempJob, Persistent }

    public struct NativeArray<T> : IDisposable where T : struct
    {
        internal GCHandle Handle;
        readonly T[] items;

        public NativeArray(int length, Allocator allocator) : this(new T[length], allocator) { }
        public NativeArray(T[] given, Allocator allocator)
        {
            items = (T[])given.Clone();
            Handle = GCHandle.Alloc(items, GCHandleType.Pinned);
        }

        public int Length { get { return items.Length; } }
        public T this[int i] { get { return items[i]; } set { items[i] = value; } }
        public void Dispose() { Handle.Free(); }
    }
}

namespace Unity.Collections.LowLevel.Unsafe
{
    public static unsafe class NativeArrayUnsafeUtility
    {
        public static void* GetUnsafeReadOnlyPtr<T>(NativeArray<T> array) where T : struct
        {
            return (void*)array.Handle.AddrOfPinnedObject();
        }
    }
}

namespace UnityEngine.Rendering
{
    public enum IndexFormat { UInt16, UInt32 }
}

namespace UnityEngine
{
    using UnityEngine.Rendering;

    public struct Vector2 { public float x, y; public Vector2(float x, float y) { this.x = x; this.y = y; } }
    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
    }
    public struct Vector4 { public float x, y, z, w; }
    public struct Color { public float r, g, b, a; }
    public struct BoneWeight { public int boneIndex0; public float weight0; }
    public struct Matrix4x4 { public float m00; }
    public enum MeshTopology { Triangles, Quads }

    public class Object { public string name = ""; }

    public sealed class Mesh : Object
    {
        Vector3[] vertexArray = new Vector3[0], normalArray = new Vector3[0];
        Vector4[] tangentArray = new Vector4[0];
        Color[] colorArray = new Color[0];
        BoneWeight[] weights = new BoneWeight[0];
        readonly Dictionary<int, Vector4[]> channels = new Dictionary<int, Vector4[]>();
        int[][] parts = new int[1][] { new int[0] };
        MeshTopology[] topologies = new MeshTopology[1];
        readonly List<Tuple<string, float, Vector3[]>> shapes = new List<Tuple<string, float, Vector3[]>>();

        public bool isReadable = true;
        public bool HasBounds;
        public IndexFormat indexFormat;
        public Matrix4x4[] bindposes = new Matrix4x4[0];
        public int vertexCount { get { return vertexArray.Length; } }
        public Vector3[] vertices { get { return Copy(vertexArray); } set { vertexArray = Copy(value); } }
        public Vector3[] normals { get { return Copy(normalArray); } set { normalArray = Whole(value); } }
        public Vector4[] tangents { get { return Copy(tangentArray); } set { tangentArray = Whole(value); } }
        public Color[] colors { get { return Copy(colorArray); } set { colorArray = Whole(value); } }
        public BoneWeight[] boneWeights { get { return Copy(weights); } set { weights = Whole(value); } }

        public int subMeshCount
        {
            get { return parts.Length; }
            set
            {
                Array.Resize(ref parts, value);
                Array.Resize(ref topologies, value);
            }
        }
        public MeshTopology GetTopology(int part) { return topologies[part]; }
        public int[] GetIndices(int part) { return Copy(parts[part]); }
        public void SetIndices(int[] indices, MeshTopology topology, int part)
        {
            if (indices.Any(index => index < 0 || index >= vertexCount)) throw new ArgumentException("index");
            parts[part] = Copy(indices);
            topologies[part] = topology;
        }
        public void GetUVs(int channel, List<Vector4> uvs)
        {
            uvs.Clear();
            if (channels.ContainsKey(channel)) uvs.AddRange(channels[channel]);
        }
        public void SetUVs(int channel, List<Vector4> uvs) { channels[channel] = Whole(uvs.ToArray()); }
        public void SetUVs(int channel, List<Vector2> uvs)
        {
            channels[channel] = Whole(uvs.Select(uv => new Vector4 { x = uv.x, y = uv.y }).ToArray());
        }
        public int blendShapeCount { get { return shapes.Count; } }
        public int GetBlendShapeFrameCount(int shape) { return 1; }
        public string GetBlendShapeName(int shape) { return shapes[shape].Item1; }
        public float GetBlendShapeFrameWeight(int shape, int frame) { return shapes[shape].Item2; }
        public void GetBlendShapeFrameVertices(int shape, int frame, Vector3[] moves, Vector3[] normals,
                                               Vector3[] tangents)
        {
            shapes[shape].Item3.CopyTo(moves, 0);
        }
        public void AddBlendShapeFrame(string name, float weight, Vector3[] moves, Vector3[] normals,
                                       Vector3[] tangents)
        {
            shapes.Add(Tuple.Create(name, weight, Whole(moves)));
        }
        public void RecalculateBounds() { HasBounds = true; }

        static T[] Copy<T>(T[] items) { return (T[])items.Clone(); }
        T[] Whole<T>(T[] items)
        {
            if (items.Length != vertexCount) throw new ArgumentException("one for each vertex");
            return Copy(items);
        }
    }

    public class MeshFilter : Object { public Mesh sharedMesh; }
    public class SkinnedMeshRenderer : Object { public Mesh sharedMesh; }
    public sealed class GameObject : Object
    {
        public readonly List<Object> Components = new List<Object>();
        public T GetComponent<T>() where T : Object { return Components.OfType<T>().FirstOrDefault(); }
    }
    public static class SystemInfo { public static int processorCount = 2; }
    public static class Debug
    {
        public static readonly List<string> Lines = new List<string>();
        public static void Log(object line) { Lines.Add(line.ToString()); }
    }
}

namespace UnityEditor
{
    using UnityEngine;

    [AttributeUsage(AttributeTargets.Method, AllowMultiple = true)]
    public sealed class MenuItem : Attribute
    {
        public MenuItem(string path) { }
        public MenuItem(string path, bool validates) { }
    }
    public static class Selection { public static GameObject[] gameObjects = new GameObject[0]; }
    public static class Undo
    {
        public static readonly List<UnityEngine.Object> Recorded = new List<UnityEngine.Object>();
        public static void RecordObject(UnityEngine.Object thing, string name) { Recorded.Add(thing); }
    }
    public static class AssetDatabase
    {
        public static readonly Dictionary<string, UnityEngine.Object> Assets =
            new Dictionary<string, UnityEngine.Object>();
        public static string GenerateUniqueAssetPath(string path) { return path; }
        public static void CreateAsset(UnityEngine.Object asset, string path) { Assets[path] = asset; }
    }
    public static class EditorUtility
    {
        public static bool Cancels;
        public static int Bars;
        public static string Shown;
        public static bool DisplayCancelableProgressBar(string title, string text, float share)
        {
            ++Bars;
            return Cancels;
        }
        public static void ClearProgressBar() { Bars = 0; }
        public static bool DisplayDialog(string title, string text, string ok)
        {
            Shown = text;
            return true;
        }
    }
}
