/** Positions: x, y, z of each vertex. */
export type Positions = Float32Array | Float64Array;
/** UVs: u, v of each corner or vertex. */
export type Uvs = Float32Array | Float64Array;

/** Polygons of any kind. A corner is one vertex of one face. */
export interface Surface {
  positions: Positions;
  /** The vertex of each corner, counted from 0: three for each face, unless faceSizes says otherwise. */
  indices: Uint32Array;
  /** Corners of each face, 3 or more; left out, all faces are triangles. */
  faceSizes?: Uint32Array;
  /** u, v of each corner: islands of an earlier layout, or for `check` what is judged. */
  cornerUvs?: Uvs;
  /** Edges to cut, as pairs of vertices. */
  seams?: Uint32Array;
  /** A number for each face; seams run where two differ. */
  faceLabels?: Uint32Array;
  /** A number above 0 for each face: how much larger it is to be in the plane. */
  densities?: Float32Array | Float64Array;
  /** A number for each face; seams come sooner where two differ (the option materialSeams). */
  materials?: Uint32Array;
}

/** A disk of triangles: one piece, one boundary, no handle. */
export interface Mesh {
  positions: Positions;
  /** Three vertices for each face, counter-clockwise. */
  indices: Uint32Array;
}

/** Triangles in the plane. Triangles that share a UV vertex are of one chart. */
export interface UvMesh {
  uvs: Uvs;
  /** Three UV vertices for each face. */
  uvIndices: Uint32Array;
  /** With positions, charts get equally many texels for equal areas on the surface. */
  positions?: Positions;
  /** With positions: three vertices for each face; left out where UV vertices are vertices. */
  indices?: Uint32Array;
  /** A number for each face: charts of different labels get different pages, in their order. All meshes have
   *  them, or none. */
  pageLabels?: Uint32Array;
}

/** How a call tells how far it is, and is ended. */
export interface Running {
  /** Called on this thread now and then; the fraction rises from 0 to 1. Return true to cancel. */
  progress?: (fraction: number, stage: string) => boolean | void;
  /** One number in shared memory that another thread sets to end the call: it looks there as often as it
   *  calls `progress`. */
  cancel?: Int32Array;
}

/** OK, or what to keep in mind of a result, such as "BELTRAMI_NOT_CONVERGED". */
export type Status = string;

/** Charts on pages. UVs are Float32Arrays with the option float32, else Float64Arrays. */
export interface Atlas {
  readonly status: Status;
  /** u, v of each corner. */
  readonly cornerUvs: Uvs;
  /** u, v of each UV vertex: vertices, split along seams. */
  readonly uvVertices: Uvs;
  /** The UV vertex of each corner: an index buffer for uvVertices. */
  readonly cornerUvVertices: Uint32Array;
  /** The vertex of the surface that each UV vertex is a copy of. */
  readonly uvVertexOrigins: Uint32Array;
  /** The page of each corner. */
  readonly cornerPages: Uint32Array;
  /** The chart of each face; 4294967295 for a face without area. */
  readonly faceCharts: Uint32Array;
  /** Three corners for each triangle that was computed on, in the orientation in which it is positive. */
  readonly triangles: Uint32Array;
  /** The seams, as pairs of vertices. */
  readonly seams: Uint32Array;
  readonly charts: Chart[];
  readonly report: AtlasReport;
  /** The proof: exact predicates on the very numbers delivered. */
  readonly certificate: AtlasCertificate;
  /** null where the atlas is not packed. */
  readonly packing: PackingReport | null;
}

export interface Flattening {
  readonly status: Status;
  /** u, v of each vertex. */
  readonly uvs: Uvs;
  readonly report: FlattenReport;
  readonly certificate: Certificate;
  readonly energy: Energy;
}

export interface Packing {
  readonly status: Status;
  /** For each mesh u, v of each UV vertex, on the page of its chart. */
  readonly uvs: Uvs[];
  /** For each mesh the chart of each face; charts count through all meshes. */
  readonly charts: Uint32Array[];
  /** The page of each chart. */
  readonly chartPages: Uint32Array;
  readonly report: PackingReport;
  readonly certificate: AtlasCertificate;
}

/** What a call of an editor moved. */
export interface Changes {
  /** "BELTRAMI_OK"; "BELTRAMI_NOT_CONVERGED" where the next update would go on; "BELTRAMI_NOT_INJECTIVE" where a
   *  chart by itself is not. */
  readonly status: Status;
  /** Corners that moved, increasing. */
  readonly corners: Uint32Array;
  /** u, v of each of them. */
  readonly uvs: Uvs;
}

/** How an editor stands. */
export interface EditorReport {
  /** The greatest reservation of all charts, each by itself. */
  readonly status: Status;
  readonly charts: number;
  /** Charts that are to be mapped further. */
  readonly due: number;
  readonly corners: number;
  /** Corners that the last update, pack or restore moved. */
  readonly changes: number;
  /** Edges cut beside the seams. */
  readonly opened: number;
  /** Mean over the area, each chart at its scale; NaN before the first update. */
  readonly symmetricDirichlet: number;
  /** Of the last update, pack or check. */
  readonly seconds: number;
  readonly cpuSeconds: number;
}

/** A chart of an editor. */
export interface EditorChart {
  /** Of this chart by itself. */
  readonly status: Status;
  readonly due: boolean;
  readonly locked: boolean;
  /** Its number: it stays while most of the chart does, and is given once. */
  readonly id: number;
  readonly triangles: number;
  /** The least of its faces. */
  readonly firstFace: number;
  readonly symmetricDirichlet: number;
  /** Lengths in the plane per length on the surface that it is to have. */
  readonly scale: number;
  readonly keepFrame: boolean;
  readonly keepScale: boolean;
  readonly align: boolean;
  readonly stack: boolean;
  /** The number of the chart that packing has laid it on, while both stay as they are, or null. */
  readonly stackedOn: number | null;
}

/** What a chart keeps, beside its lock: false where it is left out. */
export interface ChartFlags {
  /** Packing does not turn it. */
  keepFrame?: boolean;
  /** Pins leave its size, and packing those of all charts. */
  keepScale?: boolean;
  /** What is straight of its border lies along the axes; pins overrule it. */
  align?: boolean;
  /** Packing lays it on the first chart of its shape that has this flag. */
  stack?: boolean;
}

/**
 * A session of edits on one surface: seams and pins that move, and maps that follow. Edits are noted at once; `update`
 * maps the charts that they concern, from the maps that they have. A call that throws leaves the maps as they were.
 */
export interface Editor {
  /** Pairs of vertices. What meets no border and no other seam opens nothing yet. */
  openSeams(edges: Uint32Array): void;
  closeSeams(edges: Uint32Array): void;
  /** Pins, in place of all before; `directions` are those of lines. */
  setPins(corners: Uint32Array, uvs: Uvs, kinds?: ('point' | 'u' | 'v' | 'line')[], directions?: Uvs): void;
  /** Only these faces may move; null: all. */
  select(faces: Uint32Array | null): void;
  /** Charts, by their numbers, stay whatever happens, or are let go. */
  lock(charts: Uint32Array, locked?: boolean): void;
  /** These and no other flags for charts. One to be aligned is due. */
  setFlags(charts: Uint32Array, flags?: ChartFlags): void;
  /** Charts are mapped anew by the next update; cold: from nothing. */
  renew(charts: Uint32Array, cold?: boolean): void;
  /** `steps`: Newton steps of a chart at most, 0: to its minimum; `seconds`: after which no step begins, 0: any.
   *  Throws BeltramiError, of a pin that cannot be met with its corner as `element`. */
  update(how?: { seconds?: number; steps?: number } & Running): Changes;
  /** Packs charts among the others, which stay; null: all. Throws BeltramiError where there is no room. */
  pack(charts?: Uint32Array | null, how?: Running): Changes;
  /** The exact verdict on all charts together. */
  check(): AtlasCertificate;
  /** Notes everything under a number, to which `restore` goes back, to the bit. */
  save(): number;
  restore(mark: number): Changes;
  forget(mark: number): void;
  /** Frees its memory; no other call serves then. */
  close(): void;
  /** u, v of each corner. Page p is the unit square at (p modulo 10, p / 10). */
  readonly cornerUvs: Uvs;
  /** The number of the chart of each face; 4294967295 for a face without area. */
  readonly faceCharts: Uint32Array;
  /** By their least faces. */
  readonly charts: EditorChart[];
  /** Edges cut beside the seams, where these leave what is no disk. */
  readonly opened: Uint32Array;
  readonly report: EditorReport;
}

/** A call without a result: the message says what to do. */
export class BeltramiError extends Error {
  /** Such as "BELTRAMI_E_INDEX_OUT_OF_RANGE". */
  readonly status: string;
  /** The face, vertex or corner concerned, or null. */
  readonly element: number | null;
  /** "face", "vertex", "corner" or "none". */
  readonly elementKind: string;
}

/** The library, loaded. Calls run on the thread that calls them: in a page, call from a worker. */
export class Beltrami {
  /** One line on the build: version, parts, licence of what it links. */
  readonly buildInfo: string;
  /** Such as "0.1.0". */
  readonly version: string;
  /** How many threads a call has, its own among them. */
  readonly threads: number;
  /** Cuts any surface into charts, flattens and packs them. Throws BeltramiError. */
  unwrap(surface: Surface, options?: UnwrapOptions): Atlas;
  /** Flattens one disk. Throws BeltramiError. */
  flatten(mesh: Mesh, options?: FlattenOptions): Flattening;
  /** Judges the cornerUvs of a surface, from anywhere. Throws BeltramiError. */
  check(surface: Surface, options?: { allowMirrored?: boolean }): AtlasCertificate;
  /** Packs the charts of meshes in the plane. Throws BeltramiError. */
  pack(meshes: UvMesh[], options?: PackOptions): Packing;
  /**
   * Begins to edit a surface, from its `cornerUvs` and `seams` if it has them. Options are those that concern
   * flattening, welding, holes and packing. Throws BeltramiError, as its calls do.
   */
  edit(surface: Surface, options?: UnwrapOptions): Editor;
  /** Ends the threads that `load` has started. Later calls have one, those of open editors too. */
  close(): void;
}

export interface Loading {
  /**
   * How many threads a call is to have: the one that calls, and workers. 0: as many as there are processors. In a page
   * one, unless it is cross-origin isolated. The results have the same bits. Default 1.
   */
  threads?: number;
}

/**
 * Loads the library. `source` is a compiled module, the bytes of beltrami.wasm, its address, or a response that
 * has them; without it beltrami.wasm beside this file is taken. A compiled module has one thread.
 */
export function load(
  source?: WebAssembly.Module | BufferSource | Response | URL | string,
  options?: Loading
): Promise<Beltrami>;


// What follows is written by tools/generate.py: from the C header and the option table.

export interface FlattenOptions extends Running {
  /** How the map is computed: beltrami (fast and low in distortion), cm (composite majorization on the full mesh, the slow reference) or tutte (into a circle, highly distorted). Baselines to compare with are gif and bff on the surface's own metric, and uv-prolongation of the coarse UVs; bff and uv-prolongation may flip. Default: beltrami. */
  method?: 'beltrami' | 'cm' | 'tutte' | 'gif' | 'bff' | 'uv-prolongation';
  /** The distortion that is minimised; exponential-dirichlet lowers it where it is highest, at a mean that is a little higher. Default: symmetric-dirichlet. */
  energy?: 'symmetric-dirichlet' | 'symmetric-arap' | 'exponential-dirichlet';
  /** Faces of the simplified mesh that composite majorization runs on. 0 chooses 1% of the faces, at least 10,000; or 1,000 to 5,000 where meshes from 4,000 faces on go through levels. A number from 0 to 700,000,000. Default: 0. */
  coarseFaces?: number;
  /** Relative decrease of the energy in one iteration below which composite majorization stops. A number from 0 to 1. Default: 0.0001. */
  tolerance?: number;
  /** Iterations after which composite majorization stops even if it has not converged. A number from 1 to 1,000,000. Default: 500. */
  maxIterations?: number;
  /** True scales and shifts the UVs into the unit square, where those of pages are in any case; False keeps them in the mesh's unit of length. Default: false. */
  unitSquare?: boolean;
  /** How the method beltrami flattens the fine mesh. metric: a Poisson solve with a free boundary, and a polish. dirichlet: harmonic, boundary from the coarse map, faster, energy a little higher. gif: a harmonic subspace of a few boundary vertices with a scaffold. flim: the same, local injectivity only. bff: conformal, may flip. Default: metric. */
  flatten?: 'metric' | 'dirichlet' | 'gif' | 'flim' | 'bff';
  /** What the optimisation sees to: global (no flips, no boundary crossings), local (no flips: parts may overlap, at a slightly lower energy) or auto. That is global, but for the method cm, which is left as the literature has it. Default: auto. */
  injectivity?: 'auto' | 'global' | 'local';
  /** True goes on with composite majorization on the fine mesh from the result, to a little less energy in much more time. Default: false. */
  refine?: boolean;
  /** Iterations after which the refinement stops; 0 leaves it to the tolerance. A number from 0 to 1,000,000. Default: 0. */
  refineIterations?: number;
  /** Seconds since the start of the run after which iterations stop with the best map so far; 0 sets no limit. A number from 0 to 1,000,000,000. Default: 0. */
  timeLimit?: number;
  /** True delivers UVs that single precision holds exactly, rounded so that the map stays injective. Default: false. */
  float32?: boolean;
  /** True flips edges to the intrinsic Delaunay triangulation of the prolonged metric before the fine mesh is flattened: what is injective then are its own triangles on the same vertices. Default: false. */
  delaunay?: boolean;
  /** Bytes of memory that a run is to stay within by its estimate; 0 sets no limit. A run that needs more ends before it starts. Steps that only hard meshes need are left out where they would exceed it, or end the run if there is no map without them. A number from 0 to 1e+14. Default: 0. */
  memoryLimit?: number;
}

export interface UnwrapOptions extends Running {
  /** How the map is computed: beltrami (fast and low in distortion), cm (composite majorization on the full mesh, the slow reference) or tutte (into a circle, highly distorted). Baselines to compare with are gif and bff on the surface's own metric, and uv-prolongation of the coarse UVs; bff and uv-prolongation may flip. Default: beltrami. */
  method?: 'beltrami' | 'cm' | 'tutte' | 'gif' | 'bff' | 'uv-prolongation';
  /** The distortion that is minimised; exponential-dirichlet lowers it where it is highest, at a mean that is a little higher. Default: symmetric-dirichlet. */
  energy?: 'symmetric-dirichlet' | 'symmetric-arap' | 'exponential-dirichlet';
  /** Faces of the simplified mesh that composite majorization runs on. 0 chooses 1% of the faces, at least 10,000; or 1,000 to 5,000 where meshes from 4,000 faces on go through levels. A number from 0 to 700,000,000. Default: 0. */
  coarseFaces?: number;
  /** Relative decrease of the energy in one iteration below which composite majorization stops. A number from 0 to 1. Default: 0.0001. */
  tolerance?: number;
  /** Iterations after which composite majorization stops even if it has not converged. A number from 1 to 1,000,000. Default: 500. */
  maxIterations?: number;
  /** True scales and shifts the UVs into the unit square, where those of pages are in any case; False keeps them in the mesh's unit of length. Default: false. */
  unitSquare?: boolean;
  /** How the method beltrami flattens the fine mesh. metric: a Poisson solve with a free boundary, and a polish. dirichlet: harmonic, boundary from the coarse map, faster, energy a little higher. gif: a harmonic subspace of a few boundary vertices with a scaffold. flim: the same, local injectivity only. bff: conformal, may flip. Default: metric. */
  flatten?: 'metric' | 'dirichlet' | 'gif' | 'flim' | 'bff';
  /** What the optimisation sees to: global (no flips, no boundary crossings), local (no flips: parts may overlap, at a slightly lower energy) or auto. That is global, but for the method cm, which is left as the literature has it. Default: auto. */
  injectivity?: 'auto' | 'global' | 'local';
  /** True goes on with composite majorization on the fine mesh from the result, to a little less energy in much more time. Default: false. */
  refine?: boolean;
  /** Iterations after which the refinement stops; 0 leaves it to the tolerance. A number from 0 to 1,000,000. Default: 0. */
  refineIterations?: number;
  /** Seconds since the start of the run after which iterations stop with the best map so far; 0 sets no limit. A number from 0 to 1,000,000,000. Default: 0. */
  timeLimit?: number;
  /** True delivers UVs that single precision holds exactly, rounded so that the map stays injective. Default: false. */
  float32?: boolean;
  /** Bytes of memory that a run is to stay within by its estimate; 0 sets no limit. A run that needs more ends before it starts. Steps that only hard meshes need are left out where they would exceed it, or end the run if there is no map without them. A number from 0 to 1e+14. Default: 0. */
  memoryLimit?: number;
  /** Where seams go beside those that are given. auto: short ones are searched for, along which the atlas has the target-energy. minimal: a short cut graph where a piece is no disk. islands: around the charts of the UVs that the mesh has, of which what is no disk is opened. given: nowhere, and what is no disk is opened as by minimal. Default: auto. */
  cut?: 'minimal' | 'islands' | 'auto' | 'given';
  /** Degrees between the normals of two faces above which the edge between them is a seam, but for creases that end within the surface and part nothing; 180 makes none. A number from 0 to 180. Default: 180. */
  hardAngle?: number;
  /** Whether vertices at one place, to the last bit, count as one: auto (yes, but a mesh that is one disk as it stands stays so), on or off. Default: auto. */
  weld?: 'auto' | 'on' | 'off';
  /** Vertices no further apart, in the mesh's unit of length, count as one; 0 those at one place. A number from 0 to 1e+100. Default: 0. */
  weldDistance?: number;
  /** Holes whose boundary is no longer than this many roots of their component's area cost no seam, larger ones are joined to one; 0 joins all. The longest of a component is its outline. A number from 0 to 1,000,000,000. Default: 0.5. */
  fillHoles?: number;
  /** True gives copies of a face, as of double-sided surfaces, the UVs of the first instead of a layer of their own. Default: false. */
  shareCopies?: boolean;
  /** What the seams are for: sets options of the search that are not set otherwise. none: their defaults. lightmap: target-energy 2.1, hidden-seams 0, hard-seams 0.5, flat-seams 2. texturing: concave-seams 0.6, hidden-seams 2. one-chart: max-charts 1. hard-surface: hard-seams 0.5, flat-seams 6. Default: none. */
  preset?: 'none' | 'lightmap' | 'texturing' | 'one-chart' | 'hard-surface';
  /** Mean symmetric Dirichlet energy of the atlas that seams are searched for, 2 for lengths that all stay: the nearer to 2, the longer the seams. A number from 2.0001 to 1,000,000,000. Default: 2.05, or as the preset has it. */
  targetEnergy?: number;
  /** Energy that no more than 1% of the area is to exceed; 0 leaves it to the mean. A number from 0 to 1,000,000,000. Default: 0. */
  targetP99?: number;
  /** Charts that the search is to stay within, or one for each component where there are more of these, if there is a way; 0 takes any number. A number from 0 to 1,000,000,000. Default: 0, or as the preset has it. */
  maxCharts?: number;
  /** Length of the seams, over the root of the area, that the search is to stay within; 0 takes any length. A number from 0 to 1,000,000,000. Default: 0. */
  seamBudget?: number;
  /** How far seams seek concave edges and avoid convex ones; 0 does not tell them apart. At a weight a one costs exp(-a c) of its length, where c goes from -1, convex, to 1, concave. A number from 0 to 10. Default: 0.15, or as the preset has it. */
  concaveSeams?: number;
  /** How far seams hide; 0: not at all. At a weight b a seam costs 1 + b v times its length, where v goes from 0, seen from nowhere, to 1, seen from all sides. A number from 0 to 100. Default: 0.2, or as the preset has it. */
  hiddenSeams?: number;
  /** What a seam costs, times its length, along an edge whose faces turn by more than 60 degrees: below 1 such edges are sought. A number from 0.01 to 100. Default: 0.85, or as the preset has it. */
  hardSeams?: number;
  /** What a seam costs, times its length, along an edge between faces of different materials, where these are given: below 1 such edges are sought. A number from 0.01 to 100. Default: 0.5. */
  materialSeams?: number;
  /** Where charts lie: pages (on square pages of a texture, all at one scale, UVs in the unit square) or none (side by side, in the mesh's unit of length). Charts with pins always lie as for none. Default: pages. */
  pack?: 'pages' | 'none';
  /** Texels to the side of a page. A number from 8 to 32,768. Default: 1024. */
  resolution?: number;
  /** Texels between two charts at least, and half as many to the edges of a page. A number from 0 to 1,024. Default: 2. */
  margin?: number;
  /** Texels for a unit of length of the surface; 0 makes charts as large as they fit into max-pages. A number from 0 to 1e+30. Default: 0. */
  texelsPerUnit?: number;
  /** Pages to fill at most; 0 takes one, or with texels-per-unit as many as there have to be. A number from 0 to 1,000. Default: 0. */
  maxPages?: number;
  /** How charts may be turned on their page: any (as it fits best), quarter (their least box along the texels) or none; they are never mirrored. Default: any. */
  packTurns?: 'any' | 'quarter' | 'none';
  /** Texels to the side of the blocks that no two charts share, as compressed textures want it: 4; 1 leaves it to the margin. A number from 1 to 64. Default: 1. */
  packBlock?: number;
  /** Length of seams, in roots of the area, that all of a page is worth to the search for seams; 0 splits no chart. At 10 a chart is split in two where a tenth of the root of the area lets a hundredth more of the pages be filled. Charts of fewer than 32 triangles and those without a seam stay whole. A number from 0 to 1,000,000,000. Default: 10. */
  fillWeight?: number;
  /** How much more seams may cost for being symmetric where the surface is: 0.5 for half as much again. They lie in the plane that it is mirrored by, or come in pairs, to within a few edges; 0 does not look for one. A number from 0 to 100. Default: 0. */
  symmetricSeams?: number;
  /** How far seams avoid turns: at a weight w one by an angle t, in the surface, costs w (1 - cos t) times an edge there; 0 counts lengths alone. A number from 0 to 100. Default: 0. */
  straightSeams?: number;
  /** How long short seams are searched for, and a dense packing: quick, normal or high. quick takes half the time of normal, for seams some 2% longer. high takes some three times the time of normal, for seams some 2% shorter. Default: normal. */
  effort?: 'quick' | 'normal' | 'high';
  /** How many times as long the seams of a part may be if it then unfolds without distortion, as boxes and machined parts do along their edges. 0 spends all of target-energy. Setting that or target-p99 sets this to 0: set it after them. A number from 0 to 100. Default: 1.5, or as the preset has it. */
  flatSeams?: number;
  /** Whether components of one shape share texels. none: no. copies: those that a rigid motion carries onto one before them lie on its charts. mirrored: mirror images do, too. halves: what is symmetric is cut along its plane, where edges lie in that, and one half lies on the other. Not with pins, max-charts, seam-budget or symmetric-seams. Default: none. */
  stack?: 'none' | 'copies' | 'mirrored' | 'halves';
  /** Which charts become rectangles along the axes: none, or grids. These are rows and columns of quads, as roads, tubes and cloths have: each column gets one width and each row one height. Default: none. */
  rectify?: 'none' | 'grids';
  /** True turns each chart to the most of its border that is straight, then by quarters alone, and moves straight borders onto the edges of texels. Lightmaps and pixel art want that. Nothing moves by more than half a texel, and charts keep a texel more room. Default: false. */
  snapTexels?: boolean;
  /** True puts charts of faces with different labels on different pages, in the order of the labels, as tiles of UDIM by material. All have one density, and max-pages counts the pages of each label. Default: false. */
  labelPages?: boolean;
}

export interface PackOptions extends Running {
  /** True delivers UVs that single precision holds exactly, rounded so that the map stays injective. Default: false. */
  float32?: boolean;
  /** Texels to the side of a page. A number from 8 to 32,768. Default: 1024. */
  resolution?: number;
  /** Texels between two charts at least, and half as many to the edges of a page. A number from 0 to 1,024. Default: 2. */
  margin?: number;
  /** Texels for a unit of length of the surface; 0 makes charts as large as they fit into max-pages. A number from 0 to 1e+30. Default: 0. */
  texelsPerUnit?: number;
  /** Pages to fill at most; 0 takes one, or with texels-per-unit as many as there have to be. A number from 0 to 1,000. Default: 0. */
  maxPages?: number;
  /** How charts may be turned on their page: any (as it fits best), quarter (their least box along the texels) or none; they are never mirrored. Default: any. */
  packTurns?: 'any' | 'quarter' | 'none';
  /** Texels to the side of the blocks that no two charts share, as compressed textures want it: 4; 1 leaves it to the margin. A number from 1 to 64. Default: 1. */
  packBlock?: number;
}

/** The exact verdict on a map; true where nothing bad was found. */
export interface Certificate {
  /** Whether the map is proven to be injective. */
  readonly injective: boolean;
  /** Faces of positive, negative, zero area in UV. */
  readonly positive: number;
  readonly negative: number;
  readonly degenerate: number;
  /** Pairs of boundary edges that meet where they should not: of n edges all pairs while they are fewer than about n log n, else at least so many. */
  readonly boundaryCrossings: number;
  /** A face that is not positive, or null. */
  readonly firstBadFace: number | null;
  /** A vertex of each of two crossing edges, or null. */
  readonly firstCrossing: [number, number] | null;
}

/** Distortion energies of a map: means over the faces weighted by area in space. */
export interface Energy {
  /** 1/2 (s1^2 + s2^2 + s1^-2 + s2^-2), >= 2. */
  readonly symmetricDirichlet: number;
  /** (s1 - 1)^2 + (1/s2 - 1)^2, >= 0. */
  readonly symmetricArap: number;
  /** Greatest symmetric Dirichlet energy of a face. */
  readonly max: number;
  /** Where, or null. */
  readonly worstFace: number | null;
  /** Faces left out. */
  readonly leftOut: number;
}

/** Counts, area and cost of a run. */
export interface FlattenReport {
  /** Of the input. */
  readonly vertices: number;
  readonly faces: number;
  readonly boundaryEdges: number;
  /** Vertices that no face uses: UV (0, 0). */
  readonly unreferencedVertices: number;
  /** Of the mesh that CM ran on. */
  readonly coarseFaces: number;
  /** Faces that were not positive before repair. */
  readonly flipsBeforeRepair: number;
  /** Of the input, in its unit squared. */
  readonly area: number;
  /** Wall time of the run. */
  readonly seconds: number;
  /** Of the whole process during the run. */
  readonly cpuSeconds: number;
  /** Of the whole process so far. */
  readonly peakMemoryBytes: number;
  /** Vertices that repair moved into the kernel of their one-ring. */
  readonly kernelFixes: number;
  /** Patches that repair untangled. */
  readonly patchFixes: number;
  /** Layouts that repair embedded anew, with a scaffold. */
  readonly globalFixes: number;
  /** Patches optimised around faces of enormous energy. */
  readonly cleanedPatches: number;
  /** Tries after the first, whose map was not injective. */
  readonly restarts: number;
  /** Vertices that are not at the nearest float in F32. */
  readonly float32Moves: number;
  /** With the option delaunay: edges flipped. */
  readonly delaunayFlips: number;
  /** Edges that are not Delaunay: their flip would repeat an edge. */
  readonly delaunayRefused: number;
  /** Of the input: faces without area, which no energy counts. */
  readonly degenerateFaces: number;
  /** The first of them, or null. */
  readonly firstDegenerateFace: number | null;
  /** Mean energy of the coarse map; 0 where CM did not run. */
  readonly coarseEnergy: number;
}

/** What was made of a surface: counts, energy and cost. */
export interface AtlasReport {
  /** Of the input. */
  readonly vertices: number;
  readonly faces: number;
  /** Of its faces. */
  readonly corners: number;
  /** Of `triangulate`: what is computed on. */
  readonly triangles: number;
  /** Pieces of the layout. */
  readonly charts: number;
  /** What a vertex buffer needs: vertices, split along the seams. */
  readonly uvVertices: number;
  /** Vertices that no face names. */
  readonly unusedVertices: number;
  /** Vertices that count as one with a vertex before them. */
  readonly weldedVertices: number;
  /** Triangles that name a vertex twice: each gets a point. */
  readonly repeatedFaces: number;
  /** Others without area (of the largest triangle, or the square of their longest edge, 1e-14): each gets a point. */
  readonly facesWithoutArea: number;
  /** Triangles with the vertices of one before them: each lies in a layer of its own, or shares the UVs of the first. */
  readonly copies: number;
  /** Edges of more than two triangles, where flat sheets stay whole. */
  readonly crowdedEdges: number;
  /** Edges where the sides of a one-sided surface part. */
  readonly oneSidedEdges: number;
  /** Vertices where fans of faces met in one point only. */
  readonly splitVertices: number;
  /** Triangles turned over to agree with most of their component; those with a short border part from it instead. */
  readonly reversedFaces: number;
  /** Connected pieces of the surface. */
  readonly components: number;
  /** Those without a boundary. */
  readonly closedComponents: number;
  /** Boundaries but for the first of each component. */
  readonly holes: number;
  /** Boundaries that cost no seam. */
  readonly filledHoles: number;
  /** Triangles that no energy counts: flipped, or without area. */
  readonly leftOut: number;
  /** Of the surface, in its unit squared. */
  readonly area: number;
  /** On the surface, each seam once, no open border. */
  readonly seamLength: number;
  /** Area of the UVs over that of the pages, or where it is not packed of their bounding box. */
  readonly utilisation: number;
  /** Mean energy over the area, at one scale for all: >= 2. */
  readonly symmetricDirichlet: number;
  /** Energy that is exceeded on 1% of the area at most. */
  readonly p99: number;
  /** Greatest energy of a triangle. */
  readonly max: number;
  /** Wall time of the run. */
  readonly seconds: number;
  /** Of the whole process during the run. */
  readonly cpuSeconds: number;
  /** Of the whole process so far. */
  readonly peakMemoryBytes: number;
  /** Edges in `Atlas.seams`. */
  readonly seams: number;
  /** Whether seams were searched for: with cut="auto". */
  readonly searched: boolean;
  /** Whether those meet what was asked for: energy (to 0.0001), p99, charts (or one for each component), seam length. */
  readonly reached: boolean;
  /** 0 where the atlas is not packed: `Atlas.packing` has the rest. */
  readonly pages: number;
  /** Triangles that no energy above counts: the worst ones, which together have less than a millionth of the area. */
  readonly slivers: number;
  /** What it would be with them. */
  readonly symmetricDirichletWithSlivers: number;
  /** Likewise. */
  readonly maxWithSlivers: number;
  /** Components, as the cuts that are given part them, that miss the energy or p99 that seams were searched for: each is to have it. */
  readonly missedParts: number;
  /** The first face of the worst of them, or null. */
  readonly missedFace: number | null;
  /** Of that part. */
  readonly missedTriangles: number;
  /** Its mean. */
  readonly missedEnergy: number;
  /** Components that lie on others of their shape, by the option stack: no area, energy or verdict counts them. */
  readonly stackedParts: number;
}

/** A chart of an atlas: a connected piece of the surface. */
export interface Chart {
  /** "BELTRAMI_OK", "BELTRAMI_NOT_CONVERGED", "BELTRAMI_NOT_INJECTIVE" or "BELTRAMI_NOT_INJECTIVE_FLOAT32". */
  readonly status: string;
  /** Why it has no map but one point, e.g. "BELTRAMI_E_SOLVER"; else "BELTRAMI_OK". */
  readonly error: string;
  /** Of the surface. */
  readonly triangles: number;
  /** The least face of the input. */
  readonly firstFace: number;
  /** On the surface, in its unit squared. */
  readonly area: number;
  /** Mean of its faces' densities, or what its pins ask for; else 1. */
  readonly density: number;
  /** As of the atlas. */
  readonly symmetricDirichlet: number;
  /** Greatest energy of a triangle. */
  readonly max: number;
  /** Of its UVs: least u, least v, greatest u, greatest v. */
  readonly box: number[];
  /** Counted from 0; 0 where the atlas is not packed. */
  readonly page: number;
}

/** The exact verdict on an atlas; true where it is injective. */
export interface AtlasCertificate {
  /** Whether all triangles are positive, and no two overlap. */
  readonly injective: boolean;
  /** Triangles of positive, negative, zero area in UV. */
  readonly positive: number;
  readonly negative: number;
  readonly degenerate: number;
  /** Triangles not judged: without area on the surface, or sharing UVs. */
  readonly excepted: number;
  /** Charts that were negative as a whole, taken as their mirror images. */
  readonly mirroredCharts: number;
  /** Triangles in them. */
  readonly mirroredFaces: number;
  /** Pairs of triangles that overlap, one at least at a seam or border: all of them while they are few, else at least so many. */
  readonly overlaps: number;
  /** Two faces that overlap, or null. */
  readonly firstOverlap: [number, number] | null;
  /** A face that is not positive, or null. */
  readonly firstBadFace: number | null;
  /** Where borders touch, which is allowed. */
  readonly touchingPlaces: number;
}

/** What lies on the pages of a texture: counts, density, margin and cost. */
export interface PackingReport {
  /** Pieces that were moved. */
  readonly charts: number;
  /** Faces of all charts. */
  readonly triangles: number;
  /** Square pages of a texture. */
  readonly pages: number;
  /** Texels to the side of a page. */
  readonly resolution: number;
  /** Of the surface, or without positions of the UVs that were packed. */
  readonly texelsPerUnit: number;
  /** Area of the UVs over that of the pages. */
  readonly utilisation: number;
  /** Texels: the least of the distances of two charts and of twice those to the edges of pages, in the numbers that are delivered. */
  readonly margin: number;
  /** Wall time of the call. */
  readonly seconds: number;
  /** Of the whole process during the call. */
  readonly cpuSeconds: number;
  /** Charts that were made two of, with the option fill-weight. */
  readonly splits: number;
  /** Of the seams of those, in roots of the surface's area. */
  readonly splitLength: number;
  /** Utilisation without splits; the same where there are none. */
  readonly unsplitUtilisation: number;
}
