// What the viewer draws, made of the arrays that a report or a page hands it.

/** The chart of a triangle that belongs to none. */
export const NO_CHART = 0xffffffff;
/** The heat of a triangle without a finite energy: it is flipped, or has no area. */
export const BAD_HEAT = 255;
/** Bytes of a corner: place (3 x uint16), heat, normal (3 x int8), UV (2 x float32), chart (uint32). */
export const STRIDE = 24;
/** Bytes of one end of a border: place and UV, as floats. */
export const LINE_STRIDE = 44;
/** A corner whose smooth normal leaves that of its face further than this cosine is on a crease: 41 degrees. */
const CREASE = 0.75;
/** Of all triangles so many have colours within the scale: few bad ones must not make the others one colour. */
const WITHIN_SCALE = 0.98;
const ROUND_ENERGIES = [2.1, 2.2, 2.5, 3, 4, 5, 7, 10, 20, 50, 100, 1000];

/** A table of whole numbers by their hashes, for arrays too large for a Map. */
function tableFor(count) {
  let size = 16;
  while (size < 1.5 * count) size *= 2;
  return new Int32Array(size).fill(-1);
}

function mixed(a, b) {
  let hash = Math.imul(a, 0x9e3779b1) ^ Math.imul(b, 0x85ebca6b);
  hash ^= hash >>> 15;
  hash = Math.imul(hash, 0x2c1b3c6d);
  return (hash ^ (hash >>> 13)) >>> 0;
}

/** The first vertex at the place of each. */
function firstsAtPlaces(positions) {
  const bits = new Int32Array(positions.buffer, positions.byteOffset, positions.length);
  const count = positions.length / 3, firsts = new Uint32Array(count), table = tableFor(count);
  for (let v = 0; v < count; ++v) {
    let at = mixed(mixed(bits[3 * v], bits[3 * v + 1]), bits[3 * v + 2]) & (table.length - 1);
    for (;; at = (at + 1) & (table.length - 1)) {
      const w = table[at];
      if (w < 0) table[at] = v;
      else if (bits[3 * w] !== bits[3 * v] || bits[3 * w + 1] !== bits[3 * v + 1] ||
        bits[3 * w + 2] !== bits[3 * v + 2]) continue;
      firsts[v] = table[at];
      break;
    }
  }
  return firsts;
}

/** The sides of triangles that no other triangle has. */
function borders(faces) {
  const table = tableFor(faces.length / 2), shared = new Uint8Array(faces.length);
  const end = (side) => faces[side % 3 === 2 ? side - 2 : side + 1];
  for (let side = 0; side < faces.length; ++side) {
    const a = faces[side], b = end(side);
    let at = mixed(Math.min(a, b), Math.max(a, b)) & (table.length - 1);
    for (;; at = (at + 1) & (table.length - 1)) {
      const other = table[at];
      if (other < 0) { table[at] = side; break; }
      const c = faces[other], d = end(other);
      if ((a === c && b === d) || (a === d && b === c)) { shared[side] = shared[other] = 1; break; }
    }
  }
  const found = [];
  for (let side = 0; side < faces.length; ++side) if (!shared[side]) found.push(side);
  return found;
}

/** The energy at the upper end of the colours: a round number that few triangles exceed. */
function topOf(energies) {
  const finite = energies.filter(Number.isFinite).sort();
  if (finite.length === 0) return 10;
  const most = finite[Math.floor((finite.length - 1) * WITHIN_SCALE)];
  return ROUND_ENERGIES.find((energy) => most <= energy) ?? ROUND_ENERGIES.at(-1);
}

/** Triangles with a UV for each vertex, and what the viewer asks of them. */
export class Geometry {
  /**
   * `positions` and `uvs` (Float32Array) have three and two numbers for each vertex, `faces` (Uint32Array) three
   * vertices for each triangle; `energies` (Float32Array) and `charts` (Uint32Array) a number for each triangle.
   * `marked` are sides that are drawn like borders: 3 f + k is the side from corner k of triangle f.
   */
  constructor({ positions, uvs, faces, energies, charts, marked = [] }) {
    Object.assign(this, { positions, uvs, faces, energies, faceCharts: charts });
    this.triangles = faces.length / 3;
    this.top = topOf(energies);
    this.#measure();
    const sides = [...borders(faces), ...marked];
    this.corners = this.#cornerBuffer();
    this.lines = this.#lineBuffer(sides);
    this.lineCount = sides.length;
  }

  #measure() {
    const { positions, uvs, faces } = this;
    this.low = [Infinity, Infinity, Infinity];
    this.high = [-Infinity, -Infinity, -Infinity];
    this.uvBox = [Infinity, Infinity, -Infinity, -Infinity];
    for (const v of faces) {
      for (let k = 0; k < 3; ++k) {
        this.low[k] = Math.min(this.low[k], positions[3 * v + k]);
        this.high[k] = Math.max(this.high[k], positions[3 * v + k]);
      }
      for (let k = 0; k < 2; ++k) {
        this.uvBox[k] = Math.min(this.uvBox[k], uvs[2 * v + k]);
        this.uvBox[k + 2] = Math.max(this.uvBox[k + 2], uvs[2 * v + k]);
      }
    }
    this.size = this.high.map((value, k) => Math.max(value - this.low[k], 1e-30));
    this.center = this.high.map((value, k) => (value + this.low[k]) / 2);
    let square = 0;
    for (const v of faces) {
      let sum = 0;
      for (let k = 0; k < 3; ++k) sum += (positions[3 * v + k] - this.center[k]) ** 2;
      square = Math.max(square, sum);
    }
    this.radius = Math.sqrt(square) || 1;
  }

  /** Twice the area times the normal of a triangle. */
  #cross(face, out) {
    const { positions, faces } = this;
    const a = 3 * faces[3 * face], b = 3 * faces[3 * face + 1], c = 3 * faces[3 * face + 2];
    const x1 = positions[b] - positions[a], y1 = positions[b + 1] - positions[a + 1], z1 = positions[b + 2] - positions[a + 2];
    const x2 = positions[c] - positions[a], y2 = positions[c + 1] - positions[a + 1], z2 = positions[c + 2] - positions[a + 2];
    out[0] = y1 * z2 - z1 * y2;
    out[1] = z1 * x2 - x1 * z2;
    out[2] = x1 * y2 - y1 * x2;
    return Math.hypot(out[0], out[1], out[2]);
  }

  #cornerBuffer() {
    const { positions, uvs, faces, low, size, triangles } = this;
    const firsts = firstsAtPlaces(positions), normals = new Float64Array(positions.length), normal = [0, 0, 0];
    this.areas = new Float32Array(triangles);
    for (let f = 0; f < triangles; ++f) {
      this.areas[f] = this.#cross(f, normal) / 2;
      for (let c = 3 * f; c < 3 * f + 3; ++c) {
        for (let k = 0; k < 3; ++k) normals[3 * firsts[faces[c]] + k] += normal[k];
      }
    }
    const buffer = new ArrayBuffer(STRIDE * faces.length);
    const places = new Uint16Array(buffer), bytes = new Uint8Array(buffer), directions = new Int8Array(buffer);
    const floats = new Float32Array(buffer), words = new Uint32Array(buffer);
    for (let f = 0; f < triangles; ++f) {
      const length = this.#cross(f, normal) || 1, heat = this.heat(this.energies[f]);
      for (let c = 3 * f; c < 3 * f + 3; ++c) {
        const v = faces[c], n = 3 * firsts[v];
        const long = Math.hypot(normals[n], normals[n + 1], normals[n + 2]) || 1;
        let cosine = 0;
        for (let k = 0; k < 3; ++k) cosine += normals[n + k] * normal[k] / (long * length);
        for (let k = 0; k < 3; ++k) {
          places[STRIDE / 2 * c + k] = Math.round(65535 * (positions[3 * v + k] - low[k]) / size[k]);
          directions[STRIDE * c + 8 + k] = Math.round(127 * (cosine < CREASE ? normal[k] / length : normals[n + k] / long));
        }
        bytes[STRIDE * c + 6] = heat;
        floats[STRIDE / 4 * c + 3] = uvs[2 * v];
        floats[STRIDE / 4 * c + 4] = uvs[2 * v + 1];
        words[STRIDE / 4 * c + 5] = this.faceCharts[f];
      }
    }
    return buffer;
  }

  #lineBuffer(sides) {
    const { positions, uvs, faces, low, size } = this;
    const buffer = new ArrayBuffer(LINE_STRIDE * sides.length), step = LINE_STRIDE / 4;
    const floats = new Float32Array(buffer), words = new Uint32Array(buffer);
    sides.forEach((side, i) => {
      const ends = [faces[side], faces[side % 3 === 2 ? side - 2 : side + 1]];
      ends.forEach((v, e) => {
        for (let k = 0; k < 3; ++k) floats[step * i + 5 * e + k] = (positions[3 * v + k] - low[k]) / size[k];
        for (let k = 0; k < 2; ++k) floats[step * i + 5 * e + 3 + k] = uvs[2 * v + k];
      });
      words[step * i + 10] = this.faceCharts[Math.floor(side / 3)];
    });
    return buffer;
  }

  /** From 0, lengths kept, to 254, the upper end of the scale; BAD_HEAT for what is wrong. */
  heat(energy) {
    if (!Number.isFinite(energy)) return BAD_HEAT;
    const share = Math.log(energy / 2) / Math.log(this.top / 2);
    return Math.round(254 * Math.min(Math.max(share, 0), 1));
  }

  /** What is to be told of each chart, by its number. */
  get charts() {
    if (this.chartList) return this.chartList;
    const all = [];
    for (let f = 0; f < this.triangles; ++f) {
      const number = this.faceCharts[f];
      if (number === NO_CHART) continue;
      const chart = all[number] ??= {
        number, triangles: 0, area: 0, weighted: 0, measured: 0, most: 2, bad: 0,
        box: [Infinity, Infinity, -Infinity, -Infinity], normal: [0, 0, 0],
      };
      const energy = this.energies[f], area = this.areas[f], normal = [0, 0, 0];
      ++chart.triangles;
      chart.area += area;
      if (Number.isFinite(energy)) {
        chart.weighted += area * energy;
        chart.measured += area;
        chart.most = Math.max(chart.most, energy);
      } else if (area > 0) {
        ++chart.bad;
      }
      this.#cross(f, normal);
      for (let k = 0; k < 3; ++k) chart.normal[k] += normal[k];
      for (let c = 3 * f; c < 3 * f + 3; ++c) {
        for (let k = 0; k < 2; ++k) {
          const value = this.uvs[2 * this.faces[c] + k];
          chart.box[k] = Math.min(chart.box[k], value);
          chart.box[k + 2] = Math.max(chart.box[k + 2], value);
        }
      }
    }
    const total = this.areas.reduce((sum, area) => sum + area, 0) || 1;
    for (const chart of all) {
      if (!chart) continue;
      chart.share = chart.area / total;
      chart.energy = chart.measured > 0 ? chart.weighted / chart.measured : NaN;
    }
    return this.chartList = all;
  }
}
