// Just as much of OBJ files as the tests need: triangles and polygons, with UVs or without.
export function readObj(text) {
  const positions = [], uvs = [], indices = [], faceSizes = [], cornerUvs = [];
  for (const line of text.split('\n')) {
    const words = line.trim().split(/\s+/);
    if (words[0] === 'v') positions.push(...words.slice(1, 4).map(Number));
    if (words[0] === 'vt') uvs.push(words.slice(1, 3).map(Number));
    if (words[0] !== 'f') continue;
    faceSizes.push(words.length - 1);
    for (const corner of words.slice(1)) {
      const [vertex, uv] = corner.split('/');
      indices.push(Number(vertex) - 1);
      if (uv) cornerUvs.push(...uvs[Number(uv) - 1]);
    }
  }
  return {
    positions: new Float64Array(positions),
    indices: new Uint32Array(indices),
    faceSizes: new Uint32Array(faceSizes),
    ...(cornerUvs.length ? { cornerUvs: new Float64Array(cornerUvs) } : {}),
  };
}
