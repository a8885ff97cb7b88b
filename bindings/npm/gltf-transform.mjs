// A transform of glTF-Transform that makes UVs. Types and documentation: gltf-transform.d.ts.
import { gathered, splitVertices } from './split.mjs';

const TRIANGLES = 4;
/** Free space between meshes of a scene, by the size of the larger: none is to be welded to another. */
const BETWEEN = 1;

const isUsed = (property) => property.listParents().some((parent) => parent.propertyType !== 'Root');

function cornersOf(primitive) {
  const indices = primitive.getIndices();
  if (indices) return Uint32Array.from(indices.getArray());
  return Uint32Array.from({ length: primitive.getAttribute('POSITION').getCount() }, (_, i) => i);
}

/** The greatest scale at which a scene shows a mesh. */
function scaleOf(mesh) {
  const scales = mesh.listParents().filter((parent) => parent.propertyType === 'Node').map((node) => {
    const m = node.getWorldMatrix();
    return Math.max(...[0, 4, 8].map((k) => Math.hypot(m[k], m[k + 1], m[k + 2])));
  });
  return Math.max(...scales.filter((scale) => scale > 0), 0) || 1;
}

/** The primitives of some meshes as one surface, in which meshes lie apart. */
function surfaceOf(meshes, isAsked) {
  const positions = [], indices = [], materials = [], parts = [];
  let right = 0, count = 0;
  for (const { mesh, scale } of meshes) {
    const box = [Infinity, -Infinity], first = positions.length;
    for (const primitive of mesh.listPrimitives().filter(isAsked)) {
      const place = primitive.getAttribute('POSITION'), corners = cornersOf(primitive), item = [];
      for (let v = 0; v < place.getCount(); ++v) {
        for (const x of place.getElement(v, item)) positions.push(scale * x);
        box[0] = Math.min(box[0], scale * item[0]);
        box[1] = Math.max(box[1], scale * item[0]);
      }
      for (const v of corners) indices.push(count + v);
      for (let f = 0; f < corners.length / 3; ++f) materials.push(parts.length);
      count += place.getCount();
      parts.push({ primitive, corners });
    }
    if (meshes.length === 1 || first === positions.length) continue;
    const by = right - box[0], size = box[1] - box[0];
    for (let i = first; i < positions.length; i += 3) positions[i] += by;
    right += (1 + BETWEEN) * (size || 1);
  }
  return { parts, surface: { positions: new Float64Array(positions), indices: new Uint32Array(indices), materials: new Uint32Array(materials) } };
}

function replace(document, primitive, corners, uvVertices, atlas, semantic) {
  const { origins, uvs, corners: indices } = splitVertices(corners, uvVertices);
  const buffer = primitive.getAttribute('POSITION').getBuffer();
  const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
  const swap = (owner, name, made) => {
    const old = owner.getAttribute(name);
    owner.setAttribute(name, made);
    if (old && !isUsed(old)) old.dispose();
  };
  const split = (owner) => {
    for (const name of owner.listSemantics()) {
      const old = owner.getAttribute(name), array = gathered(old.getArray(), old.getElementSize(), origins);
      swap(owner, name, accessor(old.getType(), array).setNormalized(old.getNormalized()).setName(old.getName()));
    }
  };
  if (semantic === 'TEXCOORD_0') swap(primitive, 'TANGENT', null);
  swap(primitive, semantic, null);
  split(primitive);
  primitive.listTargets().forEach(split);
  const places = Float32Array.from(gathered(atlas.uvVertices, 2, uvs), (value, i) => i % 2 === 1 ? 1 - value : value);
  primitive.setAttribute(semantic, accessor('VEC2', places));
  const old = primitive.getIndices();
  primitive.setIndices(accessor('SCALAR', origins.length > 65535 ? indices : Uint16Array.from(indices)));
  if (old && !isUsed(old)) old.dispose();
}

export function unwrap({ beltrami, texcoord = 0, overwrite = false, groupBy = 'mesh', ...options }) {
  if (!beltrami) throw new Error("unwrap: give the library that load() of 'beltrami' returned, as `beltrami`");
  if (!['primitive', 'mesh', 'scene'].includes(groupBy)) throw new Error(`unwrap: groupBy is primitive, mesh or scene, not '${groupBy}'`);
  const semantic = `TEXCOORD_${texcoord}`;
  const transform = (document) => {
    const isAsked = (primitive) => primitive.getMode() === TRIANGLES && primitive.getAttribute('POSITION') && (overwrite || !primitive.getAttribute(semantic));
    const run = (meshes, which) => {
      const { parts, surface } = surfaceOf(meshes, which);
      if (parts.length === 0) return;
      const atlas = beltrami.unwrap(surface, { float32: true, maxPages: 1, ...options });
      let at = 0;
      for (const { primitive, corners } of parts) {
        replace(document, primitive, corners, atlas.cornerUvVertices.subarray(at, at + corners.length), atlas, semantic);
        at += corners.length;
      }
    };
    const meshes = document.getRoot().listMeshes().map((mesh) => ({ mesh, scale: groupBy === 'scene' ? scaleOf(mesh) : 1 }));
    if (groupBy === 'scene') {
      run(meshes, isAsked);
    } else {
      for (const one of meshes) {
        if (groupBy === 'mesh') run([one], isAsked);
        else for (const primitive of one.mesh.listPrimitives()) run([one], (other) => other === primitive && isAsked(other));
      }
    }
  };
  Object.defineProperty(transform, 'name', { value: 'unwrap' });
  return transform;
}
