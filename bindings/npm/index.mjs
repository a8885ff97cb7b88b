// beltrami in JavaScript: one file for node, pages and their workers. Types and documentation: index.d.ts.
import { layouts, options as optionTable } from './tables.mjs';

const CALLS = { flatten: 1, unwrap: 2, pack: 4 };
const F32 = 0, F64 = 1, U32 = 2;
const KINDS = ['none', 'face', 'vertex', 'corner'];
const NO_ELEMENT = 0xffffffffffffffffn;
const decoder = new TextDecoder();
const camel = (name) => name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase());

export class BeltramiError extends Error {
  constructor(message, status, element = null, elementKind = 'none') {
    super(message);
    this.name = 'BeltramiError';
    Object.assign(this, { status, element, elementKind });
  }
}

const wrong = (message) => new BeltramiError(message, 'BELTRAMI_E_INVALID_ARGUMENT');

/** What the C library asks of the system: the time, random numbers, and where a message of its own end goes. */
function system(memory) {
  const view = () => new DataView(memory().buffer);
  const nothing = (count, size) => {
    view().setUint32(count, 0, true);
    view().setUint32(size, 0, true);
    return 0;
  };
  const badDescriptor = () => 8;
  return {
    args_get: () => 0,
    args_sizes_get: nothing,
    environ_get: () => 0,
    environ_sizes_get: nothing,
    clock_time_get: (id, _precision, at) => {
      const milliseconds = id === 0 ? Date.now() : performance.now();
      view().setBigUint64(at, BigInt(Math.round(milliseconds * 1e6)), true);
      return 0;
    },
    fd_close: badDescriptor,
    fd_seek: badDescriptor,
    fd_read: badDescriptor,
    fd_fdstat_get: badDescriptor,
    fd_write: (_descriptor, list, count, written) => {
      let bytes = 0;
      for (let i = 0; i < count; ++i) bytes += view().getUint32(list + 8 * i + 4, true);
      view().setUint32(written, bytes, true);
      return 0;
    },
    random_get: (at, size) => {
      crypto.getRandomValues(new Uint8Array(memory().buffer, at, size));
      return 0;
    },
    sched_yield: () => 0,
    proc_exit: (code) => {
      throw new BeltramiError(`the library ended with ${code}`, 'BELTRAMI_E_INTERNAL');
    },
  };
}

/** Memory of the library that a call takes, and gives back at its end. */
class Arena {
  constructor(exports) {
    this.c = exports;
    this.taken = [];
  }

  take(bytes) {
    const at = this.c.malloc(Math.max(bytes, 1)) >>> 0;
    if (at === 0) throw new BeltramiError('there is not enough memory for the arrays', 'BELTRAMI_E_OUT_OF_MEMORY');
    this.taken.push(at);
    new Uint8Array(this.c.memory.buffer, at, bytes).fill(0);
    return at;
  }

  give(array) {
    const at = this.take(array.byteLength);
    new array.constructor(this.c.memory.buffer, at, array.length).set(array);
    return at;
  }

  struct(name, values = {}) {
    const { size, members } = layouts[name], at = this.take(size);
    const view = new DataView(this.c.memory.buffer);
    view.setUint32(at, size, true);
    for (const [key, value] of Object.entries(values)) {
      const [offset, kind] = members[key];
      if (kind === 'u64') view.setBigUint64(at + offset, BigInt(value), true);
      else if (kind === 'buffer') {
        view.setUint32(at + offset, value.at, true);
        view.setInt32(at + offset + 16, value.type, true);
      } else throw new Error(`${name}.${key} is set nowhere`);
    }
    return at;
  }

  free() {
    for (const at of this.taken.splice(0)) this.c.free(at);
  }
}

function element(value) {
  return value === NO_ELEMENT ? null : Number(value);
}

/** Of a struct of results, its members as JavaScript has them. */
function readStruct(library, name, at) {
  const view = new DataView(library.c.memory.buffer), found = {};
  for (const [member, [offset, kind, count]] of Object.entries(layouts[name].members)) {
    if (member === 'struct_size' || member.startsWith('reserved') || member.startsWith('error_element')) continue;
    if (member === 'status' && name !== 'beltrami_chart') continue;
    const read = (place) => {
      if (kind === 'u64') return element(view.getBigUint64(place, true));
      if (kind === 'f64') return view.getFloat64(place, true);
      const number = view.getInt32(place, true);
      if (kind === 'bool') return number === 1;
      return member === 'status' || member === 'error' ? library.statusName(number) : number;
    };
    if (count === undefined) {
      found[camel(member)] = read(at + offset);
    } else {
      const several = Array.from({ length: count }, (_, i) => read(at + offset + 8 * i));
      found[camel(member)] = several.includes(null) ? null : several;
    }
  }
  return found;
}

/** A typed array that is one of some classes, and of whole items. */
function checked(array, what, classes, items, count) {
  if (!classes.some((kind) => array instanceof kind)) {
    throw wrong(`${what} is to be a ${classes.map((kind) => kind.name).join(' or a ')}`);
  }
  if (array.length % items !== 0) throw wrong(`${what} has ${array.length} numbers, which is no multiple of ${items}`);
  if (count !== undefined && array.length !== count) throw wrong(`${what} has ${array.length} numbers instead of ${count}`);
  return array;
}

const REALS = [Float32Array, Float64Array], WHOLE = [Uint32Array];
const TYPES = new Map([[Float32Array, F32], [Float64Array, F64], [Uint32Array, U32]]);

class Beltrami {
  #hook = null;
  #failure = null;

  constructor(exports, hooks) {
    this.c = exports;
    hooks.progress = (fraction, stage) => this.#progress(fraction, stage);
    this.buildInfo = this.text(exports.beltrami_build_info());
    const number = exports.beltrami_version();
    this.version = [number / 1000000, (number / 1000) % 1000, number % 1000].map(Math.trunc).join('.');
    for (const hidden of ['c']) Object.defineProperty(this, hidden, { enumerable: false });
  }

  text(at) {
    const bytes = new Uint8Array(this.c.memory.buffer);
    return decoder.decode(bytes.slice(at, bytes.indexOf(0, at)));
  }

  statusName(status) {
    return this.text(this.c.beltrami_status_name(status));
  }

  unwrap(surface, options = {}) {
    return this.#run('unwrap', options, (context, arena) => {
      const given = this.#surface(arena, surface);
      const status = this.#call(context, options, this.c.beltrami_unwrap, given.at);
      const report = this.#struct(arena, 'beltrami_atlas', this.c.beltrami_get_atlas, context);
      const real = options.float32 ? Float32Array : Float64Array;
      const whole = (read, count) => this.#array(arena, Uint32Array, count, read, context);
      const uvs = (read, count) => this.#array(arena, real, 2 * count, read, context);
      const charts = [];
      for (let i = 0; i < report.charts; ++i) {
        charts.push(this.#struct(arena, 'beltrami_chart', this.c.beltrami_get_chart, context, BigInt(i)));
      }
      return {
        status: this.statusName(status),
        cornerUvs: uvs(this.c.beltrami_get_corner_uvs, given.corners),
        uvVertices: uvs(this.c.beltrami_get_uv_vertices, report.uvVertices),
        cornerUvVertices: whole(this.c.beltrami_get_corner_uv_vertices, given.corners),
        uvVertexOrigins: whole(this.c.beltrami_get_uv_vertex_origins, report.uvVertices),
        cornerPages: whole(this.c.beltrami_get_corner_pages, given.corners),
        faceCharts: whole(this.c.beltrami_get_face_charts, given.faces),
        triangles: whole(this.c.beltrami_get_triangles, 3 * report.triangles),
        seams: whole(this.c.beltrami_get_seams, 2 * report.seams),
        charts,
        report,
        certificate: this.#certificate(arena, this.c.beltrami_get_atlas_certificate, context, real),
        packing: report.pages > 0 ? this.#struct(arena, 'beltrami_packing', this.c.beltrami_get_packing, context) : null,
      };
    });
  }

  flatten(mesh, options = {}) {
    return this.#run('flatten', options, (context, arena) => {
      const positions = checked(mesh.positions, 'positions', REALS, 3);
      const indices = checked(mesh.indices, 'indices', WHOLE, 3);
      const vertices = positions.length / 3;
      const at = arena.struct('beltrami_mesh', {
        vertex_count: vertices,
        face_count: indices.length / 3,
        positions: this.#buffer(arena, positions),
        indices: this.#buffer(arena, indices),
      });
      this.#refuse(context, this.c.beltrami_set_mesh(context, at));
      const status = this.#call(context, options, this.c.beltrami_run);
      const real = options.float32 ? Float32Array : Float64Array;
      const judge = options.float32 ? this.c.beltrami_get_float32_certificate : this.c.beltrami_get_certificate;
      return {
        status: this.statusName(status),
        uvs: this.#array(arena, real, 2 * vertices, this.c.beltrami_get_uvs, context),
        report: this.#struct(arena, 'beltrami_result', this.c.beltrami_get_result, context),
        certificate: this.#struct(arena, 'beltrami_certificate', judge, context),
        energy: this.#struct(arena, 'beltrami_energy', this.c.beltrami_get_energy, context),
      };
    });
  }

  check(surface, options = {}) {
    const arena = new Arena(this.c);
    try {
      if (surface.cornerUvs === undefined) throw wrong('check judges the cornerUvs of a surface: give them');
      const given = this.#surface(arena, surface);
      const out = arena.struct('beltrami_atlas_certificate');
      const status = this.c.beltrami_check_atlas(given.at, options.allowMirrored ? 1 : 0, out, 0, 0n);
      if (status < 0) {
        const view = new DataView(this.c.memory.buffer), { members } = layouts.beltrami_atlas_certificate;
        throw new BeltramiError(
          this.text(this.c.beltrami_status_advice(status)), this.statusName(status),
          element(view.getBigUint64(out + members.error_element[0], true)),
          KINDS[view.getInt32(out + members.error_element_kind[0], true)] ?? 'none');
      }
      return readStruct(this, 'beltrami_atlas_certificate', out);
    } finally {
      arena.free();
    }
  }

  pack(meshes, options = {}) {
    return this.#run('pack', options, (context, arena) => {
      const given = meshes.map((mesh) => this.#uvMesh(arena, mesh));
      const list = arena.give(new Uint32Array(given.map((mesh) => mesh.at)));
      const status = this.#call(context, options, this.c.beltrami_pack, list, BigInt(given.length));
      const report = this.#struct(arena, 'beltrami_packing', this.c.beltrami_get_packing, context);
      const real = options.float32 ? Float32Array : Float64Array;
      const of = (kind, read, index, count) => this.#array(arena, kind, count, read, context, BigInt(index));
      return {
        status: this.statusName(status),
        uvs: given.map((mesh, i) => of(real, this.c.beltrami_get_packed_uvs, i, 2 * mesh.uvs)),
        charts: given.map((mesh, i) => of(Uint32Array, this.c.beltrami_get_packed_charts, i, mesh.faces)),
        chartPages: this.#array(arena, Uint32Array, report.charts, this.c.beltrami_get_chart_pages, context),
        report,
        certificate: this.#certificate(arena, this.c.beltrami_get_packing_certificate, context, real),
      };
    });
  }

  #progress(fraction, stage) {
    try {
      if (this.#hook.cancel && Atomics.load(this.#hook.cancel, 0) !== 0) return 1;
      return this.#hook.progress?.(fraction, this.text(stage)) === true ? 1 : 0;
    } catch (error) { // it must not unwind the library's frames
      this.#failure = error;
      return 1;
    }
  }

  /** A context with options for a body, and memory, both given back at the end. */
  #run(call, options, body) {
    if (this.#hook !== null) throw new BeltramiError('a call is under way: load the library once more for another', 'BELTRAMI_E_INVALID_STATE');
    const arena = new Arena(this.c), place = arena.take(4);
    let context = 0;
    try {
      if (this.c.beltrami_create_(1, place) !== 0) throw new BeltramiError('out of memory', 'BELTRAMI_E_OUT_OF_MEMORY');
      context = new DataView(this.c.memory.buffer).getUint32(place, true);
      this.#setOptions(context, arena, call, options);
      return body(context, arena);
    } finally {
      this.c.beltrami_destroy(context);
      arena.free();
    }
  }

  #setOptions(context, arena, call, options) {
    const given = Object.keys(options).filter((name) => options[name] !== undefined);
    for (const name of given) {
      if (name === 'progress' || name === 'cancel') continue;
      if (!((optionTable[name]?.[1] ?? 0) & CALLS[call])) throw wrong(`${call} has no option ${name}`);
    }
    // A preset first, since it sets others; and those as the table has them.
    const order = ['preset', ...Object.keys(optionTable).filter((name) => name !== 'preset')];
    for (const name of order.filter((known) => given.includes(known))) {
      const [plain] = optionTable[name], value = options[name];
      const key = this.c.beltrami_option_find(arena.give(new TextEncoder().encode(`${plain}\0`)));
      let status;
      if (typeof value === 'string') {
        status = this.c.beltrami_set_int(context, key, BigInt(this.#choice(key, name, value)));
      } else if (typeof value === 'boolean') {
        status = this.c.beltrami_set_int(context, key, value ? 1n : 0n);
      } else if (typeof value !== 'number') {
        throw wrong(`the option ${name} is to be a number, a boolean or a name`);
      } else {
        const isFloat = this.#isFloat(arena, key);
        if (!isFloat && !Number.isSafeInteger(value)) throw wrong(`the option ${name} is to be a whole number`);
        status = isFloat ? this.c.beltrami_set_float(context, key, value) : this.c.beltrami_set_int(context, key, BigInt(value));
      }
      this.#refuse(context, status);
    }
  }

  #isFloat(arena, key) {
    const { members } = layouts.beltrami_option_info, info = arena.struct('beltrami_option_info');
    this.c.beltrami_option_describe(key, info);
    return new DataView(this.c.memory.buffer).getInt32(info + members.type[0], true) === 1;
  }

  #choice(key, name, value) {
    const choices = [];
    for (let at; (at = this.c.beltrami_option_choice(key, choices.length)) !== 0;) choices.push(this.text(at));
    const index = choices.indexOf(value);
    if (index < 0) throw wrong(`the option ${name} is one of ${choices.join(', ') || 'numbers'}, not '${value}'`);
    return index;
  }

  #refuse(context, status) {
    if (status >= 0) return;
    const failure = this.#failure;
    this.#failure = null;
    if (failure !== null) throw failure;
    throw new BeltramiError(
      this.text(this.c.beltrami_error_message(context)) || this.text(this.c.beltrami_status_advice(status)),
      this.statusName(status), element(BigInt.asUintN(64, this.c.beltrami_error_element(context))),
      KINDS[this.c.beltrami_error_element_kind(context)] ?? 'none');
  }

  #call(context, options, run, ...rest) {
    this.#hook = options;
    let status;
    try {
      status = run(context, ...rest, this.c.progress_function(), 0);
    } finally {
      this.#hook = null;
    }
    this.#refuse(context, status);
    return status;
  }

  #buffer(arena, array) {
    return { at: arena.give(array), type: TYPES.get(array.constructor) };
  }

  #surface(arena, surface) {
    const positions = checked(surface.positions, 'positions', REALS, 3);
    const sizes = surface.faceSizes && checked(surface.faceSizes, 'faceSizes', WHOLE, 1);
    const indices = checked(surface.indices, 'indices', WHOLE, sizes ? 1 : 3);
    const corners = indices.length, faces = sizes ? sizes.length : corners / 3;
    const values = {
      vertex_count: positions.length / 3,
      face_count: faces,
      corner_count: corners,
      positions: this.#buffer(arena, positions),
      indices: this.#buffer(arena, indices),
    };
    if (sizes) values.face_sizes = this.#buffer(arena, sizes);
    const optional = (name, member, classes, items, count) => {
      if (surface[name] !== undefined) values[member] = this.#buffer(arena, checked(surface[name], name, classes, items, count));
    };
    optional('cornerUvs', 'corner_uvs', REALS, 2, 2 * corners);
    optional('faceLabels', 'face_labels', WHOLE, 1, faces);
    optional('densities', 'densities', REALS, 1, faces);
    optional('materials', 'materials', WHOLE, 1, faces);
    optional('seams', 'seams', WHOLE, 2);
    if (surface.seams !== undefined) values.seam_count = surface.seams.length / 2;
    return { at: arena.struct('beltrami_surface', values), corners, faces };
  }

  #uvMesh(arena, mesh) {
    const uvs = checked(mesh.uvs, 'uvs', REALS, 2), corners = checked(mesh.uvIndices, 'uvIndices', WHOLE, 3);
    const values = {
      uv_count: uvs.length / 2,
      face_count: corners.length / 3,
      uvs: this.#buffer(arena, uvs),
      uv_indices: this.#buffer(arena, corners),
    };
    if (mesh.positions !== undefined) {
      const positions = checked(mesh.positions, 'positions', REALS, 3);
      values.vertex_count = positions.length / 3;
      values.positions = this.#buffer(arena, positions);
    }
    if (mesh.indices !== undefined) {
      values.indices = this.#buffer(arena, checked(mesh.indices, 'indices', WHOLE, 3, corners.length));
    }
    return { at: arena.struct('beltrami_uv_mesh', values), uvs: uvs.length / 2, faces: corners.length / 3 };
  }

  #struct(arena, name, read, context, ...index) {
    const at = arena.struct(name);
    this.#refuse(context, read(context, ...index, at));
    return readStruct(this, name, at);
  }

  #certificate(arena, read, context, real) {
    const at = arena.struct('beltrami_atlas_certificate');
    this.#refuse(context, read(context, TYPES.get(real), at));
    return readStruct(this, 'beltrami_atlas_certificate', at);
  }

  #array(arena, kind, count, read, context, ...index) {
    const at = arena.take(count * kind.BYTES_PER_ELEMENT);
    this.#refuse(context, read(context, ...index, at, TYPES.get(kind), 0n));
    return new kind(this.c.memory.buffer, at, count).slice();
  }
}

/** The bytes of a file beside this one, or at an address; or what they were compiled to. */
async function fetched(source) {
  const address = source === undefined ? new URL('beltrami.wasm', import.meta.url) : source;
  if (typeof address !== 'string' && !(address instanceof URL)) {
    return typeof Response !== 'undefined' && address instanceof Response ? address.arrayBuffer() : address;
  }
  const place = new URL(address, import.meta.url);
  if (place.protocol === 'file:') {
    const { readFile } = await import('node:fs/promises');
    return readFile(place);
  }
  const response = await fetch(place);
  if (!response.ok) throw new Error(`${place}: ${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}

export async function load(source) {
  let exports = null;
  const hooks = { progress: () => 0 };
  const imports = {
    wasi_snapshot_preview1: system(() => exports.memory),
    beltrami: { progress: (fraction, stage) => hooks.progress(fraction, stage) },
  };
  const made = await WebAssembly.instantiate(await fetched(source), imports);
  exports = (made instanceof WebAssembly.Instance ? made : made.instance).exports;
  exports._initialize();
  return new Beltrami(exports, hooks);
}
