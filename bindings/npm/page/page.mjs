// The page: a mesh goes in, is unwrapped by a worker, is looked at, and comes out with UVs.
import { Viewer } from './viewer/viewer.mjs';
import { FileError, readMesh } from './read.mjs';
import { SeamEditor } from './seams.mjs';
import { arraysOf, editedAtlas, example, reportOf, writeReport } from './shown.mjs';
import { writeGlb, writeObj } from './write.mjs';

/** Milliseconds that the slider rests before a run begins. */
const REST = 300;
/** The slider goes by the logarithm of the energy above 2, which no map is below. */
const LEAST_EXCESS = 0.01, MOST_EXCESS = 0.6;
const EDITING = 'Click an edge, or press Enter, to open or close a seam there. With Shift the shortest path from the last one opens.';

const make = (name, attributes = {}, ...children) => {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) made.addEventListener(key.slice(2), value);
    else if (value !== false) made.setAttribute(key, value === true ? '' : value);
  }
  made.append(...children);
  return made;
};
const button = (words, act, more = {}) => make('button', { type: 'button', onclick: act, ...more }, words);

class Page {
  constructor(root) {
    this.root = root;
    this.viewer = new Viewer(root);
    this.file = make('input', { type: 'file', accept: '.obj,.stl,.ply,.glb', hidden: true, onchange: () => this.open(this.file.files[0]) });
    this.slider = make('input', { type: 'range', min: '0', max: '1', step: '0.005', 'aria-label': 'Distortion that is aimed at', oninput: () => this.#slid() });
    this.slider.value = String(Math.log(0.05 / LEAST_EXCESS) / Math.log(MOST_EXCESS / LEAST_EXCESS));
    this.aimed = make('output');
    this.effort = make('select', { onchange: () => this.#later() }, ...['quick', 'normal', 'high'].map((word) => make('option', {}, word)));
    this.size = make('select', { onchange: () => this.#later() }, ...[512, 1024, 2048, 4096].map((side) => make('option', side === 1024 ? { selected: true } : {}, String(side))));
    this.progress = make('progress', { max: '1', value: '0', 'aria-label': 'Progress' });
    this.stage = make('span');
    this.running = make('div', { class: 'page-run', hidden: true }, this.progress, this.stage, button('Cancel', () => this.cancel()));
    this.fault = make('div', { class: 'page-fault', role: 'alert', hidden: true });
    this.downloads = ['OBJ', 'GLB', 'Report'].map((kind) => button(kind, () => this.download(kind), { disabled: true, 'aria-label': `Download ${kind}` }));
    this.edit = button('Edit seams', () => this.editSeams(), { disabled: true, 'aria-pressed': 'false' });
    this.undo = button('Undo', () => this.takeBack(), { disabled: true });
    const bar = make('div', { class: 'page-bar' },
      button('Open…', () => this.file.click(), { class: 'main' }), this.file,
      make('label', {}, 'Distortion', this.slider, this.aimed), make('label', {}, 'Effort', this.effort), make('label', {}, 'Texture', this.size),
      make('span', { class: 'page-gap' }), this.running, this.edit, this.undo, make('label', {}, 'Download', ...this.downloads));
    this.drop = make('div', { class: 'page-drop' }, make('h2', {}, 'Drop a mesh here'),
      make('p', {}, 'OBJ, STL, PLY or GLB. It is cut, flattened and packed in this browser: nothing is sent anywhere.'),
      make('div', {}, button('Choose a file…', () => this.file.click(), { class: 'main' }), button('Try an example', () => this.take('knot', example()))));
    this.viewer.bar.after(bar, this.fault);
    this.viewer.panels.append(this.drop);
    this.viewer.title.textContent = 'Unwrap a mesh';
    this.#tell();
    this.#listen();
  }

  #listen() {
    addEventListener('keydown', (event) => {
      if (event.key !== 'z' || !(event.ctrlKey || event.metaKey) || this.undo.disabled) return;
      event.preventDefault();
      this.takeBack();
    });
    const over = (on) => (event) => {
      event.preventDefault();
      this.root.classList.toggle('page-over', on);
    };
    addEventListener('dragover', over(true));
    addEventListener('dragleave', over(false));
    addEventListener('drop', (event) => {
      over(false)(event);
      this.open(event.dataTransfer.files[0]);
    });
  }

  get target() { return 2 + LEAST_EXCESS * (MOST_EXCESS / LEAST_EXCESS) ** Number(this.slider.value); }

  #tell() { this.aimed.textContent = this.target.toFixed(3); }

  #slid() {
    this.#tell();
    this.#later();
  }

  #later() {
    clearTimeout(this.waiting);
    if (this.mesh) this.waiting = setTimeout(() => this.unwrap(), REST);
  }

  #fail(message) {
    this.fault.hidden = message === '';
    this.fault.textContent = message;
  }

  async open(file) {
    this.file.value = '';
    if (!file) return;
    try {
      this.take(file.name, readMesh(file.name, await file.arrayBuffer()));
    } catch (error) {
      this.#fail(error instanceof FileError ? error.message : `${file.name} cannot be read: ${error.message}`);
    }
  }

  take(name, mesh) {
    this.name = name;
    this.mesh = mesh;
    this.unwrap();
  }

  cancel() {
    this.worker?.terminate();
    this.worker = null;
    clearTimeout(this.waiting);
    this.running.hidden = true;
    this.#endEditing();
  }

  #endEditing() {
    this.seams?.end();
    this.seams = null;
    this.edit.setAttribute('aria-pressed', 'false');
    this.undo.disabled = true;
  }

  /** Has a new worker do something; its answers come to `answer`. */
  #start(what, options, cornerUvs) {
    this.cancel();
    this.edited = null;
    this.#fail('');
    this.running.hidden = false;
    this.progress.value = 0;
    this.stage.textContent = 'starting';
    const { positions, indices, faceSizes } = this.mesh;
    this.worker = new Worker(new URL('./worker.mjs', import.meta.url), { type: 'module' });
    this.worker.onmessage = ({ data }) => this.#answer(data);
    this.worker.onerror = (event) => {
      this.cancel();
      this.#fail(`This browser cannot run the library: ${event.message || 'it wants WebAssembly with SIMD and exceptions'}.`);
    };
    this.worker.postMessage({ what, surface: { positions, indices, ...(faceSizes ? { faceSizes } : {}), ...(cornerUvs ? { cornerUvs } : {}) }, options });
  }

  unwrap() {
    this.#start('unwrap', { targetEnergy: this.target, effort: this.effort.value, resolution: Number(this.size.value), float32: true });
  }

  /** Begins to edit what is shown, or ends it; what was edited stays. */
  editSeams() {
    if (this.seams) {
      this.cancel();
      return;
    }
    const { atlas } = this, onPlane = atlas.cornerUvs.slice();
    atlas.cornerPages.forEach((page, corner) => {
      onPlane[2 * corner] += page % 10;
      onPlane[2 * corner + 1] += Math.floor(page / 10);
    });
    this.#start('begin', { effort: 'quick', resolution: Number(this.size.value), float32: true }, onPlane);
    this.seams = new SeamEditor(this.viewer, this.mesh, atlas.triangles, (edit) => this.#askWorker({ what: 'seams', ...edit }));
    this.edit.setAttribute('aria-pressed', 'true');
  }

  takeBack() {
    this.seams.takeBack();
    this.#askWorker({ what: 'undo' });
  }

  #askWorker(message) {
    this.#fail('');
    this.undo.disabled = true;
    this.worker.postMessage(message);
  }

  #answer({ fraction, stage, atlas, threads, edited, failure }) {
    if (stage !== undefined) {
      this.progress.value = fraction;
      this.stage.textContent = stage;
      return;
    }
    if (edited !== undefined) {
      this.#showEdited(edited);
      return;
    }
    if (failure !== undefined) {
      if (this.seams && this.edited) {
        this.seams.takeBack();
        this.#showEdited(this.edited);
      } else {
        this.cancel();
      }
      this.#fail(`${this.name}: ${failure}`);
      return;
    }
    this.cancel();
    this.root.dataset.threads = String(threads);
    this.unwrapped = { name: this.name, mesh: this.mesh };
    this.drop.remove();
    this.#show(atlas, arraysOf(this.mesh, atlas), false);
    for (const one of [...this.downloads, this.edit]) one.disabled = false;
  }

  #show(atlas, arrays, stays) {
    this.atlas = atlas;
    this.arrays = arrays;
    this.report = reportOf(this.name, atlas);
    this.viewer.show(arrays, this.report, { name: this.name, stays });
    this.root.dataset.shown = String(Number(this.root.dataset.shown ?? 0) + 1);
  }

  #showEdited(edited) {
    const { seams } = this, { cornerUvs } = edited;
    this.running.hidden = true;
    this.edited = edited;
    const { atlas, arrays } = editedAtlas(this.atlas, edited, this.mesh, seams.edges.vertices, seams.seamLength(cornerUvs));
    seams.hide();
    this.#show(atlas, { ...arrays, marked: seams.marked(cornerUvs) }, true);
    this.viewer.about.textContent = EDITING;
    this.undo.disabled = edited.undos === 0;
  }

  async download(kind) {
    const { name, mesh } = this.unwrapped, stem = name.replace(/\.[^.]+$/, '');
    try {
      const [blob, ending] = kind === 'OBJ' ? [new Blob([writeObj(mesh, this.atlas)], { type: 'model/obj' }), 'obj']
        : kind === 'GLB' ? [writeGlb(mesh, this.atlas), 'glb']
          : [await writeReport(await (await fetch(new URL('./viewer/report.html', import.meta.url))).text(), this.arrays, this.report), 'html'];
      const address = URL.createObjectURL(blob), link = make('a', { href: address, download: `${stem}_uv.${ending}` });
      link.click();
      setTimeout(() => URL.revokeObjectURL(address), 60000);
    } catch (error) {
      this.#fail(`${name} cannot be written: ${error.message}`);
    }
  }
}

const root = document.getElementById('viewer');
root.page = new Page(root);
