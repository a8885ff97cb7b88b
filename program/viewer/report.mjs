// Starts the viewer on what a report holds.
import { Viewer } from './viewer.mjs';

/** Arrays as reports have them: bytes of one place in numbers after another, deflated, in base64. */
async function arraysOf(text, { vertices, triangles }) {
  const letters = atob(text.trim()), packed = new Uint8Array(letters.length);
  for (let i = 0; i < packed.length; ++i) packed[i] = letters.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer()), count = planes.length / 4;
  const bytes = new Uint8Array(planes.length);
  for (let plane = 0; plane < 4; ++plane) {
    for (let i = 0; i < count; ++i) bytes[4 * i + plane] = planes[plane * count + i];
  }
  let at = 0;
  const next = (Type, length) => new Type(bytes.buffer, 4 * (at += length) - 4 * length, length);
  const arrays = {
    positions: next(Float32Array, 3 * vertices), uvs: next(Float32Array, 2 * vertices), energies: next(Float32Array, triangles),
    faces: next(Uint32Array, 3 * triangles), charts: next(Uint32Array, triangles),
  };
  for (let i = 1; i < arrays.faces.length; ++i) arrays.faces[i] += arrays.faces[i - 1];
  return arrays;
}

async function start() {
  const { report, mesh } = JSON.parse(document.getElementById('report').textContent);
  const viewer = new Viewer(document.getElementById('viewer'));
  const name = (report.input?.path ?? '').split(/[\\/]/).pop();
  document.title = `${name || 'UVs'} · beltrami`;
  try {
    viewer.show(await arraysOf(document.getElementById('arrays').textContent, mesh), report, { name, frame: mesh.frame });
  } catch (error) {
    viewer.about.textContent = `This report cannot be shown: ${error.message}`;
    throw error;
  }
}

start();
