"""Checks of any atlas, whoever made it, and the triangles of polygons."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from . import _arrays, _polygons, _surfaces
from ._arrays import Array
from ._cancel import CancelToken
from ._polygons import Faces
from ._surfaces import Surface
from ._tables import AtlasCertificate


@dataclass(frozen=True, eq=False)
class AtlasCheck(AtlasCertificate):
    """The exact verdict on an atlas, with faces that overlap. It equals itself only.

    Attributes
    ----------
    pairs : (k, 2) array of int64
        Faces that overlap, the lesser first, each pair once and in order; of a polygon whose own
        triangles overlap the face twice.
    """

    pairs: Array = field(default_factory=lambda: np.empty((0, 2), np.int64), repr=False)


def check_atlas(
    vertices: npt.ArrayLike,
    faces: Faces,
    corner_uvs: npt.ArrayLike,
    allow_mirrored: bool = False,
    *,
    most_pairs: int = 1000,
    cancel: CancelToken | None = None,
) -> AtlasCheck:
    """Judge the UVs of an atlas, by exact predicates on the very numbers given.

    Charts are the triangles joined by edges with the same UVs on both sides. Triangles without area
    on the surface are not judged, and triangles that disagree in orientation with their chart are
    turned over, for a winding that changes is no fold.

    Parameters
    ----------
    vertices : (n, 3) array_like of floats
        Positions; float32 and float64 are read in place.
    faces : (m, k) array_like of integers, or sequence of polygons
        Vertex numbers from 0, as for `unwrap`.
    corner_uvs : (m, k, 2) array_like of floats
        A (u, v) for each corner of each face, or (c, 2) of all corners, face after face. Judged as
        stored. UVs of vertices are ``uv[faces]``.
    allow_mirrored : bool
        True takes charts that are negative as a whole for their mirror images.
    most_pairs : int
        How many overlaps of triangles are looked at for `pairs`, at most.
    cancel : CancelToken, optional
        Ends the call from any thread.

    Returns
    -------
    AtlasCheck
        True where every triangle is positive, and no two have a common inner point, in one chart or
        in two. Else the counts and `pairs` say what is wrong, and where.

    Raises
    ------
    MeshError
        `IndexOutOfRangeError`, `NonFiniteError` (a vertex or a UV), with the element.
    TypeError, ValueError
        For arrays of other shapes or types.
    Cancelled, KeyboardInterrupt
        By `cancel`; on Ctrl-C, in the main thread.
    OutOfMemoryError
        As its name says.

    Examples
    --------
    Two triangles at the same place of the page:

    >>> vertices = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> uvs = [[[0.0, 0], [1, 0], [0, 1]], [[0.1, 0.1], [0.6, 0.1], [0.1, 0.6]]]
    >>> check = beltrami.check_atlas(vertices, [[0, 1, 2], [0, 3, 1]], uvs)
    >>> bool(check), check.overlaps, check.pairs.tolist()
    (False, 1, [[0, 1]])
    """
    if most_pairs < 0:
        raise ValueError(f"most_pairs is {most_pairs}: give 0 or more")
    points = _arrays.positions(vertices)
    polygons = _polygons.polygons(faces, len(points))
    surface = Surface(points, polygons, _polygons.corner_uvs(corner_uvs, polygons))
    found, pairs = _surfaces.check(surface, allow_mirrored, most_pairs, cancel)
    fields = {f.name: getattr(found, f.name) for f in dataclasses.fields(found)}
    return AtlasCheck(**fields, pairs=pairs)


@dataclass(frozen=True, eq=False)
class Triangulation:
    """The triangles of polygons. It equals itself only.

    Attributes
    ----------
    triangles : (t, 3) array of integers
        Vertex numbers, n - 2 triangles for a face of n corners, those of one face after another.
    corners : (t, 3) array of int64
        The same as corners, which are counted from 0, face after face.
    face_of_triangle : (t,) array of int64
        The face that each is a part of.
    first_repeating : int | None
        The first face that names a vertex twice, or that cannot be cut without repeating an edge.
    """

    triangles: Array = field(repr=False)
    corners: Array = field(repr=False)
    face_of_triangle: Array = field(repr=False)
    first_repeating: int | None


def triangulate(vertices: npt.ArrayLike, faces: Faces) -> Triangulation:
    """Cut polygons into triangles as `unwrap` does: by ears, the best-shaped first.

    Parameters
    ----------
    vertices : (n, 3) array_like of floats
        Positions; float32 and float64 are read in place.
    faces : (m, k) array_like of integers, or sequence of polygons
        Vertex numbers from 0, as for `unwrap`.

    Returns
    -------
    Triangulation
        For every face of n corners n - 2 triangles.

    Raises
    ------
    IndexOutOfRangeError, MeshError, TypeError, ValueError, OutOfMemoryError
        As `check_atlas` does.

    Examples
    --------
    >>> vertices = [[0.0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0], [3, 0, 0]]
    >>> found = beltrami.triangulate(vertices, [[0, 1, 2, 3], [1, 4, 2]])
    >>> len(found.triangles), found.face_of_triangle.tolist()
    (3, [0, 0, 1])
    """
    points = _arrays.positions(vertices)
    polygons = _polygons.polygons(faces, len(points))
    corners, repeating = _surfaces.triangulate(Surface(points, polygons))
    numbers = np.arange(len(polygons))
    sizes = 3 if polygons.sizes is None else polygons.sizes
    triangles = polygons.indices.ravel()[corners]
    return Triangulation(triangles, corners, np.repeat(numbers, sizes - 2), repeating)
