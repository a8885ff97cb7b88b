// From the C header and the library's table of options.
// Written by tools/generate.py: change it there.

using System;
using System.Runtime.InteropServices;

namespace Beltrami
{
    public enum Status
    {
        Ok = 0,
        NotConverged = 1,
        NotInjective = 2,
        NotInjectiveFloat32 = 3,
        EInvalidArgument = -1,
        EOutOfMemory = -2,
        EAbiMismatch = -3,
        EUnsupported = -4,
        EInvalidState = -5,
        ECancelled = -6,
        EInternal = -7,
        EEmpty = -20,
        EIndexOutOfRange = -21,
        ENonFinite = -22,
        ERepeatedVertex = -23,
        ENonManifoldEdge = -24,
        ENonManifoldVertex = -25,
        EOrientation = -26,
        EComponents = -27,
        EClosed = -28,
        EBoundaries = -29,
        EGenus = -30,
        EZeroArea = -31,
        EPins = -32,
        ENoRoom = -33,
        ESolver = -40,
    }

    /// <summary>What an element index counts.</summary>
    public enum ElementKind
    {
        None = 0,
        Face = 1,
        Vertex = 2,
        Corner = 3,
    }

    /// <summary>A block of at least `bytes` whose address is a multiple of `alignment`, a power of
    /// two of at most 4096; or NULL where none is left.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public delegate IntPtr Allocate(IntPtr user, ulong bytes, ulong alignment);

    /// <summary>Takes back a block, with the numbers that it was asked for with.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public delegate void Release(IntPtr user, IntPtr block, ulong bytes, ulong alignment);

    /// <summary>Memory of the host's. Both functions may be called from every thread of a call on
    /// the context, several at a time; they neither throw nor call the library.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct NativeAllocator
    {
        public uint StructSize;
        /// <summary>0.</summary>
        public uint Reserved;
        public IntPtr User;
        public IntPtr Allocate;
        public IntPtr Release;
    }

    public enum Option
    {
        Method = 0,
        Energy = 1,
        CoarseFaces = 2,
        Tolerance = 3,
        MaxIterations = 4,
        Threads = 5,
        UnitSquare = 6,
        Flatten = 7,
        Injectivity = 8,
        Refine = 9,
        RefineIterations = 10,
        TimeLimit = 11,
        Float32 = 12,
        Delaunay = 13,
        MemoryLimit = 14,
        Cut = 15,
        HardAngle = 16,
        Weld = 17,
        WeldDistance = 18,
        FillHoles = 19,
        ShareCopies = 20,
        Preset = 21,
        TargetEnergy = 22,
        TargetP99 = 23,
        MaxCharts = 24,
        SeamBudget = 25,
        ConcaveSeams = 26,
        HiddenSeams = 27,
        HardSeams = 28,
        MaterialSeams = 29,
        Pack = 30,
        Resolution = 31,
        Margin = 32,
        TexelsPerUnit = 33,
        MaxPages = 34,
        PackTurns = 35,
        PackBlock = 36,
        FillWeight = 37,
        SymmetricSeams = 38,
        StraightSeams = 39,
        Effort = 40,
        FlatSeams = 41,
        Stack = 42,
        Rectify = 43,
        SnapTexels = 44,
        LabelPages = 45,
    }

    /// <summary>How long short seams are searched for, and a dense packing. Every level has the
    /// same promises.</summary>
    public enum Effort
    {
        Quick = 0,
        Normal = 1,
        High = 2,
    }

    /// <summary>Where the charts of an atlas lie.</summary>
    public enum Pack
    {
        Pages = 0,
        None = 1,
    }

    /// <summary>How charts may be turned on a page; they are never mirrored.</summary>
    public enum PackTurns
    {
        Any = 0,
        Quarter = 1,
        None = 2,
    }

    /// <summary>What is cut beside the seams that come with a surface.</summary>
    public enum Cut
    {
        Minimal = 0,
        Islands = 1,
        Auto = 2,
        Given = 3,
    }

    /// <summary>What the seams are for: setting one writes its values to the options of the
    /// search.</summary>
    public enum Preset
    {
        None = 0,
        Lightmap = 1,
        Texturing = 2,
        OneChart = 3,
        HardSurface = 4,
    }

    /// <summary>Whether components of one shape share texels: each corner of such a component has
    /// the UV of the corner that it lies on. Its UV vertices are its own, its faces are not
    /// judged.</summary>
    public enum Stack
    {
        None = 0,
        Copies = 1,
        Mirrored = 2,
        Halves = 3,
    }

    /// <summary>Which charts become rectangles, beside those that a surface names.</summary>
    public enum Rectify
    {
        None = 0,
        Grids = 1,
    }

    /// <summary>What is held of a pin, and what edges that are straight have in common.</summary>
    public enum Pin
    {
        Point = 0,
        U = 1,
        V = 2,
        Line = 3,
    }

    /// <summary>Whether vertices at one place are one.</summary>
    public enum Weld
    {
        Auto = 0,
        On = 1,
        Off = 2,
    }

    public enum Method
    {
        Beltrami = 0,
        Cm = 1,
        Tutte = 2,
        Gif = 3,
        Bff = 4,
        UvProlongation = 5,
    }

    /// <summary>How the method BELTRAMI flattens the fine mesh.</summary>
    public enum Flatten
    {
        Metric = 0,
        Dirichlet = 1,
        Gif = 2,
        Flim = 3,
        Bff = 4,
    }

    /// <summary>What the optimisation sees to. The certificate always judges global
    /// injectivity.</summary>
    public enum Injectivity
    {
        Auto = 0,
        Global = 1,
        Local = 2,
    }

    public enum Energy
    {
        SymmetricDirichlet = 0,
        SymmetricArap = 1,
        ExponentialDirichlet = 2,
    }

    /// <summary>How an option's value is given.</summary>
    public enum OptionType
    {
        Int = 0,
        Float = 1,
        Choice = 2,
    }

    /// <summary>What an option is for.</summary>
    public enum Call
    {
        Run = 1,
        Unwrap = 2,
        Pack = 4,
        Bake = 8,
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct NativeOptionInfo
    {
        public uint StructSize;
        /// <summary>BELTRAMI_OPTION_.</summary>
        public int Key;
        /// <summary>BELTRAMI_TYPE_.</summary>
        public int Type;
        /// <summary>0.</summary>
        public int Reserved;
        /// <summary>Inclusive.</summary>
        public double Minimum;
        /// <summary>Inclusive.</summary>
        public double Maximum;
        public double DefaultValue;
        /// <summary>"coarse-faces": the flag of the program, static.</summary>
        public IntPtr Name;
        /// <summary>One sentence, static.</summary>
        public IntPtr Summary;
        /// <summary>Sum of the BELTRAMI_CALL_ numbers of those that take it.</summary>
        public int Calls;
        /// <summary>0.</summary>
        public int Reserved2;
    }

    /// <summary>One job of a loop of the library.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public delegate void Job(IntPtr data, int index);

    /// <summary>A host's loop: calls `job(data, index)` once for each index from 0 to count - 1,
    /// and returns when all calls have returned. They may come from any threads, also that of the
    /// loop itself, several at a time or one after the other. A thread wants a stack of 512 KiB.
    /// Neither the loop nor the threads may leave a job by an exception.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public delegate void ParallelFor(IntPtr user, int count, Job job, IntPtr data);

    /// <summary>Element types of buffers.</summary>
    public enum Scalar
    {
        F32 = 0,
        F64 = 1,
        U32 = 2,
        U64 = 3,
        U8 = 4,
        U16 = 5,
    }

    /// <summary>Items of 2 or 3 consecutive elements, `stride` bytes from one item to the next (0:
    /// packed). The library never writes to a buffer that it takes as input. No alignment is
    /// required.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct NativeBuffer
    {
        public IntPtr Data;
        public ulong Stride;
        /// <summary>BELTRAMI_F32, ...</summary>
        public int Type;
        /// <summary>0.</summary>
        public uint Reserved;
    }

    /// <summary>A triangle mesh in the caller's memory. Its faces must form one consistently
    /// oriented disk: one component, edge- and vertex-manifold, one boundary loop, no handles.
    /// Vertices that no face uses are allowed: they get the UV (0, 0) and are counted in
    /// beltrami_result.unreferenced_vertices.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct NativeMesh
    {
        public uint StructSize;
        /// <summary>0.</summary>
        public uint Flags;
        /// <summary>At most 2^31 - 1.</summary>
        public ulong VertexCount;
        /// <summary>At most 700,000,000.</summary>
        public ulong FaceCount;
        /// <summary>Vertex_count items of 3: F32 or F64, in any unit of length.</summary>
        public NativeBuffer Positions;
        /// <summary>Face_count items of 3: U32 or U64, counter-clockwise.</summary>
        public NativeBuffer Indices;
        public IntPtr Cancel;
    }

    /// <summary>Called on the thread that called beltrami_run, only. `fraction` is in [0, 1] and
    /// never decreases; `stage` is the name of the stage under way. Return non-zero to
    /// cancel.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public delegate int Progress(IntPtr user, double fraction, IntPtr stage);

    /// <summary>The exact verdict on a map. Signs of areas and crossings are decided by exact
    /// predicates on the very floats given. Injective: every face positive, no boundary crossing,
    /// on one oriented disk.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Certificate
    {
        public uint StructSize;
        /// <summary>1 or 0.</summary>
        public int Injective;
        /// <summary>Faces of positive, negative, zero area in UV.</summary>
        public ulong Positive;
        public ulong Negative;
        public ulong Degenerate;
        /// <summary>Pairs of boundary edges that meet where they should not: of n edges all pairs
        /// while they are fewer than about n log n, else at least so many.</summary>
        public ulong BoundaryCrossings;
        /// <summary>A face that is not positive, or BELTRAMI_NO_ELEMENT.</summary>
        public ulong FirstBadFace;
        /// <summary>A vertex of each of two crossing edges, or BELTRAMI_NO_ELEMENT.</summary>
        public fixed ulong FirstCrossing[2];
        /// <summary>The element of an error status, or BELTRAMI_NO_ELEMENT.</summary>
        public ulong ErrorElement;
        /// <summary>BELTRAMI_ELEMENT_.</summary>
        public int ErrorElementKind;
        /// <summary>0.</summary>
        public int Reserved;
    }

    /// <summary>Distortion energies: means over the faces weighted by 3D area, at the scale of the
    /// UVs as given. NaN where no face is left to count. s1 &gt;= s2 are the singular values of the
    /// map of a face. Faces without 3D area, or whose map has no finite energy (flipped or
    /// degenerate), are left out and counted.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct EnergyReport
    {
        public uint StructSize;
        /// <summary>0.</summary>
        public uint Reserved;
        /// <summary>1/2 (s1^2 + s2^2 + s1^-2 + s2^-2), &gt;= 2.</summary>
        public double SymmetricDirichlet;
        /// <summary>(s1 - 1)^2 + (1/s2 - 1)^2, &gt;= 0.</summary>
        public double SymmetricArap;
        /// <summary>Greatest symmetric Dirichlet energy of a face.</summary>
        public double Max;
        /// <summary>Where, or BELTRAMI_NO_ELEMENT.</summary>
        public ulong WorstFace;
        /// <summary>Faces left out.</summary>
        public ulong LeftOut;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct FlattenReport
    {
        public uint StructSize;
        /// <summary>What beltrami_run returned.</summary>
        public Status Status;
        /// <summary>Of the input.</summary>
        public ulong Vertices;
        public ulong Faces;
        public ulong BoundaryEdges;
        /// <summary>Vertices that no face uses: UV (0, 0).</summary>
        public ulong UnreferencedVertices;
        /// <summary>Of the mesh that CM ran on.</summary>
        public ulong CoarseFaces;
        /// <summary>Faces that were not positive before repair.</summary>
        public ulong FlipsBeforeRepair;
        /// <summary>Of the input, in its unit squared.</summary>
        public double Area;
        /// <summary>Wall time of the run.</summary>
        public double Seconds;
        /// <summary>Of the whole process during the run.</summary>
        public double CpuSeconds;
        /// <summary>Of the whole process so far.</summary>
        public ulong PeakMemoryBytes;
        /// <summary>Vertices that repair moved into the kernel of their one-ring.</summary>
        public ulong KernelFixes;
        /// <summary>Patches that repair untangled.</summary>
        public ulong PatchFixes;
        /// <summary>Layouts that repair embedded anew, with a scaffold.</summary>
        public ulong GlobalFixes;
        /// <summary>Patches optimised around faces of enormous energy.</summary>
        public ulong CleanedPatches;
        /// <summary>Tries after the first, whose map was not injective.</summary>
        public ulong Restarts;
        /// <summary>Vertices that are not at the nearest float in F32.</summary>
        public ulong Float32Moves;
        /// <summary>With the option delaunay: edges flipped.</summary>
        public ulong DelaunayFlips;
        /// <summary>Edges that are not Delaunay: their flip would repeat an edge.</summary>
        public ulong DelaunayRefused;
        /// <summary>Of the input: faces without area, which no energy counts.</summary>
        public ulong DegenerateFaces;
        /// <summary>The first of them, or BELTRAMI_NO_ELEMENT.</summary>
        public ulong FirstDegenerateFace;
        /// <summary>Mean energy of the coarse map; 0 where CM did not run.</summary>
        public double CoarseEnergy;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct Stage
    {
        public uint StructSize;
        /// <summary>0 where a stage does not iterate.</summary>
        public int Iterations;
        /// <summary>Wall time.</summary>
        public double Seconds;
        /// <summary>Of the whole process.</summary>
        public double CpuSeconds;
        /// <summary>Static: "simplify", "coarse", "prolong", "flatten", "repair", ...</summary>
        public IntPtr Name;
    }

    /// <summary>Polygons in the caller's memory: any number of components, with holes and handles
    /// or without, closed or open, of any quality. Nothing is refused but indices out of range,
    /// numbers that are not finite, and surfaces without any area. What is not manifold is parted,
    /// faces that disagree are turned, and every corner gets its UV. A corner is one vertex of one
    /// face; corners are counted from 0, face after face. Buffers said to be optional are left out
    /// by data NULL.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct NativeSurface
    {
        public uint StructSize;
        /// <summary>0.</summary>
        public uint Flags;
        /// <summary>At most 2^31 - 1.</summary>
        public ulong VertexCount;
        /// <summary>At most 700,000,000 triangles, polygons counted by theirs.</summary>
        public ulong FaceCount;
        /// <summary>Of all faces; 0 where all are triangles.</summary>
        public ulong CornerCount;
        /// <summary>Vertex_count items of 3: F32 or F64, in any unit of length.</summary>
        public NativeBuffer Positions;
        /// <summary>The vertex of each corner, U32 or U64: face_count items of 3 where face_sizes
        /// is left out, else corner_count items of 1.</summary>
        public NativeBuffer Indices;
        /// <summary>Optional: face_count items of 1, U32 or U64: corners, 3 or more.</summary>
        public NativeBuffer FaceSizes;
        /// <summary>Optional: an item of 2 per corner, F32 or F64.</summary>
        public NativeBuffer CornerUvs;
        /// <summary>Optional: face_count items of 1, U32 or U64: materials, groups; seams run where
        /// they differ.</summary>
        public NativeBuffer FaceLabels;
        /// <summary>Optional: face_count items of 1, F32 or F64, above 0: how much larger the face
        /// is to be in the plane. A chart has the mean.</summary>
        public NativeBuffer Densities;
        /// <summary>Optional: seam_count items of 2, U32 or U64: edges to cut, by their vertices;
        /// pairs that are no edge are ignored.</summary>
        public NativeBuffer Seams;
        public ulong SeamCount;
        /// <summary>As in beltrami_mesh.</summary>
        public IntPtr Cancel;
        /// <summary>Optional: pin_count items of 1, U32 or U64: corners.</summary>
        public NativeBuffer Pins;
        /// <summary>Pin_count items of 2, F32 or F64, in the unit of positions.</summary>
        public NativeBuffer PinUvs;
        public ulong PinCount;
        /// <summary>Optional: vertex_count items of 1, F32 or F64: factors; an edge has the
        /// geometric mean of its ends.</summary>
        public NativeBuffer VertexPaint;
        /// <summary>Optional: painted_edge_count items of 2, U32 or U64: edges by their vertices;
        /// pairs that are no edge are ignored.</summary>
        public NativeBuffer PaintedEdges;
        /// <summary>Painted_edge_count items of 1, F32 or F64: factors, which multiply those of the
        /// ends; those of one edge multiply.</summary>
        public NativeBuffer EdgePaint;
        public ulong PaintedEdgeCount;
        /// <summary>Optional: face_count items of 1, U32 or U64: where they differ a seam costs the
        /// factor of the option material-seams.</summary>
        public NativeBuffer Materials;
        /// <summary>Optional: pin_count items of 1, U32 or U64: BELTRAMI_PIN_; else all are
        /// POINT.</summary>
        public NativeBuffer PinKinds;
        public NativeBuffer PinDirections;
        /// <summary>Optional: straight_edge_count items of 2, U32 or U64: edges by their
        /// vertices.</summary>
        public NativeBuffer StraightEdges;
        /// <summary>Straight_edge_count items of 1, U32 or U64: BELTRAMI_PIN_U, V or
        /// LINE.</summary>
        public NativeBuffer StraightKinds;
        public ulong StraightEdgeCount;
        /// <summary>Optional: rectangle_count items of 1, U32 or U64: faces; the chart of each
        /// becomes a rectangle along the axes.</summary>
        public NativeBuffer Rectangles;
        /// <summary>Optional: rectangle_count items of 4, U32 or U64: vertices of its border, in
        /// any order; four BELTRAMI_NO_ELEMENT of U64, or left out: the four where its border turns
        /// most.</summary>
        public NativeBuffer RectangleCorners;
        public ulong RectangleCount;
    }

    /// <summary>What was made of a surface. Triangles are those of beltrami_triangulate, faces the
    /// input's.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct AtlasReport
    {
        public uint StructSize;
        /// <summary>What beltrami_unwrap returned.</summary>
        public Status Status;
        /// <summary>Of the input.</summary>
        public ulong Vertices;
        public ulong Faces;
        public ulong Corners;
        public ulong Triangles;
        public ulong Charts;
        /// <summary>What a vertex buffer needs: vertices, split along the seams.</summary>
        public ulong UvVertices;
        /// <summary>That no face names.</summary>
        public ulong UnusedVertices;
        /// <summary>That count as one with a vertex before them.</summary>
        public ulong WeldedVertices;
        /// <summary>Triangles that name a vertex twice: each gets a point.</summary>
        public ulong RepeatedFaces;
        /// <summary>Others without area (of the largest triangle, or the square of their longest
        /// edge, 1e-14): each gets a point.</summary>
        public ulong FacesWithoutArea;
        /// <summary>Triangles with the vertices of one before them: each lies in a layer of its
        /// own, or shares the UVs of the first.</summary>
        public ulong Copies;
        /// <summary>Of more than two triangles: those stay together that continue each
        /// other.</summary>
        public ulong CrowdedEdges;
        /// <summary>Where the sides of a one-sided surface part.</summary>
        public ulong OneSidedEdges;
        /// <summary>Where fans of faces met in one point only.</summary>
        public ulong SplitVertices;
        /// <summary>Triangles turned over to agree with most of their component; those with a short
        /// border part from it instead.</summary>
        public ulong ReversedFaces;
        public ulong Components;
        /// <summary>Without a boundary.</summary>
        public ulong ClosedComponents;
        /// <summary>Boundaries but for the first of each component.</summary>
        public ulong Holes;
        /// <summary>Boundaries that cost no seam.</summary>
        public ulong FilledHoles;
        /// <summary>Triangles that no energy counts: flipped, or without area.</summary>
        public ulong LeftOut;
        /// <summary>Of the surface, in its unit squared.</summary>
        public double Area;
        /// <summary>On the surface, each seam once, no open border.</summary>
        public double SeamLength;
        /// <summary>Area of the UVs over that of the pages, or where it is not packed of their
        /// bounding box.</summary>
        public double Utilisation;
        /// <summary>Mean over the area, at one scale for all: &gt;= 2.</summary>
        public double SymmetricDirichlet;
        /// <summary>Exceeded on 1% of the area at most.</summary>
        public double P99;
        public double Max;
        /// <summary>Wall time of the run.</summary>
        public double Seconds;
        /// <summary>Of the whole process during the run.</summary>
        public double CpuSeconds;
        /// <summary>Of the whole process so far.</summary>
        public ulong PeakMemoryBytes;
        /// <summary>Edges, see beltrami_get_seams.</summary>
        public ulong Seams;
        /// <summary>1 where seams were searched for: with the cut AUTO; else 0.</summary>
        public int Searched;
        /// <summary>1 where those meet what was asked for: energy (to 0.0001), p99, charts (or one
        /// for each component), seam length; else 0.</summary>
        public int Reached;
        /// <summary>0 where it is not packed: beltrami_get_packing has the rest.</summary>
        public ulong Pages;
        /// <summary>Triangles that no energy above counts: the worst ones, which together have less
        /// than a millionth of the area.</summary>
        public ulong Slivers;
        /// <summary>What it would be with them.</summary>
        public double SymmetricDirichletWithSlivers;
        /// <summary>Likewise.</summary>
        public double MaxWithSlivers;
        /// <summary>Components, as the cuts that are given part them, that miss the energy or p99
        /// that seams were searched for: each is to have it.</summary>
        public ulong MissedParts;
        /// <summary>The first face of the worst of them, or BELTRAMI_NO_ELEMENT.</summary>
        public ulong MissedFace;
        /// <summary>Of that part.</summary>
        public ulong MissedTriangles;
        /// <summary>Its mean.</summary>
        public double MissedEnergy;
        /// <summary>Components that lie on others of their shape, by the option stack: no area,
        /// energy or verdict counts them.</summary>
        public ulong StackedParts;
    }

    /// <summary>A chart: a connected piece of the surface.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct ChartReport
    {
        public uint StructSize;
        /// <summary>OK, NOT_CONVERGED, NOT_INJECTIVE or NOT_INJECTIVE_FLOAT32.</summary>
        public Status Status;
        /// <summary>Why it has no map but one point, e.g. SOLVER; else OK.</summary>
        public Status Error;
        /// <summary>0.</summary>
        public int Reserved;
        public ulong Triangles;
        /// <summary>Of the input, the least.</summary>
        public ulong FirstFace;
        /// <summary>On the surface, in its unit squared.</summary>
        public double Area;
        /// <summary>Mean of its faces' densities, or what its pins ask for; else 1.</summary>
        public double Density;
        /// <summary>As of the atlas.</summary>
        public double SymmetricDirichlet;
        public double Max;
        /// <summary>Of its UVs: least u, least v, greatest u, greatest v.</summary>
        public fixed double Box[4];
        /// <summary>Counted from 0; 0 where the atlas is not packed.</summary>
        public ulong Page;
    }

    /// <summary>The exact verdict on an atlas: every triangle positive, no two with a common inner
    /// point, in one chart or in two. Signs are decided by exact predicates on the very floats
    /// given.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct AtlasCertificate
    {
        public uint StructSize;
        /// <summary>1 or 0.</summary>
        public int Injective;
        /// <summary>Triangles of positive, negative, zero area in UV.</summary>
        public ulong Positive;
        public ulong Negative;
        public ulong Degenerate;
        /// <summary>Not judged: without area on the surface, sharing UVs, or stacked.</summary>
        public ulong Excepted;
        /// <summary>All of whose triangles were negative, taken as their mirror images.</summary>
        public ulong MirroredCharts;
        /// <summary>Triangles in them.</summary>
        public ulong MirroredFaces;
        /// <summary>Pairs of triangles that overlap, one at least at a seam or border: all of them
        /// while they are few, else at least so many.</summary>
        public ulong Overlaps;
        /// <summary>Two faces that overlap, or BELTRAMI_NO_ELEMENT.</summary>
        public fixed ulong FirstOverlap[2];
        /// <summary>A face that is not positive, or BELTRAMI_NO_ELEMENT.</summary>
        public ulong FirstBadFace;
        /// <summary>Where borders touch, which is allowed.</summary>
        public ulong TouchingPlaces;
        /// <summary>The element of an error status, or BELTRAMI_NO_ELEMENT.</summary>
        public ulong ErrorElement;
        /// <summary>BELTRAMI_ELEMENT_.</summary>
        public int ErrorElementKind;
        /// <summary>0.</summary>
        public int Reserved;
    }

    /// <summary>Triangles in the plane, in the caller's memory: what beltrami_pack packs. Triangles
    /// that share a UV vertex are of one chart. Buffers said to be optional are left out by data
    /// NULL.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct NativeUvMesh
    {
        public uint StructSize;
        /// <summary>0.</summary>
        public uint Flags;
        /// <summary>UV vertices, at most 2^31 - 1, those of all meshes together.</summary>
        public ulong UvCount;
        /// <summary>At most 700,000,000, likewise.</summary>
        public ulong FaceCount;
        /// <summary>Uv_count items of 2: F32 or F64.</summary>
        public NativeBuffer Uvs;
        /// <summary>Face_count items of 3: U32 or U64, the UV vertices of corners.</summary>
        public NativeBuffer UvIndices;
        /// <summary>Of positions.</summary>
        public ulong VertexCount;
        /// <summary>Optional: vertex_count items of 3: F32 or F64. With them charts get equally
        /// many texels for equal areas on the surface, else they keep their sizes to each other.
        /// All meshes have them, or none.</summary>
        public NativeBuffer Positions;
        /// <summary>With positions: face_count items of 3: U32 or U64, the vertices of corners;
        /// left out where UV vertices are vertices.</summary>
        public NativeBuffer Indices;
        /// <summary>Optional: face_count items of 1: U32 or U64. All bits set: the chart of the
        /// face is placed anew; else it stays where its UVs, in [0,1]^2, are on this page. The same
        /// for all faces of a chart.</summary>
        public NativeBuffer KeptPages;
        /// <summary>Of the first mesh: as in beltrami_mesh.</summary>
        public IntPtr Cancel;
        public NativeBuffer PageLabels;
    }

    /// <summary>What lies on the pages.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct PackingReport
    {
        public uint StructSize;
        /// <summary>Of the call that packed it.</summary>
        public Status Status;
        public ulong Charts;
        public ulong Triangles;
        public ulong Pages;
        /// <summary>Texels to the side of a page.</summary>
        public ulong Resolution;
        /// <summary>Of the surface, or without positions of the UVs that were packed.</summary>
        public double TexelsPerUnit;
        /// <summary>Area of the UVs over that of the pages.</summary>
        public double Utilisation;
        /// <summary>Texels: the least of the distances of two charts and of twice those to the
        /// edges of pages, in the numbers that are delivered.</summary>
        public double Margin;
        /// <summary>Wall time of the call.</summary>
        public double Seconds;
        /// <summary>Of the whole process during the call.</summary>
        public double CpuSeconds;
        /// <summary>Charts that were made two of, with the option fill-weight.</summary>
        public ulong Splits;
        /// <summary>Of the seams of those, in roots of the surface's area.</summary>
        public double SplitLength;
        /// <summary>Utilisation without splits; the same where there are none.</summary>
        public double UnsplitUtilisation;
    }

    /// <summary>What a byte of a mask says of its texel.</summary>
    public enum Texel
    {
        Free = 0,
        Gutter = 1,
        Covered = 2,
    }

    /// <summary>What a chart keeps, beside its lock: a sum of these.</summary>
    public enum Chart
    {
        KeepFrame = 1,
        KeepScale = 2,
        Align = 4,
        Stack = 8,
    }

    /// <summary>How a session stands.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct NativeSession
    {
        public uint StructSize;
        /// <summary>The greatest reservation of all charts.</summary>
        public Status Status;
        public ulong Charts;
        /// <summary>Charts that are to be mapped further.</summary>
        public ulong Due;
        /// <summary>Of the surface.</summary>
        public ulong Corners;
        /// <summary>Corners that the last update, pack or restore moved.</summary>
        public ulong Changes;
        /// <summary>Edges cut beside the seams.</summary>
        public ulong Opened;
        /// <summary>Mean over the area, each chart at its scale; NaN before the first
        /// update.</summary>
        public double SymmetricDirichlet;
        /// <summary>Of the last update, pack or check.</summary>
        public double Seconds;
        public double CpuSeconds;
    }

    /// <summary>A chart of a session.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct NativeSessionChart
    {
        public uint StructSize;
        /// <summary>OK, NOT_CONVERGED or NOT_INJECTIVE: by itself.</summary>
        public Status Status;
        /// <summary>1 or 0.</summary>
        public int Due;
        /// <summary>1: all of its faces are.</summary>
        public int Locked;
        /// <summary>Its number: it stays while most of the chart does, and is given once.</summary>
        public ulong Id;
        public ulong Triangles;
        /// <summary>Of the input, the least.</summary>
        public ulong FirstFace;
        public double SymmetricDirichlet;
        /// <summary>Lengths in the plane per length on the surface that it is to have.</summary>
        public double Scale;
        /// <summary>A sum of BELTRAMI_CHART_ numbers: those of all of its faces.</summary>
        public uint Flags;
        /// <summary>0.</summary>
        public uint Reserved;
        /// <summary>The number of the chart that it lies on; all bits set: none.</summary>
        public ulong StackedOn;
    }

    /// <summary>What an image shows beyond [0,1]^2.</summary>
    public enum Wrap
    {
        Repeat = 0,
        Clamp = 1,
        Mirror = 2,
    }

    /// <summary>How texels are read.</summary>
    public enum Filter
    {
        Linear = 0,
        Nearest = 1,
    }

    /// <summary>What the channels of an image are, which says how a mean of them is
    /// taken.</summary>
    public enum Pixels
    {
        Linear = 0,
        Srgb = 1,
        SrgbAlpha = 2,
        Normals = 3,
        Occlusion = 4,
    }

    /// <summary>An image in the caller's memory: rows from the top (v = 1) down, integers in their
    /// whole range.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct NativeImage
    {
        public IntPtr Pixels;
        /// <summary>1 to 65536.</summary>
        public ulong Width;
        /// <summary>1 to 65536.</summary>
        public ulong Height;
        /// <summary>Bytes from one row to the next (0: packed).</summary>
        public ulong Stride;
        /// <summary>BELTRAMI_U8, BELTRAMI_U16 or BELTRAMI_F32.</summary>
        public int Type;
        /// <summary>1 to 4.</summary>
        public uint Channels;
    }

    /// <summary>Triangles with two layouts of UVs, and the images of the old one. A corner is one
    /// of 3 of each face, one after another. Buffers said to be optional are left out by data
    /// NULL.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct NativeBakeJob
    {
        public uint StructSize;
        /// <summary>0.</summary>
        public uint Flags;
        /// <summary>One for each old page, of one type and as many channels. For OCCLUSION one,
        /// whose type and channels alone are looked at.</summary>
        public IntPtr Images;
        public ulong ImageCount;
        /// <summary>BELTRAMI_PIXELS_.</summary>
        public int Pixels;
        /// <summary>BELTRAMI_FILTER_.</summary>
        public int Filter;
        /// <summary>BELTRAMI_WRAP_.</summary>
        public int WrapU;
        /// <summary>BELTRAMI_WRAP_.</summary>
        public int WrapV;
        /// <summary>At most 700,000,000.</summary>
        public ulong FaceCount;
        /// <summary>An item of 2 per corner, F32 or F64, on the page of the face:
        /// [0,1]^2.</summary>
        public NativeBuffer NewUvs;
        /// <summary>Optional: face_count items of 1, U32 or U64, counted from 0; all bits set: the
        /// face is on none. Left out: all are on page 0.</summary>
        public NativeBuffer NewPages;
        /// <summary>An item of 2 per corner, F32 or F64, in units of the image of the page. A face
        /// with one that is not finite has no source.</summary>
        public NativeBuffer OldUvs;
        /// <summary>Optional: as new_pages, of images; all bits set: no source.</summary>
        public NativeBuffer OldPages;
        /// <summary>An item of 3 per corner, F32 or F64; optional but for NORMALS and with
        /// source_positions.</summary>
        public NativeBuffer Positions;
        /// <summary>Optional, for NORMALS and with a cage: an item of 3 per corner, F32 or F64; NaN
        /// or left out: that of the face.</summary>
        public NativeBuffer Normals;
        /// <summary>Optional, for NORMALS: an item of 4 per corner, F32 or F64: the axis of the old
        /// u, and -1 where UVs are mirrored, else 1. Left out: as MikkTSpace has them.</summary>
        public NativeBuffer Tangents;
        /// <summary>With source_positions.</summary>
        public ulong SourceFaceCount;
        /// <summary>Optional: an item of 3 per corner of another surface of the same shape in the
        /// same place, F32 or F64. Then old_uvs and old_pages are of its source_face_count faces.
        /// Each texel shows the nearest place of it, of a face that looks the same way. Not for
        /// NORMALS.</summary>
        public NativeBuffer SourcePositions;
        /// <summary>Texels to the side of a new page, 1 to 32768.</summary>
        public ulong Resolution;
        /// <summary>Texels around charts that continue them; all bits set: the whole
        /// page.</summary>
        public ulong Gutter;
        /// <summary>New pages, 1 to 1000.</summary>
        public ulong PageCount;
        /// <summary>As in beltrami_mesh.</summary>
        public IntPtr Cancel;
        /// <summary>With source_positions, in their unit: 0, or how far rays along the normals look
        /// for the source. One comes from as far outside and goes as far inside; the first face
        /// that it comes to from outside is shown. Where it meets none, the nearest place is. Gaps
        /// stay closed where corners in one place have one normal.</summary>
        public double Cage;
        /// <summary>For OCCLUSION, 1 to 4096: from each texel to the sky. The faces hide it, or
        /// with source_positions those of the source.</summary>
        public ulong Rays;
    }

    /// <summary>Room for what is baked, and what is told of it.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe struct NativeBaked
    {
        public uint StructSize;
        /// <summary>0.</summary>
        public uint Reserved;
        /// <summary>Given: room for page_count pages of resolution rows from the top, one page
        /// after another, of the images' type and channels; 0 where nothing is baked.</summary>
        public IntPtr Pixels;
        /// <summary>Given: bytes from one row to the next (0: packed).</summary>
        public ulong Stride;
        /// <summary>Given: NULL, or room for a byte per texel of each page, a BELTRAMI_TEXEL_
        /// number.</summary>
        public IntPtr Masks;
        /// <summary>That a face covers, at least in part.</summary>
        public ulong Texels;
        /// <summary>Of these: nothing was baked there.</summary>
        public ulong WithoutSource;
        /// <summary>Of the images along the side of a new texel, in the mean: above 1 is coarser
        /// than before; 0 with source_positions.</summary>
        public double OldTexels;
        /// <summary>Wall time of the call.</summary>
        public double Seconds;
        /// <summary>Of the whole process during the call.</summary>
        public double CpuSeconds;
    }

    /// <summary>The C interface as it is: docs/reference.md says what each function
    /// does.</summary>
    public static unsafe class Native
    {
        /// <summary>libbeltrami.so, beltrami.dll or libbeltrami.dylib.</summary>
        public const string Library = "beltrami";
        /// <summary>The number of the binary interface that this was made for.</summary>
        public const uint Abi = 1;
        /// <summary>No element, in fields of elements.</summary>
        public const ulong NoElement = ulong.MaxValue;

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern uint beltrami_version();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr beltrami_build_info();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int beltrami_has(string feature);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr beltrami_status_name(Status status);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr beltrami_status_advice(Status status);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_create_(uint abi, IntPtr* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_create_with_(
            uint abi,
            NativeAllocator* allocator,
            IntPtr* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void beltrami_destroy(IntPtr context);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr beltrami_error_message(IntPtr context);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern ulong beltrami_error_element(IntPtr context);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int beltrami_error_element_kind(IntPtr context);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int beltrami_option_find(string name);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_option_describe(int key, NativeOptionInfo* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr beltrami_option_choice(int key, int value);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_set_int(IntPtr context, int key, long value);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_set_float(IntPtr context, int key, double value);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_set_parallel_for(
            IntPtr context,
            ParallelFor parallelFor,
            IntPtr user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_option(IntPtr context, int key, double* value);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_set_mesh(IntPtr context, NativeMesh* mesh);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_estimate_memory(IntPtr context, ulong* bytes);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_run(IntPtr context, Progress progress, IntPtr user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void beltrami_cancel(IntPtr context);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_result(IntPtr context, FlattenReport* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_uvs(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_certificate(IntPtr context, Certificate* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_float32_certificate(
            IntPtr context,
            Certificate* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_faces(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_energy(IntPtr context, EnergyReport* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_face_energies(
            IntPtr context,
            IntPtr result,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int beltrami_stage_count(IntPtr context);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_stage(IntPtr context, int index, Stage* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_triangulate(
            NativeSurface* surface,
            IntPtr result,
            int type,
            ulong stride,
            ulong* repeating);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_unwrap(
            IntPtr context,
            NativeSurface* surface,
            Progress progress,
            IntPtr user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_unwrap_surfaces(
            IntPtr context,
            NativeSurface** surfaces,
            ulong surfaceCount,
            Progress progress,
            IntPtr user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_atlas(IntPtr context, AtlasReport* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_chart(
            IntPtr context,
            ulong index,
            ChartReport* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_atlas_certificate(
            IntPtr context,
            int type,
            AtlasCertificate* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_corner_uvs(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_corner_pages(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_corner_uv_vertices(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_uv_vertices(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_uv_vertex_origins(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_face_charts(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_seams(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_triangles(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int beltrami_atlas_stage_count(IntPtr context);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_atlas_stage(
            IntPtr context,
            int index,
            Stage* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_check_atlas(
            NativeSurface* surface,
            int allowMirrored,
            AtlasCertificate* result,
            ulong* pairs,
            ulong capacity);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_pack(
            IntPtr context,
            NativeUvMesh** meshes,
            ulong meshCount,
            Progress progress,
            IntPtr user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_packing(IntPtr context, PackingReport* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_page_utilisations(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_chart_pages(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_packing_certificate(
            IntPtr context,
            int type,
            AtlasCertificate* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_page_mask(
            IntPtr context,
            ulong page,
            byte* result,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_packed_uvs(
            IntPtr context,
            ulong mesh,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_packed_charts(
            IntPtr context,
            ulong mesh,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_begin(
            IntPtr context,
            NativeSurface* surface,
            Progress progress,
            IntPtr user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_end(IntPtr context);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_set_seams(
            IntPtr context,
            NativeBuffer* edges,
            ulong count,
            int open);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_set_pins(
            IntPtr context,
            NativeBuffer* corners,
            NativeBuffer* uvs,
            ulong count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_set_pin_kinds(
            IntPtr context,
            NativeBuffer* kinds,
            NativeBuffer* directions,
            ulong count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_select(
            IntPtr context,
            NativeBuffer* faces,
            ulong count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_lock(
            IntPtr context,
            NativeBuffer* charts,
            ulong count,
            int locked);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_set_flags(
            IntPtr context,
            NativeBuffer* charts,
            ulong count,
            uint flags);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_renew(
            IntPtr context,
            NativeBuffer* charts,
            ulong count,
            int cold);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_update(
            IntPtr context,
            double seconds,
            int steps,
            Progress progress,
            IntPtr user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_pack(
            IntPtr context,
            NativeBuffer* charts,
            ulong count,
            Progress progress,
            IntPtr user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_check(
            IntPtr context,
            AtlasCertificate* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_save(IntPtr context, ulong* mark);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_restore(IntPtr context, ulong mark);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_session_forget(IntPtr context, ulong mark);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_session(IntPtr context, NativeSession* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_session_chart(
            IntPtr context,
            ulong index,
            NativeSessionChart* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_session_uvs(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_session_changes(
            IntPtr context,
            IntPtr corners,
            int cornerType,
            IntPtr uvs,
            int uvType);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_session_face_charts(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_get_session_opened(
            IntPtr context,
            IntPtr result,
            int type,
            ulong stride);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_bake(
            IntPtr context,
            NativeBakeJob* job,
            NativeBaked* result,
            Progress progress,
            IntPtr user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_check_triangles(
            NativeMesh* mesh,
            NativeBuffer* uvs,
            Certificate* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_check_boundary(
            NativeMesh* mesh,
            NativeBuffer* uvs,
            Certificate* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_check_injective(
            NativeMesh* mesh,
            NativeBuffer* uvs,
            Certificate* result);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_measure(
            NativeMesh* mesh,
            NativeBuffer* uvs,
            EnergyReport* result,
            double* faceEnergies);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Status beltrami_measure_faces(
            NativeMesh* mesh,
            NativeBuffer* uvs,
            IntPtr result,
            ulong stride);
    }
}
