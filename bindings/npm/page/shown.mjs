// From a mesh and its atlas to what the viewer shows, and to the keys of a report.
import { facesOfCorners } from './corners.mjs';

/** The symmetric Dirichlet energy of a triangle, whose UVs are in units of length; infinite where it is flipped. */
function energyOf(positions, a, b, c, uvs, corners, unit) {
  const e = [0, 0, 0], f = [0, 0, 0];
  for (let k = 0; k < 3; ++k) {
    e[k] = positions[3 * b + k] - positions[3 * a + k];
    f[k] = positions[3 * c + k] - positions[3 * a + k];
  }
  const ee = e[0] * e[0] + e[1] * e[1] + e[2] * e[2], ef = e[0] * f[0] + e[1] * f[1] + e[2] * f[2], ff = f[0] * f[0] + f[1] * f[1] + f[2] * f[2];
  const square = ee * ff - ef * ef; // of twice the area
  const along = (corner, k) => unit * (uvs[2 * corner + k] - uvs[2 * corners[0] + k]);
  const p = [along(corners[1], 0), along(corners[1], 1)], q = [along(corners[2], 0), along(corners[2], 1)];
  const twice = p[0] * q[1] - p[1] * q[0];
  if (!(twice > 0) || !(square > 0)) return Infinity;
  const pp = p[0] * p[0] + p[1] * p[1], pq = p[0] * q[0] + p[1] * q[1], qq = q[0] * q[0] + q[1] * q[1];
  const grown = (pp * ff - 2 * pq * ef + qq * ee) / square; // the sum of squared singular values
  return 0.5 * grown * (1 + square / (twice * twice));
}

/** Arrays for the viewer's Geometry. */
export function arraysOf(mesh, atlas) {
  const { triangles, cornerUvs, cornerUvVertices, cornerPages, faceCharts } = atlas, count = triangles.length / 3;
  const unit = atlas.packing ? atlas.packing.resolution / atlas.packing.texelsPerUnit : 1;
  const arrays = { energies: new Float32Array(count), charts: new Uint32Array(count), faces: new Uint32Array(3 * count) };
  const faces = facesOfCorners(mesh);
  const uvVertices = atlas.uvVertices.length / 2, uvs = new Float32Array(2 * uvVertices), places = new Float64Array(3 * uvVertices);
  for (let t = 0; t < count; ++t) {
    const corners = triangles.subarray(3 * t, 3 * t + 3);
    arrays.charts[t] = faceCharts[faces[corners[0]]];
    arrays.energies[t] = energyOf(mesh.positions, ...Array.from(corners, (c) => mesh.indices[c]), cornerUvs, corners, unit);
    corners.forEach((corner, k) => {
      const v = cornerUvVertices[corner], page = cornerPages[corner];
      arrays.faces[3 * t + k] = v;
      uvs[2 * v] = cornerUvs[2 * corner] + page % 10;
      uvs[2 * v + 1] = cornerUvs[2 * corner + 1] + Math.floor(page / 10);
      for (let d = 0; d < 3; ++d) places[3 * v + d] = mesh.positions[3 * mesh.indices[corner] + d];
    });
  }
  // Far from the origin single precision has few digits.
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const v of arrays.faces) {
    for (let d = 0; d < 3; ++d) {
      low[d] = Math.min(low[d], places[3 * v + d]);
      high[d] = Math.max(high[d], places[3 * v + d]);
    }
  }
  arrays.positions = Float32Array.from(places, (value, i) => value - (low[i % 3] + high[i % 3]) / 2);
  arrays.uvs = uvs;
  return arrays;
}

/** Of an edited atlas the energy of which so much of the area is below, weighed by areas on the surface. */
function percentile(energies, areas, share) {
  const order = Array.from(energies.keys()).sort((a, b) => energies[a] - energies[b]), all = areas.reduce((sum, area) => sum + area, 0);
  let sum = 0;
  for (const i of order) if ((sum += areas[i]) >= share * all) return energies[i];
  return energies[order.at(-1)];
}

/**
 * What a session of edits has made of an atlas, as `unwrap` would say it: pages are parted, corners of one vertex at one
 * place share a UV vertex. `vertices`: of each corner, those at one place being one.
 */
export function editedAtlas(atlas, { cornerUvs, faceCharts, charts, report, certificate }, mesh, vertices, seamLength) {
  const count = vertices.length, known = new Map(), uvs = [], cornerUvVertices = new Uint32Array(count), cornerPages = new Uint32Array(count);
  const own = new cornerUvs.constructor(cornerUvs), chartOf = facesOfCorners(mesh).map((face) => faceCharts[face]);
  const leasts = new Map(); // u and v of a chart
  chartOf.forEach((chart, corner) => {
    const least = leasts.get(chart) ?? [Infinity, Infinity];
    leasts.set(chart, least.map((value, k) => Math.min(value, cornerUvs[2 * corner + k])));
  });
  for (let corner = 0; corner < count; ++corner) {
    const [column, row] = leasts.get(chartOf[corner]).map((least) => Math.max(Math.floor(least), 0));
    cornerPages[corner] = column + 10 * row;
    own[2 * corner] -= column;
    own[2 * corner + 1] -= row;
    const key = `${vertices[corner]} ${chartOf[corner]} ${own[2 * corner]} ${own[2 * corner + 1]}`;
    if (!known.has(key)) {
      known.set(key, known.size);
      uvs.push(own[2 * corner], own[2 * corner + 1]);
    }
    cornerUvVertices[corner] = known.get(key);
  }
  const scale = charts.reduce((sum, chart) => sum + chart.scale * chart.triangles, 0) / charts.reduce((sum, { triangles }) => sum + triangles, 0);
  const pages = cornerPages.reduce((most, page) => Math.max(most, page), 0) + 1;
  const packing = atlas.packing && { ...atlas.packing, pages, margin: null, texelsPerUnit: scale * atlas.packing.resolution };
  const changed = { ...atlas, status: report.status, cornerUvs: own, cornerUvVertices, cornerPages, uvVertices: Float64Array.from(uvs), faceCharts, certificate, packing };
  const arrays = arraysOf(mesh, changed), areas = new Float64Array(arrays.energies.length);
  let covered = 0, whole = 0;
  for (let t = 0; t < areas.length; ++t) {
    const [a, b, c] = arrays.faces.subarray(3 * t, 3 * t + 3), at = (v, k) => arrays.positions[3 * v + k];
    const e = [0, 1, 2].map((k) => at(b, k) - at(a, k)), f = [0, 1, 2].map((k) => at(c, k) - at(a, k));
    areas[t] = Math.hypot(e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]) / 2;
    whole += areas[t];
    const uv = (v, k) => arrays.uvs[2 * v + k];
    covered += Math.abs((uv(b, 0) - uv(a, 0)) * (uv(c, 1) - uv(a, 1)) - (uv(b, 1) - uv(a, 1)) * (uv(c, 0) - uv(a, 0))) / 2;
  }
  const counts = { charts: charts.length, seamLength, area: whole, utilisation: covered / pages, seconds: report.seconds };
  const energy = { symmetricDirichlet: report.symmetricDirichlet, p99: percentile(arrays.energies, areas, 0.99), max: arrays.energies.reduce((most, one) => Math.max(most, one), 2) };
  return { atlas: { ...changed, report: { ...atlas.report, ...counts, ...energy } }, arrays };
}

/** The keys of the program's report that the viewer reads. */
export function reportOf(name, atlas) {
  const { report, certificate, packing } = atlas;
  return {
    status: atlas.status,
    input: { path: name, faces: report.faces, triangles: report.triangles },
    charts: report.charts,
    seam_over_root_area: report.seamLength / Math.sqrt(report.area),
    utilisation: report.utilisation,
    injective: { result: certificate.injective, positive: certificate.positive, negative: certificate.negative, degenerate: certificate.degenerate, overlaps: certificate.overlaps },
    energy: { symmetric_dirichlet: report.symmetricDirichlet, p99: report.p99, max: report.max },
    packing: packing && { pages: packing.pages, resolution: packing.resolution, margin: packing.margin, texels_per_unit: packing.texelsPerUnit },
    seconds: report.seconds,
  };
}

/** The page that `--html` writes, of `template`: report.html. */
export async function writeReport(template, arrays, report) {
  const { positions, uvs, energies, faces, charts } = arrays, steps = Uint32Array.from(faces, (vertex, i) => vertex - (i > 0 ? faces[i - 1] : 0));
  const parts = [positions, uvs, energies, steps, charts].map((array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength));
  const count = parts.reduce((sum, part) => sum + part.length, 0) / 4, planes = new Uint8Array(4 * count);
  let at = 0;
  for (const part of parts) {
    for (let i = 0; i < part.length; i += 4, ++at) for (let plane = 0; plane < 4; ++plane) planes[plane * count + at] = part[i + plane];
  }
  const packed = new Uint8Array(await new Response(new Blob([planes]).stream().pipeThrough(new CompressionStream('deflate'))).arrayBuffer());
  let letters = '';
  for (let i = 0; i < packed.length; i += 32768) letters += String.fromCharCode(...packed.subarray(i, i + 32768));
  const said = JSON.stringify({ mesh: { vertices: uvs.length / 2, triangles: energies.length }, report }).replaceAll('<', '\\u003c');
  const [before, rest] = template.split(/@report@([^]*)/), [between, after] = rest.split(/@arrays@([^]*)/);
  return new Blob([before, said, between, btoa(letters), after], { type: 'text/html' });
}

/** A mesh for who has none at hand: a tube along a knot, of quadrilaterals. */
export function example() {
  const along = 240, around = 24, positions = [], indices = [];
  const knot = (t) => [(2 + Math.cos(3 * t)) * Math.cos(2 * t), Math.sin(3 * t), (2 + Math.cos(3 * t)) * Math.sin(2 * t)];
  for (let i = 0; i < along; ++i) {
    const t = 2 * Math.PI * i / along, p = knot(t), q = knot(t + 1e-4), way = q.map((x, k) => x - p[k]);
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const unit = (a) => a.map((x) => x / Math.hypot(...a)), side = unit(cross(way, p)), up = unit(cross(side, way));
    for (let j = 0; j < around; ++j) {
      const angle = 2 * Math.PI * j / around;
      p.forEach((x, k) => positions.push(x + 0.42 * (Math.cos(angle) * side[k] + Math.sin(angle) * up[k])));
      const a = i * around + j, b = i * around + (j + 1) % around, next = (row) => (row + around) % (along * around);
      indices.push(a, next(a), next(b), b);
    }
  }
  return { positions: new Float64Array(positions), indices: new Uint32Array(indices), faceSizes: new Uint32Array(along * around).fill(4), source: { format: 'knot' } };
}
