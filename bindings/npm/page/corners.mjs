// Corners of a mesh, counted face after face.

/** The face of each corner. */
export function facesOfCorners({ indices, faceSizes }) {
  if (!faceSizes) return Uint32Array.from(indices, (_, corner) => Math.floor(corner / 3));
  const faces = new Uint32Array(indices.length);
  let at = 0;
  faceSizes.forEach((size, face) => faces.fill(face, at, at += size));
  return faces;
}
