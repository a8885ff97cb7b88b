import type { BufferGeometry } from 'three';
import type { Atlas, Beltrami, Surface, UnwrapOptions } from 'beltrami';

/** The triangles of a geometry, with or without an index; its groups are materials. */
export function surfaceOf(geometry: BufferGeometry): Surface;

/**
 * A new geometry with the UVs of an atlas of `surfaceOf(geometry)`, which a worker may have made: vertices are copied
 * along seams, with all attributes and morph targets. `attribute` is "uv", or "uv1" for lightmaps, which leaves "uv".
 */
export function withUvs(geometry: BufferGeometry, atlas: Atlas, how?: { attribute?: string }): BufferGeometry;

/** Both in one, on this thread. Throws BeltramiError. */
export function unwrapGeometry(
  beltrami: Beltrami, geometry: BufferGeometry, options?: UnwrapOptions & { attribute?: string }
): { geometry: BufferGeometry; atlas: Atlas };
