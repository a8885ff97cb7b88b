"""Faces with any number of corners, and what users have for each face or corner of them.

A corner is one vertex of one face. Corners are counted from 0, face after face.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _arrays
from ._arrays import Array

#: Faces as users have them: (m, k) integers, or one sequence of vertex numbers for each face.
Faces = Union[npt.ArrayLike, Sequence[Sequence[int]], Sequence[Array]]

# So many quads around one vertex are none: the 3 that each begins with is a count.
_MANY_FACES = 12


@dataclass(frozen=True, eq=False)
class Polygons:
    """The corners of all faces.

    Attributes
    ----------
    indices : (m, 3) or (c,) array of integers
        Of triangles the rows, which the library reads in place; else the vertex of each corner.
    sizes : (m,) array of int64 | None
        How many corners each face has; None where all are triangles.
    columns : int | None
        Corners of every face, where they were given as an array; None for a list of faces.
    """

    indices: Array
    sizes: Array | None
    columns: int | None

    def __len__(self) -> int:
        return len(self.indices) if self.sizes is None else len(self.sizes)

    @property
    def corner_count(self) -> int:
        """The number of corners of all faces."""
        return self.indices.size

    def ends(self) -> Array:
        """Return the end of the corners of each face, (m,)."""
        sizes = np.full(len(self), 3) if self.sizes is None else self.sizes
        ends: Array = np.cumsum(sizes)
        return ends

    def face(self, number: int) -> Array:
        """Return the vertices of a face."""
        if self.sizes is None:
            triangle: Array = self.indices[number]
            return triangle
        end = int(self.ends()[number])
        face: Array = self.indices[end - int(self.sizes[number]) : end]
        return face

    def shaped(self, of_corners: Array) -> Array | list[Array]:
        """Return what there is for each corner, (c,), in the shape of the faces as given."""
        if self.columns is not None:
            return of_corners.reshape(-1, self.columns)
        return np.split(of_corners, self.ends()[:-1])


def polygons(faces: Any, vertices: int) -> Polygons:
    """Return faces of so many vertices as the library reads them. Raises TypeError, ValueError."""
    if isinstance(faces, (list, tuple)):
        listed = _listed(faces)
        if listed is not None:
            return listed
    array = np.asarray(faces)
    if array.dtype.kind == "O" and array.ndim == 1:
        listed = _listed(array.tolist())
        if listed is not None:
            return listed
    if array.ndim != 2 or array.shape[1] <= 3 or array.dtype.kind not in "iu":
        return Polygons(_arrays.indices(faces), None, 3)
    if array.shape[1] == 4 and len(array) > _MANY_FACES and (array[:, 0] == 3).all():
        raise ValueError("faces begin with the counts of VTK: give faces[:, 1:]")
    if len(array) == 3 and array.shape[1] > vertices:
        raise ValueError(
            f"faces has the shape {array.shape}, and no polygon has {array.shape[1]} corners "
            f"where there are {vertices} vertices: give faces.T"
        )
    array = array.astype(f"={array.dtype.kind}{max(array.dtype.itemsize, 4)}", copy=False)
    rows, columns = array.shape
    return Polygons(np.ascontiguousarray(array).ravel(), np.full(rows, columns), columns)


def _listed(faces: Sequence[Any]) -> Polygons | None:
    """Return a list of faces of several sizes; None for what is none."""
    try:
        sizes = np.fromiter(map(len, faces), np.int64, len(faces))
    except TypeError:
        return None
    if len(sizes) == 0 or (sizes == sizes[0]).all():
        return None
    if sizes.min() < 3:
        face = int(sizes.argmin())
        raise ValueError(f"face {face} has {sizes[face]} corners: a face has 3 or more")
    if all(isinstance(face, np.ndarray) for face in faces):
        flat = np.concatenate(faces)
    else:
        flat = np.array(list(chain.from_iterable(faces)))
    if flat.ndim != 1 or flat.dtype.kind not in "iu":
        raise TypeError(f"faces must be sequences of whole numbers, not of {flat.dtype}")
    flat = flat.astype(f"={flat.dtype.kind}{max(flat.dtype.itemsize, 4)}", copy=False)
    return Polygons(flat, sizes, None)


# ---- What there is for each corner, face, edge --------------------------------------------


def corner_uvs(values: Any, faces: Polygons) -> Array:
    """Return UVs of corners as a (c, 2) array. Raises TypeError, ValueError."""
    if isinstance(values, (list, tuple)) and faces.columns is None:
        values = np.concatenate([np.asarray(of_face) for of_face in values])
    array = np.asarray(values)
    count = faces.corner_count
    if array.shape == (len(faces), faces.columns, 2):
        array = array.reshape(-1, 2)
    elif array.shape != (count, 2):
        shape = f"({count}, 2)"
        if faces.columns is not None:
            shape = f"({len(faces)}, {faces.columns}, 2), a UV for each corner of each face"
        hint = ": of UVs per vertex, give uv[faces]" if array.ndim == 2 else ""
        raise ValueError(f"corner_uvs must have the shape {shape}, not {array.shape}{hint}")
    return _arrays.coordinates(array)


def labels(values: Any, faces: Polygons, name: str = "face_labels") -> Array:
    """Return a number for each face, (m,), equal where the labels are. Raises ValueError."""
    array = _of_faces(name, np.asarray(values), faces)
    if array.dtype.kind not in "iu":
        array = np.unique(array, return_inverse=True)[1]
    size = max(array.dtype.itemsize, 4)
    return np.ascontiguousarray(array.astype(f"={array.dtype.kind}{size}", copy=False))


def densities(values: Any, faces: Polygons) -> Array:
    """Return a float for each face, (m,). Raises TypeError, ValueError."""
    array = _of_faces("densities", np.asarray(values), faces)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"densities must be real numbers, not {array.dtype}")
    return np.ascontiguousarray(array, np.float64)


def seams(values: Any, name: str = "seams") -> Array:
    """Return pairs of vertices, (k, 2). Raises TypeError, ValueError."""
    array = np.asarray(list(values) if isinstance(values, (set, frozenset)) else values)
    if array.size == 0:
        return np.empty((0, 2), np.int64)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} must be pairs of vertex numbers, not {array.dtype}")
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"{name} must have the shape (k, 2), not {array.shape}")
    size = max(array.dtype.itemsize, 4)
    return np.ascontiguousarray(array.astype(f"={array.dtype.kind}{size}", copy=False))


def vertex_paint(values: Any, vertices: int) -> Array:
    """Return a float for each vertex, (n,). Raises TypeError, ValueError."""
    array = np.asarray(values)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"vertex_paint must be real numbers, not {array.dtype}")
    if array.shape != (vertices,):
        raise ValueError(
            f"vertex_paint must have the shape ({vertices},), one for each vertex, "
            f"not {array.shape}"
        )
    return np.ascontiguousarray(array, np.float64)


def edge_paint(values: Any) -> tuple[Array, Array]:
    """Return edges (k, 2) and a float for each, (k,). Raises TypeError, ValueError."""
    if not isinstance(values, tuple) or len(values) != 2:
        raise TypeError("edge_paint is a pair: edges by their vertices, and their factors")
    edges = seams(values[0], "the edges of edge_paint")
    factors = np.asarray(values[1], np.float64)
    if factors.shape != (len(edges),):
        raise ValueError(
            f"the factors of edge_paint must have the shape ({len(edges)},), not {factors.shape}"
        )
    return edges, np.ascontiguousarray(factors)


def pins(values: Any, faces: Polygons) -> tuple[Array, Array]:
    """Return corners (k,) and their UVs (k, 2). Raises TypeError, ValueError."""
    if not isinstance(values, tuple) or len(values) != 2:
        raise TypeError("pins are a pair: the numbers of corners, and their UVs")
    corners, uvs = np.asarray(values[0]), np.asarray(values[1], np.float64)
    if corners.size == 0 and uvs.size == 0:
        return np.empty(0, np.uint64), np.empty((0, 2))
    if corners.dtype.kind not in "iu" or corners.ndim != 1:
        raise TypeError(f"the corners of pins must be (k,) integers, not {corners.dtype}")
    if uvs.shape != (len(corners), 2):
        raise ValueError(
            f"the UVs of pins must have the shape ({len(corners)}, 2), not {uvs.shape}"
        )
    odd = np.flatnonzero((corners < 0) | (corners >= faces.corner_count))
    if len(odd):
        raise ValueError(
            f"pin {odd[0]} names corner {corners[odd[0]]}, but there are {faces.corner_count}"
        )
    return np.ascontiguousarray(corners, np.uint64), np.ascontiguousarray(uvs)


def _of_faces(name: str, array: Array, faces: Polygons) -> Array:
    if array.shape != (len(faces),):
        raise ValueError(
            f"{name} must have the shape ({len(faces)},), one for each face, not {array.shape}"
        )
    return array
