// The page that unwraps in the browser. SITE is its folder, as ./dev dist wasm32 makes it.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { keep, launch, missing, open, serve } from './browser.mjs';

const skip = missing || (process.env.SITE ? false : 'SITE is not set');
const spot = join(import.meta.dirname, '../../examples/data/spot.obj');
let browser, server;

before(async () => {
  if (skip) return;
  browser = await launch();
  server = await serve(process.env.SITE);
});
after(async () => {
  await browser?.close();
  server?.end();
});

/** Waits until so many atlases have been shown. */
const shown = (page, count) => page.waitForFunction((n) => Number(document.getElementById('viewer').dataset.shown ?? 0) >= n, count, { timeout: 300000 });
const drop = (page, name, bytes) => page.setInputFiles('input[accept^=".obj"]', { name, mimeType: 'application/octet-stream', buffer: Buffer.from(bytes) });

async function downloaded(page, kind) {
  const [download] = await Promise.all([page.waitForEvent('download'), page.click(`button[aria-label="Download ${kind}"]`)]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

const cube = `mtllib a.mtl
v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1
vt 0 0
usemtl red
f 1/1 3/1 4/1 2/1\nf 5 6 8 7\nf 1 2 6 5
usemtl blue
f 3 7 8 4\nf 1 5 7 3\nf -7 -5 -1 -3
`;

test('an example is unwrapped, seen, and changes with the slider', { skip }, async () => {
  const { page, faults } = await open(browser, server.address);
  await keep(page, 'page-empty');
  await page.click('text=Try an example');
  await shown(page, 1);
  await keep(page, 'page-example');
  assert.match(await page.textContent('.bv-badge'), /proven/);
  const energy = () => page.evaluate(() => document.getElementById('viewer').page.report.energy.symmetric_dirichlet);
  const before = await energy();
  assert.ok(before < 2.06, String(before)); // what the slider says at first
  await page.locator('input[type=range]').fill('0');
  await shown(page, 2);
  assert.equal(await page.textContent('.page-bar output'), '2.010');
  assert.ok(await energy() < before, `${await energy()} < ${before}`);
  assert.deepEqual(faults, []);
});

test('OBJ keeps its lines, and comes back with UVs', { skip }, async () => {
  const { page, faults } = await open(browser, server.address);
  await drop(page, 'cube.obj', cube);
  await shown(page, 1);
  const { name, bytes } = await downloaded(page, 'OBJ'), lines = bytes.toString().split('\n');
  assert.equal(name, 'cube_uv.obj');
  for (const line of ['mtllib a.mtl', 'usemtl red', 'usemtl blue']) assert.ok(lines.includes(line), line);
  assert.equal(lines.filter((line) => line.startsWith('v ')).length, 8);
  const uvs = lines.filter((line) => line.startsWith('vt ')).map((line) => line.split(' ').slice(1).map(Number));
  assert.ok(uvs.length >= 14 && uvs.flat().every((x) => x >= 0 && x <= 1));
  const faces = lines.filter((line) => line.startsWith('f '));
  assert.equal(faces.length, 6);
  assert.ok(faces.every((line) => line.split(' ').slice(1).every((corner) => /^-?\d+\/\d+$/.test(corner) && Number(corner.split('/')[1]) <= uvs.length)));
  assert.deepEqual(faults, []);
});

test('GLB goes in and out', { skip }, async () => {
  const { page, faults } = await open(browser, server.address);
  await drop(page, 'cube.obj', cube);
  await shown(page, 1);
  const first = await downloaded(page, 'GLB');
  const json = (bytes) => JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)).toString());
  assert.equal(first.bytes.readUInt32LE(8), first.bytes.length);
  const made = json(first.bytes).meshes[0].primitives[0];
  assert.equal(json(first.bytes).accessors[made.indices].count, 36);
  await drop(page, 'cube.glb', first.bytes);
  await shown(page, 2);
  const again = json((await downloaded(page, 'GLB')).bytes), primitive = again.meshes[0].primitives[0];
  assert.equal(again.accessors[primitive.indices].count, 36);
  assert.equal(again.accessors[primitive.attributes.TEXCOORD_0].count, again.accessors[primitive.attributes.POSITION].count);
  assert.deepEqual(faults, []);
});

test('STL and PLY are read', { skip }, async () => {
  const { page, faults } = await open(browser, server.address);
  const stl = Buffer.alloc(84 + 50 * 4), corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
  stl.writeUInt32LE(4, 80);
  [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]].forEach((face, f) => face.forEach((v, c) => corners[v].forEach((x, k) => stl.writeFloatLE(x, 84 + 50 * f + 12 * (c + 1) + 4 * k))));
  await drop(page, 'a.stl', stl);
  await shown(page, 1);
  assert.equal(await page.evaluate(() => document.getElementById('viewer').page.mesh.positions.length), 12);
  const header = 'ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n';
  const body = Buffer.alloc(4 * 13 + 17);
  [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]].forEach((p, v) => p.forEach((x, k) => body.writeFloatLE(x, 13 * v + 4 * k)));
  body.writeUInt8(4, 52);
  [0, 1, 2, 3].forEach((v, k) => body.writeInt32LE(v, 53 + 4 * k));
  await drop(page, 'b.PLY', Buffer.concat([Buffer.from(header), body]));
  await shown(page, 2);
  assert.equal(await page.evaluate(() => document.getElementById('viewer').page.report.input.triangles), 2);
  assert.deepEqual(faults, []);
});

test('a run is cancelled, and the next one goes', { skip }, async () => {
  const { page, faults } = await open(browser, server.address);
  await drop(page, 'spot.obj', readFileSync(spot));
  await page.waitForFunction(() => document.querySelector('.page-run progress').value > 0, null, { timeout: 120000 });
  await page.click('.page-run button');
  assert.equal(await page.isVisible('.page-run'), false);
  await page.click('text=Try an example');
  await shown(page, 1);
  assert.equal(await page.textContent('.bv-title'), 'knot');
  assert.deepEqual(faults, []);
});

test('bad files get a sentence', { skip }, async () => {
  const { page } = await open(browser, server.address);
  for (const [name, bytes, words] of [
    ['a.fbx', 'x', /reads \.obj, \.stl, \.ply and \.glb/], ['a.obj', '# nothing', /no faces/], ['a.obj', 'v 0 0 0\nf 1 2 3', /names a vertex that is not there/],
    ['a.ply', 'ply\n', /header/], ['a.glb', 'glTF', /no GLB file of version 2/], ['a.obj', 'v 0 0 x\nv 1 0 0\nv 0 1 0\nf 1 2 3', /vertex 0 .*finite/],
  ]) {
    await drop(page, name, bytes);
    await page.waitForFunction((text) => new RegExp(text).test(document.querySelector('.page-fault').textContent), words.source);
    assert.match(await page.textContent('.page-fault'), words);
  }
});

test('the report that is downloaded shows the same', { skip }, async () => {
  const { page } = await open(browser, server.address, { scheme: 'dark', width: 390, height: 844 });
  await keep(page, 'page-phone-empty');
  await page.click('text=Try an example');
  await shown(page, 1);
  await keep(page, 'page-phone');
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'wider than a phone');
  const { bytes } = await downloaded(page, 'Report');
  const second = await page.context().newPage();
  await second.setContent(bytes.toString());
  await second.waitForFunction(() => Number(document.querySelector('.bv').dataset.drawn) > 0);
  assert.equal(await second.textContent('.bv-figures'), await page.textContent('.bv-figures'));
});
