// From the C header and the library's table of options.
// Written by tools/generate.py: change it there.

namespace Beltrami
{
    /// <summary>The options of a context, with what each is for.</summary>
    public sealed partial class Options
    {
        /// <summary>How the map is computed: beltrami (fast and low in distortion), cm (composite
        /// majorization on the full mesh, the slow reference) or tutte (into a circle, highly
        /// distorted). Baselines to compare with are gif and bff on the surface's own metric, and
        /// uv-prolongation of the coarse UVs; bff and uv-prolongation may flip. Default:
        /// Method.Beltrami.</summary>
        public Method Method
        {
            get { return (Method)(int)Get(Option.Method); }
            set { SetInt(Option.Method, (long)value); }
        }

        /// <summary>The distortion that is minimised; exponential-dirichlet lowers it where it is
        /// highest, at a mean that is a little higher. Default:
        /// Energy.SymmetricDirichlet.</summary>
        public Energy Energy
        {
            get { return (Energy)(int)Get(Option.Energy); }
            set { SetInt(Option.Energy, (long)value); }
        }

        /// <summary>Faces of the simplified mesh that composite majorization runs on. 0 chooses 1%
        /// of the faces, at least 10,000; or 1,000 to 5,000 where meshes from 4,000 faces on go
        /// through levels. A number from 0 to 700,000,000. Default: 0.</summary>
        public long CoarseFaces
        {
            get { return (long)Get(Option.CoarseFaces); }
            set { SetInt(Option.CoarseFaces, value); }
        }

        /// <summary>Relative decrease of the energy in one iteration below which composite
        /// majorization stops. A number from 0 to 1. Default: 0.0001.</summary>
        public double Tolerance
        {
            get { return Get(Option.Tolerance); }
            set { SetFloat(Option.Tolerance, value); }
        }

        /// <summary>Iterations after which composite majorization stops even if it has not
        /// converged. A number from 1 to 1,000,000. Default: 500.</summary>
        public long MaxIterations
        {
            get { return (long)Get(Option.MaxIterations); }
            set { SetInt(Option.MaxIterations, value); }
        }

        /// <summary>Threads to use, the calling one included; the result does not depend on it. A
        /// number from 1 to 1,024. Default: 1.</summary>
        public long Threads
        {
            get { return (long)Get(Option.Threads); }
            set { SetInt(Option.Threads, value); }
        }

        /// <summary>True scales and shifts the UVs into the unit square, where those of pages are
        /// in any case; false keeps them in the mesh's unit of length. Default: false.</summary>
        public bool UnitSquare
        {
            get { return Get(Option.UnitSquare) != 0; }
            set { SetInt(Option.UnitSquare, value ? 1 : 0); }
        }

        /// <summary>How the method beltrami flattens the fine mesh. metric: a Poisson solve with a
        /// free boundary, and a polish. dirichlet: harmonic, boundary from the coarse map, faster,
        /// energy a little higher. gif: a harmonic subspace of a few boundary vertices with a
        /// scaffold. flim: the same, local injectivity only. bff: conformal, may flip. Default:
        /// Flatten.Metric.</summary>
        public Flatten Flatten
        {
            get { return (Flatten)(int)Get(Option.Flatten); }
            set { SetInt(Option.Flatten, (long)value); }
        }

        /// <summary>What the optimisation sees to: global (no flips, no boundary crossings), local
        /// (no flips: parts may overlap, at a slightly lower energy) or auto. That is global, but
        /// for the method cm, which is left as the literature has it. Default:
        /// Injectivity.Auto.</summary>
        public Injectivity Injectivity
        {
            get { return (Injectivity)(int)Get(Option.Injectivity); }
            set { SetInt(Option.Injectivity, (long)value); }
        }

        /// <summary>True goes on with composite majorization on the fine mesh from the result, to a
        /// little less energy in much more time. Default: false.</summary>
        public bool Refine
        {
            get { return Get(Option.Refine) != 0; }
            set { SetInt(Option.Refine, value ? 1 : 0); }
        }

        /// <summary>Iterations after which the refinement stops; 0 leaves it to the tolerance. A
        /// number from 0 to 1,000,000. Default: 0.</summary>
        public long RefineIterations
        {
            get { return (long)Get(Option.RefineIterations); }
            set { SetInt(Option.RefineIterations, value); }
        }

        /// <summary>Seconds since the start of the run after which iterations stop with the best
        /// map so far; 0 sets no limit. A number from 0 to 1,000,000,000. Default: 0.0.</summary>
        public double TimeLimit
        {
            get { return Get(Option.TimeLimit); }
            set { SetFloat(Option.TimeLimit, value); }
        }

        /// <summary>True delivers UVs that single precision holds exactly, rounded so that the map
        /// stays injective. Default: false.</summary>
        public bool Float32
        {
            get { return Get(Option.Float32) != 0; }
            set { SetInt(Option.Float32, value ? 1 : 0); }
        }

        /// <summary>True flips edges to the intrinsic Delaunay triangulation of the prolonged
        /// metric before the fine mesh is flattened: what is injective then are its own triangles
        /// on the same vertices. Default: false.</summary>
        public bool Delaunay
        {
            get { return Get(Option.Delaunay) != 0; }
            set { SetInt(Option.Delaunay, value ? 1 : 0); }
        }

        /// <summary>Bytes of memory that a run is to stay within by its estimate; 0 sets no limit.
        /// A run that needs more ends before it starts. Steps that only hard meshes need are left
        /// out where they would exceed it, or end the run if there is no map without them. A number
        /// from 0 to 1e+14. Default: 0.</summary>
        public long MemoryLimit
        {
            get { return (long)Get(Option.MemoryLimit); }
            set { SetInt(Option.MemoryLimit, value); }
        }

        /// <summary>Where seams go beside those that are given. auto: short ones are searched for,
        /// along which the atlas has the target-energy. minimal: a short cut graph where a piece is
        /// no disk. islands: around the charts of the UVs that the mesh has, of which what is no
        /// disk is opened. given: nowhere, and what is no disk is opened as by minimal. Default:
        /// Cut.Auto.</summary>
        public Cut Cut
        {
            get { return (Cut)(int)Get(Option.Cut); }
            set { SetInt(Option.Cut, (long)value); }
        }

        /// <summary>Degrees between the normals of two faces above which the edge between them is a
        /// seam, but for creases that end within the surface and part nothing; 180 makes none. A
        /// number from 0 to 180. Default: 180.0.</summary>
        public double HardAngle
        {
            get { return Get(Option.HardAngle); }
            set { SetFloat(Option.HardAngle, value); }
        }

        /// <summary>Whether vertices at one place, to the last bit, count as one: auto (yes, but a
        /// mesh that is one disk as it stands stays so), on or off. Default: Weld.Auto.</summary>
        public Weld Weld
        {
            get { return (Weld)(int)Get(Option.Weld); }
            set { SetInt(Option.Weld, (long)value); }
        }

        /// <summary>Vertices no further apart, in the mesh's unit of length, count as one; 0 those
        /// at one place. A number from 0 to 1e+100. Default: 0.0.</summary>
        public double WeldDistance
        {
            get { return Get(Option.WeldDistance); }
            set { SetFloat(Option.WeldDistance, value); }
        }

        /// <summary>Holes whose boundary is no longer than this many roots of their component's
        /// area cost no seam, larger ones are joined to one; 0 joins all. The longest of a
        /// component is its outline. A number from 0 to 1,000,000,000. Default: 0.5.</summary>
        public double FillHoles
        {
            get { return Get(Option.FillHoles); }
            set { SetFloat(Option.FillHoles, value); }
        }

        /// <summary>True gives copies of a face, as of double-sided surfaces, the UVs of the first
        /// instead of a layer of their own. Default: false.</summary>
        public bool ShareCopies
        {
            get { return Get(Option.ShareCopies) != 0; }
            set { SetInt(Option.ShareCopies, value ? 1 : 0); }
        }

        /// <summary>What the seams are for: sets options of the search that are not set otherwise.
        /// none: their defaults. lightmap: target-energy 2.1, hidden-seams 0, hard-seams 0.5,
        /// flat-seams 2. texturing: concave-seams 0.6, hidden-seams 2. one-chart: max-charts 1.
        /// hard-surface: hard-seams 0.5, flat-seams 6. Default: Preset.None.</summary>
        public Preset Preset
        {
            get { return (Preset)(int)Get(Option.Preset); }
            set { SetInt(Option.Preset, (long)value); }
        }

        /// <summary>Mean symmetric Dirichlet energy of the atlas that seams are searched for, 2 for
        /// lengths that all stay: the nearer to 2, the longer the seams. A number from 2.0001 to
        /// 1,000,000,000. Default: 2.05, or as the preset has it.</summary>
        public double TargetEnergy
        {
            get { return Get(Option.TargetEnergy); }
            set { SetFloat(Option.TargetEnergy, value); }
        }

        /// <summary>Energy that no more than 1% of the area is to exceed; 0 leaves it to the mean.
        /// A number from 0 to 1,000,000,000. Default: 0.0.</summary>
        public double TargetP99
        {
            get { return Get(Option.TargetP99); }
            set { SetFloat(Option.TargetP99, value); }
        }

        /// <summary>Charts that the search is to stay within, or one for each component where there
        /// are more of these, if there is a way; 0 takes any number. A number from 0 to
        /// 1,000,000,000. Default: 0, or as the preset has it.</summary>
        public long MaxCharts
        {
            get { return (long)Get(Option.MaxCharts); }
            set { SetInt(Option.MaxCharts, value); }
        }

        /// <summary>Length of the seams, over the root of the area, that the search is to stay
        /// within; 0 takes any length. A number from 0 to 1,000,000,000. Default: 0.0.</summary>
        public double SeamBudget
        {
            get { return Get(Option.SeamBudget); }
            set { SetFloat(Option.SeamBudget, value); }
        }

        /// <summary>How far seams seek concave edges and avoid convex ones; 0 does not tell them
        /// apart. At a weight a one costs exp(-a c) of its length, where c goes from -1, convex, to
        /// 1, concave. A number from 0 to 10. Default: 0.15, or as the preset has it.</summary>
        public double ConcaveSeams
        {
            get { return Get(Option.ConcaveSeams); }
            set { SetFloat(Option.ConcaveSeams, value); }
        }

        /// <summary>How far seams hide; 0: not at all. At a weight b a seam costs 1 + b v times its
        /// length, where v goes from 0, seen from nowhere, to 1, seen from all sides. A number from
        /// 0 to 100. Default: 0.2, or as the preset has it.</summary>
        public double HiddenSeams
        {
            get { return Get(Option.HiddenSeams); }
            set { SetFloat(Option.HiddenSeams, value); }
        }

        /// <summary>What a seam costs, times its length, along an edge whose faces turn by more
        /// than 60 degrees: below 1 such edges are sought. A number from 0.01 to 100. Default:
        /// 0.85, or as the preset has it.</summary>
        public double HardSeams
        {
            get { return Get(Option.HardSeams); }
            set { SetFloat(Option.HardSeams, value); }
        }

        /// <summary>What a seam costs, times its length, along an edge between faces of different
        /// materials, where these are given: below 1 such edges are sought. A number from 0.01 to
        /// 100. Default: 0.5.</summary>
        public double MaterialSeams
        {
            get { return Get(Option.MaterialSeams); }
            set { SetFloat(Option.MaterialSeams, value); }
        }

        /// <summary>Where charts lie: pages (on square pages of a texture, all at one scale, UVs in
        /// the unit square) or none (side by side, in the mesh's unit of length). Charts with pins
        /// always lie as for none. Default: Pack.Pages.</summary>
        public Pack Pack
        {
            get { return (Pack)(int)Get(Option.Pack); }
            set { SetInt(Option.Pack, (long)value); }
        }

        /// <summary>Texels to the side of a page. A number from 8 to 32,768. Default:
        /// 1024.</summary>
        public long Resolution
        {
            get { return (long)Get(Option.Resolution); }
            set { SetInt(Option.Resolution, value); }
        }

        /// <summary>Texels between two charts at least, and half as many to the edges of a page. A
        /// number from 0 to 1,024. Default: 2.0.</summary>
        public double Margin
        {
            get { return Get(Option.Margin); }
            set { SetFloat(Option.Margin, value); }
        }

        /// <summary>Texels for a unit of length of the surface; 0 makes charts as large as they fit
        /// into max-pages. A number from 0 to 1e+30. Default: 0.0.</summary>
        public double TexelsPerUnit
        {
            get { return Get(Option.TexelsPerUnit); }
            set { SetFloat(Option.TexelsPerUnit, value); }
        }

        /// <summary>Pages to fill at most; 0 takes one, or with texels-per-unit as many as there
        /// have to be. A number from 0 to 1,000. Default: 0.</summary>
        public long MaxPages
        {
            get { return (long)Get(Option.MaxPages); }
            set { SetInt(Option.MaxPages, value); }
        }

        /// <summary>How charts may be turned on their page: any (as it fits best), quarter (their
        /// least box along the texels) or none; they are never mirrored. Default:
        /// PackTurns.Any.</summary>
        public PackTurns PackTurns
        {
            get { return (PackTurns)(int)Get(Option.PackTurns); }
            set { SetInt(Option.PackTurns, (long)value); }
        }

        /// <summary>Texels to the side of the blocks that no two charts share, as compressed
        /// textures want it: 4; 1 leaves it to the margin. A number from 1 to 64. Default:
        /// 1.</summary>
        public long PackBlock
        {
            get { return (long)Get(Option.PackBlock); }
            set { SetInt(Option.PackBlock, value); }
        }

        /// <summary>Length of seams, in roots of the area, that all of a page is worth to the
        /// search for seams; 0 splits no chart. At 10 a chart is split in two where a tenth of the
        /// root of the area lets a hundredth more of the pages be filled. Charts of fewer than 32
        /// triangles and those without a seam stay whole. A number from 0 to 1,000,000,000.
        /// Default: 10.0.</summary>
        public double FillWeight
        {
            get { return Get(Option.FillWeight); }
            set { SetFloat(Option.FillWeight, value); }
        }

        /// <summary>How much more seams may cost for being symmetric where the surface is: 0.5 for
        /// half as much again. They lie in the plane that it is mirrored by, or come in pairs, to
        /// within a few edges; 0 does not look for one. A number from 0 to 100. Default:
        /// 0.0.</summary>
        public double SymmetricSeams
        {
            get { return Get(Option.SymmetricSeams); }
            set { SetFloat(Option.SymmetricSeams, value); }
        }

        /// <summary>How far seams avoid turns: at a weight w one by an angle t, in the surface,
        /// costs w (1 - cos t) times an edge there; 0 counts lengths alone. A number from 0 to 100.
        /// Default: 0.0.</summary>
        public double StraightSeams
        {
            get { return Get(Option.StraightSeams); }
            set { SetFloat(Option.StraightSeams, value); }
        }

        /// <summary>How long short seams are searched for, and a dense packing: quick, normal or
        /// high. quick takes half the time of normal, for seams some 2% longer. high takes some
        /// three times the time of normal, for seams some 2% shorter. Default:
        /// Effort.Normal.</summary>
        public Effort Effort
        {
            get { return (Effort)(int)Get(Option.Effort); }
            set { SetInt(Option.Effort, (long)value); }
        }

        /// <summary>How many times as long the seams of a part may be if it then unfolds without
        /// distortion, as boxes and machined parts do along their edges. 0 spends all of
        /// target-energy. Setting that or target-p99 sets this to 0: set it after them. A number
        /// from 0 to 100. Default: 1.5, or as the preset has it.</summary>
        public double FlatSeams
        {
            get { return Get(Option.FlatSeams); }
            set { SetFloat(Option.FlatSeams, value); }
        }

        /// <summary>Whether components of one shape share texels. none: no. copies: those that a
        /// rigid motion carries onto one before them lie on its charts. mirrored: mirror images do,
        /// too. halves: what is symmetric is cut along its plane, where edges lie in that, and one
        /// half lies on the other. Not with pins, max-charts, seam-budget or symmetric-seams.
        /// Default: Stack.None.</summary>
        public Stack Stack
        {
            get { return (Stack)(int)Get(Option.Stack); }
            set { SetInt(Option.Stack, (long)value); }
        }

        /// <summary>Which charts become rectangles along the axes: none, or grids. These are rows
        /// and columns of quads, as roads, tubes and cloths have: each column gets one width and
        /// each row one height. Default: Rectify.None.</summary>
        public Rectify Rectify
        {
            get { return (Rectify)(int)Get(Option.Rectify); }
            set { SetInt(Option.Rectify, (long)value); }
        }

        /// <summary>True turns each chart to the most of its border that is straight, then by
        /// quarters alone, and moves straight borders onto the edges of texels. Lightmaps and pixel
        /// art want that. Nothing moves by more than half a texel, and charts keep a texel more
        /// room. Default: false.</summary>
        public bool SnapTexels
        {
            get { return Get(Option.SnapTexels) != 0; }
            set { SetInt(Option.SnapTexels, value ? 1 : 0); }
        }

        /// <summary>True puts charts of faces with different labels on different pages, in the
        /// order of the labels, as tiles of UDIM by material. All have one density, and max-pages
        /// counts the pages of each label. Default: false.</summary>
        public bool LabelPages
        {
            get { return Get(Option.LabelPages) != 0; }
            set { SetInt(Option.LabelPages, value ? 1 : 0); }
        }
    }
}
