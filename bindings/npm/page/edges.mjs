// Edges of a mesh as an editor of seams sees them: vertices at one place are one.
import { facesOfCorners } from './corners.mjs';

export class Edges {
  /** `triangles`: three corners each, of which the mesh's polygons are made. */
  constructor(mesh, triangles) {
    this.mesh = mesh;
    this.triangles = triangles;
    this.vertices = this.#welded();
    const faces = facesOfCorners(mesh);
    let first = 0; // of the face
    /** The corner after each, around its face. */
    this.next = Uint32Array.from(mesh.indices, (_, corner) => {
      if (faces[corner + 1] === faces[corner]) return corner + 1;
      const back = first;
      first = corner + 1;
      return back;
    });
    /** By the number of an edge, the corners from which its sides go. */
    this.sides = new Map();
    /** By a vertex, the edges at it. */
    this.around = new Map();
    for (let corner = 0; corner < this.next.length; ++corner) this.#add(corner);
  }

  #welded() {
    const { positions } = this.mesh, known = new Map(), first = new Uint32Array(positions.length / 3);
    for (let v = 0; v < first.length; ++v) {
      const place = `${positions[3 * v]} ${positions[3 * v + 1]} ${positions[3 * v + 2]}`;
      if (!known.has(place)) known.set(place, v);
      first[v] = known.get(place);
    }
    return Uint32Array.from(this.mesh.indices, (vertex) => first[vertex]);
  }

  #add(corner) {
    const edge = this.numberOf(corner), ends = this.endsOf(corner);
    if (!this.sides.has(edge)) {
      this.sides.set(edge, []);
      for (const end of ends) {
        if (!this.around.has(end)) this.around.set(end, []);
        this.around.get(end).push(edge);
      }
    }
    this.sides.get(edge).push(corner);
  }

  /** The vertices of the side that goes from a corner. */
  endsOf(corner) { return [this.vertices[corner], this.vertices[this.next[corner]]]; }

  numberOf(corner) {
    const [a, b] = this.endsOf(corner);
    return Math.min(a, b) * 2 ** 26 + Math.max(a, b);
  }

  /** The corners from which the three sides of a triangle go; null for those inside a polygon. */
  sidesOf(triangle) {
    return [0, 1, 2].map((k) => {
      const a = this.triangles[3 * triangle + k], b = this.triangles[3 * triangle + (k + 1) % 3];
      return this.next[a] === b ? a : this.next[b] === a ? b : null;
    });
  }

  isBorder(edge) { return this.sides.get(edge).length === 1; }

  /** Whether the UVs of its sides differ. */
  isCut(edge, cornerUvs) {
    const [first, ...others] = this.sides.get(edge), [a] = this.endsOf(first);
    const at = (side, vertex) => {
      const corner = this.vertices[side] === vertex ? side : this.next[side];
      return [cornerUvs[2 * corner], cornerUvs[2 * corner + 1]];
    };
    const [, b] = this.endsOf(first);
    return others.some((side) => [a, b].some((vertex) => at(side, vertex).some((x, k) => x !== at(first, vertex)[k])));
  }

  lengthOf(edge) {
    const [a, b] = this.endsOf(this.sides.get(edge)[0]), { positions } = this.mesh;
    return Math.hypot(...[0, 1, 2].map((k) => positions[3 * b + k] - positions[3 * a + k]));
  }

  /** Pairs of vertices of the mesh. */
  pairsOf(edges) {
    return Uint32Array.from([...edges].flatMap((edge) => {
      const [corner] = this.sides.get(edge);
      return [this.mesh.indices[corner], this.mesh.indices[this.next[corner]]];
    }));
  }

  /** The edges of a shortest path between the ends of two, with both. */
  path(from, to) {
    const ends = (edge) => this.endsOf(this.sides.get(edge)[0]), goals = new Set(ends(to));
    const distance = new Map(ends(from).map((vertex) => [vertex, 0])), by = new Map(), done = new Set();
    const heap = ends(from).map((vertex) => [0, vertex]); // a binary heap by distance
    const push = (item) => {
      let i = heap.push(item) - 1;
      for (; i > 0 && heap[(i - 1) >> 1][0] > item[0]; i = (i - 1) >> 1) heap[i] = heap[(i - 1) >> 1];
      heap[i] = item;
    };
    const pop = () => {
      const [top] = heap, last = heap.pop();
      if (heap.length === 0) return top;
      let i = 0;
      for (let child; (child = 2 * i + 1) < heap.length; i = child) {
        if (child + 1 < heap.length && heap[child + 1][0] < heap[child][0]) ++child;
        if (heap[child][0] >= last[0]) break;
        heap[i] = heap[child];
      }
      heap[i] = last;
      return top;
    };
    while (heap.length > 0) {
      const [far, vertex] = pop();
      if (done.has(vertex)) continue;
      done.add(vertex);
      if (goals.has(vertex)) {
        const found = [from, to];
        for (let v = vertex; by.has(v);) {
          found.push(by.get(v));
          const [a, b] = ends(by.get(v));
          v = a === v ? b : a;
        }
        return new Set(found);
      }
      for (const edge of this.around.get(vertex)) {
        const [a, b] = ends(edge), other = a === vertex ? b : a, reached = far + this.lengthOf(edge);
        if (reached >= (distance.get(other) ?? Infinity)) continue;
        distance.set(other, reached);
        by.set(other, edge);
        push([reached, other]);
      }
    }
    return new Set([from, to]);
  }
}
