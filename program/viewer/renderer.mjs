// Draws the model and the layout into one canvas by WebGL 2.
import { LINE_STRIDE, NO_CHART, STRIDE } from './geometry.mjs';

export const MODES = ['checker', 'heat', 'charts', 'texture'];

const CORNER_SHADER = `#version 300 es
layout(location = 0) in vec3 place;
layout(location = 1) in float heat;
layout(location = 2) in vec3 normal;
layout(location = 3) in vec2 uv;
layout(location = 4) in uint chart;
uniform mat4 matrix;
uniform bool flat_view;
out vec2 at;
out vec3 facing, side;
flat out uint of_chart;
flat out uint of_face;
flat out float hot;
void main() {
  gl_Position = matrix * (flat_view ? vec4(uv, 0.0, 1.0) : vec4(place, 1.0));
  if (flat_view && heat > 0.998) gl_Position.z = -0.5; // what is wrong must not hide under what is right
  at = uv;
  facing = normal;
  int corner = gl_VertexID % 3;
  side = vec3(corner == 0, corner == 1, corner == 2);
  of_chart = chart;
  of_face = uint(gl_VertexID / 3);
  hot = heat;
}`;

// Viridis (CC0, van der Walt and Smith) as a polynomial that is within 1% of the table.
const FACE_SHADER = `#version 300 es
precision highp float;
precision highp int;
in vec2 at;
in vec3 facing, side;
flat in uint of_chart;
flat in uint of_face;
flat in float hot;
uniform bool flat_view, wire;
uniform int mode;
uniform uint lit;
uniform float cell;
uniform vec3 right, up, toward, dimmed;
uniform sampler2D image;
out vec4 colour;
vec3 viridis(float t) {
  return vec3(0.2777273272, 0.0054073445, 0.3340998053) + t * (vec3(0.1050930431, 1.4046135299, 1.3845901626) +
    t * (vec3(-0.3308618287, 0.2148475595, 0.0950951630) + t * (vec3(-4.6342304990, -5.7991009734, -19.3324409563) +
    t * (vec3(6.2282699363, 14.1799333668, 56.6905526007) + t * (vec3(4.7763849977, -13.7451453777, -65.3530326334) +
    t * vec3(-5.4354558559, 4.6458526122, 26.3124352495))))));
}
vec3 hue(uint chart) {
  float turn = fract(float(chart % 4096u) * 0.61803398875 + 0.08), light = 0.62 + 0.16 * float(chart % 3u);
  vec3 full = clamp(abs(mod(6.0 * turn + vec3(0, 4, 2), 6.0) - 3.0) - 1.0, 0.0, 1.0);
  return light * mix(vec3(1), full, 0.48);
}
float checker(vec2 p) { // the mean over the pixel, so that far cells are grey
  vec2 width = max(fwidth(p), vec2(1e-6));
  vec2 share = 2.0 * (abs(fract((p - 0.5 * width) * 0.5) - 0.5) - abs(fract((p + 0.5 * width) * 0.5) - 0.5)) / width;
  return clamp(0.5 - 0.5 * share.x * share.y, 0.0, 1.0);
}
void main() {
  vec3 base;
  float dark = checker(at / cell);
  vec4 shown = texture(image, at);
  if (mode == 0) base = mix(vec3(0.97, 0.95, 0.90), vec3(0.20, 0.43, 0.60), dark);
  else if (mode == 1) base = hot > 0.998 ? vec3(0.90, 0.10, 0.15) : viridis(hot * 255.0 / 254.0);
  else if (mode == 2) base = hue(of_chart);
  else base = mix(vec3(0.6), shown.rgb, shown.a);
  if (wire) {
    vec3 width = fwidth(side), near = smoothstep(vec3(0), 1.2 * width, side);
    float line = 1.0 - min(near.x, min(near.y, near.z));
    float size = max(width.x, max(width.y, width.z)); // triangles of few pixels would be all lines
    base = mix(base, vec3(0.08, 0.09, 0.12), 0.55 * line * (1.0 - smoothstep(0.15, 0.5, size)));
  }
  if (!flat_view) {
    vec3 n = normalize(vec3(dot(facing, right), dot(facing, up), dot(facing, toward)) + vec3(0, 0, 1e-6));
    float strength = 1.0;
    if (!gl_FrontFacing) { n = -n; strength = 0.5; }
    float light = 0.34 + 0.56 * max(0.0, dot(n, normalize(vec3(-0.4, 0.55, 0.9)))) +
      0.22 * max(0.0, dot(n, normalize(vec3(0.8, 0.1, 0.6))));
    base *= strength * light;
  }
  if (lit != ${NO_CHART}u) base = of_chart == lit ? mix(base, vec3(1), 0.10) : mix(base, dimmed, 0.62);
  colour = vec4(base, 1);
}`;

const PICK_SHADER = `#version 300 es
precision highp float;
precision highp int;
flat in uint of_face;
out vec4 colour;
void main() {
  uint n = of_face + 1u;
  colour = vec4(n & 255u, (n >> 8) & 255u, (n >> 16) & 255u, n >> 24) / 255.0;
}`;

const LINE_SHADER = `#version 300 es
layout(location = 0) in vec3 from;
layout(location = 1) in vec2 from_uv;
layout(location = 2) in vec3 to;
layout(location = 3) in vec2 to_uv;
layout(location = 4) in uint chart;
uniform mat4 matrix;
uniform bool flat_view, only_lit;
uniform uint lit;
uniform float nearer, width;
uniform vec2 size;
void main() {
  vec4 a = matrix * (flat_view ? vec4(from_uv, 0, 1) : vec4(from, 1));
  vec4 b = matrix * (flat_view ? vec4(to_uv, 0, 1) : vec4(to, 1));
  vec2 along = (b.xy / b.w - a.xy / a.w) * size;
  along = length(along) > 1e-6 ? normalize(along) : vec2(1, 0);
  float end = float(gl_VertexID / 2), left = float(gl_VertexID % 2) * 2.0 - 1.0;
  vec4 place = mix(a, b, end);
  vec2 away = vec2(-along.y, along.x) * left + along * (end * 2.0 - 1.0) * 0.5;
  place.xy += away * width / size * place.w;
  place.z -= nearer * place.w;
  if (only_lit && chart != lit) place = vec4(2, 2, 2, 1);
  gl_Position = place;
}`;

const COLOUR_SHADER = `#version 300 es
precision highp float;
uniform vec4 ink;
out vec4 colour;
void main() { colour = vec4(ink.rgb * ink.a, ink.a); }`;

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) {
    throw new Error(gl.getProgramInfoLog(made) || 'the shaders do not link');
  }
  const places = {}, count = gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS);
  for (let i = 0; i < count; ++i) {
    const { name } = gl.getActiveUniform(made, i);
    places[name] = gl.getUniformLocation(made, name);
  }
  return { made, places };
}

/** One context for both panels, so that the mesh is in the memory of the graphics once. */
export class Renderer {
  /** Throws an Error where the browser has no WebGL 2. */
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = canvas.getContext('webgl2', { antialias: true, alpha: true, powerPreference: 'low-power' });
    if (!this.gl) throw new Error('this view needs WebGL 2, which this browser does not offer');
    this.#make();
    canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => {
      this.#make();
      if (this.geometry) this.show(this.geometry);
      if (this.picture) this.showImage(this.picture);
      this.restored?.();
    });
  }

  #make() {
    const { gl } = this;
    this.faces = program(gl, CORNER_SHADER, FACE_SHADER);
    this.picks = program(gl, CORNER_SHADER, PICK_SHADER);
    this.borders = program(gl, LINE_SHADER, COLOUR_SHADER);
    this.image = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.image);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 1, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array([150, 150, 150, 255]));
    this.pickTarget = gl.createFramebuffer();
    this.pickColour = gl.createRenderbuffer();
    this.pickDepth = gl.createRenderbuffer();
    this.corners = this.lines = this.frames = null;
    this.picked = false;
  }

  show(geometry) {
    const { gl } = this;
    for (const old of [this.corners, this.lines]) {
      if (!old) continue;
      gl.deleteBuffer(old.buffer);
      gl.deleteVertexArray(old.array);
    }
    this.geometry = geometry;
    this.corners = this.#array(geometry.corners, STRIDE, [
      [3, gl.UNSIGNED_SHORT, true, 0], [1, gl.UNSIGNED_BYTE, true, 6], [3, gl.BYTE, true, 8], [2, gl.FLOAT, false, 12], [1, 0, false, 20],
    ], 0);
    this.lines = this.#array(geometry.lines, LINE_STRIDE, [
      [3, gl.FLOAT, false, 0], [2, gl.FLOAT, false, 12], [3, gl.FLOAT, false, 20], [2, gl.FLOAT, false, 32], [1, 0, false, 40],
    ], 1);
    this.picked = false;
  }

  #array(data, stride, attributes, divisor) {
    const { gl } = this, array = gl.createVertexArray(), buffer = gl.createBuffer();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    attributes.forEach(([count, type, normalized, offset], location) => {
      gl.enableVertexAttribArray(location);
      if (type) gl.vertexAttribPointer(location, count, type, normalized, stride, offset);
      else gl.vertexAttribIPointer(location, count, gl.UNSIGNED_INT, stride, offset);
      gl.vertexAttribDivisor(location, divisor);
    });
    gl.bindVertexArray(null);
    return { array, buffer };
  }

  /** What the mode "texture" shows: an image or a canvas, whose upper edge is at v = 1. */
  showImage(picture) {
    const { gl } = this;
    this.picture = picture;
    gl.bindTexture(gl.TEXTURE_2D, this.image);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, true);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    const finer = gl.getExtension('EXT_texture_filter_anisotropic');
    if (finer) gl.texParameterf(gl.TEXTURE_2D, finer.TEXTURE_MAX_ANISOTROPY_EXT, 8);
  }

  /** Pixels of the canvas, for a size in those of the page. Returns whether it changed. */
  resize(width, height, ratio) {
    const wide = Math.max(1, Math.round(width * ratio)), high = Math.max(1, Math.round(height * ratio));
    this.ratio = ratio;
    if (this.canvas.width === wide && this.canvas.height === high) return false;
    this.canvas.width = wide;
    this.canvas.height = high;
    this.picked = false;
    return true;
  }

  #set(shader, values) {
    const { gl } = this;
    gl.useProgram(shader.made);
    for (const [name, value] of Object.entries(values)) {
      const place = shader.places[name];
      if (place === undefined) continue;
      if (name === 'matrix') gl.uniformMatrix4fv(place, false, value);
      else if (name === 'lit') gl.uniform1ui(place, value);
      else if (typeof value === 'boolean' || name === 'mode' || name === 'image') gl.uniform1i(place, Number(value));
      else if (typeof value === 'number') gl.uniform1f(place, value);
      else gl[`uniform${value.length}fv`](place, value);
    }
  }

  #viewport({ left, bottom, width, height }) {
    const { gl, ratio } = this, box = [left, bottom, width, height].map((value) => Math.round(value * ratio));
    gl.viewport(...box);
    gl.scissor(...box);
    return [box[2], box[3]];
  }

  /**
   * Draws `views`: of each the panel (`left`, `bottom`, `width`, `height` in pixels of the page), `matrix`, `frame`
   * of a model or null for a layout. `look` has mode, wire, lit (a chart or NO_CHART), cell, inks, and seams.
   */
  draw(views, look) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!this.corners) return;
    gl.enable(gl.SCISSOR_TEST);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    for (const view of views) this.#drawView(view, look);
  }

  #drawView(view, look) {
    const { gl } = this, size = this.#viewport(view), flat_view = view.frame === null;
    const [right, up, toward] = view.frame ?? [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const common = { matrix: view.matrix, flat_view, lit: look.lit };
    gl.bindVertexArray(this.corners.array);
    gl.bindTexture(gl.TEXTURE_2D, this.image);
    this.#set(this.faces, {
      ...common, wire: look.wire, mode: MODES.indexOf(look.mode), cell: look.cell, right, up, toward,
      dimmed: look.inks.dimmed.slice(0, 3), image: 0,
    });
    gl.drawArrays(gl.TRIANGLES, 0, 3 * this.geometry.triangles);
    gl.bindVertexArray(this.lines.array);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const lines = (ink, width, only_lit) => {
      this.#set(this.borders, { ...common, size, ink, only_lit, width: width * this.ratio, nearer: flat_view ? 0.6 : 0.004 });
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.geometry.lineCount);
    };
    if (look.seams) lines(look.inks[look.mode === 'heat' ? 'line-heat' : 'line'], flat_view ? 1.3 : 1.1, false);
    if (look.lit !== NO_CHART) {
      lines(look.inks.lit, 2.4, true);
      gl.disable(gl.DEPTH_TEST); // what is behind shows through, faintly
      lines([...look.inks.lit.slice(0, 3), 0.22], 1.6, true);
      gl.enable(gl.DEPTH_TEST);
    }
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
  }

  /** To be called when a camera moves: what was drawn to pick from is out of date. */
  moved() { this.picked = false; }

  /** The triangle at a place of the canvas, in pixels of the page from its lower left; or -1. */
  pick(views, x, y) {
    const { gl, canvas } = this;
    if (!this.corners) return -1;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.pickTarget);
    if (!this.picked) this.#drawPicks(views);
    const pixel = new Uint8Array(4);
    const at = [x, y].map((value) => Math.floor(value * this.ratio));
    if (at[0] >= 0 && at[1] >= 0 && at[0] < canvas.width && at[1] < canvas.height) {
      gl.readPixels(at[0], at[1], 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return pixel[0] + 256 * pixel[1] + 65536 * pixel[2] + 16777216 * pixel[3] - 1;
  }

  #drawPicks(views) {
    const { gl, canvas } = this;
    for (const [buffer, format, place] of [[this.pickColour, gl.RGBA8, gl.COLOR_ATTACHMENT0], [this.pickDepth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, canvas.width, canvas.height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
    }
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.SCISSOR_TEST);
    gl.enable(gl.DEPTH_TEST);
    gl.bindVertexArray(this.corners.array);
    for (const view of views) {
      this.#viewport(view);
      this.#set(this.picks, { matrix: view.matrix, flat_view: view.frame === null });
      gl.drawArrays(gl.TRIANGLES, 0, 3 * this.geometry.triangles);
    }
    gl.bindVertexArray(null);
    this.picked = true;
  }
}
