// A BufferGeometry of three.js in, one with UVs out. Types and documentation: three.d.ts.
import { BufferAttribute, BufferGeometry } from 'three';
import { gathered, splitVertices } from './split.mjs';

const cornersOf = (geometry) => geometry.index ? Uint32Array.from(geometry.index.array) : Uint32Array.from({ length: geometry.attributes.position.count }, (_, i) => i);

/** The numbers of an attribute, side by side: those of an interleaved one are spread. */
function packed(attribute) {
  if (!attribute.isInterleavedBufferAttribute) return attribute.array.subarray(0, attribute.count * attribute.itemSize);
  const { array, stride } = attribute.data, { count, itemSize, offset } = attribute;
  const made = new array.constructor(count * itemSize);
  for (let i = 0; i < count; ++i) for (let k = 0; k < itemSize; ++k) made[itemSize * i + k] = array[stride * i + offset + k];
  return made;
}

export function surfaceOf(geometry) {
  const { position } = geometry.attributes, positions = new Float32Array(3 * position.count);
  for (let i = 0; i < position.count; ++i) positions.set([position.getX(i), position.getY(i), position.getZ(i)], 3 * i);
  const indices = cornersOf(geometry), surface = { positions, indices };
  if (geometry.groups.length > 1) {
    surface.materials = new Uint32Array(indices.length / 3);
    for (const { start, count, materialIndex = 0 } of geometry.groups) surface.materials.fill(materialIndex, start / 3, (start + count) / 3);
  }
  return surface;
}

export function withUvs(geometry, atlas, { attribute = 'uv' } = {}) {
  const { origins, uvs, corners } = splitVertices(cornersOf(geometry), atlas.cornerUvVertices);
  const made = new BufferGeometry();
  const split = (old) => {
    const copy = new BufferAttribute(gathered(packed(old), old.itemSize, origins), old.itemSize, old.normalized);
    copy.name = old.name;
    return copy;
  };
  for (const [name, old] of Object.entries(geometry.attributes)) {
    // Tangents go with `uv`: they belonged to the old ones.
    if (name !== attribute && !(name === 'tangent' && attribute === 'uv')) made.setAttribute(name, split(old));
  }
  for (const [name, all] of Object.entries(geometry.morphAttributes)) made.morphAttributes[name] = all.map(split);
  made.morphTargetsRelative = geometry.morphTargetsRelative;
  made.setAttribute(attribute, new BufferAttribute(Float32Array.from(gathered(atlas.uvVertices, 2, uvs)), 2));
  made.setIndex(new BufferAttribute(origins.length > 65535 ? corners : Uint16Array.from(corners), 1));
  for (const { start, count, materialIndex } of geometry.groups) made.addGroup(start, count, materialIndex);
  made.setDrawRange(geometry.drawRange.start, geometry.drawRange.count);
  made.name = geometry.name;
  made.userData = geometry.userData;
  return made;
}

export function unwrapGeometry(beltrami, geometry, { attribute, ...options } = {}) {
  const atlas = beltrami.unwrap(surfaceOf(geometry), { float32: true, maxPages: 1, ...options });
  return { geometry: withUvs(geometry, atlas, { attribute }), atlas };
}
