// Editing: one surface whose seams and pins move, and maps that follow. Documentation: index.d.ts.
import { checked, REALS, WHOLE, wrong } from './calls.mjs';

const PIN_KINDS = ['point', 'u', 'v', 'line'];
const FLAGS = ['keepFrame', 'keepScale', 'align', 'stack']; // by their bits

export class Editor {
  #calls;
  #context;
  #given;
  #real;

  constructor(calls, surface, options) {
    this.#calls = calls;
    this.#real = options.float32 ? Float32Array : Float64Array;
    this.#context = calls.open('unwrap', options);
    try {
      this.#given = calls.within((arena) => {
        const given = calls.surface(arena, surface);
        calls.call(this.#context, options, calls.c.beltrami_session_begin, given.at);
        return { corners: given.corners, faces: given.faces };
      });
    } catch (error) {
      this.close();
      throw error;
    }
  }

  openSeams(edges) { this.#edit('beltrami_session_set_seams', edges, 'edges', 2, 1); }

  closeSeams(edges) { this.#edit('beltrami_session_set_seams', edges, 'edges', 2, 0); }

  select(faces) { this.#edit('beltrami_session_select', faces ?? new Uint32Array(), 'faces', 1); }

  lock(charts, locked = true) { this.#edit('beltrami_session_lock', charts, 'charts', 1, locked ? 1 : 0); }

  setFlags(charts, flags = {}) {
    const unknown = Object.keys(flags).find((name) => !FLAGS.includes(name));
    if (unknown) throw wrong(`a chart has no flag "${unknown}": there are ${FLAGS.join(', ')}`);
    const sum = FLAGS.reduce((all, name, i) => all + (flags[name] ? 1 << i : 0), 0);
    this.#edit('beltrami_session_set_flags', charts, 'charts', 1, sum);
  }

  renew(charts, cold = false) { this.#edit('beltrami_session_renew', charts, 'charts', 1, cold ? 1 : 0); }

  setPins(corners, uvs, kinds, directions) {
    const count = checked(corners, 'corners', WHOLE, 1).length;
    checked(uvs, 'uvs', REALS, 2, 2 * count);
    const numbers = kinds === undefined ? null : Uint32Array.from(kinds, (kind) => PIN_KINDS.indexOf(kind) >>> 0);
    if (numbers && (numbers.length !== count || numbers.some((kind) => kind >= PIN_KINDS.length))) {
      throw wrong(`kinds is to name one of ${PIN_KINDS.join(', ')} for each of the ${count} corners`);
    }
    if (directions !== undefined) checked(directions, 'directions', REALS, 2, 2 * count);
    else if (numbers?.includes(PIN_KINDS.indexOf('line'))) throw wrong("pins of the kind 'line' have directions: give these after the kinds");
    this.#within((calls, context, arena) => {
      calls.refuse(context, calls.c.beltrami_session_set_pins(context, arena.buffer(corners), arena.buffer(uvs), BigInt(count)));
      if (!numbers) return;
      const along = directions === undefined ? 0 : arena.buffer(directions);
      calls.refuse(context, calls.c.beltrami_session_set_pin_kinds(context, arena.buffer(numbers), along, BigInt(count)));
    });
  }

  update({ seconds = 0, steps = 0, ...running } = {}) {
    return this.#within((calls, context, arena) => {
      const status = calls.call(context, running, calls.c.beltrami_session_update, seconds, steps);
      return this.#changes(arena, calls.statusName(status));
    });
  }

  pack(charts = null, running = {}) {
    if (charts !== null && checked(charts, 'charts', WHOLE, 1).length === 0) throw wrong('there are no charts to pack: give null for all');
    return this.#within((calls, context, arena) => {
      const some = charts ?? new Uint32Array();
      const status = calls.call(context, running, calls.c.beltrami_session_pack, arena.buffer(some), BigInt(some.length));
      return this.#changes(arena, calls.statusName(status));
    });
  }

  check() { return this.#read('beltrami_atlas_certificate', 'beltrami_session_check'); }

  save() {
    return this.#within((calls, context, arena) => {
      const mark = arena.take(8);
      calls.refuse(context, calls.c.beltrami_session_save(context, mark));
      return Number(new DataView(calls.c.memory.buffer).getBigUint64(mark, true));
    });
  }

  restore(mark) {
    return this.#within((calls, context, arena) => {
      calls.refuse(context, calls.c.beltrami_session_restore(context, BigInt(mark)));
      return this.#changes(arena, calls.struct(arena, 'beltrami_session', calls.c.beltrami_get_session, context).status);
    });
  }

  forget(mark) {
    this.#within((calls, context) => calls.refuse(context, calls.c.beltrami_session_forget(context, BigInt(mark))));
  }

  close() {
    this.#calls.refuseWithin();
    this.#calls.c.beltrami_destroy(this.#context);
    this.#context = 0;
  }

  get cornerUvs() { return this.#array(this.#real, 2 * this.#given.corners, 'beltrami_get_session_uvs'); }

  get faceCharts() { return this.#array(Uint32Array, this.#given.faces, 'beltrami_get_session_face_charts'); }

  get opened() { return this.#array(Uint32Array, 2 * this.report.opened, 'beltrami_get_session_opened'); }

  get report() { return this.#read('beltrami_session', 'beltrami_get_session'); }

  get charts() {
    return Array.from({ length: this.report.charts }, (_, i) => {
      const { flags, reserved, stackedOn, ...chart } = this.#read('beltrami_session_chart', 'beltrami_get_session_chart', BigInt(i));
      FLAGS.forEach((name, bit) => { chart[name] = (flags >> bit & 1) === 1; });
      return { ...chart, stackedOn: stackedOn < 2 ** 53 ? stackedOn : null };
    });
  }

  #within(body) {
    if (this.#context === 0) throw wrong('this editor is closed: begin another');
    return this.#calls.within((arena) => body(this.#calls, this.#context, arena));
  }

  #edit(name, items, what, width, ...rest) {
    checked(items, what, WHOLE, width);
    this.#within((calls, context, arena) => {
      const count = BigInt(items.length / width);
      calls.refuse(context, calls.c[name](context, arena.buffer(items), count, ...rest));
    });
  }

  #read(struct, name, ...index) {
    return this.#within((calls, context, arena) => calls.struct(arena, struct, calls.c[name], context, ...index));
  }

  #array(kind, count, name) {
    return this.#within((calls, context, arena) => calls.array(arena, kind, count, calls.c[name], context));
  }

  #changes(arena, status) {
    const calls = this.#calls, context = this.#context;
    const { changes } = calls.struct(arena, 'beltrami_session', calls.c.beltrami_get_session, context);
    const corners = arena.room(Uint32Array, changes), uvs = arena.room(this.#real, 2 * changes);
    calls.refuse(context, calls.c.beltrami_get_session_changes(context, corners.at, corners.type, uvs.at, uvs.type));
    return { status, corners: corners.copy(), uvs: uvs.copy() };
  }
}
