// What README.md and docs/start.md show is run, as modules beside the installed package.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

const folder = process.env.BELTRAMI_NPM ?? join(import.meta.dirname, '../../../build/dist/npm/node_modules/beltrami');
const skip = existsSync(join(folder, '../three')) ? false : 'three and @gltf-transform/core are not beside the package';
/** What a snippet has from those before it: the library, a sheet of squares, and its atlas. */
const before = `import { load as loaded } from 'beltrami';
const beltrami = await loaded(), positions = [], indices = [];
for (let i = 0; i < 25; ++i) positions.push(i % 5, Math.floor(i / 5), 0);
for (let i = 0; i < 20; ++i) if (i % 5 < 4) indices.push(i, i + 1, i + 6, i, i + 6, i + 5);
const surface = { positions: new Float32Array(positions), indices: new Uint32Array(indices) };
const atlas = beltrami.unwrap(surface);
globalThis.postMessage = () => {};
`;
const more = [[/BoxGeometry/, "import { BoxGeometry } from 'three';\n"], [/document\./, "import { Document } from '@gltf-transform/core';\nconst document = new Document();\n"]];

const snippetsOf = (page) => [...readFileSync(page, 'utf8').matchAll(/^```js\n([^]*?)^```/gm)].map(([, code]) => code);

test('the snippets of README.md and of the quick starts run', { skip }, () => {
  const starts = snippetsOf(join(import.meta.dirname, '../../../docs/start.md'));
  const snippets = [...starts, ...snippetsOf(join(folder, 'README.md'))];
  assert.ok(starts.length === 1 && snippets.length >= 6);
  const place = mkdtempSync(join(folder, '../../snippets-'));
  try {
    snippets.forEach((code, i) => {
      const names = more.filter(([word]) => word.test(code)).map(([, lines]) => lines).join('');
      // Some are whole; names that others make themselves are in a block of their own.
      const [imports, rest] = [code.match(/^import .*$/gm)?.join('\n') ?? '', code.replace(/^import .*$/gm, '')];
      const file = join(place, `${i}.mjs`);
      writeFileSync(file, code.includes('await load()') ? code : `${names}${imports}\n${before}{\n${rest}}\n`);
      const { status, stderr } = spawnSync(process.execPath, [file], { encoding: 'utf8' });
      assert.equal(status, 0, `${code}\n${stderr}`);
    });
  } finally {
    rmSync(place, { recursive: true });
  }
});
