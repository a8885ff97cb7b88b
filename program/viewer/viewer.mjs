// The viewer: a model beside its layout, which light each other up.
import { LayoutCamera, ModelCamera, projected } from './cameras.mjs';
import { aboutChart, figures, short, verdict } from './figures.mjs';
import { Geometry, NO_CHART } from './geometry.mjs';
import { testGrid } from './grid.mjs';
import { MODES, Renderer } from './renderer.mjs';

/** Cells of the checkerboard along a page, or along the longer side of a layout without pages. */
const CHECKER_CELLS = 40;
/** Pixels that a pointer may move in a click. */
const CLICK = 4;
const TITLES = { checker: 'Checker', heat: 'Distortion', charts: 'Charts', texture: 'Texture' };
const HINT = 'Point at a chart, or press N for the next one. Press ? for all keys.';
const KEYS = [
  ['1 2 3 4', 'checker, distortion, charts, texture'], ['W', 'edges of triangles'], ['S', 'borders of charts'], ['N, P', 'next chart, the one before'],
  ['B', 'the chart of the highest mean energy'], ['F', 'look at the chart'], ['Esc', 'no chart'], ['arrows', 'turn the model, move the layout'], ['+ −', 'nearer, further'], ['0', 'the whole'],
];

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) made.addEventListener(key.slice(2), value);
    else if (value === true) made.setAttribute(key, '');
    else if (value !== false) made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

/** The colours that a style sheet gives, from 0 to 1. */
function inksOf(root) {
  const probe = element('i'), inks = {};
  root.append(probe);
  for (const name of ['line', 'line-heat', 'lit', 'dimmed']) {
    probe.style.color = `var(--${name})`;
    const numbers = getComputedStyle(probe).color.match(/[\d.]+/g).map(Number);
    inks[name] = [numbers[0] / 255, numbers[1] / 255, numbers[2] / 255, numbers[3] ?? 1];
  }
  probe.remove();
  return inks;
}

export class Viewer {
  /** What a page does with a click in a panel: it returns whether no chart is to be chosen. */
  clicked = null;

  /** Fills `root`, an element of the page. */
  constructor(root) {
    this.root = root;
    this.look = { mode: 'checker', wire: false, seams: true };
    this.hovered = this.chosen = NO_CHART;
    this.#build();
    try {
      this.renderer = new Renderer(this.canvas);
      this.renderer.restored = () => this.redraw();
      this.showImage(testGrid());
    } catch (error) {
      this.panels.before(element('p', { class: 'bv-fault', role: 'alert' }, `No picture: ${error.message}. The figures hold all the same.`));
      this.panels.hidden = true;
    }
    this.inks = inksOf(root);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.#themed());
    new ResizeObserver(() => this.redraw()).observe(this.panels);
  }

  #build() {
    this.title = element('h1', { class: 'bv-title' });
    this.badge = element('span', { class: 'bv-badge', hidden: true });
    this.modes = element('div', { class: 'bv-modes', role: 'radiogroup', 'aria-label': 'What the surface shows' });
    for (const mode of MODES) {
      const input = element('input', { type: 'radio', name: 'bv-mode', value: mode, onchange: () => this.setMode(mode) });
      input.checked = mode === this.look.mode;
      this.modes.append(element('label', {}, input, element('span', {}, TITLES[mode])));
    }
    const toggle = (key, words) => {
      const button = element('button', { type: 'button', 'aria-pressed': String(this.look[key]), onclick: () => this.toggle(key) }, words);
      return (this.toggles ??= {})[key] = button;
    };
    this.file = element('input', { type: 'file', accept: 'image/*', hidden: true, onchange: () => this.#chooseImage() });
    this.keys = element('dialog', { class: 'bv-keys', 'aria-label': 'Keys', onclick: () => this.keys.close() },
      element('dl', {}, ...KEYS.flatMap(([keys, words]) => [element('dt', {}, keys), element('dd', {}, words)])),
      element('form', { method: 'dialog' }, element('button', {}, 'Close')));
    this.tools = element('div', { class: 'bv-tools' },
      toggle('wire', 'Edges'), toggle('seams', 'Borders'),
      element('button', { type: 'button', title: 'Show a picture of yours as the texture', onclick: () => this.file.click() }, 'Image…'), this.file,
      element('button', { type: 'button', title: 'Light or dark', 'aria-label': 'Light or dark', onclick: () => this.#turnTheme() }, '◐'),
      element('button', { type: 'button', 'aria-label': 'Keys', title: 'Keys', onclick: () => this.keys.showModal() }, '?'));
    this.bar = element('header', { class: 'bv-bar' }, element('div', { class: 'bv-head' }, this.title, this.badge), this.modes, this.tools);
    this.canvas = element('canvas', { 'aria-hidden': 'true' });
    this.legend = element('div', { class: 'bv-legend', hidden: true }, element('span'), element('i'), element('span'), element('em', {}, 'symmetric Dirichlet energy'));
    this.panes = ['Model', 'Layout'].map((name, index) => {
      const label = element('span', { class: 'bv-label' }, name), dot = element('b', { class: 'bv-dot', hidden: true });
      const box = element('section', { class: 'bv-pane', tabindex: '0', role: 'application', 'aria-roledescription': 'view', 'aria-label': `${name}: arrows move it, plus and minus magnify, N and P choose charts` }, label, dot);
      return { box, label, dot, index, pointers: new Map() };
    });
    this.panels = element('div', { class: 'bv-panels' }, this.canvas, ...this.panes.map((pane) => pane.box));
    this.about = element('output', { class: 'bv-about', 'aria-live': 'polite' });
    this.figures = element('dl', { class: 'bv-figures' });
    this.root.classList.add('bv');
    this.root.append(this.bar, this.panels, element('div', { class: 'bv-line' }, this.about, this.legend), this.figures, this.keys);
    this.panes.forEach((pane) => this.#listen(pane));
    document.addEventListener('keydown', (event) => this.#key(event));
  }

  /**
   * Shows triangles: see Geometry for `arrays`, and figures.mjs for `report`. `frame` is from where to look at the
   * model: what is right, up, and toward the eye. With `stays` the same model is looked at as before.
   */
  show(arrays, report, { name = '', frame, stays = false } = {}) {
    this.report = report;
    this.title.textContent = name;
    const { good, words } = verdict(report);
    this.badge.hidden = false;
    this.badge.textContent = words;
    this.badge.dataset.good = String(good);
    this.figures.replaceChildren(...figures(report).map(([key, value]) => element('div', {}, element('dt', {}, key), element('dd', {}, value))));
    if (!this.renderer) return;
    this.geometry = new Geometry(arrays);
    this.renderer.show(this.geometry);
    const { uvBox } = this.geometry, pages = report.packing?.pages ?? 0;
    const box = pages > 0 ? [Math.floor(uvBox[0]), Math.floor(uvBox[1]), Math.max(Math.ceil(uvBox[2]), 1), Math.max(Math.ceil(uvBox[3]), 1)] : uvBox;
    this.look.cell = (pages > 0 ? 1 : Math.max(uvBox[2] - uvBox[0], uvBox[3] - uvBox[1], 1e-30)) / CHECKER_CELLS;
    if (!stays) {
      this.panes[0].camera = new ModelCamera(this.geometry, frame);
      this.panes[1].camera = new LayoutCamera(box);
    }
    this.panes[1].label.textContent = pages > 1 ? `Layout, ${pages} pages` : 'Layout';
    const [least, , most] = this.legend.children;
    least.textContent = '2';
    most.textContent = `${short(this.geometry.top)}+`;
    this.hovered = this.chosen = NO_CHART;
    this.#tell();
    this.#moved();
  }

  setMode(mode) {
    this.look.mode = mode;
    for (const input of this.modes.querySelectorAll('input')) input.checked = input.value === mode;
    this.legend.hidden = mode !== 'heat';
    this.redraw();
  }

  toggle(key) {
    this.look[key] = !this.look[key];
    this.toggles[key].setAttribute('aria-pressed', String(this.look[key]));
    this.redraw();
  }

  /** An image or a canvas, which the mode "texture" shows. */
  showImage(picture) {
    this.renderer?.showImage(picture);
    this.redraw();
  }

  async #chooseImage() {
    const [file] = this.file.files;
    this.file.value = '';
    if (!file) return;
    try {
      const whole = await createImageBitmap(file), most = 4096;
      const share = Math.min(1, most / Math.max(whole.width, whole.height));
      const canvas = element('canvas');
      canvas.width = Math.max(1, Math.round(whole.width * share));
      canvas.height = Math.max(1, Math.round(whole.height * share));
      canvas.getContext('2d').drawImage(whole, 0, 0, canvas.width, canvas.height);
      this.showImage(canvas);
      this.setMode('texture');
    } catch {
      this.about.textContent = `${file.name} is no picture that this browser reads: choose a PNG or a JPEG.`;
    }
  }

  #turnTheme() {
    const dark = document.documentElement.dataset.theme ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
    document.documentElement.dataset.theme = dark === 'dark' ? 'light' : 'dark';
    this.#themed();
  }

  #themed() {
    this.inks = inksOf(this.root);
    this.redraw();
  }

  get lit() { return this.hovered === NO_CHART ? this.chosen : this.hovered; }

  #tell(face) {
    const chart = this.lit === NO_CHART ? undefined : this.geometry.charts[this.lit];
    this.about.textContent = chart ? aboutChart(chart, face === undefined ? undefined : this.geometry.energies[face]) : HINT;
  }

  choose(chart) {
    this.chosen = chart ?? NO_CHART;
    this.hovered = NO_CHART;
    this.#hideDots();
    this.#tell();
    this.redraw();
  }

  /** The chart that is so many further, of those that there are. */
  #step(by) {
    const numbers = Object.keys(this.geometry.charts).map(Number), at = numbers.indexOf(this.chosen);
    const next = at < 0 ? (by > 0 ? 0 : numbers.length - 1) : (at + by + numbers.length) % numbers.length;
    this.choose(numbers[next]);
  }

  #worst() {
    let worst;
    for (const chart of this.geometry.charts) {
      if (chart && (!worst || chart.bad > worst.bad || (chart.bad === worst.bad && chart.energy > worst.energy))) worst = chart;
    }
    this.choose(worst?.number);
  }

  /** Fills both panels with the chart. */
  frameChart() {
    const chart = this.geometry.charts[this.lit];
    if (!chart) return;
    this.panes[0].camera.face(chart.normal);
    this.panes[1].camera.show(chart.box, this.#aspect(this.panes[1]));
    this.#moved();
  }

  #aspect({ box }) { return Math.max(box.clientWidth, 1) / Math.max(box.clientHeight, 1); }

  #moved() {
    this.renderer.moved();
    this.#hideDots();
    this.redraw();
  }

  redraw() {
    if (this.waiting || !this.renderer) return;
    this.waiting = requestAnimationFrame(() => {
      this.waiting = 0;
      this.#draw();
    });
  }

  #draw() {
    const { clientWidth: width, clientHeight: height } = this.panels;
    this.renderer.resize(width, height, Math.min(devicePixelRatio || 1, 2));
    this.views = this.geometry ? this.panes.map(({ box, camera, index }) => ({
      left: box.offsetLeft + box.clientLeft, bottom: height - box.offsetTop - box.clientTop - box.clientHeight,
      width: box.clientWidth, height: box.clientHeight, matrix: camera.matrix(box.clientWidth / Math.max(box.clientHeight, 1)),
      frame: index === 0 ? camera.frame : null,
    })) : [];
    this.renderer.draw(this.views, { ...this.look, lit: this.lit, inks: this.inks });
    this.#placePages();
    this.root.dataset.drawn = String(Number(this.root.dataset.drawn ?? 0) + 1);
  }

  /** The frames of pages, drawn by the page behind the canvas. */
  #placePages() {
    const pane = this.panes[1], shown = [];
    if (this.geometry && (this.report.packing?.pages ?? 0) > 0) {
      const { box } = pane.camera, view = this.views[1];
      for (let v = box[1]; v < box[3]; ++v) {
        for (let u = box[0]; u < box[2]; ++u) {
          const [left, bottom] = this.onPane(projected(view.matrix, [u, v]), view), [right, top] = this.onPane(projected(view.matrix, [u + 1, v + 1]), view);
          shown.push([left, top, right - left, bottom - top]);
        }
      }
    }
    while (pane.box.querySelectorAll('.bv-page').length < shown.length) pane.box.prepend(element('i', { class: 'bv-page' }));
    pane.box.querySelectorAll('.bv-page').forEach((page, i) => {
      page.hidden = i >= shown.length;
      if (page.hidden) return;
      ['left', 'top', 'width', 'height'].forEach((side, k) => { page.style[side] = `${shown[i][k]}px`; });
    });
  }

  /** Pixels from the upper left corner of a panel. */
  onPane([x, y], { width, height }) { return [(x + 1) / 2 * width, (1 - y) / 2 * height]; }

  #hideDots() { for (const { dot } of this.panes) dot.hidden = true; }

  /** Marks in the other panel the place that the pointer is at. */
  #mark(pane, face, place) {
    const other = this.panes[1 - pane.index], from = this.views[pane.index], to = this.views[other.index];
    const { positions, uvs, faces, low, size } = this.geometry;
    const placesOf = (index) => [0, 1, 2].map((k) => {
      const v = faces[3 * face + k];
      return index === 1 ? [uvs[2 * v], uvs[2 * v + 1]] : [0, 1, 2].map((d) => (positions[3 * v + d] - low[d]) / size[d]);
    });
    const [a, b, c] = placesOf(pane.index).map((corner) => projected(from.matrix, corner));
    const area = (p, q, r) => (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    const weights = [area(place, b, c) / a[3], area(a, place, c) / b[3], area(a, b, place) / c[3]];
    const sum = weights[0] + weights[1] + weights[2];
    other.dot.hidden = !(Math.abs(sum) > 0);
    if (other.dot.hidden) return;
    const shares = weights.map((weight) => Math.min(Math.max(weight / sum, 0), 1)), corners = placesOf(other.index);
    const [x, y] = this.onPane(projected(to.matrix, corners[0].map((_, d) => corners.reduce((total, corner, k) => total + shares[k] * corner[d], 0))), to);
    other.dot.hidden = x < 0 || y < 0 || x > to.width || y > to.height;
    other.dot.style.translate = `${x}px ${y}px`;
  }

  /** From an event to a place of the panel, from -1 to 1. */
  place(pane, event) {
    const box = pane.box.getBoundingClientRect();
    return [2 * (event.clientX - box.left - pane.box.clientLeft) / pane.box.clientWidth - 1, 1 - 2 * (event.clientY - box.top - pane.box.clientTop) / pane.box.clientHeight];
  }

  /** The triangle at a place of a panel, or -1. */
  faceAt(pane, place) {
    const view = this.views?.[pane.index];
    if (!view) return -1;
    return this.renderer.pick(this.views, view.left + (place[0] + 1) / 2 * view.width, view.bottom + (place[1] + 1) / 2 * view.height);
  }

  #hover(pane, event) {
    const place = this.place(pane, event), face = this.faceAt(pane, place), before = this.hovered;
    this.#hideDots();
    this.hovered = face < 0 ? NO_CHART : this.geometry.faceCharts[face];
    if (face >= 0) this.#mark(pane, face, place);
    this.#tell(face < 0 ? undefined : face);
    if (this.hovered !== before) this.redraw();
  }

  #listen(pane) {
    const { box, pointers } = pane;
    box.addEventListener('pointerdown', (event) => {
      if (!this.geometry) return;
      box.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, { at: this.place(pane, event), start: [event.clientX, event.clientY], still: pointers.size === 0 });
    });
    box.addEventListener('pointermove', (event) => {
      if (!this.geometry) return;
      if (pointers.has(event.pointerId)) this.#drag(pane, event);
      else if (event.pointerType !== 'touch') this.#hover(pane, event);
    });
    const up = (event) => {
      const pointer = pointers.get(event.pointerId);
      pointers.delete(event.pointerId);
      if (!pointer?.still || event.type !== 'pointerup' || this.clicked?.(pane, event)) return;
      const face = this.faceAt(pane, this.place(pane, event));
      const chart = face < 0 ? NO_CHART : this.geometry.faceCharts[face];
      this.choose(chart === this.chosen ? NO_CHART : chart);
    };
    box.addEventListener('pointerup', up);
    box.addEventListener('pointercancel', up);
    box.addEventListener('pointerleave', () => {
      if (!this.geometry || this.hovered === NO_CHART) return;
      this.hovered = NO_CHART;
      this.#hideDots();
      this.#tell();
      this.redraw();
    });
    box.addEventListener('wheel', (event) => {
      if (!this.geometry) return;
      event.preventDefault();
      pane.camera.magnify(2 ** (-event.deltaY * (event.deltaMode === 1 ? 20 : 1) / 400), this.place(pane, event));
      this.#moved();
    }, { passive: false });
    box.addEventListener('dblclick', () => this.geometry && this.frameChart());
    box.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  #drag(pane, event) {
    const { pointers, camera, box } = pane, pointer = pointers.get(event.pointerId), place = this.place(pane, event);
    if (pointer.still && Math.hypot(event.clientX - pointer.start[0], event.clientY - pointer.start[1]) <= CLICK) return;
    for (const one of pointers.values()) one.still = false;
    const step = place.map((value, k) => value - pointer.at[k]);
    if (pointers.size > 1) { // two fingers move and magnify
      const [a, b] = [...pointers.values()], apart = () => Math.hypot((a.at[0] - b.at[0]) * box.clientWidth, (a.at[1] - b.at[1]) * box.clientHeight);
      const before = apart();
      pointer.at = place;
      camera.magnify(apart() / Math.max(before, 1), [(a.at[0] + b.at[0]) / 2, (a.at[1] + b.at[1]) / 2]);
      camera.move(step[0] / 2, step[1] / 2);
    } else {
      pointer.at = place;
      if (pane.index === 1 || event.buttons & 6 || event.shiftKey) camera.move(...step);
      else camera.turn(step[0] * Math.min(this.#aspect(pane), 1.5) * 1.6, -step[1] * 1.6);
    }
    this.#moved();
  }

  #key(event) {
    if (!this.geometry || event.ctrlKey || event.metaKey || event.altKey || this.keys.open) return;
    const input = event.target.closest?.('input, select, textarea');
    if (input && !(input.type === 'radio' && !event.key.startsWith('Arrow'))) return;
    const pane = this.panes.find(({ box }) => box === document.activeElement), camera = (pane ?? this.panes[0]).camera;
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const actions = {
      w: () => this.toggle('wire'), s: () => this.toggle('seams'), n: () => this.#step(1), p: () => this.#step(-1), b: () => this.#worst(),
      f: () => this.frameChart(), Escape: () => this.choose(NO_CHART), '?': () => this.keys.showModal(),
      '+': () => camera.magnify(1.25), '=': () => camera.magnify(1.25), '-': () => camera.magnify(0.8), 0: () => this.panes.forEach((one) => one.camera.reset()),
    };
    MODES.forEach((mode, i) => { actions[i + 1] = () => this.setMode(mode); });
    if (pane && arrows[key]) {
      const [x, y] = arrows[key];
      if (pane.index === 1) camera.move(-0.12 * x, -0.12 * y);
      else camera.turn(0.15 * x, -0.15 * y);
    } else if (Object.hasOwn(actions, key)) {
      actions[key]();
    } else {
      return;
    }
    event.preventDefault();
    if (arrows[key] || '+=-0'.includes(key)) this.#moved();
  }
}
