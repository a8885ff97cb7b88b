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

test('isolated it takes all processors, for the same numbers', { skip }, async () => {
  const isolated = await serve(process.env.SITE, { isolated: true }), found = [];
  try {
    for (const { address } of [server, isolated]) {
      const { page, faults } = await open(browser, address);
      await page.click('text=Try an example');
      await shown(page, 1);
      const threads = await page.evaluate(() => [document.getElementById('viewer').dataset.threads, navigator.hardwareConcurrency].map(Number));
      const { bytes } = await downloaded(page, 'OBJ');
      found.push({ threads, text: bytes.toString() });
      assert.deepEqual(faults, []);
    }
  } finally {
    isolated.end();
  }
  assert.equal(found[0].threads[0], 1);
  assert.equal(found[1].threads[0], found[1].threads[1]);
  assert.equal(found[0].text, found[1].text);
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

/** The middle of an edge on the layout, in pixels of the page: of the first of which the sides are apart, or are not. */
const middleOf = (page, isCut) => page.evaluate(async (wanted) => {
  const { projected } = await import('./viewer/cameras.mjs'), { seams, viewer, atlas } = document.getElementById('viewer').page;
  const { edges } = seams, { uvs, faces } = viewer.geometry, box = viewer.panes[1].box.getBoundingClientRect();
  for (let t = 0; t < faces.length / 3; ++t) {
    for (const [k, corner] of edges.sidesOf(t).entries()) {
      if (corner === null || edges.isBorder(edges.numberOf(corner)) || edges.isCut(edges.numberOf(corner), atlas.cornerUvs) !== wanted) continue;
      const [a, b] = [faces[3 * t + k], faces[3 * t + (k + 1) % 3]], at = projected(viewer.views[1].matrix, [0, 1].map((d) => (uvs[2 * a + d] + uvs[2 * b + d]) / 2));
      const c = faces[3 * t + (k + 2) % 3], inside = projected(viewer.views[1].matrix, [uvs[2 * c], uvs[2 * c + 1]]);
      const [x, y] = [0, 1].map((d) => 0.97 * at[d] + 0.03 * inside[d]); // of this triangle, not of the next
      return [box.left + (x + 1) / 2 * box.width, box.top + (1 - y) / 2 * box.height];
    }
  }
  return null;
}, isCut);

test('seams open and close by clicks, by keys, and are taken back', { skip }, async () => {
  const { page, faults } = await open(browser, server.address), state = () => page.evaluate(() => {
    const { report, atlas } = document.getElementById('viewer').page;
    return { charts: report.charts, proven: report.injective.result, seams: report.seam_over_root_area, uvs: Array.from(atlas.cornerUvs) };
  });
  await drop(page, 'cube.obj', cube);
  await shown(page, 1);
  const unwrapped = await state();
  await page.click('text=Edit seams');
  await shown(page, 2);
  const first = await state();
  assert.deepEqual(first.uvs, unwrapped.uvs);
  assert.ok(Math.abs(first.seams - unwrapped.seams) < 1e-6, `${first.seams} ${unwrapped.seams}`);
  await page.mouse.move(...await middleOf(page, false));
  assert.equal(await page.locator('.page-edge:visible').count(), 2);
  await keep(page, 'page-seams');
  await page.mouse.click(...await middleOf(page, false));
  await shown(page, 3);
  const opened = await state();
  assert.equal(opened.charts, first.charts + 1);
  assert.ok(opened.proven && opened.seams > first.seams);
  assert.notDeepEqual(opened.uvs, first.uvs); // the parts lie apart, though neither changes its shape
  await page.keyboard.press('Control+z');
  await shown(page, 4);
  assert.deepEqual((await state()).uvs, first.uvs);
  assert.ok(await page.isDisabled('text=Undo'));
  await page.mouse.click(...await middleOf(page, true)); // a seam of the atlas closes: what is no disk then is opened elsewhere
  await shown(page, 5);
  assert.ok((await state()).proven);
  const { bytes } = await downloaded(page, 'OBJ');
  assert.equal(bytes.toString().split('\n').filter((line) => line.startsWith('f ')).length, 6);
  const [x, y] = await middleOf(page, false); // Enter is a click in the middle of a panel
  await page.evaluate(([left, top]) => {
    const { viewer } = document.getElementById('viewer').page, pane = viewer.panes[1];
    const place = viewer.place(pane, { clientX: left, clientY: top });
    pane.camera.move(-place[0], -place[1]);
    viewer.renderer.moved();
    viewer.redraw();
  }, [x, y]);
  const before = await state();
  await page.waitForTimeout(100);
  await page.locator('.bv-pane').nth(1).focus();
  await page.keyboard.press('Enter');
  await shown(page, 6);
  assert.notDeepEqual((await state()).uvs, before.uvs);
  await page.click('text=Edit seams');
  assert.equal(await page.getAttribute('text=Edit seams', 'aria-pressed'), 'false');
  await page.locator('input[type=range]').fill('0.5'); // and the search goes on as before
  await shown(page, 7);
  assert.deepEqual(faults, []);
});

test('paths are the shortest ones', { skip }, async () => {
  const { page } = await open(browser, server.address);
  const path = await page.evaluate(async () => {
    const { Edges } = await import('./edges.mjs'), positions = [], indices = [];
    for (let i = 0; i <= 4; ++i) for (let j = 0; j <= 4; ++j) positions.push(i, j, 0);
    for (let i = 0; i < 4; ++i) for (let j = 0; j < 4; ++j) indices.push(5 * i + j, 5 * i + j + 5, 5 * i + j + 6, 5 * i + j + 1);
    const mesh = { positions: new Float64Array(positions), indices: new Uint32Array(indices), faceSizes: new Uint32Array(16).fill(4) };
    const edges = new Edges(mesh, new Uint32Array()), number = (a, b) => Math.min(a, b) * 2 ** 26 + Math.max(a, b);
    return Array.from(edges.pairsOf(edges.path(number(5, 6), number(8, 9)))).sort((a, b) => a - b);
  });
  assert.deepEqual(path, [5, 6, 6, 7, 7, 8, 8, 9]);
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
