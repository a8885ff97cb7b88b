// The page that `beltrami unwrap --html` writes, in a browser. PROGRAM is the program.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { keep, launch, missing, open } from './browser.mjs';

const skip = missing || (process.env.PROGRAM ? false : 'PROGRAM is not set');
const spot = join(import.meta.dirname, '../../examples/data/spot.obj');
let browser, folder, address;

before(async () => {
  if (skip) return;
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), 'beltrami-'));
  const report = join(folder, 'report.html');
  const done = spawnSync(process.env.PROGRAM, ['unwrap', spot, join(folder, 'out.obj'), '--effort', 'quick', '-q', '--html', report], { encoding: 'utf8' });
  assert.equal(done.status, 0, done.stderr);
  address = pathToFileURL(report).href;
});
after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true });
});

const drawn = (page) => page.waitForFunction(() => Number(document.querySelector('.bv').dataset.drawn ?? 0) > 1 && document.querySelector('.bv-figures').children.length > 0);

/** How many pixels of a panel differ once something was done. */
async function differing(page, act, pane) {
  const box = await page.locator('.bv-pane').nth(pane).boundingBox();
  const clip = { x: box.x + 20, y: box.y + 30, width: box.width - 40, height: box.height - 60 };
  const look = async () => {
    await page.evaluate(() => new Promise((done) => { requestAnimationFrame(() => requestAnimationFrame(done)); }));
    return page.evaluate(async (text) => { // the pixels stay in the page
      const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${text}`)).blob());
      const pen = new OffscreenCanvas(image.width, image.height).getContext('2d');
      pen.drawImage(image, 0, 0);
      const now = pen.getImageData(0, 0, image.width, image.height).data, before = window.pixelsBefore;
      window.pixelsBefore = now;
      let count = 0;
      for (let i = 0; before?.length === now.length && i < now.length; i += 4) {
        count += [0, 1, 2].some((k) => Math.abs(before[i + k] - now[i + k]) > 8);
      }
      return count;
    }, (await page.screenshot({ clip })).toString('base64'));
  };
  await look();
  await act();
  return look();
}

test('it asks for nothing, and shows figures and both views', { skip }, async () => {
  const { page, faults } = await open(browser, address);
  await drawn(page);
  await keep(page, 'report-light');
  assert.match(await page.title(), /spot\.obj/);
  assert.match(await page.textContent('.bv-badge'), /proven/);
  assert.match(await page.textContent('.bv-figures'), /Triangles23,062/);
  assert.ok(await differing(page, () => page.keyboard.press('2'), 0) > 5000, 'the heat map on the model');
  assert.ok(await differing(page, () => page.keyboard.press('3'), 1) > 5000, 'the charts in the layout');
  assert.deepEqual(faults, []);
});

test('what is pointed at lights up in the other view', { skip }, async () => {
  const { page, faults } = await open(browser, address);
  await drawn(page);
  const layout = await page.locator('.bv-pane').nth(1).boundingBox(), model = await page.locator('.bv-pane').nth(0).boundingBox();
  const middle = (box, x, y) => page.mouse.move(box.x + x * box.width, box.y + y * box.height);
  assert.ok(await differing(page, () => middle(layout, 0.42, 0.7), 0) > 2000);
  assert.match(await page.textContent('.bv-about'), /^Chart \d+ · .* here /);
  assert.equal(await page.locator('.bv-pane').nth(0).locator('.bv-dot').isVisible(), true);
  assert.ok(await differing(page, () => middle(model, 0.5, 0.55), 1) > 0 || (await page.textContent('.bv-about')).startsWith('Chart'));
  await middle(model, 0.02, 0.98);
  assert.match(await page.textContent('.bv-about'), /^Point at a chart/);
  assert.deepEqual(faults, []);
});

test('all goes by the keyboard', { skip }, async () => {
  const { page, faults } = await open(browser, address, { scheme: 'dark' });
  await drawn(page);
  await page.keyboard.press('n');
  const first = await page.textContent('.bv-about');
  await page.keyboard.press('n');
  assert.notEqual(await page.textContent('.bv-about'), first);
  await page.keyboard.press('p');
  assert.equal(await page.textContent('.bv-about'), first);
  await page.keyboard.press('2');
  await keep(page, 'report-dark');
  assert.ok(await differing(page, () => page.keyboard.press('f'), 1) > 1000);
  await page.keyboard.press('0');
  await page.keyboard.press('Escape');
  assert.match(await page.textContent('.bv-about'), /^Point at/);
  const reached = new Set(); // every control by the tabulator
  for (let i = 0; i < 12; ++i) {
    await page.keyboard.press('Tab');
    reached.add(await page.evaluate(() => document.activeElement.getAttribute('aria-label') ?? document.activeElement.value ?? document.activeElement.textContent));
  }
  for (const name of ['Edges', 'Borders', 'Light or dark', 'Keys']) assert.ok([...reached].some((found) => found?.includes(name)), name);
  await page.locator('.bv-pane').nth(0).focus();
  assert.ok(await differing(page, () => page.keyboard.press('ArrowLeft'), 0) > 1000);
  await page.keyboard.press('?');
  assert.equal(await page.isVisible('dialog'), true);
  assert.deepEqual(faults, []);
});

test('it fits a phone, and goes by touch', { skip }, async () => {
  const { page, faults } = await open(browser, address, { width: 390, height: 844, touch: true });
  await drawn(page);
  await keep(page, 'report-phone');
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'wider than a phone');
  const box = await page.locator('.bv-pane').nth(0).boundingBox();
  await page.touchscreen.tap(box.x + 0.5 * box.width, box.y + 0.55 * box.height);
  assert.match(await page.textContent('.bv-about'), /^Chart/);
  assert.deepEqual(faults, []);
});

test('a picture of the user is the texture', { skip }, async () => {
  const { page, faults } = await open(browser, address);
  await drawn(page);
  const red = Buffer.from('iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg==', 'base64');
  assert.ok(await differing(page, () => page.setInputFiles('input[accept="image/*"]', { name: 'red.png', mimeType: 'image/png', buffer: red }), 1) > 5000);
  assert.equal(await page.isChecked('input[value=texture]'), true);
  await page.setInputFiles('input[accept="image/*"]', { name: 'no.png', mimeType: 'image/png', buffer: Buffer.from('no') });
  await page.waitForFunction(() => /no picture/.test(document.querySelector('.bv-about').textContent));
  assert.deepEqual(faults, []);
});

test('without WebGL the figures are there, and a sentence', { skip }, async () => {
  const context = await browser.newContext();
  await context.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; });
  const page = await context.newPage();
  await page.goto(address);
  await page.waitForSelector('.bv-fault');
  assert.match(await page.textContent('.bv-fault'), /needs WebGL 2/);
  await page.waitForFunction(() => document.querySelector('.bv-figures').children.length > 0);
});
