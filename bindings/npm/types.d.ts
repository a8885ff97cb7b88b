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

