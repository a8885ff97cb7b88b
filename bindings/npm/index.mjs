// beltrami in JavaScript, for node, pages and their workers. Types and documentation: index.d.ts.
import { BeltramiError, Calls, checked, element, KINDS, readStruct, REALS, WHOLE, wrong } from './calls.mjs';
import { Editor } from './editor.mjs';
import { imports } from './system.mjs';
import { layouts } from './tables.mjs';
import { startHelpers, threadsFor, withSharedMemory } from './threads.mjs';

export { BeltramiError };

/** Of the memory, in pages: tools/dist/npm.py links the module for these. */
const FIRST_PAGES = 256, MOST_PAGES = 65535;

class Beltrami {
  #calls;
  #endHelpers;

  constructor(calls, endHelpers) {
    this.#calls = calls;
    this.#endHelpers = endHelpers;
    this.threads = calls.threads;
    this.buildInfo = calls.text(calls.c.beltrami_build_info());
    const number = calls.c.beltrami_version();
    this.version = [number / 1000000, (number / 1000) % 1000, number % 1000].map(Math.trunc).join('.');
  }

  unwrap(surface, options = {}) {
    const calls = this.#calls;
    return calls.run('unwrap', options, (context, arena) => {
      const given = calls.surface(arena, surface);
      const status = calls.call(context, options, calls.c.beltrami_unwrap, given.at);
      const report = calls.struct(arena, 'beltrami_atlas', calls.c.beltrami_get_atlas, context);
      const real = options.float32 ? Float32Array : Float64Array;
      const whole = (read, count) => calls.array(arena, Uint32Array, count, read, context);
      const uvs = (read, count) => calls.array(arena, real, 2 * count, read, context);
      const charts = [];
      for (let i = 0; i < report.charts; ++i) {
        charts.push(calls.struct(arena, 'beltrami_chart', calls.c.beltrami_get_chart, context, BigInt(i)));
      }
      return {
        status: calls.statusName(status),
        cornerUvs: uvs(calls.c.beltrami_get_corner_uvs, given.corners),
        uvVertices: uvs(calls.c.beltrami_get_uv_vertices, report.uvVertices),
        cornerUvVertices: whole(calls.c.beltrami_get_corner_uv_vertices, given.corners),
        uvVertexOrigins: whole(calls.c.beltrami_get_uv_vertex_origins, report.uvVertices),
        cornerPages: whole(calls.c.beltrami_get_corner_pages, given.corners),
        faceCharts: whole(calls.c.beltrami_get_face_charts, given.faces),
        triangles: whole(calls.c.beltrami_get_triangles, 3 * report.triangles),
        seams: whole(calls.c.beltrami_get_seams, 2 * report.seams),
        charts,
        report,
        certificate: calls.certificate(arena, calls.c.beltrami_get_atlas_certificate, context, real),
        packing: report.pages > 0 ? calls.struct(arena, 'beltrami_packing', calls.c.beltrami_get_packing, context) : null,
      };
    });
  }

  flatten(mesh, options = {}) {
    const calls = this.#calls;
    return calls.run('flatten', options, (context, arena) => {
      const positions = checked(mesh.positions, 'positions', REALS, 3);
      const indices = checked(mesh.indices, 'indices', WHOLE, 3);
      const vertices = positions.length / 3;
      const at = arena.struct('beltrami_mesh', {
        vertex_count: vertices,
        face_count: indices.length / 3,
        positions,
        indices,
      });
      calls.refuse(context, calls.c.beltrami_set_mesh(context, at));
      const status = calls.call(context, options, calls.c.beltrami_run);
      const real = options.float32 ? Float32Array : Float64Array;
      const judge = options.float32 ? calls.c.beltrami_get_float32_certificate : calls.c.beltrami_get_certificate;
      return {
        status: calls.statusName(status),
        uvs: calls.array(arena, real, 2 * vertices, calls.c.beltrami_get_uvs, context),
        report: calls.struct(arena, 'beltrami_result', calls.c.beltrami_get_result, context),
        certificate: calls.struct(arena, 'beltrami_certificate', judge, context),
        energy: calls.struct(arena, 'beltrami_energy', calls.c.beltrami_get_energy, context),
      };
    });
  }

  check(surface, options = {}) {
    const calls = this.#calls;
    return calls.within((arena) => {
      if (surface.cornerUvs === undefined) throw wrong('check judges the cornerUvs of a surface: give them');
      const given = calls.surface(arena, surface);
      const out = arena.struct('beltrami_atlas_certificate');
      const status = calls.c.beltrami_check_atlas(given.at, options.allowMirrored ? 1 : 0, out, 0, 0n);
      if (status < 0) {
        const view = new DataView(calls.c.memory.buffer), { members } = layouts.beltrami_atlas_certificate;
        throw new BeltramiError(
          calls.text(calls.c.beltrami_status_advice(status)), calls.statusName(status),
          element(view.getBigUint64(out + members.error_element[0], true)),
          KINDS[view.getInt32(out + members.error_element_kind[0], true)] ?? 'none');
      }
      return readStruct(calls, 'beltrami_atlas_certificate', out);
    });
  }

  pack(meshes, options = {}) {
    const calls = this.#calls;
    return calls.run('pack', options, (context, arena) => {
      const given = meshes.map((mesh) => calls.uvMesh(arena, mesh));
      const list = arena.give(new Uint32Array(given.map((mesh) => mesh.at)));
      const status = calls.call(context, options, calls.c.beltrami_pack, list, BigInt(given.length));
      const report = calls.struct(arena, 'beltrami_packing', calls.c.beltrami_get_packing, context);
      const real = options.float32 ? Float32Array : Float64Array;
      const of = (kind, read, index, count) => calls.array(arena, kind, count, read, context, BigInt(index));
      return {
        status: calls.statusName(status),
        uvs: given.map((mesh, i) => of(real, calls.c.beltrami_get_packed_uvs, i, 2 * mesh.uvs)),
        charts: given.map((mesh, i) => of(Uint32Array, calls.c.beltrami_get_packed_charts, i, mesh.faces)),
        chartPages: calls.array(arena, Uint32Array, report.charts, calls.c.beltrami_get_chart_pages, context),
        report,
        certificate: calls.certificate(arena, calls.c.beltrami_get_packing_certificate, context, real),
      };
    });
  }

  edit(surface, options = {}) { return new Editor(this.#calls, surface, options); }

  close() {
    this.#calls.refuseWithin();
    this.#endHelpers();
    this.#calls.threads = this.threads = 1;
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

/** Memory that grows as far as this machine has addresses for: what is shared takes all of them at once. */
function growing(shared) {
  for (let maximum = MOST_PAGES; ; maximum >>= 1) {
    try {
      return new WebAssembly.Memory({ initial: FIRST_PAGES, maximum, shared });
    } catch (error) {
      if (maximum < 2 * FIRST_PAGES) throw error;
    }
  }
}

/** The module, compiled; with `shared`, for memory that threads share. */
async function compiled(source, shared) {
  const found = await fetched(source);
  if (!shared) return found instanceof WebAssembly.Module ? found : WebAssembly.compile(found);
  if (found instanceof WebAssembly.Module) {
    throw wrong('for threads load takes the address or the bytes of beltrami.wasm, and compiles them itself');
  }
  return WebAssembly.compile(withSharedMemory(found));
}

export async function load(source, { threads = 1 } = {}) {
  const count = await threadsFor(threads), shared = count > 1;
  const module = await compiled(source, shared);
  const memory = growing(shared);
  const hooks = { progress: () => 0 };
  const end = (code) => {
    throw new BeltramiError(`the library ended with ${code}`, 'BELTRAMI_E_INTERNAL');
  };
  const asked = imports(memory, (fraction, stage) => hooks.progress(fraction, stage), end);
  const { exports: c } = await WebAssembly.instantiate(module, asked);
  c._initialize();
  const endHelpers = shared ? await startHelpers(module, memory, c, count - 1) : () => {};
  return new Beltrami(new Calls(c, hooks, count), endHelpers);
}
