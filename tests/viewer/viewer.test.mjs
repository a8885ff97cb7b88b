// node --test tests/viewer, with VIEWER, the folder of the viewer's modules, and PAGE, the page that they are joined
// into: what the viewer computes, without a browser.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';

const folder = process.env.VIEWER ?? join(import.meta.dirname, '../../program/viewer');
const module = (name) => import(pathToFileURL(join(folder, `${name}.mjs`)).href);
const { BAD_HEAT, Geometry, NO_CHART } = await module('geometry');
const { LayoutCamera, ModelCamera, projected } = await module('cameras');
const { aboutChart, figures, verdict } = await module('figures');

/** A square of two triangles and a triangle beside it, in two charts. */
const arrays = {
  positions: new Float32Array([0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0, 2, 0, 0, 4, 0, 1, 2, 2, 0]),
  uvs: new Float32Array([0, 0, 0.4, 0, 0.4, 0.4, 0, 0.4, 0.5, 0, 0.9, 0, 0.5, 0.4]),
  faces: new Uint32Array([0, 1, 2, 0, 2, 3, 4, 5, 6]),
  energies: new Float32Array([2, 3, Infinity]),
  charts: new Uint32Array([0, 0, 1]),
};

test('borders are the sides of one triangle', () => {
  const geometry = new Geometry(arrays);
  assert.equal(geometry.lineCount, 7); // the diagonal of the square is inside
  assert.equal(geometry.triangles, 3);
});

test('charts add up', () => {
  const [square, triangle] = new Geometry(arrays).charts;
  assert.deepEqual([square.triangles, triangle.triangles], [2, 1]);
  assert.equal(square.energy, 2.5);
  assert.equal(square.most, 3);
  assert.equal(triangle.bad, 1);
  assert.ok(Math.abs(square.share + triangle.share - 1) < 1e-6);
  assert.deepEqual(square.box.map((x) => Number(x.toFixed(6))), [0, 0, 0.4, 0.4]);
  assert.match(aboutChart(square, 2), /^Chart 1 · .* 2 triangles · mean energy 2\.5 · greatest 3 · here 2$/);
});

test('faces without a chart are in none', () => {
  const geometry = new Geometry({ ...arrays, charts: new Uint32Array([0, 0, NO_CHART]) });
  assert.equal(geometry.charts.length, 1);
});

test('heat rises with energy, and what is wrong stands out', () => {
  const geometry = new Geometry(arrays);
  const heats = [2, 2.2, 2.6, 1000].map((energy) => geometry.heat(energy));
  assert.equal(heats[0], 0);
  assert.deepEqual([...heats].sort((a, b) => a - b), heats);
  assert.equal(heats[3], 254);
  assert.equal(geometry.heat(Infinity), BAD_HEAT);
  assert.equal(geometry.heat(NaN), BAD_HEAT);
});

test('vertices at one place share a normal, but for creases', () => {
  const cube = new Geometry({
    positions: new Float32Array([0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 1, 1, 0]), uvs: new Float32Array(12),
    faces: new Uint32Array([0, 1, 2, 3, 4, 5]), energies: new Float32Array([2, 2]), charts: new Uint32Array(2),
  });
  const bytes = new Int8Array(cube.corners), normal = (corner) => [...bytes.slice(24 * corner + 8, 24 * corner + 11)];
  assert.deepEqual(normal(0), [0, -127, 0]);
  assert.deepEqual(normal(3).map(Math.abs), [0, 0, 127]);
});

test('cameras show all, and keep it where it is pointed at', () => {
  const geometry = new Geometry(arrays);
  for (const aspect of [0.5, 1, 2.5]) {
    const model = new ModelCamera(geometry), layout = new LayoutCamera([0, 0, 1, 1]);
    for (const camera of [model, layout]) {
      for (const place of [[0, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 0]]) {
        const [x, y] = projected(camera.matrix(aspect), place);
        assert.ok(Math.abs(x) < 1 && Math.abs(y) < 1, `${place}: ${x} ${y}`);
      }
      const before = projected(camera.matrix(aspect), [0.3, 0.4, 0]);
      camera.magnify(3, before.slice(0, 2));
      const after = projected(camera.matrix(aspect), [0.3, 0.4, 0]);
      assert.ok(Math.hypot(after[0] - before[0], after[1] - before[1]) < 1e-5);
    }
    model.turn(0.7, 5); // no further than from above
    const [right, up, toward] = model.frame;
    const dot = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);
    for (const [a, b, value] of [[right, up, 0], [up, toward, 0], [toward, right, 0], [up, up, 1], [toward, model.up, 1]]) {
      assert.ok(Math.abs(dot(a, b) - value) < 1e-6);
    }
    layout.show([0.5, 0.5, 0.6, 0.6], aspect);
    const [x, y] = projected(layout.matrix(aspect), [0.55, 0.55]);
    assert.ok(Math.hypot(x, y) < 1e-5);
  }
});

test('figures leave out what is not known', () => {
  const report = {
    charts: 2, input: { triangles: 1234 }, energy: { symmetric_dirichlet: 2.04567 }, utilisation: 0.5, packing: null, injective: { result: true },
  };
  assert.deepEqual(figures(report), [['Charts', '2'], ['Triangles', '1,234'], ['Mean energy', '2.046'], ['Texture used', '50.0 %']]);
  assert.equal(verdict(report).good, true);
  assert.match(verdict({ injective: { result: false, negative: 1, overlaps: 2 } }).words, /1 flipped triangle, 2 overlaps/);
});

test('the modules joined in one scope are a module', { skip: process.env.PAGE ? false : 'PAGE is not set' }, () => {
  const page = readFileSync(process.env.PAGE, 'utf8');
  const script = page.match(/<script type="module">\n([^]*)<\/script>/)[1];
  assert.doesNotMatch(script, /^(import|export) /m);
  const checked = spawnSync(process.execPath, ['--input-type=module', '--check'], { input: script, encoding: 'utf8' });
  assert.equal(checked.status, 0, checked.stderr);
});
