// Tests of the C# package: run.py compiles and runs them.
using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using System.Runtime.InteropServices;
using System.Threading;
using Beltrami;
using Unity.Collections;
using UnityEngine;

public static class Tests
{
    // ---- Meshes ----

    static readonly float[] CubeCorners =
        { 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1 };
    static readonly int[] CubeSides =
        { 0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 1, 3, 7, 5, 3, 2, 6, 7, 2, 0, 4, 6 };

    static Surface Cube() { return new Surface(CubeCorners, CubeSides, Enumerable.Repeat(4, 6).ToArray()); }

    static int[] CubeTriangles()
    {
        List<int> triangles = new List<int>();
        for (int f = 0; f < 6; ++f) {
            foreach (int k in new[] { 0, 1, 2, 0, 2, 3 }) triangles.Add(CubeSides[4 * f + k]);
        }
        return triangles.ToArray();
    }

    /// A hump of n by n cells.
    static Surface Hump(int n)
    {
        List<float> positions = new List<float>();
        List<int> indices = new List<int>();
        for (int i = 0; i <= n; ++i) {
            for (int j = 0; j <= n; ++j) {
                positions.AddRange(new[] { i, j, 4 * (float)Math.Sin(3.0 * i / n) * (float)Math.Sin(3.0 * j / n) });
                if (i == n || j == n) continue;
                int a = i * (n + 1) + j, b = a + n + 1;
                indices.AddRange(new[] { a, b, b + 1, a, b + 1, a + 1 });
            }
        }
        return new Surface(positions.ToArray(), indices.ToArray());
    }

    // ---- Expectations ----

    static void Expect(bool condition, string what) { if (!condition) throw new Exception("not so: " + what); }

    static T Refuses<T>(Action action) where T : Exception
    {
        try {
            action();
        } catch (T refusal) {
            return refusal;
        }
        throw new Exception("no " + typeof(T).Name);
    }

    // ---- Tests ----

    public static void UnwrapsACube()
    {
        using (Context context = new Context()) {
            Atlas atlas = context.Unwrap(Cube());
            Expect(atlas.Injective && atlas.Status == Status.Ok, "injective");
            Expect(atlas.Report.Faces == 6 && atlas.Report.Corners == 24, "counts");
            Expect(atlas.UvOfCorner.Length == 24 && atlas.ChartOfFace.Length == 6, "lengths");
            Expect(atlas.Uvs.All(x => x >= 0 && x <= 1), "on the page");
            Expect(atlas.Pages.All(page => page == 0), "pages");
            for (int c = 0; c < 24; ++c) {
                Expect(atlas.Origins[atlas.UvOfCorner[c]] == CubeSides[c], "origins");
            }
            float[] split = atlas.Split(CubeCorners, 3);
            Expect(split.Length == 3 * atlas.Origins.Length, "split");
            Expect(split[4] == CubeCorners[3 * atlas.Origins[1] + 1], "split values");
            Surface again = Cube();
            again.CornerUvs = atlas.CornerUvs();
            Expect(Context.CheckAtlas(again).Injective == 1, "checked");
            again.CornerUvs = new float[48];
            for (int i = 0; i < 24; ++i) {
                again.CornerUvs[2 * i] = i % 4 % 3 == 0 ? 0 : 1;
                again.CornerUvs[2 * i + 1] = i % 4 < 2 ? 0 : 1;
            }
            Expect(Context.CheckAtlas(again).Injective == 0, "six sides at one place");
        }
    }

    public static void ArraysOfEveryTypeGiveTheSameBits()
    {
        using (Context context = new Context()) {
            int[] triangles = CubeTriangles();
            float[] expected = context.Unwrap(new Surface(CubeCorners, triangles)).Uvs;
            ushort[] few = triangles.Select(index => (ushort)index).ToArray();
            double[] wide = CubeCorners.Select(x => (double)x).ToArray();
            Expect(context.Unwrap(new Surface(CubeCorners, few)).Uvs.SequenceEqual(expected), "ushort");
            context.Options.Float32 = false;
            Expect(context.Unwrap(new Surface(wide, triangles)).Uvs.SequenceEqual(expected), "double");
            unsafe {
                fixed (float* positions = CubeCorners)
                fixed (int* indices = triangles) {
                    Surface raw = new Surface((IntPtr)positions, Scalar.F32, 12, 8, (IntPtr)indices,
                                              Scalar.U32, 0, 12);
                    Expect(context.Unwrap(raw).Uvs.SequenceEqual(expected), "memory");
                }
            }
        }
    }

    public static void SeveralSurfacesShareAPageInTheirOwnNumbers()
    {
        using (Context context = new Context()) {
            Surface[] surfaces = { Cube(), Hump(6), Cube() };
            Atlas[] atlases = context.UnwrapTogether(surfaces);
            Expect(atlases.Length == 3, "one for each");
            List<float> all = new List<float>();
            List<int> corners = new List<int>(), sizes = new List<int>();
            List<float> positions = new List<float>();
            for (int i = 0; i < 3; ++i) {
                Atlas atlas = atlases[i];
                Expect(atlas.Injective && atlas.Report.Components == 3, "one verdict");
                Expect(atlas.UvOfCorner.Length == surfaces[i].CornerCount, "corners");
                Expect(atlas.UvOfCorner.Max() == atlas.Origins.Length - 1, "UV vertices");
                Expect(atlas.UvOfCorner.Min() == 0 && atlas.Origins.Min() == 0, "from 0");
                Expect(atlas.Origins.Max() == surfaces[i].VertexCount - 1, "origins");
                all.AddRange(atlas.CornerUvs());
            }
            // All of them as one mesh: no two overlap.
            int at = 0;
            foreach (Atlas atlas in atlases) {
                for (int c = 0; c < atlas.UvOfCorner.Length; ++c) corners.Add(at++);
            }
            for (int c = 0; c < corners.Count; ++c) positions.AddRange(new[] { c, (float)Math.Sin(c), (float)Math.Cos(2 * c) });
            for (int i = 0; i < 3; ++i) {
                long faces = surfaces[i].FaceCount;
                for (long f = 0; f < faces; ++f) sizes.Add(surfaces[i].FaceSizes == null ? 3 : 4);
            }
            Surface judged = new Surface(positions.ToArray(), corners.ToArray(), sizes.ToArray());
            judged.CornerUvs = all.ToArray();
            Expect(Context.CheckAtlas(judged).Overlaps == 0, "no overlaps");
        }
    }

    public static void FlattensADisk()
    {
        using (Context context = new Context()) {
            Flattening map = context.Flatten(Hump(10));
            Expect(map.Injective && map.Uvs.Length == 2 * 121, "one UV for each vertex");
            Expect(map.Energy.SymmetricDirichlet >= 2 && map.Report.Faces == 200, "report");
            BeltramiException closed = Refuses<BeltramiException>(
                () => context.Flatten(new Surface(CubeCorners, CubeTriangles())));
            Expect(closed.Status == Status.EClosed && closed.Message.Length > 10, "closed");
            Refuses<ArgumentException>(() => context.Flatten(Cube()));
        }
    }

    public static void OptionsAreThoseOfTheTable()
    {
        using (Context context = new Context()) {
            Options options = context.Options;
            Expect(options.Resolution == 1024 && options.Effort == Effort.Normal && !options.Float32, "defaults");
            options.Resolution = 512;
            options.TargetEnergy = 2.1;
            options.Effort = Effort.Quick;
            options.Float32 = true;
            Expect(options.Resolution == 512 && options.TargetEnergy == 2.1, "numbers");
            Expect(options.Effort == Effort.Quick && options.Float32, "choices");
            options.Set("margin", 4).Set("effort", "high").Set("resolution", 256);
            Expect(options.Margin == 4 && options.Effort == Effort.High && options.Resolution == 256, "names");
            Refuses<ArgumentException>(() => options.Set("no-such-option", 1));
            Refuses<ArgumentException>(() => options.Set("effort", "none such"));
            BeltramiException refusal = Refuses<BeltramiException>(() => options.Resolution = 1);
            Expect(refusal.Status == Status.EInvalidArgument, "range");
            Expect(options.Resolution == 256, "the old value stays");
            int key = 0;
            NativeOptionInfo info = new NativeOptionInfo { StructSize = (uint)Marshal.SizeOf(typeof(NativeOptionInfo)) };
            PropertyInfo[] properties = typeof(Options).GetProperties();
            unsafe {
                while (Native.beltrami_option_describe(key, &info) == Status.Ok) {
                    string name = Marshal.PtrToStringAnsi(info.Name).Replace("-", "");
                    Expect(properties.Count(p => p.Name.ToLower() == name) == 1, name);
                    ++key;
                }
            }
            Expect(key == properties.Length, "and no others");
        }
    }

    public static void SaysWhatIsWrongAndWhere()
    {
        using (Context context = new Context()) {
            int[] triangles = CubeTriangles();
            triangles[10] = 99;
            BeltramiException error = Refuses<BeltramiException>(
                () => context.Unwrap(new Surface(CubeCorners, triangles)));
            Expect(error.Status == Status.EIndexOutOfRange, "status");
            Expect(error.ElementKind == ElementKind.Face && error.Element == 3, "element");
            Expect(error.Message.Contains("99"), error.Message);
            Refuses<ArgumentException>(() => new Surface(new float[4], triangles));
            Refuses<ArgumentException>(() => new Surface(CubeCorners, new int[4]));
            Refuses<ArgumentNullException>(() => new Surface((float[])null, triangles));
            Surface odd = Cube();
            odd.FaceLabels = new int[5];
            Refuses<ArgumentException>(() => context.Unwrap(odd));
            odd = Cube();
            odd.CornerUvs = new float[47];
            Refuses<ArgumentException>(() => Context.CheckAtlas(odd));
            Refuses<ArgumentException>(() => context.UnwrapTogether(new Surface[0]));
            Refuses<ArgumentNullException>(() => context.Unwrap(null));
            BeltramiException none = Refuses<BeltramiException>(
                () => context.Unwrap(new Surface(new float[0], new int[0])));
            Expect(none.Status == Status.EEmpty, "no faces");
            Expect(none.Element == -1 && none.ElementKind == ElementKind.None, "no element");
        }
        Context gone = new Context();
        gone.Dispose();
        gone.Dispose();
        Refuses<ObjectDisposedException>(() => gone.Unwrap(Cube()));
    }

    public static void LabelsSeamsAndDensitiesCount()
    {
        using (Context context = new Context()) {
            Surface labelled = Cube();
            labelled.FaceLabels = new[] { 0, 1, 2, 3, 4, 5 };
            Expect(context.Unwrap(labelled).ChartOfFace.Distinct().Count() == 6, "labels");
            Surface dense = Cube();
            dense.FaceLabels = labelled.FaceLabels;
            dense.Densities = new float[] { 2, 1, 1, 1, 1, 1 };
            Atlas atlas = context.Unwrap(dense);
            Expect(Area(atlas, 0) / Area(atlas, 1) > 3.9 && Area(atlas, 0) / Area(atlas, 1) < 4.1, "densities");
            Surface cut = Cube();
            cut.Seams = new[] { 0, 1, 1, 3, 3, 2, 2, 0 };
            cut.VertexPaint = Enumerable.Repeat(1f, 8).ToArray();
            cut.Materials = labelled.FaceLabels;
            Expect(context.Unwrap(cut).ChartOfFace.Count(chart => chart == 0) == 1, "seams");
        }
    }

    static double Area(Atlas atlas, int side)
    {
        float[] uvs = atlas.CornerUvs();
        double sum = 0;
        for (int k = 0; k < 4; ++k) {
            int a = 8 * side + 2 * k, b = 8 * side + 2 * ((k + 1) % 4);
            sum += uvs[a] * uvs[b + 1] - uvs[b] * uvs[a + 1];
        }
        return sum / 2;
    }

    public static void ProgressIsToldAndCancels()
    {
        using (Context context = new Context()) {
            List<double> fractions = new List<double>();
            int thread = Thread.CurrentThread.ManagedThreadId;
            context.Unwrap(Hump(20), (fraction, stage) => {
                Expect(Thread.CurrentThread.ManagedThreadId == thread && stage.Length > 0, "told here");
                fractions.Add(fraction);
                return true;
            });
            Expect(fractions.Count > 2 && fractions.SequenceEqual(fractions.OrderBy(x => x)), "rises");
            Refuses<OperationCanceledException>(() => context.Unwrap(Hump(20), (f, s) => false));
            Refuses<OperationCanceledException>(() => context.Flatten(Hump(20), (f, s) => false));
            Refuses<DivideByZeroException>(() => context.Unwrap(Hump(20), (f, s) => {
                throw new DivideByZeroException();
            }));
            Expect(context.Unwrap(Cube()).Injective, "goes on");
        }
    }

    public static void ATokenCancelsFromAnyThread()
    {
        using (Context context = new Context())
        using (CancellationTokenSource source = new CancellationTokenSource()) {
            foreach (bool flatten in new[] { false, true }) {
                CancellationTokenSource own = new CancellationTokenSource();
                Func<double, string, bool> progress = (f, s) => {
                    Thread other = new Thread(own.Cancel);
                    other.Start();
                    other.Join();
                    return true;
                };
                OperationCanceledException ended = Refuses<OperationCanceledException>(() => {
                    if (flatten) context.Flatten(Hump(30), progress, own.Token);
                    else context.Unwrap(Hump(30), progress, own.Token);
                });
                Expect(ended.CancellationToken == own.Token, "whose token");
                Refuses<OperationCanceledException>(() => context.Unwrap(Cube(), null, own.Token));
                Expect(context.Unwrap(Cube(), null, source.Token).Injective, "no request is left");
                Expect(context.Flatten(Hump(5), null, source.Token).Injective, "no request is left");
            }
        }
    }

    public static void LoopsMayRunOnThreadsOfTheHost()
    {
        using (Context context = new Context()) {
            context.Options.Threads = 3;
            float[] expected = context.Unwrap(Hump(40)).Uvs;
            int loops = 0;
            ParallelFor loop = (user, count, job, data) => {
                ++loops;
                System.Threading.Tasks.Parallel.For(0, count, i => job(data, i));
            };
            Native.beltrami_set_parallel_for(context.Handle, loop, IntPtr.Zero);
            Expect(context.Unwrap(Hump(40)).Uvs.SequenceEqual(expected) && loops > 0, "the same bits");
            Native.beltrami_set_parallel_for(context.Handle, null, IntPtr.Zero);
            GC.KeepAlive(loop);
        }
    }

    // ---- Unity, of which there are stand-ins alone here ----

    static Mesh CubeMesh()
    {
        int[] triangles = CubeTriangles();
        Mesh mesh = new Mesh { name = "cube" };
        mesh.vertices = Enumerable.Range(0, 8).Select(
            v => new Vector3(CubeCorners[3 * v], CubeCorners[3 * v + 1], CubeCorners[3 * v + 2])).ToArray();
        mesh.normals = mesh.vertices;
        mesh.colors = Enumerable.Range(0, 8).Select(v => new Color { r = v }).ToArray();
        mesh.SetUVs(2, Enumerable.Range(0, 8).Select(v => new Vector4 { x = v }).ToList());
        mesh.AddBlendShapeFrame("smile", 50, mesh.vertices, mesh.vertices, mesh.vertices);
        mesh.subMeshCount = 2;
        mesh.SetIndices(triangles.Take(12).ToArray(), MeshTopology.Triangles, 0);
        mesh.SetIndices(triangles.Skip(12).ToArray(), MeshTopology.Triangles, 1);
        return mesh;
    }

    public static void AMeshOfUnityKeepsWhatItsVerticesHave()
    {
        using (Context context = new Context()) {
            Mesh mesh = CubeMesh(), made = UnityMeshes.Unwrapped(mesh, context, 1);
            Expect(made.name == "cube" && made.subMeshCount == 2 && made.HasBounds, "of the whole");
            Expect(made.vertexCount > 8, "split");
            List<Vector4> uvs = new List<Vector4>(), others = new List<Vector4>();
            made.GetUVs(1, uvs);
            made.GetUVs(2, others);
            Vector3[] moves = new Vector3[made.vertexCount];
            made.GetBlendShapeFrameVertices(0, 0, moves, null, null);
            for (int part = 0; part < 2; ++part) {
                int[] before = mesh.GetIndices(part), after = made.GetIndices(part);
                for (int c = 0; c < before.Length; ++c) {
                    Expect(made.vertices[after[c]].Equals(mesh.vertices[before[c]]), "positions");
                    Expect(made.normals[after[c]].Equals(mesh.normals[before[c]]), "normals");
                    Expect(made.colors[after[c]].r == before[c] && others[after[c]].x == before[c], "values");
                    Expect(moves[after[c]].Equals(mesh.vertices[before[c]]), "blend shapes");
                }
            }
            // In Unity's axes faces are seen to run clockwise, and so do their UVs on the page.
            int[] first = made.GetIndices(0);
            Vector4 a = uvs[first[0]], b = uvs[first[1]], c2 = uvs[first[2]];
            float turn = (b.x - a.x) * (c2.y - a.y) - (b.y - a.y) * (c2.x - a.x);
            Expect(turn < 0, "as Unity sees it");
            Expect(uvs.All(uv => uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1), "UVs");
            mesh.isReadable = false;
            Refuses<ArgumentException>(() => UnityMeshes.Unwrapped(mesh, context));
        }
    }

    public static void NativeArraysAreReadInPlace()
    {
        using (Context context = new Context()) {
            Vector3[] corners = CubeMesh().vertices;
            int[] triangles = CubeTriangles();
            float[] expected = context.Unwrap(new Surface(CubeCorners, triangles)).Uvs;
            using (NativeArray<Vector3> positions = new NativeArray<Vector3>(corners, Allocator.Temp))
            using (NativeArray<int> wide = new NativeArray<int>(triangles, Allocator.Temp))
            using (NativeArray<ushort> few = new NativeArray<ushort>(
                       triangles.Select(index => (ushort)index).ToArray(), Allocator.Temp)) {
                Atlas atlas = context.Unwrap(UnityMeshes.SurfaceOf(positions, wide));
                Expect(atlas.Uvs.SequenceEqual(expected), "32 bits");
                Expect(context.Unwrap(UnityMeshes.SurfaceOf(positions, few)).Uvs.SequenceEqual(expected), "16 bits");
                using (NativeArray<Vector2> uvs = UnityMeshes.UvsOf(atlas, Allocator.Temp)) {
                    Expect(uvs.Length == atlas.Origins.Length && uvs[1].x == atlas.Uvs[2], "UVs");
                }
            }
        }
    }

    public static void TheMenuUnwrapsWhatIsSelected()
    {
        GameObject thing = new GameObject { name = "thing" };
        MeshFilter filter = new MeshFilter { sharedMesh = CubeMesh() };
        UnityEditor.Selection.gameObjects = new[] { thing };
        Expect(!UnwrapMenu.HasSelection(), "nothing with a mesh");
        thing.Components.Add(filter);
        Expect(UnwrapMenu.HasSelection(), "a mesh");
        UnwrapMenu.UnwrapForLightmaps();
        Expect(filter.sharedMesh.vertexCount > 8 && UnityEditor.EditorUtility.Shown == null, "unwrapped");
        Expect(UnityEditor.AssetDatabase.Assets["Assets/cube unwrapped.asset"] == filter.sharedMesh, "an asset");
        Expect(UnityEditor.Undo.Recorded.Contains(filter), "undo");
        Mesh before = filter.sharedMesh;
        UnityEditor.EditorUtility.Cancels = true;
        UnwrapMenu.UnwrapForTextures();
        Expect(filter.sharedMesh == before && Debug.Lines.Contains("beltrami: cancelled"), "cancelled");
        UnityEditor.EditorUtility.Cancels = false;
        filter.sharedMesh.isReadable = false;
        UnwrapMenu.UnwrapForTextures();
        Expect(UnityEditor.EditorUtility.Shown.Contains("Read/Write"), "a sentence");
        Expect(UnityEditor.EditorUtility.Bars == 0, "no bar is left");
    }

    // ---- Layouts ----

    /// Prints sizes and offsets, for run.py to compare with those of a compiler of C.
    static void PrintLayouts()
    {
        foreach (Type type in typeof(Native).Assembly.GetTypes().OrderBy(t => t.Name)) {
            if (!type.IsValueType || type.IsEnum || type.IsNested || type.Namespace != "Beltrami") continue;
            Console.WriteLine(type.Name + " " + Marshal.SizeOf(type));
            foreach (FieldInfo field in type.GetFields(BindingFlags.Public | BindingFlags.Instance)) {
                Console.WriteLine(type.Name + "." + field.Name + " " + Marshal.OffsetOf(type, field.Name));
            }
        }
    }

    public static int Main(string[] arguments)
    {
        if (arguments.Contains("--layouts")) {
            PrintLayouts();
            return 0;
        }
        int passed = 0, failed = 0;
        foreach (MethodInfo test in typeof(Tests).GetMethods(BindingFlags.Public | BindingFlags.Static)) {
            if (test.Name == "Main") continue;
            try {
                test.Invoke(null, null);
                ++passed;
            } catch (TargetInvocationException error) {
                ++failed;
                Console.WriteLine(test.Name + ": " + error.InnerException);
            }
        }
        Console.WriteLine("test result: {0} passed; {1} failed; 0 ignored", passed, failed);
        return failed == 0 ? 0 : 1;
    }
}
