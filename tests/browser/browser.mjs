// Chromium for the tests, and a server of one folder. PLAYWRIGHT is the folder of playwright-core, CHROMIUM the browser.
import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { extname, join, normalize } from 'node:path';

const KINDS = { '.html': 'text/html', '.mjs': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.obj': 'text/plain' };

export const chromium = process.env.CHROMIUM ?? '/usr/bin/chromium';
/** Why the tests cannot run, or false. */
export const missing = !process.env.PLAYWRIGHT ? 'PLAYWRIGHT is not set' : !existsSync(chromium) && `there is no ${chromium}`;

/** Pictures are drawn by the processor, so that they need no graphics card. */
export function launch() {
  const { chromium: driver } = createRequire(import.meta.url)(process.env.PLAYWRIGHT);
  return driver.launch({ executablePath: chromium, args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
}

/** Where the folder is served: pages are to work below any. */
const BELOW = '/some/where/';

/** What a page has to be sent for its workers to share memory. */
const ISOLATING = { 'cross-origin-opener-policy': 'same-origin', 'cross-origin-embedder-policy': 'require-corp' };

/** Serves a folder on a free port of this machine; returns its address, and how to end it. */
export async function serve(folder, { isolated = false } = {}) {
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
    const inside = path.startsWith(BELOW) ? path.slice(BELOW.length) : 'none', file = join(folder, inside === '' || inside.endsWith('/') ? `${inside}index.html` : inside);
    if (!existsSync(file) || !statSync(file).isFile()) {
      response.writeHead(404).end();
      return;
    }
    const kind = { 'content-type': KINDS[extname(file)] ?? 'application/octet-stream' };
    response.writeHead(200, isolated ? { ...kind, ...ISOLATING } : kind);
    createReadStream(file).pipe(response);
  });
  await new Promise((ready) => server.listen(0, '127.0.0.1', ready));
  return { address: `http://127.0.0.1:${server.address().port}${BELOW}`, end: () => server.close() };
}

/** A page that fails the test for anything that goes wrong in it. */
export async function open(browser, address, { scheme = 'light', width = 1280, height = 760, touch = false } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, hasTouch: touch, acceptDownloads: true });
  const page = await context.newPage(), faults = [];
  page.on('pageerror', (error) => faults.push(error.message));
  page.on('console', (message) => { if (message.type() === 'error') faults.push(message.text()); });
  page.on('request', (request) => { if (!/^(file|data|blob):|^http:\/\/127\.0\.0\.1/.test(request.url())) faults.push(`asked for ${request.url()}`); });
  await page.goto(address);
  return { page, faults };
}

/** Has the screenshot kept where SCREENSHOTS names a folder, to be looked at. */
export async function keep(page, name) {
  const shot = await page.screenshot();
  if (process.env.SCREENSHOTS) (await import('node:fs')).writeFileSync(join(process.env.SCREENSHOTS, `${name}.png`), shot);
  return shot;
}
