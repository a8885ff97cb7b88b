// The options of the library, written by tests/option_table.rs from its table and header.

use std::time::Duration;

use super::{choice, options, Options, PackOptions, UnwrapOptions};

choice! {
    /// How the map is computed: beltrami (fast and low in distortion), cm (composite majorization
    /// on the full mesh, the slow reference) or tutte (into a circle, highly distorted). Baselines
    /// to compare with are gif and bff on the surface's own metric, and uv-prolongation of the
    /// coarse UVs; bff and uv-prolongation may flip. See [`Options::method`].
    Method {
        /// Coarse CM, prolongation of its Beltrami coefficients, one harmonic solve in their
        /// metric.
        Beltrami = "beltrami",
        /// Composite majorization on the full mesh: the slow reference.
        Cm = "cm",
        /// Tutte's embedding into a circle: injective, fast, highly distorted.
        Tutte = "tutte",
        /// Baseline: globally injective, in the harmonic subspace of the surface's own metric.
        Gif = "gif",
        /// Baseline: boundary first flattening, conformal. May flip and overlap.
        Bff = "bff",
        /// Baseline: the UVs of the coarse mesh carried over by closest points. Flips.
        UvProlongation = "uv-prolongation",
    }
}

choice! {
    /// The distortion that is minimised; exponential-dirichlet lowers it where it is highest, at a
    /// mean that is a little higher. See [`Options::energy`].
    Energy {
        /// 1/2 (s1^2 + s2^2 + s1^-2 + s2^-2), minimum 2.
        SymmetricDirichlet = "symmetric-dirichlet",
        /// (s1 - 1)^2 + (1/s2 - 1)^2, minimum 0.
        SymmetricArap = "symmetric-arap",
        /// 1 + exp(D - 2) of the symmetric Dirichlet energy D, minimum 2: what is distorted most
        /// counts most. The worst faces are better for it, at a mean that is a little higher. From
        /// D = 14 on a parabola instead of the exponential.
        ExponentialDirichlet = "exponential-dirichlet",
    }
}

choice! {
    /// How the method beltrami flattens the fine mesh. metric: a Poisson solve with a free
    /// boundary, and a polish. dirichlet: harmonic, boundary from the coarse map, faster, energy a
    /// little higher. gif: a harmonic subspace of a few boundary vertices with a scaffold. flim:
    /// the same, local injectivity only. bff: conformal, may flip. See [`Options::flatten`].
    Flatten {
        /// Poisson solve for the whole prolonged metric, free boundary, then a few L-BFGS steps.
        Metric = "metric",
        /// Harmonic in the prolonged Beltrami coefficients with the boundary of the coarse map:
        /// faster, and 0.3% to 3% higher in energy.
        Dirichlet = "dirichlet",
        /// The paper's: the harmonic subspace of a few boundary vertices, with a scaffold.
        Gif = "gif",
        /// The same without a scaffold: no flips, but the boundary may overlap itself.
        Flim = "flim",
        /// Conformal with the boundary lengths that the coarse map asks for. May flip and overlap.
        Bff = "bff",
    }
}

choice! {
    /// What the optimisation sees to: global (no flips, no boundary crossings), local (no flips:
    /// parts may overlap, at a slightly lower energy) or auto. That is global, but for the method
    /// cm, which is left as the literature has it. See [`Options::injectivity`].
    Injectivity {
        /// Global, but for the method CM: that is left as the literature has it, the reference.
        Auto = "auto",
        /// No flips, and no part of the boundary may cross another.
        Global = "global",
        /// No flips; the boundary may overlap itself, at a slightly lower energy.
        Local = "local",
    }
}

choice! {
    /// [`On`](Delaunay::On) flips edges to the intrinsic Delaunay triangulation of the prolonged
    /// metric before the fine mesh is flattened: what is injective then are its own triangles on
    /// the same vertices. See [`Options::delaunay`].
    Delaunay {
        /// Off.
        Off = "off",
        /// On.
        On = "on",
    }
}

choice! {
    /// Where seams go beside those that are given. auto: short ones are searched for, along which
    /// the atlas has the target-energy. minimal: a short cut graph where a piece is no disk.
    /// islands: around the charts of the UVs that the mesh has, of which what is no disk is opened.
    /// given: nowhere, and what is no disk is opened as by minimal. See [`UnwrapOptions::cut`].
    Cut {
        /// Nothing but a short cut graph where a piece is no disk.
        Minimal = "minimal",
        /// Also where the corner UVs of the surface part: its charts stay what they are.
        Islands = "islands",
        /// The default: short seams that are searched for, along which the maps have the energy
        /// asked for by the option target-energy.
        Auto = "auto",
        /// Nothing: the seams that come with the surface are used as they are. What is no disk then
        /// is opened as by MINIMAL, which does the same; seams of an earlier atlas leave nothing to
        /// open.
        Given = "given",
    }
}

choice! {
    /// Whether vertices at one place, to the last bit, count as one: auto (yes, but a mesh that is
    /// one disk as it stands stays so), on or off. See [`UnwrapOptions::weld`].
    Weld {
        /// Yes; but a surface that is one disk as it stands stays so.
        Auto = "auto",
        /// On.
        On = "on",
        /// Off.
        Off = "off",
    }
}

choice! {
    /// What the seams are for: sets options of the search that are not set otherwise. none: their
    /// defaults. lightmap: target-energy 2.1, hidden-seams 0, hard-seams 0.5, flat-seams 2.
    /// texturing: concave-seams 0.6, hidden-seams 2. one-chart: max-charts 1. hard-surface:
    /// hard-seams 0.5, flat-seams 6. See [`UnwrapOptions::preset`].
    Preset {
        /// The defaults.
        None = "none",
        /// Light that is baked: target-energy 2.1, and short seams wherever they are seen, sooner
        /// along hard edges: hidden-seams 0, hard-seams 0.5, flat-seams 2.
        Lightmap = "lightmap",
        /// Textures that are painted or photographed: seams where nobody looks, though they be
        /// longer: concave-seams 0.6, hidden-seams 2.
        Texturing = "texturing",
        /// One chart for each component, at the energy that it can have: max-charts 1.
        OneChart = "one-chart",
        /// Machined and built things: seams along hard edges and flat faces, though there be more:
        /// hard-seams 0.5, flat-seams 6.
        HardSurface = "hard-surface",
    }
}

choice! {
    /// Where charts lie: pages (on square pages of a texture, all at one scale, UVs in the unit
    /// square) or none (side by side, in the mesh's unit of length). Charts with pins always lie as
    /// for none. See [`UnwrapOptions::pack`].
    Pack {
        /// On square pages of a texture, each chart moved and turned, and all scaled alike: the UVs
        /// of a page are in \[0,1\]^2. Rounded to single precision their charts keep all faces,
        /// also where v is stored as 1 - v. With the option float32 they are multiples of 2^-24 (of
        /// more on further pages), of which v and 1 - v are exact. A surface with pins is not
        /// packed.
        Pages = "pages",
        /// Side by side, in the surface's own unit of length.
        None = "none",
    }
}

choice! {
    /// How charts may be turned on their page: any (as it fits best), quarter (their least box
    /// along the texels) or none; they are never mirrored. See [`UnwrapOptions::pack_turns`].
    PackTurns {
        /// Any.
        Any = "any",
        /// By 90 degrees and multiples.
        Quarter = "quarter",
        /// None.
        None = "none",
    }
}

choice! {
    /// How long short seams are searched for, and a dense packing: quick, normal or high. quick
    /// takes half the time of normal, for seams some 2% longer. high takes some three times the
    /// time of normal, for seams some 2% shorter. See [`UnwrapOptions::effort`].
    Effort {
        /// Half the time of NORMAL, seams some 2% longer.
        Quick = "quick",
        /// The default.
        Normal = "normal",
        /// Some three times the time of NORMAL, seams some 2% shorter.
        High = "high",
    }
}

choice! {
    /// Whether components of one shape share texels. none: no. copies: those that a rigid motion
    /// carries onto one before them lie on its charts. mirrored: mirror images do, too. halves:
    /// what is symmetric is cut along its plane, where edges lie in that, and one half lies on the
    /// other. Not with pins, max-charts, seam-budget or symmetric-seams. See
    /// [`UnwrapOptions::stack`].
    Stack {
        /// None.
        None = "none",
        /// Those that a rigid motion carries onto one before them, lengths within a ten thousandth.
        Copies = "copies",
        /// Mirror images, too.
        Mirrored = "mirrored",
        /// And the halves of what is symmetric to the plane of the whole surface: it is cut along
        /// the edges in that, if no face lies across it.
        Halves = "halves",
    }
}

choice! {
    /// Which charts become rectangles along the axes: none, or grids. These are rows and columns of
    /// quads, as roads, tubes and cloths have: each column gets one width and each row one height.
    /// See [`UnwrapOptions::rectify`].
    Rectify {
        /// None.
        None = "none",
        /// Those that are rows and columns of quads: each column gets the mean length of its edges
        /// as its width, each row as its height.
        Grids = "grids",
    }
}

options! {
    /// How the map is computed: beltrami (fast and low in distortion), cm (composite majorization
    /// on the full mesh, the slow reference) or tutte (into a circle, highly distorted). Baselines
    /// to compare with are gif and bff on the surface's own metric, and uv-prolongation of the
    /// coarse UVs; bff and uv-prolongation may flip.
    ///
    /// Default: [`Beltrami`](Method::Beltrami).
    method(Method) of [Options UnwrapOptions] = 0 "method"
        "How the map is computed: beltrami (fast and low in distortion), cm (composite majorization on the full mesh, the slow reference) or tutte (into a circle, highly distorted). Baselines to compare with are gif and bff on the surface's own metric, and uv-prolongation of the coarse UVs; bff and uv-prolongation may flip."
        Choice(Method::NAMES), 0..=5, default 0, calls 3;

    /// The distortion that is minimised; exponential-dirichlet lowers it where it is highest, at a
    /// mean that is a little higher.
    ///
    /// Default: [`SymmetricDirichlet`](Energy::SymmetricDirichlet).
    energy(Energy) of [Options UnwrapOptions] = 1 "energy"
        "The distortion that is minimised; exponential-dirichlet lowers it where it is highest, at a mean that is a little higher."
        Choice(Energy::NAMES), 0..=2, default 0, calls 3;

    /// Faces of the simplified mesh that composite majorization runs on. 0 chooses 1% of the faces,
    /// at least 10,000; or 1,000 to 5,000 where meshes from 4,000 faces on go through levels.
    ///
    /// From 0 to 700000000.
    ///
    /// Default: 0.
    coarse_faces(u32) of [Options UnwrapOptions] = 2 "coarse-faces"
        "Faces of the simplified mesh that composite majorization runs on. 0 chooses 1% of the faces, at least 10,000; or 1,000 to 5,000 where meshes from 4,000 faces on go through levels."
        Int(&[]), 0..=700000000, default 0, calls 3;

    /// Relative decrease of the energy in one iteration below which composite majorization stops.
    ///
    /// From 0 to 1.
    ///
    /// Default: 0.0001.
    tolerance(f64) of [Options UnwrapOptions] = 3 "tolerance"
        "Relative decrease of the energy in one iteration below which composite majorization stops."
        Float(&[]), 0..=1, default 0.0001, calls 3;

    /// Iterations after which composite majorization stops even if it has not converged.
    ///
    /// From 1 to 1000000.
    ///
    /// Default: 500.
    max_iterations(u32) of [Options UnwrapOptions] = 4 "max-iterations"
        "Iterations after which composite majorization stops even if it has not converged."
        Int(&[]), 1..=1000000, default 500, calls 3;

    /// Threads to use, the calling one included; the result does not depend on it.
    ///
    /// From 1 to 1024.
    ///
    /// Default: 1.
    threads(u32) of [Options UnwrapOptions PackOptions] = 5 "threads"
        "Threads to use, the calling one included; the result does not depend on it."
        Int(&[]), 1..=1024, default 1, calls 15;

    /// `true` scales and shifts the UVs into the unit square, where those of pages are in any case;
    /// `false` keeps them in the mesh's unit of length.
    ///
    /// Default: `false`.
    unit_square(bool) of [Options UnwrapOptions] = 6 "unit-square"
        "1 scales and shifts the UVs into the unit square, where those of pages are in any case; 0 keeps them in the mesh's unit of length."
        Switch(&[]), 0..=1, default 0, calls 3;

    /// How the method beltrami flattens the fine mesh. metric: a Poisson solve with a free
    /// boundary, and a polish. dirichlet: harmonic, boundary from the coarse map, faster, energy a
    /// little higher. gif: a harmonic subspace of a few boundary vertices with a scaffold. flim:
    /// the same, local injectivity only. bff: conformal, may flip.
    ///
    /// Default: [`Metric`](Flatten::Metric).
    flatten(Flatten) of [Options UnwrapOptions] = 7 "flatten"
        "How the method beltrami flattens the fine mesh. metric: a Poisson solve with a free boundary, and a polish. dirichlet: harmonic, boundary from the coarse map, faster, energy a little higher. gif: a harmonic subspace of a few boundary vertices with a scaffold. flim: the same, local injectivity only. bff: conformal, may flip."
        Choice(Flatten::NAMES), 0..=4, default 0, calls 3;

    /// What the optimisation sees to: global (no flips, no boundary crossings), local (no flips:
    /// parts may overlap, at a slightly lower energy) or auto. That is global, but for the method
    /// cm, which is left as the literature has it.
    ///
    /// Default: [`Auto`](Injectivity::Auto).
    injectivity(Injectivity) of [Options UnwrapOptions] = 8 "injectivity"
        "What the optimisation sees to: global (no flips, no boundary crossings), local (no flips: parts may overlap, at a slightly lower energy) or auto. That is global, but for the method cm, which is left as the literature has it."
        Choice(Injectivity::NAMES), 0..=2, default 0, calls 3;

    /// `true` goes on with composite majorization on the fine mesh from the result, to a little
    /// less energy in much more time.
    ///
    /// Default: `false`.
    refine(bool) of [Options UnwrapOptions] = 9 "refine"
        "1 goes on with composite majorization on the fine mesh from the result, to a little less energy in much more time."
        Switch(&[]), 0..=1, default 0, calls 3;

    /// Iterations after which the refinement stops; 0 leaves it to the tolerance.
    ///
    /// From 0 to 1000000.
    ///
    /// Default: 0.
    refine_iterations(u32) of [Options UnwrapOptions] = 10 "refine-iterations"
        "Iterations after which the refinement stops; 0 leaves it to the tolerance."
        Int(&[]), 0..=1000000, default 0, calls 3;

    /// Seconds since the start of the run after which iterations stop with the best map so far; 0
    /// sets no limit.
    ///
    /// From 0 to 1000000000.
    ///
    /// Default: [`Duration::ZERO`].
    time_limit(Duration) of [Options UnwrapOptions] = 11 "time-limit"
        "Seconds since the start of the run after which iterations stop with the best map so far; 0 sets no limit."
        Float(&[]), 0..=1000000000, default 0, calls 3;

    /// `true` delivers UVs that single precision holds exactly, rounded so that the map stays
    /// injective.
    ///
    /// Default: `false`.
    float32(bool) of [Options UnwrapOptions PackOptions] = 12 "float32"
        "1 delivers UVs that single precision holds exactly, rounded so that the map stays injective."
        Switch(&[]), 0..=1, default 0, calls 7;

    /// [`On`](Delaunay::On) flips edges to the intrinsic Delaunay triangulation of the prolonged
    /// metric before the fine mesh is flattened: what is injective then are its own triangles on
    /// the same vertices.
    ///
    /// Default: [`Off`](Delaunay::Off).
    delaunay(Delaunay) of [Options] = 13 "delaunay"
        "on flips edges to the intrinsic Delaunay triangulation of the prolonged metric before the fine mesh is flattened: what is injective then are its own triangles on the same vertices."
        Choice(Delaunay::NAMES), 0..=1, default 0, calls 1;

    /// Bytes of memory that a run is to stay within by its estimate; 0 sets no limit. A run that
    /// needs more ends before it starts. Steps that only hard meshes need are left out where they
    /// would exceed it, or end the run if there is no map without them.
    ///
    /// From 0 to 100000000000000.
    ///
    /// Default: 0.
    memory_limit(u64) of [Options UnwrapOptions] = 14 "memory-limit"
        "Bytes of memory that a run is to stay within by its estimate; 0 sets no limit. A run that needs more ends before it starts. Steps that only hard meshes need are left out where they would exceed it, or end the run if there is no map without them."
        Int(&[]), 0..=100000000000000.0, default 0, calls 3;

    /// Where seams go beside those that are given. auto: short ones are searched for, along which
    /// the atlas has the target-energy. minimal: a short cut graph where a piece is no disk.
    /// islands: around the charts of the UVs that the mesh has, of which what is no disk is opened.
    /// given: nowhere, and what is no disk is opened as by minimal.
    ///
    /// Default: [`Auto`](Cut::Auto).
    cut(Cut) of [UnwrapOptions] = 15 "cut"
        "Where seams go beside those that are given. auto: short ones are searched for, along which the atlas has the target-energy. minimal: a short cut graph where a piece is no disk. islands: around the charts of the UVs that the mesh has, of which what is no disk is opened. given: nowhere, and what is no disk is opened as by minimal."
        Choice(Cut::NAMES), 0..=3, default 2, calls 2;

    /// Degrees between the normals of two faces above which the edge between them is a seam, but
    /// for creases that end within the surface and part nothing; 180 makes none.
    ///
    /// From 0 to 180.
    ///
    /// Default: 180.
    hard_angle(f64) of [UnwrapOptions] = 16 "hard-angle"
        "Degrees between the normals of two faces above which the edge between them is a seam, but for creases that end within the surface and part nothing; 180 makes none."
        Float(&[]), 0..=180, default 180, calls 2;

    /// Whether vertices at one place, to the last bit, count as one: auto (yes, but a mesh that is
    /// one disk as it stands stays so), on or off.
    ///
    /// Default: [`Auto`](Weld::Auto).
    weld(Weld) of [UnwrapOptions] = 17 "weld"
        "Whether vertices at one place, to the last bit, count as one: auto (yes, but a mesh that is one disk as it stands stays so), on or off."
        Choice(Weld::NAMES), 0..=2, default 0, calls 2;

    /// Vertices no further apart, in the mesh's unit of length, count as one; 0 those at one place.
    ///
    /// From 0 to 1e100.
    ///
    /// Default: 0.
    weld_distance(f64) of [UnwrapOptions] = 18 "weld-distance"
        "Vertices no further apart, in the mesh's unit of length, count as one; 0 those at one place."
        Float(&[]), 0..=1e100, default 0, calls 2;

    /// Holes whose boundary is no longer than this many roots of their component's area cost no
    /// seam, larger ones are joined to one; 0 joins all. The longest of a component is its outline.
    ///
    /// From 0 to 1000000000.
    ///
    /// Default: 0.5.
    fill_holes(f64) of [UnwrapOptions] = 19 "fill-holes"
        "Holes whose boundary is no longer than this many roots of their component's area cost no seam, larger ones are joined to one; 0 joins all. The longest of a component is its outline."
        Float(&[]), 0..=1000000000, default 0.5, calls 2;

    /// `true` gives copies of a face, as of double-sided surfaces, the UVs of the first instead of
    /// a layer of their own.
    ///
    /// Default: `false`.
    share_copies(bool) of [UnwrapOptions] = 20 "share-copies"
        "1 gives copies of a face, as of double-sided surfaces, the UVs of the first instead of a layer of their own."
        Switch(&[]), 0..=1, default 0, calls 2;

    /// What the seams are for: sets options of the search that are not set otherwise. none: their
    /// defaults. lightmap: target-energy 2.1, hidden-seams 0, hard-seams 0.5, flat-seams 2.
    /// texturing: concave-seams 0.6, hidden-seams 2. one-chart: max-charts 1. hard-surface:
    /// hard-seams 0.5, flat-seams 6.
    ///
    /// Default: [`None`](Preset::None).
    preset(Preset) of [UnwrapOptions] = 21 "preset"
        "What the seams are for: sets options of the search that are not set otherwise. none: their defaults. lightmap: target-energy 2.1, hidden-seams 0, hard-seams 0.5, flat-seams 2. texturing: concave-seams 0.6, hidden-seams 2. one-chart: max-charts 1. hard-surface: hard-seams 0.5, flat-seams 6."
        Choice(Preset::NAMES), 0..=4, default 0, calls 2;

    /// Mean symmetric Dirichlet energy of the atlas that seams are searched for, 2 for lengths that
    /// all stay: the nearer to 2, the longer the seams.
    ///
    /// From 2.0001 to 1000000000.
    ///
    /// Default: 2.05.
    target_energy(f64) of [UnwrapOptions] = 22 "target-energy"
        "Mean symmetric Dirichlet energy of the atlas that seams are searched for, 2 for lengths that all stay: the nearer to 2, the longer the seams."
        Float(&[]), 2.0001..=1000000000, default 2.05, calls 2;

    /// Energy that no more than 1% of the area is to exceed; 0 leaves it to the mean.
    ///
    /// From 0 to 1000000000.
    ///
    /// Default: 0.
    target_p99(f64) of [UnwrapOptions] = 23 "target-p99"
        "Energy that no more than 1% of the area is to exceed; 0 leaves it to the mean."
        Float(&[]), 0..=1000000000, default 0, calls 2;

    /// Charts that the search is to stay within, or one for each component where there are more of
    /// these, if there is a way; 0 takes any number.
    ///
    /// From 0 to 1000000000.
    ///
    /// Default: 0.
    max_charts(u32) of [UnwrapOptions] = 24 "max-charts"
        "Charts that the search is to stay within, or one for each component where there are more of these, if there is a way; 0 takes any number."
        Int(&[]), 0..=1000000000, default 0, calls 2;

    /// Length of the seams, over the root of the area, that the search is to stay within; 0 takes
    /// any length.
    ///
    /// From 0 to 1000000000.
    ///
    /// Default: 0.
    seam_budget(f64) of [UnwrapOptions] = 25 "seam-budget"
        "Length of the seams, over the root of the area, that the search is to stay within; 0 takes any length."
        Float(&[]), 0..=1000000000, default 0, calls 2;

    /// How far seams seek concave edges and avoid convex ones; 0 does not tell them apart. At a
    /// weight a one costs exp(-a c) of its length, where c goes from -1, convex, to 1, concave.
    ///
    /// From 0 to 10.
    ///
    /// Default: 0.15.
    concave_seams(f64) of [UnwrapOptions] = 26 "concave-seams"
        "How far seams seek concave edges and avoid convex ones; 0 does not tell them apart. At a weight a one costs exp(-a c) of its length, where c goes from -1, convex, to 1, concave."
        Float(&[]), 0..=10, default 0.15, calls 2;

    /// How far seams hide; 0: not at all. At a weight b a seam costs 1 + b v times its length,
    /// where v goes from 0, seen from nowhere, to 1, seen from all sides.
    ///
    /// From 0 to 100.
    ///
    /// Default: 0.2.
    hidden_seams(f64) of [UnwrapOptions] = 27 "hidden-seams"
        "How far seams hide; 0: not at all. At a weight b a seam costs 1 + b v times its length, where v goes from 0, seen from nowhere, to 1, seen from all sides."
        Float(&[]), 0..=100, default 0.2, calls 2;

    /// What a seam costs, times its length, along an edge whose faces turn by more than 60 degrees:
    /// below 1 such edges are sought.
    ///
    /// From 0.01 to 100.
    ///
    /// Default: 0.85.
    hard_seams(f64) of [UnwrapOptions] = 28 "hard-seams"
        "What a seam costs, times its length, along an edge whose faces turn by more than 60 degrees: below 1 such edges are sought."
        Float(&[]), 0.01..=100, default 0.85, calls 2;

    /// What a seam costs, times its length, along an edge between faces of different materials,
    /// where these are given: below 1 such edges are sought.
    ///
    /// From 0.01 to 100.
    ///
    /// Default: 0.5.
    material_seams(f64) of [UnwrapOptions] = 29 "material-seams"
        "What a seam costs, times its length, along an edge between faces of different materials, where these are given: below 1 such edges are sought."
        Float(&[]), 0.01..=100, default 0.5, calls 2;

    /// Where charts lie: pages (on square pages of a texture, all at one scale, UVs in the unit
    /// square) or none (side by side, in the mesh's unit of length). Charts with pins always lie as
    /// for none.
    ///
    /// Default: [`Pages`](Pack::Pages).
    pack(Pack) of [UnwrapOptions] = 30 "pack"
        "Where charts lie: pages (on square pages of a texture, all at one scale, UVs in the unit square) or none (side by side, in the mesh's unit of length). Charts with pins always lie as for none."
        Choice(Pack::NAMES), 0..=1, default 0, calls 2;

    /// Texels to the side of a page.
    ///
    /// From 8 to 32768.
    ///
    /// Default: 1024.
    resolution(u32) of [UnwrapOptions PackOptions] = 31 "resolution"
        "Texels to the side of a page."
        Int(&[]), 8..=32768, default 1024, calls 6;

    /// Texels between two charts at least, and half as many to the edges of a page.
    ///
    /// From 0 to 1024.
    ///
    /// Default: 2.
    margin(f64) of [UnwrapOptions PackOptions] = 32 "margin"
        "Texels between two charts at least, and half as many to the edges of a page."
        Float(&[]), 0..=1024, default 2, calls 6;

    /// Texels for a unit of length of the surface; 0 makes charts as large as they fit into
    /// max-pages.
    ///
    /// From 0 to 1e30.
    ///
    /// Default: 0.
    texels_per_unit(f64) of [UnwrapOptions PackOptions] = 33 "texels-per-unit"
        "Texels for a unit of length of the surface; 0 makes charts as large as they fit into max-pages."
        Float(&[]), 0..=1e30, default 0, calls 6;

    /// Pages to fill at most; 0 takes one, or with texels-per-unit as many as there have to be.
    ///
    /// From 0 to 1000.
    ///
    /// Default: 0.
    max_pages(u32) of [UnwrapOptions PackOptions] = 34 "max-pages"
        "Pages to fill at most; 0 takes one, or with texels-per-unit as many as there have to be."
        Int(&[]), 0..=1000, default 0, calls 6;

    /// How charts may be turned on their page: any (as it fits best), quarter (their least box
    /// along the texels) or none; they are never mirrored.
    ///
    /// Default: [`Any`](PackTurns::Any).
    pack_turns(PackTurns) of [UnwrapOptions PackOptions] = 35 "pack-turns"
        "How charts may be turned on their page: any (as it fits best), quarter (their least box along the texels) or none; they are never mirrored."
        Choice(PackTurns::NAMES), 0..=2, default 0, calls 6;

    /// Texels to the side of the blocks that no two charts share, as compressed textures want it:
    /// 4; 1 leaves it to the margin.
    ///
    /// From 1 to 64.
    ///
    /// Default: 1.
    pack_block(u32) of [UnwrapOptions PackOptions] = 36 "pack-block"
        "Texels to the side of the blocks that no two charts share, as compressed textures want it: 4; 1 leaves it to the margin."
        Int(&[]), 1..=64, default 1, calls 6;

    /// Length of seams, in roots of the area, that all of a page is worth to the search for seams;
    /// 0 splits no chart. At 10 a chart is split in two where a tenth of the root of the area lets
    /// a hundredth more of the pages be filled. Charts of fewer than 32 triangles and those without
    /// a seam stay whole.
    ///
    /// From 0 to 1000000000.
    ///
    /// Default: 10.
    fill_weight(f64) of [UnwrapOptions] = 37 "fill-weight"
        "Length of seams, in roots of the area, that all of a page is worth to the search for seams; 0 splits no chart. At 10 a chart is split in two where a tenth of the root of the area lets a hundredth more of the pages be filled. Charts of fewer than 32 triangles and those without a seam stay whole."
        Float(&[]), 0..=1000000000, default 10, calls 2;

    /// How much more seams may cost for being symmetric where the surface is: 0.5 for half as much
    /// again. They lie in the plane that it is mirrored by, or come in pairs, to within a few
    /// edges; 0 does not look for one.
    ///
    /// From 0 to 100.
    ///
    /// Default: 0.
    symmetric_seams(f64) of [UnwrapOptions] = 38 "symmetric-seams"
        "How much more seams may cost for being symmetric where the surface is: 0.5 for half as much again. They lie in the plane that it is mirrored by, or come in pairs, to within a few edges; 0 does not look for one."
        Float(&[]), 0..=100, default 0, calls 2;

    /// How far seams avoid turns: at a weight w one by an angle t, in the surface, costs w (1 - cos
    /// t) times an edge there; 0 counts lengths alone.
    ///
    /// From 0 to 100.
    ///
    /// Default: 0.
    straight_seams(f64) of [UnwrapOptions] = 39 "straight-seams"
        "How far seams avoid turns: at a weight w one by an angle t, in the surface, costs w (1 - cos t) times an edge there; 0 counts lengths alone."
        Float(&[]), 0..=100, default 0, calls 2;

    /// How long short seams are searched for, and a dense packing: quick, normal or high. quick
    /// takes half the time of normal, for seams some 2% longer. high takes some three times the
    /// time of normal, for seams some 2% shorter.
    ///
    /// Default: [`Normal`](Effort::Normal).
    effort(Effort) of [UnwrapOptions] = 40 "effort"
        "How long short seams are searched for, and a dense packing: quick, normal or high. quick takes half the time of normal, for seams some 2% longer. high takes some three times the time of normal, for seams some 2% shorter."
        Choice(Effort::NAMES), 0..=2, default 1, calls 2;

    /// How many times as long the seams of a part may be if it then unfolds without distortion, as
    /// boxes and machined parts do along their edges. 0 spends all of target-energy. Setting that
    /// or target-p99 sets this to 0: set it after them.
    ///
    /// From 0 to 100.
    ///
    /// Default: 1.5.
    flat_seams(f64) of [UnwrapOptions] = 41 "flat-seams"
        "How many times as long the seams of a part may be if it then unfolds without distortion, as boxes and machined parts do along their edges. 0 spends all of target-energy. Setting that or target-p99 sets this to 0: set it after them."
        Float(&[]), 0..=100, default 1.5, calls 2;

    /// Whether components of one shape share texels. none: no. copies: those that a rigid motion
    /// carries onto one before them lie on its charts. mirrored: mirror images do, too. halves:
    /// what is symmetric is cut along its plane, where edges lie in that, and one half lies on the
    /// other. Not with pins, max-charts, seam-budget or symmetric-seams.
    ///
    /// Default: [`None`](Stack::None).
    stack(Stack) of [UnwrapOptions] = 42 "stack"
        "Whether components of one shape share texels. none: no. copies: those that a rigid motion carries onto one before them lie on its charts. mirrored: mirror images do, too. halves: what is symmetric is cut along its plane, where edges lie in that, and one half lies on the other. Not with pins, max-charts, seam-budget or symmetric-seams."
        Choice(Stack::NAMES), 0..=3, default 0, calls 2;

    /// Which charts become rectangles along the axes: none, or grids. These are rows and columns of
    /// quads, as roads, tubes and cloths have: each column gets one width and each row one height.
    ///
    /// Default: [`None`](Rectify::None).
    rectify(Rectify) of [UnwrapOptions] = 43 "rectify"
        "Which charts become rectangles along the axes: none, or grids. These are rows and columns of quads, as roads, tubes and cloths have: each column gets one width and each row one height."
        Choice(Rectify::NAMES), 0..=1, default 0, calls 2;

    /// `true` turns each chart to the most of its border that is straight, then by quarters alone,
    /// and moves straight borders onto the edges of texels. Lightmaps and pixel art want that.
    /// Nothing moves by more than half a texel, and charts keep a texel more room.
    ///
    /// Default: `false`.
    snap_texels(bool) of [UnwrapOptions] = 44 "snap-texels"
        "1 turns each chart to the most of its border that is straight, then by quarters alone, and moves straight borders onto the edges of texels. Lightmaps and pixel art want that. Nothing moves by more than half a texel, and charts keep a texel more room."
        Switch(&[]), 0..=1, default 0, calls 2;

    /// `true` puts charts of faces with different labels on different pages, in the order of the
    /// labels, as tiles of UDIM by material. All have one density, and max-pages counts the pages
    /// of each label.
    ///
    /// Default: `false`.
    label_pages(bool) of [UnwrapOptions] = 45 "label-pages"
        "1 puts charts of faces with different labels on different pages, in the order of the labels, as tiles of UDIM by material. All have one density, and max-pages counts the pages of each label."
        Switch(&[]), 0..=1, default 0, calls 2;
}
