// How the library is called: its memory, structs, options and failures.
import { layouts, options as optionTable } from './tables.mjs';

const CALLS = { flatten: 1, unwrap: 2, pack: 4 };
export const REALS = [Float32Array, Float64Array], WHOLE = [Uint32Array];
const TYPES = new Map([[Float32Array, 0], [Float64Array, 1], [Uint32Array, 2]]); // BELTRAMI_F32, F64, U32
const BUFFER_BYTES = 24, BUFFER_TYPE = 16; // of beltrami_buffer, and where its type is
export const KINDS = ['none', 'face', 'vertex', 'corner'];
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

export const wrong = (message) => new BeltramiError(message, 'BELTRAMI_E_INVALID_ARGUMENT');

/** Memory of the library that a call takes, and gives back at its end. */
export class Arena {
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

  #describe(at, array) {
    const data = this.give(array), view = new DataView(this.c.memory.buffer);
    view.setUint32(at, data, true);
    view.setInt32(at + BUFFER_TYPE, TYPES.get(array.constructor), true);
  }

  /** A beltrami_buffer of an array. */
  buffer(array) {
    const at = this.take(BUFFER_BYTES);
    this.#describe(at, array);
    return at;
  }

  /** Room for an array that the library writes, and a copy of what it wrote. */
  room(kind, count) {
    const at = this.take(count * kind.BYTES_PER_ELEMENT);
    return { at, type: TYPES.get(kind), copy: () => new kind(this.c.memory.buffer, at, count).slice() };
  }

  struct(name, values = {}) {
    const { size, members } = layouts[name], at = this.take(size);
    const view = () => new DataView(this.c.memory.buffer); // which grows
    view().setUint32(at, size, true);
    for (const [key, value] of Object.entries(values)) {
      const [offset, kind] = members[key];
      if (kind === 'u64') view().setBigUint64(at + offset, BigInt(value), true);
      else if (kind === 'buffer') this.#describe(at + offset, value);
      else throw new Error(`${name}.${key} is set nowhere`);
    }
    return at;
  }

  free() {
    for (const at of this.taken.splice(0)) this.c.free(at);
  }
}

export function element(value) {
  return value === NO_ELEMENT ? null : Number(value);
}

/** Structs whose status is not that of the call. */
const OWN_STATUS = new Set(['beltrami_chart', 'beltrami_session', 'beltrami_session_chart']);

/** Of a struct of results, its members as JavaScript has them. */
export function readStruct(library, name, at) {
  const view = new DataView(library.c.memory.buffer), found = {};
  for (const [member, [offset, kind, count]] of Object.entries(layouts[name].members)) {
    if (member === 'struct_size' || member.startsWith('reserved') || member.startsWith('error_element')) continue;
    if (member === 'status' && !OWN_STATUS.has(name)) continue;
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
export function checked(array, what, classes, items, count) {
  if (!classes.some((kind) => array instanceof kind)) {
    throw wrong(`${what} is to be a ${classes.map((kind) => kind.name).join(' or a ')}`);
  }
  if (array.length % items !== 0) throw wrong(`${what} has ${array.length} numbers, which is no multiple of ${items}`);
  if (count !== undefined && array.length !== count) throw wrong(`${what} has ${array.length} numbers instead of ${count}`);
  return array;
}

/** Calls of the library, one at a time. */
export class Calls {
  #hook = null;
  #failure = null;

  constructor(exports, hooks, threads) {
    this.c = exports;
    this.threads = threads;
    hooks.progress = (fraction, stage) => this.#progress(fraction, stage);
  }

  text(at) {
    const bytes = new Uint8Array(this.c.memory.buffer);
    return decoder.decode(bytes.slice(at, bytes.indexOf(0, at)));
  }

  statusName(status) {
    return this.text(this.c.beltrami_status_name(status));
  }

  /** A new context with options. */
  open(call, options) {
    this.refuseWithin();
    const arena = new Arena(this.c), place = arena.take(4);
    let context = 0;
    try {
      if (this.c.beltrami_create_(1, place) !== 0) throw new BeltramiError('out of memory', 'BELTRAMI_E_OUT_OF_MEMORY');
      context = new DataView(this.c.memory.buffer).getUint32(place, true);
      this.#setOptions(context, arena, call, options);
      if (this.threads > 1) this.#lendThreads(context, arena);
      return context;
    } catch (error) {
      this.c.beltrami_destroy(context);
      throw error;
    } finally {
      arena.free();
    }
  }

  /** No call may begin inside another, as of its progress. */
  refuseWithin() {
    if (this.#hook !== null) throw new BeltramiError('a call is under way: load the library once more for another', 'BELTRAMI_E_INVALID_STATE');
  }

  /** Memory for a body, given back at its end. */
  within(body) {
    this.refuseWithin();
    const arena = new Arena(this.c);
    try {
      return body(arena);
    } finally {
      arena.free();
    }
  }

  /** A context with options for a body, and memory, both given back at the end. */
  run(call, options, body) {
    const context = this.open(call, options);
    try {
      return this.within((arena) => body(context, arena));
    } finally {
      this.c.beltrami_destroy(context);
    }
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
      this.refuse(context, status);
    }
  }

  /** The loops of calls on a context go to all threads. */
  #lendThreads(context, arena) {
    this.refuse(context, this.c.beltrami_set_parallel_for(context, this.c.loop_function(), 0));
    const key = this.c.beltrami_option_find(arena.give(new TextEncoder().encode('threads\0')));
    this.refuse(context, this.c.beltrami_set_int(context, key, BigInt(this.threads)));
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

  refuse(context, status) {
    if (status >= 0) return;
    const failure = this.#failure;
    this.#failure = null;
    if (failure !== null) throw failure;
    throw new BeltramiError(
      this.text(this.c.beltrami_error_message(context)) || this.text(this.c.beltrami_status_advice(status)),
      this.statusName(status), element(BigInt.asUintN(64, this.c.beltrami_error_element(context))),
      KINDS[this.c.beltrami_error_element_kind(context)] ?? 'none');
  }

  call(context, options, run, ...rest) {
    this.#hook = options;
    let status;
    try {
      status = run(context, ...rest, this.c.progress_function(), 0);
    } finally {
      this.#hook = null;
    }
    this.refuse(context, status);
    return status;
  }

  surface(arena, surface) {
    const positions = checked(surface.positions, 'positions', REALS, 3);
    const sizes = surface.faceSizes && checked(surface.faceSizes, 'faceSizes', WHOLE, 1);
    const indices = checked(surface.indices, 'indices', WHOLE, sizes ? 1 : 3);
    const corners = indices.length, faces = sizes ? sizes.length : corners / 3;
    const values = {
      vertex_count: positions.length / 3,
      face_count: faces,
      corner_count: corners,
      positions,
      indices,
    };
    if (sizes) values.face_sizes = sizes;
    const optional = (name, member, classes, items, count) => {
      if (surface[name] !== undefined) values[member] = checked(surface[name], name, classes, items, count);
    };
    optional('cornerUvs', 'corner_uvs', REALS, 2, 2 * corners);
    optional('faceLabels', 'face_labels', WHOLE, 1, faces);
    optional('densities', 'densities', REALS, 1, faces);
    optional('materials', 'materials', WHOLE, 1, faces);
    optional('seams', 'seams', WHOLE, 2);
    if (surface.seams !== undefined) values.seam_count = surface.seams.length / 2;
    return { at: arena.struct('beltrami_surface', values), corners, faces };
  }

  uvMesh(arena, mesh) {
    const uvs = checked(mesh.uvs, 'uvs', REALS, 2), corners = checked(mesh.uvIndices, 'uvIndices', WHOLE, 3);
    const values = {
      uv_count: uvs.length / 2,
      face_count: corners.length / 3,
      uvs,
      uv_indices: corners,
    };
    if (mesh.positions !== undefined) {
      const positions = checked(mesh.positions, 'positions', REALS, 3);
      values.vertex_count = positions.length / 3;
      values.positions = positions;
    }
    if (mesh.indices !== undefined) {
      values.indices = checked(mesh.indices, 'indices', WHOLE, 3, corners.length);
    }
    if (mesh.pageLabels !== undefined) {
      values.page_labels = checked(mesh.pageLabels, 'pageLabels', WHOLE, 1, corners.length / 3);
    }
    return { at: arena.struct('beltrami_uv_mesh', values), uvs: uvs.length / 2, faces: corners.length / 3 };
  }

  struct(arena, name, read, context, ...index) {
    const at = arena.struct(name);
    this.refuse(context, read(context, ...index, at));
    return readStruct(this, name, at);
  }

  certificate(arena, read, context, real) {
    const at = arena.struct('beltrami_atlas_certificate');
    this.refuse(context, read(context, TYPES.get(real), at));
    return readStruct(this, 'beltrami_atlas_certificate', at);
  }

  array(arena, kind, count, read, context, ...index) {
    const { at, type, copy } = arena.room(kind, count);
    this.refuse(context, read(context, ...index, at, type, 0n));
    return copy();
  }
}
