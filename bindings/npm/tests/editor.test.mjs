// Editing sessions. Run as beltrami.test.mjs is.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';

const folder = process.env.BELTRAMI_NPM ?? join(import.meta.dirname, '../../../build/dist/stage/wasm32');
const { load, BeltramiError } = await import(pathToFileURL(join(folder, 'index.mjs')).href);
const beltrami = await load();

/** A bent sheet of n by n quadrilaterals. */
function sheet(n) {
  const positions = [], indices = [], at = (i, j) => i * (n + 1) + j;
  for (let i = 0; i <= n; ++i) for (let j = 0; j <= n; ++j) positions.push(i, j, 0.05 * i * j);
  for (let i = 0; i < n; ++i) for (let j = 0; j < n; ++j) indices.push(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return { at, surface: { positions: new Float64Array(positions), indices: new Uint32Array(indices), faceSizes: new Uint32Array(n * n).fill(4) } };
}

const { at, surface } = sheet(6);
/** The edges that part the sheet in the middle. */
const middle = Uint32Array.from({ length: 12 }, (_, k) => at(3, (k + 1) >> 1));

test('seams open and close, and undo comes back to the bit', () => {
  const editor = beltrami.edit(surface);
  const first = editor.update();
  assert.equal(first.status, 'BELTRAMI_OK');
  assert.equal(first.corners.length, 144);
  assert.deepEqual(editor.cornerUvs, first.uvs);
  assert.equal(editor.charts.length, 1);
  const mark = editor.save(), before = editor.cornerUvs;
  editor.openSeams(middle);
  assert.notEqual(editor.update({ steps: 2 }).corners.length, 0);
  assert.equal(editor.report.charts, 2);
  assert.equal(new Set(editor.faceCharts).size, 2);
  assert.equal(editor.pack().status, 'BELTRAMI_OK');
  assert.equal(editor.check().injective, true);
  assert.ok(editor.cornerUvs.every((value) => value >= 0 && value <= 1));
  editor.closeSeams(middle);
  editor.update();
  assert.equal(editor.report.charts, 1);
  const undone = editor.restore(mark);
  assert.deepEqual(editor.cornerUvs, before);
  assert.ok(undone.corners.length > 0);
  editor.forget(mark);
  assert.throws(() => editor.restore(mark), BeltramiError);
  editor.close();
  assert.throws(() => editor.update(), /closed/);
});

test('pins are met, and charts and faces are held', () => {
  const editor = beltrami.edit(surface, { float32: true });
  editor.update();
  const place = Float32Array.of(10, 20, 13, 20);
  editor.setPins(Uint32Array.of(0, 143), place);
  editor.update();
  const uvs = editor.cornerUvs;
  assert.ok(uvs instanceof Float32Array);
  assert.deepEqual([...uvs.slice(0, 2), ...uvs.slice(-2)], [...place]);
  editor.setPins(Uint32Array.of(0, 143), Float32Array.of(11, 0, 12, 30), ['u', 'line'], Float32Array.of(0, 0, 0, 1));
  editor.update();
  assert.deepEqual([editor.cornerUvs[0], editor.cornerUvs.at(-2)], [11, 12]);
  editor.setPins(Uint32Array.of(), Float32Array.of());
  const [{ id }] = editor.charts;
  editor.lock(Uint32Array.of(id));
  assert.equal(editor.charts[0].locked, true);
  editor.renew(Uint32Array.of(id));
  assert.equal(editor.update().corners.length, 0);
  editor.lock(Uint32Array.of(id), false);
  editor.setFlags(Uint32Array.of(id), { align: true, stack: true });
  const [{ keepFrame, align, stack, stackedOn }] = editor.charts;
  assert.deepEqual({ keepFrame, align, stack, stackedOn }, { keepFrame: false, align: true, stack: true, stackedOn: null });
  assert.throws(() => editor.setFlags(Uint32Array.of(id), { locked: true }), /keepFrame/);
  editor.setFlags(Uint32Array.of(id));
  editor.select(Uint32Array.of(0));
  editor.update();
  editor.select(null);
  editor.renew(Uint32Array.of(id), true);
  assert.equal(editor.charts[0].due, true);
  editor.close();
});

test('what is wrong is refused, and the editor goes on', () => {
  const editor = beltrami.edit(surface);
  assert.throws(() => editor.openSeams(Uint32Array.of(0, 48)), (error) => error instanceof BeltramiError && /edge/.test(error.message));
  assert.throws(() => editor.openSeams([0, 1]), /Uint32Array/);
  assert.throws(() => editor.openSeams(Uint32Array.of(0)), /multiple of 2/);
  assert.throws(() => editor.setPins(Uint32Array.of(0), Float64Array.of(1)), /instead of 2|multiple of 2/);
  assert.throws(() => editor.setPins(Uint32Array.of(0), Float64Array.of(0, 0), ['corner']), /point, u, v, line/);
  assert.throws(() => editor.setPins(Uint32Array.of(0), Float64Array.of(0, 0), ['line']), /directions/);
  assert.throws(() => editor.pack(Uint32Array.of()), /null for all/);
  assert.throws(() => editor.update({ progress: () => true }), (error) => error.status === 'BELTRAMI_E_CANCELLED');
  assert.throws(() => editor.update({ progress: () => editor.close() }), /under way/);
  assert.equal(editor.update().status, 'BELTRAMI_OK');
  assert.throws(() => beltrami.edit({ ...surface, indices: Uint32Array.of(0, 1) }), BeltramiError);
  editor.close();
});

test('begins from UVs that there are', () => {
  const { cornerUvs } = beltrami.unwrap(surface);
  const editor = beltrami.edit({ ...surface, cornerUvs });
  editor.update();
  assert.deepEqual(editor.cornerUvs, cornerUvs);
  editor.openSeams(middle);
  editor.update({ seconds: 10 });
  assert.equal(editor.report.charts, 2);
  editor.close();
});
