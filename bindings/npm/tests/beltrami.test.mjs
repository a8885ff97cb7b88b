// node --test bindings/npm/tests, with BELTRAMI_NPM, the folder of the package with its beltrami.wasm; and where
// BELTRAMI_PROGRAM is this machine's program, the same bits are asked for.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { readObj } from './obj.mjs';

const folder = process.env.BELTRAMI_NPM ?? join(import.meta.dirname, '../../../build/dist/stage/wasm32');
const data = join(import.meta.dirname, '../../../examples/data');
const { load, BeltramiError } = await import(pathToFileURL(join(folder, 'index.mjs')).href);
const beltrami = await load();

const box = {
  positions: new Float64Array([0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0, 0, 0, 1, 2, 0, 1, 2, 1, 1, 0, 1, 1]),
  indices: new Uint32Array([0, 1, 2, 3, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7]),
  faceSizes: new Uint32Array([4, 4, 4, 4, 4]),
};
const square = { positions: new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0.5, 0, 1, 0]), indices: new Uint32Array([0, 1, 2, 0, 2, 3]) };

test('tells what it is', () => {
  assert.match(beltrami.version, /^\d+\.\d+\.\d+$/);
  assert.match(beltrami.buildInfo, /exact numbers own, links no GPL code and no LGPL code/);
});

test('unwraps polygons, and proves it', () => {
  const atlas = beltrami.unwrap(box);
  assert.equal(atlas.status, 'BELTRAMI_OK');
  assert.equal(atlas.certificate.injective, true);
  assert.equal(atlas.cornerUvs.length, 40);
  assert.ok(atlas.cornerUvs instanceof Float64Array);
  assert.ok(atlas.cornerUvs.every((value) => value >= 0 && value <= 1));
  assert.equal(atlas.charts.length, atlas.report.charts);
  assert.equal(atlas.packing.pages, 1);
  for (let corner = 0; corner < 20; ++corner) { // UV vertices are what corners have
    const at = atlas.cornerUvVertices[corner];
    assert.equal(atlas.uvVertices[2 * at], atlas.cornerUvs[2 * corner]);
    assert.equal(atlas.uvVertexOrigins[at], box.indices[corner]);
  }
  const verdict = beltrami.check({ ...box, cornerUvs: atlas.cornerUvs });
  assert.equal(verdict.injective, true);
  assert.equal(verdict.firstBadFace, null);
});

test('gives single precision where that is asked for', () => {
  const atlas = beltrami.unwrap(box, { float32: true });
  assert.ok(atlas.cornerUvs instanceof Float32Array);
  assert.equal(atlas.certificate.injective, true);
});

test('finds faces that lie on each other', () => {
  const cornerUvs = new Float64Array([0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 1, 0]);
  const verdict = beltrami.check({ ...square, cornerUvs });
  assert.equal(verdict.injective, false);
  assert.equal(verdict.firstBadFace, 1);
});

test('flattens a disk', () => {
  const { uvs, status, certificate, energy } = beltrami.flatten(square);
  assert.equal(status, 'BELTRAMI_OK');
  assert.equal(uvs.length, 8);
  assert.equal(certificate.injective, true);
  assert.ok(energy.symmetricDirichlet >= 2);
});

test('packs charts of several meshes', () => {
  const mesh = { uvs: new Float32Array([0, 0, 1, 0, 1, 1]), uvIndices: new Uint32Array([0, 1, 2]) };
  const packing = beltrami.pack([mesh, mesh], { resolution: 256, margin: 4 });
  assert.equal(packing.uvs.length, 2);
  assert.deepEqual([...packing.charts[0], ...packing.charts[1]], [0, 1]);
  assert.equal(packing.chartPages.length, 2);
  assert.equal(packing.certificate.injective, true);
  assert.ok(packing.report.margin >= 4);
  const labelled = (label) => ({ ...mesh, pageLabels: Uint32Array.of(label) });
  assert.deepEqual([...beltrami.pack([labelled(3), labelled(1)]).chartPages].map(Number), [1, 0]);
});

test('options are those of the table', () => {
  assert.throws(() => beltrami.unwrap(box, { colour: 1 }), /no option colour/);
  assert.throws(() => beltrami.flatten(square, { targetEnergy: 2.1 }), /flatten has no option targetEnergy/);
  assert.throws(() => beltrami.unwrap(box, { effort: 'vast' }), /quick, normal, high/);
  assert.throws(() => beltrami.unwrap(box, { targetEnergy: 1 }), BeltramiError);
  assert.throws(() => beltrami.unwrap(box, { resolution: 2.5 }), /whole number/);
  assert.equal(beltrami.unwrap(box, { resolution: 64 }).packing.resolution, 64);
  assert.equal(beltrami.unwrap(box, { pack: 'none' }).packing, null);
});

test('bad input gets a sentence, and the element', () => {
  const beyond = { ...square, indices: new Uint32Array([0, 1, 2, 0, 2, 9]) };
  assert.throws(() => beltrami.unwrap(beyond), (error) =>
    error instanceof BeltramiError && error.status === 'BELTRAMI_E_INDEX_OUT_OF_RANGE' && error.elementKind !== 'none');
  assert.throws(() => beltrami.unwrap({ ...square, positions: [0, 0, 0] }), /Float32Array or a Float64Array/);
  assert.throws(() => beltrami.unwrap({ ...square, indices: new Uint32Array([0, 1]) }), /multiple of 3/);
  assert.throws(() => beltrami.check(square), /cornerUvs/);
  assert.throws(() => beltrami.flatten({ ...square, indices: new Uint32Array() }), BeltramiError);
  assert.equal(beltrami.unwrap(square).status, 'BELTRAMI_OK'); // and the next call is as if nothing had been
});

test('progress rises, cancels, and may throw', () => {
  const mesh = readObj(readFileSync(join(data, 'spot.obj'), 'utf8'));
  let last = 0, calls = 0;
  const progress = (fraction, stage) => {
    assert.ok(fraction >= last && fraction <= 1 && stage.length > 0);
    last = fraction;
    return ++calls > 3;
  };
  assert.throws(() => beltrami.unwrap(mesh, { progress }), (error) => error.status === 'BELTRAMI_E_CANCELLED');
  assert.equal(calls, 4);
  const mine = new Error('mine');
  assert.throws(() => beltrami.unwrap(mesh, { progress: () => { throw mine; } }), (error) => error === mine);
  const cancel = new Int32Array(new SharedArrayBuffer(4));
  cancel[0] = 1;
  assert.throws(() => beltrami.unwrap(mesh, { cancel }), (error) => error.status === 'BELTRAMI_E_CANCELLED');
  const inside = () => { beltrami.unwrap(box); };
  assert.throws(() => beltrami.unwrap(mesh, { progress: inside }), /under way/);
});

test('has the bits of the program of this machine', { skip: process.env.BELTRAMI_PROGRAM ? false : 'BELTRAMI_PROGRAM is not set' }, () => {
  const place = mkdtempSync(join(tmpdir(), 'beltrami-'));
  try {
    for (const [command, name, run] of [
      ['unwrap', 'spot.obj', (mesh) => beltrami.unwrap(mesh, { effort: 'quick' }).cornerUvs],
      ['flatten', 'nefertiti_disk.obj', (mesh) => {
        const { uvs } = beltrami.flatten(mesh);
        return Float64Array.from({ length: 2 * mesh.indices.length }, (_, i) => uvs[2 * mesh.indices[i >> 1] + (i & 1)]);
      }],
    ]) {
      const out = join(place, name), extra = command === 'unwrap' ? ['--effort', 'quick'] : [];
      const done = spawnSync(process.env.BELTRAMI_PROGRAM, [command, join(data, name), out, '--quiet', ...extra]);
      assert.equal(done.status, 0, String(done.stderr));
      const { cornerUvs: expected } = readObj(readFileSync(out, 'utf8'));
      const { cornerUvs: _, ...mesh } = readObj(readFileSync(join(data, name), 'utf8'));
      const found = run(mesh);
      const differing = found.reduce((sum, value, i) => sum + (value === expected[i] ? 0 : 1), 0);
      assert.equal(differing, 0, `${name}: ${differing} of ${found.length} numbers differ`);
    }
  } finally {
    rmSync(place, { recursive: true });
  }
});
