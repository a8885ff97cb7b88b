// Threads of the module: workers that share its memory. As beltrami.test.mjs.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { readObj } from './obj.mjs';

const folder = process.env.BELTRAMI_NPM ?? join(import.meta.dirname, '../../../build/dist/stage/wasm32');
const data = join(import.meta.dirname, '../../../examples/data');
const { load, BeltramiError } = await import(pathToFileURL(join(folder, 'index.mjs')).href);
const read = (name) => readObj(readFileSync(join(data, name), 'utf8'));
const one = await load(), several = [await load(undefined, { threads: 2 }), await load(undefined, { threads: 5 })];

after(() => several.forEach((beltrami) => beltrami.close()));

test('says how many there are', async () => {
  assert.equal(one.threads, 1);
  assert.deepEqual(several.map(({ threads }) => threads), [2, 5]);
  const all = await load(undefined, { threads: 0 });
  assert.ok(all.threads >= 1);
  all.close();
  assert.equal(all.threads, 1);
  assert.equal(all.unwrap(read('spot.obj'), { effort: 'quick' }).status, 'BELTRAMI_OK');
});

test('refuses what cannot have them', async () => {
  const bytes = readFileSync(join(folder, 'beltrami.wasm'));
  await assert.rejects(load(await WebAssembly.compile(bytes), { threads: 2 }), /address or the bytes/);
  await assert.rejects(load(undefined, { threads: 1.5 }), BeltramiError);
  await assert.rejects(load(undefined, { threads: -1 }), /whole number/);
  await assert.rejects(load(new Uint8Array(64), { threads: 2 }), /not beltrami.wasm/);
  const beltrami = await load(bytes, { threads: 2 });
  assert.equal(beltrami.threads, 2);
  beltrami.close();
});

test('gives the same bits', () => {
  const { cornerUvs: _, ...spot } = read('spot.obj'), disk = read('nefertiti_disk.obj');
  const atlas = one.unwrap(spot, { effort: 'quick' }), map = one.flatten(disk);
  for (const beltrami of several) {
    assert.deepEqual(beltrami.unwrap(spot, { effort: 'quick' }).cornerUvs, atlas.cornerUvs);
    assert.deepEqual(beltrami.flatten(disk).uvs, map.uvs);
  }
});

test('an editor goes on when the threads have ended', async () => {
  const { cornerUvs: _, ...spot } = read('spot.obj'), beltrami = await load(undefined, { threads: 3 });
  const editor = beltrami.edit({ ...spot, cornerUvs: one.unwrap(spot, { effort: 'quick' }).cornerUvs });
  beltrami.close();
  editor.update();
  assert.equal(editor.check().injective, true);
  editor.close();
});

test('edits, cancels and fails as one does', () => {
  const { cornerUvs: _, ...spot } = read('spot.obj');
  for (const beltrami of several) {
    let calls = 0;
    assert.throws(() => beltrami.unwrap(spot, { progress: () => ++calls > 3 }), (error) => error.status === 'BELTRAMI_E_CANCELLED');
    assert.throws(() => beltrami.unwrap({ ...spot, indices: new Uint32Array([0, 1, 99999]) }), BeltramiError);
    const editor = beltrami.edit({ ...spot, cornerUvs: one.unwrap(spot, { effort: 'quick' }).cornerUvs });
    editor.update();
    assert.equal(editor.check().injective, true);
    assert.throws(() => beltrami.unwrap(spot, { progress: () => { beltrami.close(); } }), /under way/);
    editor.close();
  }
});
