// Seams that are opened and closed by clicks: what the pointer is at, and what a click asks of the worker.
import { projected } from './viewer/cameras.mjs';
import { Edges } from './edges.mjs';

/** Pixels from an edge within which a click means it. */
const REACH = 14;

export class SeamEditor {
  /** `ask`: what a click wants, as arrays of vertices by pairs: {open, close}. */
  constructor(viewer, mesh, triangles, ask) {
    this.viewer = viewer;
    this.ask = ask;
    this.edges = new Edges(mesh, triangles);
    /** Seams that were asked for, for they cut nothing until they meet others. */
    this.asked = new Set();
    this.undone = []; // what was asked for before each edit
    this.last = null;
    this.lines = viewer.panes.map(({ box }) => {
      const line = document.createElement('i');
      line.className = 'page-edge';
      line.hidden = true;
      box.append(line);
      return line;
    });
    this.listeners = new AbortController();
    const { signal } = this.listeners;
    for (const pane of viewer.panes) {
      pane.box.addEventListener('pointermove', (event) => this.#show(pane, viewer.place(pane, event)), { signal });
      pane.box.addEventListener('pointerleave', () => this.hide(), { signal });
      pane.box.addEventListener('focus', () => pane.box.matches(':focus-visible') && this.#show(pane, [0, 0]), { signal });
      pane.box.addEventListener('keydown', (event) => this.#key(pane, event), { signal });
    }
    viewer.clicked = (pane, event) => this.#click(this.#edgeAt(pane, viewer.place(pane, event)), event.shiftKey);
  }

  end() {
    this.listeners.abort();
    this.viewer.clicked = null;
    for (const line of this.lines) line.remove();
  }

  hide() { for (const line of this.lines) line.hidden = true; }

  /** Arrows move what is shown under the middle of a panel; Enter is a click there. */
  #key(pane, event) {
    if (event.key === 'Enter') this.#click(this.#edgeAt(pane, [0, 0]), event.shiftKey);
    requestAnimationFrame(() => requestAnimationFrame(() => this.#show(pane, [0, 0])));
  }

  /** The places of the ends of a triangle's side on a panel, in pixels. */
  #ends(pane, triangle, k) {
    const { geometry, views } = this.viewer, { positions, uvs, faces, low, size } = geometry, view = views[pane.index];
    return [k, (k + 1) % 3].map((corner) => {
      const v = faces[3 * triangle + corner];
      const place = pane.index === 1 ? [uvs[2 * v], uvs[2 * v + 1]] : [0, 1, 2].map((d) => (positions[3 * v + d] - low[d]) / size[d]);
      return this.viewer.onPane(projected(view.matrix, place), view);
    });
  }

  /** The side of the triangle at a place of a panel that is nearest to it. */
  #edgeAt(pane, place) {
    const triangle = this.viewer.faceAt(pane, place);
    if (triangle < 0) return null;
    const view = this.viewer.views[pane.index], [x, y] = this.viewer.onPane(place, view);
    let best = null;
    this.edges.sidesOf(triangle).forEach((corner, k) => {
      if (corner === null) return;
      const [[ax, ay], [bx, by]] = this.#ends(pane, triangle, k), dx = bx - ax, dy = by - ay;
      const along = Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1), 0), 1);
      const away = Math.hypot(ax + along * dx - x, ay + along * dy - y);
      if (away <= REACH && (best === null || away < best.away)) best = { edge: this.edges.numberOf(corner), triangle, k, away };
    });
    return best;
  }

  #show(pane, place) {
    const found = this.viewer.views?.length ? this.#edgeAt(pane, place) : null;
    this.hide();
    if (!found || this.edges.isBorder(found.edge)) return;
    this.viewer.panes.forEach((other, i) => {
      const [[ax, ay], [bx, by]] = this.#ends(other, found.triangle, found.k), line = this.lines[i];
      line.hidden = false;
      line.style.width = `${Math.hypot(bx - ax, by - ay)}px`;
      line.style.transform = `translate(${ax}px, ${ay}px) rotate(${Math.atan2(by - ay, bx - ax)}rad)`;
    });
  }

  #isOpen(edge) { return this.asked.has(edge) || this.edges.isCut(edge, this.cornerUvs); }

  #click(found, isPath) {
    if (!found || this.edges.isBorder(found.edge) || !this.cornerUvs) return found !== null;
    const { edge } = found, closes = !isPath && this.#isOpen(edge);
    const some = isPath && this.last !== null ? this.edges.path(this.last, edge) : new Set([edge]);
    const now = [...some].filter((one) => !this.edges.isBorder(one) && this.#isOpen(one) === closes);
    this.last = edge;
    this.undone.push(new Set(this.asked));
    for (const one of now) if (closes) this.asked.delete(one); else this.asked.add(one);
    const pairs = this.edges.pairsOf(now), none = new Uint32Array();
    this.cornerUvs = null; // until the worker answers
    this.ask(closes ? { open: none, close: pairs } : { open: pairs, close: none });
    return true;
  }

  /** After the worker has taken an edit back, or has refused it. */
  takeBack() {
    this.asked = this.undone.pop() ?? this.asked;
    this.last = null;
  }

  /** Sides that are seams which cut nothing yet, as the viewer's geometry numbers them. */
  marked(cornerUvs) {
    this.cornerUvs = cornerUvs;
    const sides = [], { triangles } = this.edges;
    if (this.asked.size === 0) return sides;
    for (let t = 0; t < triangles.length / 3; ++t) {
      this.edges.sidesOf(t).forEach((corner, k) => {
        if (corner === null) return;
        const edge = this.edges.numberOf(corner);
        if (this.asked.has(edge) && !this.edges.isCut(edge, cornerUvs)) sides.push(3 * t + k);
      });
    }
    return sides;
  }

  /** Length of all edges whose sides are apart, or have none. */
  seamLength(cornerUvs) {
    let sum = 0;
    for (const edge of this.edges.sides.keys()) if (!this.edges.isBorder(edge) && this.edges.isCut(edge, cornerUvs)) sum += this.edges.lengthOf(edge);
    return sum;
  }
}
