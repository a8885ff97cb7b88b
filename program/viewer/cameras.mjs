// From where the model and the layout are looked at. Matrices are by columns, as WebGL takes them.

/** Of the model's eye, in radians. */
const OPENING = 0.5;
const LEAST_ZOOM = 0.2, MOST_ZOOM = 400;
/** Free around what is shown, of the panel: room for its name. */
const MARGIN = 0.09;

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, factor) => a.map((value) => value * factor);
const unit = (a) => scaled(a, 1 / (Math.hypot(...a) || 1));
/** `v` turned about the unit vector `axis`. */
function turned(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle), along = dot(axis, v) * (1 - c), side = cross(axis, v);
  return v.map((value, k) => c * value + s * side[k] + along * axis[k]);
}

/** What a panel shows is moved and magnified in the coordinates of the panel, from -1 to 1. */
class Camera {
  reset() {
    this.zoom = 1;
    this.pan = [0, 0];
  }

  /** Magnifies about a place of the panel. */
  magnify(factor, place = [0, 0]) {
    const before = this.zoom;
    this.zoom = clamp(before * factor, LEAST_ZOOM, MOST_ZOOM);
    const change = this.zoom / before;
    this.pan = this.pan.map((value, k) => place[k] + change * (value - place[k]));
  }

  move(x, y) {
    this.pan = [clamp(this.pan[0] + x, -2 * this.zoom - 1, 2 * this.zoom + 1), clamp(this.pan[1] + y, -2 * this.zoom - 1, 2 * this.zoom + 1)];
  }
}

/** Around a model: it turns about what is up in it, and tilts. */
export class ModelCamera extends Camera {
  /** `frame`: what is right, up, and toward the eye, as three rows. */
  constructor(geometry, frame = [0.848, 0, -0.53, -0.159, 0.954, -0.254, 0.506, 0.3, 0.809]) {
    super();
    this.geometry = geometry;
    const toward = unit(frame.slice(6, 9)), right = unit(cross(frame.slice(3, 6), toward));
    this.first = [right, cross(toward, right), toward];
    const up = this.first[1], longest = up.map(Math.abs).indexOf(Math.max(...up.map(Math.abs)));
    this.up = [0, 0, 0];
    this.up[longest] = Math.sign(up[longest]) || 1;
    this.reset();
  }

  reset() {
    super.reset();
    this.frame = this.first;
  }

  turn(x, y) {
    const height = Math.asin(clamp(dot(this.frame[2], this.up), -1, 1));
    const tilt = clamp(height + y, -Math.PI / 2, Math.PI / 2) - height;
    const right = this.frame[0];
    this.frame = this.frame.map((row) => turned(turned(row, right, -tilt), this.up, -x));
  }

  /** Looks at a surface with this normal. */
  face(normal) {
    const toward = unit(normal);
    let right = cross(this.up, toward);
    if (Math.hypot(...right) < 0.05) right = this.frame[0].map((value, k) => value - dot(this.frame[0], toward) * toward[k]);
    right = unit(right);
    this.frame = [right, cross(toward, right), toward];
    super.reset();
  }

  /** From places in the box of the geometry, each from 0 to 1, to those of a panel. */
  matrix(aspect) {
    const { low, size, center, radius } = this.geometry;
    const rows = this.frame.map((row) => [...row.map((value, k) => value * size[k] / radius),
      dot(row, low.map((value, k) => value - center[k])) / radius]);
    const away = 1 / Math.sin(OPENING / 2), near = away - 1.02, far = away + 1.02;
    const magnified = this.zoom * (1 - MARGIN) / Math.tan(OPENING / 2);
    const depth = scaled(rows[2], -1);
    depth[3] += away; // distance from the eye
    const across = (row, factor, pan) => row.map((value, k) => factor * value + pan * depth[k]);
    const x = across(rows[0], magnified / Math.max(aspect, 1), this.pan[0]);
    const y = across(rows[1], magnified * Math.min(aspect, 1), this.pan[1]);
    const z = depth.map((value, k) => (far + near) / (far - near) * value - (k === 3 ? 2 * far * near / (far - near) : 0));
    return new Float32Array([0, 1, 2, 3].flatMap((k) => [x[k], y[k], z[k], depth[k]]));
  }
}

/** Above a layout. */
export class LayoutCamera extends Camera {
  /** `box`: the least u and v, and the greatest, of what is to be seen. */
  constructor(box) {
    super();
    this.box = box;
    this.reset();
  }

  turn(x, y) { this.move(x, y); }

  /** Fills the panel with a part of the layout. */
  show(box, aspect) {
    this.reset();
    const whole = this.#scale(this.box, aspect), part = this.#scale(box, aspect);
    this.zoom = clamp(0.8 * part / whole, 1, MOST_ZOOM);
    const middle = (b, k) => (b[k] + b[k + 2]) / 2, scale = whole * this.zoom;
    this.pan = [(middle(this.box, 0) - middle(box, 0)) * scale / Math.max(aspect, 1),
      (middle(this.box, 1) - middle(box, 1)) * scale * Math.min(aspect, 1)];
  }

  #scale(box, aspect) {
    const wide = Math.max(box[2] - box[0], 1e-30) / Math.max(aspect, 1), high = Math.max(box[3] - box[1], 1e-30) * Math.min(aspect, 1);
    return 2 * (1 - MARGIN) / Math.max(wide, high);
  }

  /** From u, v, 0, 1 to places of a panel. */
  matrix(aspect) {
    const scale = this.#scale(this.box, aspect) * this.zoom;
    const x = scale / Math.max(aspect, 1), y = scale * Math.min(aspect, 1);
    return new Float32Array([x, 0, 0, 0, 0, y, 0, 0, 0, 0, 1, 0,
      this.pan[0] - x * (this.box[0] + this.box[2]) / 2, this.pan[1] - y * (this.box[1] + this.box[3]) / 2, 0, 1]);
  }
}

/** Where a place of three or two coordinates comes to lie: x, y and depth over w, with that w. */
export function projected(matrix, place) {
  const [x, y, z = 0] = place;
  const of = (k) => matrix[k] * x + matrix[4 + k] * y + matrix[8 + k] * z + matrix[12 + k];
  const w = of(3);
  return [of(0) / w, of(1) / w, of(2) / w, w];
}
