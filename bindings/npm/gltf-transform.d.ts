import type { Transform } from '@gltf-transform/core';
import type { Beltrami, UnwrapOptions } from 'beltrami';

export interface UnwrapTransformOptions extends UnwrapOptions {
  /** What `load()` returned. */
  beltrami: Beltrami;
  /** The set of UVs to make: 0 for textures, which no longer fit then, 1 for lightmaps. Default: 0. */
  texcoord?: number;
  /** Whether primitives that have this set get a new one. Default: false. */
  overwrite?: boolean;
  /** What shares pages: the triangles of a primitive, of a mesh, or all, by the sizes that the scene shows. Default: 'mesh'. */
  groupBy?: 'primitive' | 'mesh' | 'scene';
}

/**
 * A transform that gives the triangles of a document UVs: vertices are copied along seams, with all attributes and
 * morph targets. Tangents of a new TEXCOORD_0 are dropped. Strips, fans, lines and points stay as they are.
 */
export function unwrap(options: UnwrapTransformOptions): Transform;
