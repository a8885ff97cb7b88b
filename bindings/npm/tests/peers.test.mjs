// Geometries of three.js and documents of glTF-Transform. Run as beltrami.test.mjs is, where the package was installed
// beside these two.
import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';

const folder = process.env.BELTRAMI_NPM ?? join(import.meta.dirname, '../../../build/dist/npm/node_modules/beltrami');
const beside = (...path) => pathToFileURL(join(folder, ...path)).href;
const skip = existsSync(join(folder, '../three')) ? false : 'three and @gltf-transform/core are not beside the package';
const { load } = skip ? {} : await import(beside('index.mjs'));
const beltrami = skip ? null : await load();
const THREE = skip ? null : await import(beside('../three/build/three.module.js'));
const { surfaceOf, unwrapGeometry, withUvs } = skip ? {} : await import(beside('three.mjs'));
const { Document } = skip ? {} : await import(beside('../@gltf-transform/core/dist/index.js'));
const { unwrap } = skip ? {} : await import(beside('gltf-transform.mjs'));

/** Positions and UVs of the corners of triangles, as they are drawn. */
function drawn(geometry, name) {
  const attribute = geometry.attributes[name], index = geometry.index?.array ?? Array.from({ length: attribute.count }, (_, i) => i);
  return Array.from(index, (v) => Array.from({ length: attribute.itemSize }, (_, k) => attribute.getComponent(v, k)));
}

test('a geometry keeps what it is, and gets UVs', { skip }, () => {
  const box = new THREE.BoxGeometry(1, 2, 3, 2, 2, 2);
  box.morphAttributes.position = [new THREE.BufferAttribute(Float32Array.from(box.attributes.position.array, (x) => 2 * x), 3)];
  const { geometry, atlas } = unwrapGeometry(beltrami, box, { attribute: 'uv1' });
  assert.equal(atlas.certificate.injective, true);
  for (const name of ['position', 'normal', 'uv']) assert.deepEqual(drawn(geometry, name), drawn(box, name), name);
  assert.deepEqual(geometry.groups, box.groups);
  assert.equal(geometry.morphAttributes.position[0].count, geometry.attributes.position.count);
  const { cornerUvs } = beltrami.unwrap(surfaceOf(box), { float32: true, maxPages: 1 });
  assert.deepEqual(drawn(geometry, 'uv1').flat(), Array.from(cornerUvs));
});

test('interleaved and without an index', { skip }, () => {
  const plain = new THREE.IcosahedronGeometry(1, 2), { position, normal } = plain.attributes;
  const data = new THREE.InterleavedBuffer(new Float32Array(6 * position.count), 6);
  for (let i = 0; i < position.count; ++i) data.array.set([...position.array.subarray(3 * i, 3 * i + 3), ...normal.array.subarray(3 * i, 3 * i + 3)], 6 * i);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.InterleavedBufferAttribute(data, 3, 0));
  geometry.setAttribute('normal', new THREE.InterleavedBufferAttribute(data, 3, 3));
  geometry.setAttribute('tangent', new THREE.BufferAttribute(new Float32Array(4 * position.count), 4));
  const made = withUvs(geometry, beltrami.unwrap(surfaceOf(geometry)));
  assert.deepEqual(drawn(made, 'normal'), drawn(plain, 'normal'));
  assert.equal(made.attributes.tangent, undefined);
  assert.ok(made.attributes.uv.array.every((x) => x >= 0 && x <= 1));
});

/** Two meshes of one tetrahedron each, the second of two primitives and twice as large. */
function scene() {
  const document = new Document(), buffer = document.createBuffer();
  const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
  const place = accessor('VEC3', new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]));
  const primitive = (...indices) => document.createPrimitive().setAttribute('POSITION', place).setIndices(accessor('SCALAR', new Uint16Array(indices)));
  const small = document.createMesh().addPrimitive(primitive(0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2));
  const large = document.createMesh().addPrimitive(primitive(0, 2, 1, 0, 1, 3)).addPrimitive(primitive(1, 2, 3, 0, 3, 2));
  document.createScene().addChild(document.createNode().setMesh(small)).addChild(document.createNode().setMesh(large).setScale([2, 2, 2]));
  return { document, small, large };
}

const corners = (primitive, name) => Array.from(primitive.getIndices().getArray(), (v) => primitive.getAttribute(name).getElement(v, []));
function areaOf(primitive) {
  const uvs = corners(primitive, 'TEXCOORD_1');
  let area = 0;
  for (let c = 0; c < uvs.length; c += 3) {
    const [a, b, d] = uvs.slice(c, c + 3);
    area += Math.abs((b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0])) / 2;
  }
  return area;
}

for (const groupBy of ['primitive', 'mesh', 'scene']) {
  test(`a document gets UVs by ${groupBy}`, { skip }, async () => {
    const { document, small, large } = scene(), all = [...small.listPrimitives(), ...large.listPrimitives()];
    const before = all.map((primitive) => corners(primitive, 'POSITION'));
    await document.transform(unwrap({ beltrami, texcoord: 1, groupBy }));
    all.forEach((primitive, i) => assert.deepEqual(corners(primitive, 'POSITION'), before[i]));
    assert.ok(all.every((primitive) => corners(primitive, 'TEXCOORD_1').flat().every((x) => x >= 0 && x <= 1)));
    const used = document.getRoot().listAccessors().filter((accessor) => accessor.listParents().length < 2);
    assert.deepEqual(used, []); // nothing is left over
    if (groupBy !== 'scene') return;
    const ratio = (areaOf(all[1]) + areaOf(all[2])) / areaOf(all[0]);
    assert.ok(ratio > 3.5 && ratio < 4.5, String(ratio));
  });
}

test('what is there stays unless it is to be overwritten', { skip }, async () => {
  const { document, small } = scene(), [primitive] = small.listPrimitives();
  await document.transform(unwrap({ beltrami }));
  const first = primitive.getAttribute('TEXCOORD_0');
  await document.transform(unwrap({ beltrami }));
  assert.equal(primitive.getAttribute('TEXCOORD_0'), first);
  await document.transform(unwrap({ beltrami, overwrite: true }));
  assert.notEqual(primitive.getAttribute('TEXCOORD_0'), first);
  assert.throws(() => unwrap({}), /load\(\)/);
  assert.throws(() => unwrap({ beltrami, groupBy: 'all' }), /primitive, mesh or scene/);
});
