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
  /** Cuts any surface into charts, flattens and packs them. Throws BeltramiError. */
  unwrap(surface: Surface, options?: UnwrapOptions): Atlas;
  /** Flattens one disk. Throws BeltramiError. */
  flatten(mesh: Mesh, options?: FlattenOptions): Flattening;
  /** Judges the cornerUvs of a surface, from anywhere. Throws BeltramiError. */
  check(surface: Surface, options?: { allowMirrored?: boolean }): AtlasCertificate;
  /** Packs the charts of meshes in the plane. Throws BeltramiError. */
  pack(meshes: UvMesh[], options?: PackOptions): Packing;
}

/**
 * Loads the library. `source` is a compiled module, the bytes of beltrami.wasm, its address, or a response that
 * has them; without it beltrami.wasm beside this file is taken.
 */
export function load(
  source?: WebAssembly.Module | BufferSource | Response | URL | string
): Promise<Beltrami>;

