// Meshes in files that are dropped on the page: OBJ, STL, PLY and GLB, as surfaces for `unwrap`.

/** A file that cannot be read; the message says what to do. */
export class FileError extends Error {}

const fail = (message) => { throw new FileError(message); };
const text = (bytes) => new TextDecoder().decode(bytes);

/** Positions, and polygons as their vertices with the numbers of their corners. */
class Builder {
  positions = [];
  indices = [];
  sizes = [];

  /** Leaves out faces of fewer than three corners. */
  face(vertices) {
    if (vertices.length < 3) return;
    for (const vertex of vertices) {
      if (!(vertex >= 0 && vertex < this.positions.length / 3)) {
        fail(`face ${this.sizes.length} (counted from 0) names a vertex that is not there: export the file again`);
      }
      this.indices.push(vertex);
    }
    this.sizes.push(vertices.length);
  }

  get surface() {
    const surface = { positions: new Float64Array(this.positions), indices: new Uint32Array(this.indices) };
    if (this.sizes.some((size) => size !== 3)) surface.faceSizes = new Uint32Array(this.sizes);
    return surface;
  }
}

/** The words of each line, with lines that end in a backslash joined to the next. */
export function* objLines(content) {
  for (const line of content.replace(/\\\r?\n/g, ' ').split('\n')) yield [line, line.trim().split(/\s+/)];
}

function readObj(content) {
  const builder = new Builder();
  for (const [, words] of objLines(content)) {
    if (words[0] === 'v') for (let k = 1; k < 4; ++k) builder.positions.push(Number(words[k]));
    if (words[0] !== 'f') continue;
    const last = builder.positions.length / 3;
    builder.face(words.slice(1).map((corner) => {
      const number = parseInt(corner, 10);
      return number < 0 ? last + number : number - 1;
    }));
  }
  return { ...builder.surface, source: { format: 'obj', content } };
}

/** Corners at one place are one vertex: STL has no other way to say so. */
function welded(corners) {
  const known = new Map(), builder = new Builder();
  for (let c = 0; c < corners.length; c += 9) {
    const face = [0, 3, 6].map((k) => {
      const place = corners.slice(c + k, c + k + 3).join(' ');
      if (!known.has(place)) {
        known.set(place, builder.positions.length / 3);
        for (let d = 0; d < 3; ++d) builder.positions.push(corners[c + k + d]);
      }
      return known.get(place);
    });
    builder.face(face);
  }
  return { ...builder.surface, source: { format: 'stl' } };
}

function readStl(buffer) {
  const view = new DataView(buffer), corners = [];
  const count = buffer.byteLength >= 84 ? view.getUint32(80, true) : -1;
  if (buffer.byteLength === 84 + 50 * count) {
    for (let f = 0; f < count; ++f) {
      for (let k = 0; k < 9; ++k) corners.push(view.getFloat32(84 + 50 * f + 12 + 4 * k, true));
    }
    return welded(corners);
  }
  for (const [, x, y, z] of text(buffer).matchAll(/^\s*vertex\s+(\S+)\s+(\S+)\s+(\S+)/gm)) {
    corners.push(Math.fround(x), Math.fround(y), Math.fround(z));
  }
  return welded(corners.slice(0, corners.length - corners.length % 9));
}

const PLY_TYPES = {
  char: ['getInt8', 1], int8: ['getInt8', 1], uchar: ['getUint8', 1], uint8: ['getUint8', 1],
  short: ['getInt16', 2], int16: ['getInt16', 2], ushort: ['getUint16', 2], uint16: ['getUint16', 2],
  int: ['getInt32', 4], int32: ['getInt32', 4], uint: ['getUint32', 4], uint32: ['getUint32', 4],
  float: ['getFloat32', 4], float32: ['getFloat32', 4], double: ['getFloat64', 8], float64: ['getFloat64', 8],
};

function plyHeader(buffer) {
  const head = text(new Uint8Array(buffer, 0, Math.min(buffer.byteLength, 65536)));
  const end = head.match(/end_header[^\n]*\n/), elements = [];
  if (!end) fail('the header of this PLY file does not end: export it again');
  let format = '';
  for (const line of head.slice(0, end.index).split('\n')) {
    const words = line.trim().split(/\s+/);
    if (words[0] === 'format') format = words[1];
    if (words[0] === 'element') elements.push({ name: words[1], count: Number(words[2]), properties: [] });
    if (words[0] !== 'property') continue;
    const list = words[1] === 'list', types = list ? words.slice(2, 4) : words.slice(1, 2);
    if (!types.every((type) => PLY_TYPES[type])) fail(`this PLY file has the type ${types.join(' ')}, which is none of PLY: export it again`);
    elements.at(-1)?.properties.push({ name: words.at(-1), list, types });
  }
  return { format, elements, start: new TextEncoder().encode(head.slice(0, end.index + end[0].length)).length };
}

function readPly(buffer) {
  const { format, elements, start } = plyHeader(buffer), builder = new Builder();
  let next; // the next value of a type
  if (format === 'ascii') {
    const words = text(new Uint8Array(buffer, start)).split(/\s+/);
    let at = words[0] === '' ? 1 : 0;
    next = () => Number(words[at++]);
  } else {
    const view = new DataView(buffer), little = format === 'binary_little_endian';
    let at = start;
    next = (type) => {
      const [read, size] = PLY_TYPES[type];
      at += size;
      return view[read](at - size, little);
    };
  }
  try {
    for (const { name, count, properties } of elements) {
      for (let i = 0; i < count; ++i) {
        const found = {};
        for (const { name: property, list, types } of properties) {
          found[property] = list ? Array.from({ length: next(types[0]) }, () => next(types[1])) : next(types[0]);
        }
        if (name === 'vertex') builder.positions.push(found.x, found.y, found.z);
        if (name === 'face') builder.face(found.vertex_indices ?? found.vertex_index ?? []);
      }
    }
  } catch (error) {
    if (error instanceof RangeError) fail('this PLY file ends too soon: copy it again');
    throw error;
  }
  return { ...builder.surface, source: { format: 'ply' } };
}

const COMPONENTS = { 5120: [Int8Array, 127], 5121: [Uint8Array, 255], 5122: [Int16Array, 32767], 5123: [Uint16Array, 65535], 5125: [Uint32Array, 1], 5126: [Float32Array, 1] };
export const WIDTHS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT2: 4, MAT3: 9, MAT4: 16 };

/** The bytes of an accessor, packed: of each item `size` of them. */
export function accessorBytes({ json, bin }, index) {
  const accessor = json.accessors[index], [Type] = COMPONENTS[accessor.componentType];
  if (accessor.sparse || accessor.bufferView === undefined) fail('this GLB file has sparse accessors: export it without');
  const size = Type.BYTES_PER_ELEMENT * WIDTHS[accessor.type], view = json.bufferViews[accessor.bufferView];
  const step = view.byteStride ?? size, first = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
  if (view.buffer !== 0 || first + step * (accessor.count - 1) + size > bin.length) fail('this GLB file ends too soon, or its bytes are in other files: export it again as one .glb');
  const bytes = new Uint8Array(size * accessor.count);
  for (let i = 0; i < accessor.count; ++i) bytes.set(bin.subarray(first + step * i, first + step * i + size), size * i);
  return { bytes, size, count: accessor.count, Type };
}

function numbersOf(glb, index) {
  const { componentType, normalized } = glb.json.accessors[index], { bytes, Type } = accessorBytes(glb, index);
  const values = new Type(bytes.buffer), most = normalized ? COMPONENTS[componentType][1] : 1;
  return normalized ? Float64Array.from(values, (value) => Math.max(value / most, -1)) : values;
}

/** Of matrices by columns. */
function product(a, b) {
  return Array.from({ length: 16 }, (_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + i % 4] * b[4 * Math.floor(i / 4) + k], 0));
}

function localMatrix({ matrix, translation: t = [0, 0, 0], rotation: [x, y, z, w] = [0, 0, 0, 1], scale: s = [1, 1, 1] }) {
  if (matrix) return matrix;
  return [
    s[0] * (1 - 2 * (y * y + z * z)), s[0] * 2 * (x * y + z * w), s[0] * 2 * (x * z - y * w), 0,
    s[1] * 2 * (x * y - z * w), s[1] * (1 - 2 * (x * x + z * z)), s[1] * 2 * (y * z + x * w), 0,
    s[2] * 2 * (x * z + y * w), s[2] * 2 * (y * z - x * w), s[2] * (1 - 2 * (x * x + y * y)), 0, ...t, 1,
  ];
}

/** Where the first node that shows each mesh has it. */
function meshMatrices(json) {
  const found = new Map(), seen = new Set();
  const visit = (index, above) => {
    const node = json.nodes?.[index];
    if (!node || seen.has(index)) return;
    seen.add(index);
    const matrix = product(above, localMatrix(node));
    if (node.mesh !== undefined && node.skin === undefined && !found.has(node.mesh)) found.set(node.mesh, matrix);
    for (const child of node.children ?? []) visit(child, matrix);
  };
  const unit = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  for (const scene of json.scenes ?? []) for (const root of scene.nodes ?? []) visit(root, unit);
  return found;
}

function readGlb(buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < 20 || view.getUint32(0, true) !== 0x46546c67 || view.getUint32(4, true) !== 2) fail('this is no GLB file of version 2: export it again');
  const glb = { json: null, bin: new Uint8Array() };
  for (let at = 12; at + 8 <= buffer.byteLength;) {
    const size = view.getUint32(at, true), kind = view.getUint32(at + 4, true);
    const part = new Uint8Array(buffer, at + 8, Math.min(size, buffer.byteLength - at - 8));
    if (kind === 0x4e4f534a) glb.json = JSON.parse(text(part));
    if (kind === 0x004e4942) glb.bin = part;
    at += 8 + size + (4 - size % 4) % 4;
  }
  const builder = new Builder(), primitives = [], matrices = meshMatrices(glb.json);
  for (const required of glb.json.extensionsRequired ?? []) {
    if (/draco|meshopt/i.test(required)) fail('this GLB file is compressed: export it without compression');
  }
  glb.json.meshes?.forEach((mesh, m) => mesh.primitives.forEach((primitive) => {
    if ((primitive.mode ?? 4) !== 4 || primitive.attributes.POSITION === undefined) return;
    const positions = numbersOf(glb, primitive.attributes.POSITION), first = builder.positions.length / 3, t = matrices.get(m);
    for (let i = 0; i < positions.length; i += 3) {
      const p = positions.slice(i, i + 3);
      for (let k = 0; k < 3; ++k) builder.positions.push(t ? t[k] * p[0] + t[4 + k] * p[1] + t[8 + k] * p[2] + t[12 + k] : p[k]);
    }
    const count = positions.length / 3;
    const indices = primitive.indices === undefined ? Uint32Array.from({ length: count - count % 3 }, (_, i) => i) : numbersOf(glb, primitive.indices);
    primitives.push({ primitive, first, indices, corner: builder.indices.length });
    for (let i = 0; i + 2 < indices.length; i += 3) builder.face([first + indices[i], first + indices[i + 1], first + indices[i + 2]]);
  }));
  return { ...builder.surface, source: { format: 'glb', ...glb, primitives } };
}

/** A surface, with the `source` that write.mjs wants. Throws FileError, whose message says what to do. */
export function readMesh(name, buffer) {
  const ending = name.toLowerCase().match(/\.([a-z]+)$/)?.[1];
  const readers = { obj: (bytes) => readObj(text(bytes)), stl: readStl, ply: readPly, glb: readGlb };
  if (!readers[ending]) fail(`${name}: the page reads .obj, .stl, .ply and .glb`);
  let found;
  try {
    found = readers[ending](buffer);
  } catch (error) {
    throw new FileError(`${name}: ${error instanceof FileError ? error.message : `it is not what its name says (${error.message})`}`);
  }
  if (found.indices.length === 0) throw new FileError(`${name}: there are no faces in it`);
  const bad = found.positions.findIndex((value) => !Number.isFinite(value));
  if (bad >= 0) throw new FileError(`${name}: vertex ${Math.floor(bad / 3)} (counted from 0) is not three finite numbers`);
  return found;
}
