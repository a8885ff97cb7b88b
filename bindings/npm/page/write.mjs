// Meshes with their new UVs, for downloads.
import { splitVertices } from './beltrami/split.mjs';
import { accessorBytes, objLines, WIDTHS } from './read.mjs';

const FLOAT = 5126, UNSIGNED_INT = 5125, VERTICES = 34962, INDICES = 34963;

/** The place of a corner's UVs on the pages of UDIM: `atlas.cornerPages` says on which of them it is. */
function cornerUv(atlas, corner) {
  const page = atlas.cornerPages[corner];
  return [atlas.cornerUvs[2 * corner] + page % 10, atlas.cornerUvs[2 * corner + 1] + Math.floor(page / 10)];
}

/** OBJ. Of an OBJ file everything but its old UVs is kept, line by line. */
export function writeObj(mesh, atlas) {
  const uvOf = new Map(), uvLines = [];
  const uvNumber = (corner) => {
    const key = atlas.cornerUvVertices[corner];
    if (!uvOf.has(key)) {
      uvLines.push(`vt ${cornerUv(atlas, corner).join(' ')}`);
      uvOf.set(key, uvLines.length);
    }
    return uvOf.get(key);
  };
  const lines = [];
  let corner = 0;
  if (mesh.source.format === 'obj') {
    for (const [line, words] of objLines(mesh.source.content)) {
      if (words[0] === 'vt') continue;
      if (words[0] !== 'f' || words.length < 4) {
        lines.push(line);
        continue;
      }
      lines.push(`f ${words.slice(1).map((word) => {
        const [vertex, , normal] = word.split('/');
        return `${vertex}/${uvNumber(corner++)}${normal ? `/${normal}` : ''}`;
      }).join(' ')}`);
    }
    const first = lines.findIndex((line) => /^\s*f\s/.test(line));
    return [...lines.slice(0, first), ...uvLines, ...lines.slice(first)].join('\n');
  }
  for (let v = 0; v < mesh.positions.length; v += 3) lines.push(`v ${mesh.positions.slice(v, v + 3).join(' ')}`);
  const faces = [], count = mesh.faceSizes ? mesh.faceSizes.length : mesh.indices.length / 3;
  for (let f = 0; f < count; ++f) {
    let face = 'f';
    for (const end = corner + (mesh.faceSizes ? mesh.faceSizes[f] : 3); corner < end; ++corner) {
      face += ` ${mesh.indices[corner] + 1}/${uvNumber(corner)}`;
    }
    faces.push(face);
  }
  return [...lines, ...uvLines, ...faces, ''].join('\n');
}

/** A buffer that grows, and what JSON says of it. */
class Document {
  constructor(json, bin = new Uint8Array()) {
    this.json = json;
    this.parts = [];
    this.size = 0;
    this.append(bin);
  }

  append(bytes) {
    const at = this.size, whole = new Uint8Array(Math.ceil(bytes.byteLength / 4) * 4);
    whole.set(new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength));
    this.parts.push(whole);
    this.size += whole.length;
    return at;
  }

  accessor(bytes, target, description) {
    const views = this.json.bufferViews ??= [], accessors = this.json.accessors ??= [];
    views.push({ buffer: 0, byteOffset: this.append(bytes), byteLength: bytes.byteLength, target });
    accessors.push({ ...description, bufferView: views.length - 1 });
    return accessors.length - 1;
  }

  get glb() {
    this.json.buffers = [{ ...this.json.buffers?.[0], byteLength: this.size }];
    const bytes = new TextEncoder().encode(JSON.stringify(this.json)), text = new Uint8Array(Math.ceil(bytes.length / 4) * 4).fill(32);
    text.set(bytes);
    const head = (...words) => new Uint8Array(new Uint32Array(words).buffer);
    return new Blob([head(0x46546c67, 2, 28 + text.length + this.size, text.length, 0x4e4f534a), text, head(this.size, 0x004e4942), ...this.parts], { type: 'model/gltf-binary' });
  }
}

/** u, v of corners as glTF has them: its V axis points down. */
function gltfUvs(atlas, corners) {
  const uvs = new Float32Array(2 * corners.length);
  corners.forEach((corner, i) => {
    const [u, v] = cornerUv(atlas, corner);
    uvs[2 * i] = u;
    uvs[2 * i + 1] = 1 - v;
  });
  return uvs;
}

/** What other attributes of a vertex are, for its copies. */
function gathered(document, source, index, origins) {
  const { bytes, size } = accessorBytes(source, index), copies = new Uint8Array(size * origins.length);
  origins.forEach((origin, i) => copies.set(bytes.subarray(size * origin, size * origin + size), size * i));
  const { componentType, type, normalized, min, max } = source.json.accessors[index];
  const kept = { componentType, type, count: origins.length, ...(normalized ? { normalized } : {}), ...(min ? { min, max } : {}) };
  const padded = Math.ceil(size / 4) * 4; // vertices begin at multiples of 4 bytes
  if (padded === size || !WIDTHS[type]) return document.accessor(copies, VERTICES, kept);
  const wide = new Uint8Array(padded * origins.length);
  origins.forEach((_, i) => wide.set(copies.subarray(size * i, size * i + size), padded * i));
  const made = document.accessor(wide, VERTICES, kept);
  document.json.bufferViews.at(-1).byteStride = padded;
  return made;
}

function intoGlb({ source }, atlas) {
  const document = new Document(structuredClone(source.json), source.bin), primitives = document.json.meshes.flatMap((mesh) => mesh.primitives);
  const olds = source.json.meshes.flatMap((mesh) => mesh.primitives);
  for (const { primitive, indices, corner } of source.primitives) {
    const made = primitives[olds.indexOf(primitive)], count = indices.length - indices.length % 3;
    const split = splitVertices(indices.slice(0, count), atlas.cornerUvVertices.subarray(corner, corner + count));
    const copy = (attributes) => Object.fromEntries(Object.entries(attributes).map(([name, index]) => [name, gathered(document, source, index, split.origins)]));
    const { TANGENT, TEXCOORD_0, ...others } = primitive.attributes; // these belonged to the old UVs
    made.attributes = copy(others);
    made.attributes.TEXCOORD_0 = document.accessor(gltfUvs(atlas, split.firsts.map((first) => corner + first)), VERTICES, { componentType: FLOAT, type: 'VEC2', count: split.firsts.length });
    if (primitive.targets) made.targets = primitive.targets.map(({ TANGENT: old, ...target }) => copy(target));
    made.indices = document.accessor(split.corners, INDICES, { componentType: UNSIGNED_INT, type: 'SCALAR', count: split.corners.length });
  }
  return document.glb;
}

/** GLB. A GLB file keeps its materials, nodes, skins and animations; of others a new one is made, of triangles. */
export function writeGlb(mesh, atlas) {
  if (mesh.source.format === 'glb') return intoGlb(mesh, atlas);
  const { triangles } = atlas; // of corners
  const split = splitVertices(triangles.map((corner) => mesh.indices[corner]), triangles.map((corner) => atlas.cornerUvVertices[corner]));
  const positions = Float32Array.from({ length: 3 * split.origins.length }, (_, i) => mesh.positions[3 * split.origins[Math.floor(i / 3)] + i % 3]);
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  positions.forEach((value, i) => {
    low[i % 3] = Math.min(low[i % 3], value);
    high[i % 3] = Math.max(high[i % 3], value);
  });
  const document = new Document({ asset: { version: '2.0', generator: 'beltrami' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }] });
  const count = split.origins.length;
  document.json.meshes = [{ primitives: [{
    attributes: {
      POSITION: document.accessor(positions, VERTICES, { componentType: FLOAT, type: 'VEC3', count, min: low, max: high }),
      TEXCOORD_0: document.accessor(gltfUvs(atlas, split.firsts.map((first) => triangles[first])), VERTICES, { componentType: FLOAT, type: 'VEC2', count }),
    },
    indices: document.accessor(split.corners, INDICES, { componentType: UNSIGNED_INT, type: 'SCALAR', count: split.corners.length }),
  }] }];
  return document.glb;
}
