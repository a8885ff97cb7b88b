// beltrami in JavaScript, for node, pages and their workers. Types and documentation: index.d.ts.
import { BeltramiError, Calls, checked, element, KINDS, readStruct, REALS, WHOLE, wrong } from './calls.mjs';
import { Editor } from './editor.mjs';
import { layouts } from './tables.mjs';

export { BeltramiError };

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

class Beltrami {
  #calls;

  constructor(calls) {
    this.#calls = calls;
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
  return new Beltrami(new Calls(exports, hooks));
}
