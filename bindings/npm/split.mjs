// From an atlas to vertex buffers, whose vertices are copied along seams.

/**
 * Vertices for corners, one for each pair of a vertex and a UV vertex: what the atlas welded stays apart, for normals
 * may differ. Returns of each new vertex the old one, its UV vertex and the first of its corners, and of each corner
 * the new vertex.
 */
export function splitVertices(vertices, uvVertices) {
  const origins = [], uvs = [], firsts = [], corners = new Uint32Array(vertices.length);
  const last = new Map(), before = []; // of an old vertex the new one that was made last, and of that the one before
  for (let corner = 0; corner < vertices.length; ++corner) {
    const origin = vertices[corner], uv = uvVertices[corner];
    let vertex = last.get(origin);
    while (vertex !== undefined && uvs[vertex] !== uv) vertex = before[vertex];
    if (vertex === undefined) {
      vertex = origins.length;
      before.push(last.get(origin));
      last.set(origin, vertex);
      origins.push(origin);
      uvs.push(uv);
      firsts.push(corner);
    }
    corners[corner] = vertex;
  }
  return { origins, uvs, firsts, corners };
}

/** The items of an array of `width` numbers each that are named, as an array of the same type. */
export function gathered(array, width, items) {
  const made = new array.constructor(width * items.length);
  for (let i = 0; i < items.length; ++i) {
    for (let k = 0; k < width; ++k) made[width * i + k] = array[width * items[i] + k];
  }
  return made;
}
