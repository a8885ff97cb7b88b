"""Checks and measures of any UVs, whoever made them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from . import _arrays, _library
from ._arrays import Array
from ._tables import Certificate, Energy


def check_injective(uv: npt.ArrayLike, faces: npt.ArrayLike) -> Certificate:
    """Judge whether a map is injective, by exact predicates on the very numbers given.

    Parameters
    ----------
    uv : (n, 2) array_like of floats
        Judged as stored: float32 and float64 are read in place.
    faces : (m, 3) array_like of integers
        Counter-clockwise vertex numbers from 0; they must form one oriented disk.

    Returns
    -------
    Certificate
        True where the piecewise linear map is injective: every face positive, and a boundary that
        nowhere meets itself. Else the counts say what is wrong, and where.

    Raises
    ------
    MeshError
        `NotADiskError`, `IndexOutOfRangeError`, `NonFiniteError` (a UV), with the element.
    TypeError, ValueError
        For arrays of other shapes or types.
    OutOfMemoryError
        As its name says.

    Examples
    --------
    >>> uv = [[0.0, 0], [1, 0], [1, 1], [0, 1]]
    >>> bool(beltrami.check_injective(uv, [[0, 1, 2], [0, 2, 3]]))
    True
    >>> uv[3] = [1.0, 0.9]  # folds the second face over the first
    >>> beltrami.check_injective(uv, [[0, 1, 2], [0, 2, 3]]).negative
    1
    """
    return _library.check("injective", *_uv_and_faces(uv, faces))


def check_triangles(uv: npt.ArrayLike, faces: npt.ArrayLike) -> Certificate:
    """Judge the orientation of every face, exactly; any list of triangles will do.

    Parameters
    ----------
    uv : (n, 2) array_like of floats
        Judged as stored: float32 and float64 are read in place.
    faces : (m, 3) array_like of integers
        Vertex numbers from 0. They need not form a disk: UVs of several charts can be judged.

    Returns
    -------
    Certificate
        True where every face is positive. That proves no more, so `injective` stays False.

    Raises
    ------
    IndexOutOfRangeError, NonFiniteError, TypeError, ValueError, OutOfMemoryError
        As `check_injective` does.

    Examples
    --------
    >>> uv = [[0.0, 0], [1, 0], [1, 1], [0, 1]]
    >>> verdict = beltrami.check_triangles(uv, [[0, 1, 2], [0, 3, 2]])
    >>> bool(verdict), verdict.negative, verdict.first_bad_face
    (False, 1, 1)
    """
    return _library.check("triangles", *_uv_and_faces(uv, faces))


def check_boundary(uv: npt.ArrayLike, faces: npt.ArrayLike) -> Certificate:
    """Judge, exactly, whether the image of the boundary is a simple polygon.

    Parameters
    ----------
    uv : (n, 2) array_like of floats
        Judged as stored: float32 and float64 are read in place.
    faces : (m, 3) array_like of integers
        Vertex numbers from 0; they must form one oriented disk.

    Returns
    -------
    Certificate
        True where the boundary nowhere meets itself. That proves no more, so `injective` stays
        False.

    Raises
    ------
    MeshError, TypeError, ValueError, OutOfMemoryError
        As `check_injective` does.

    Examples
    --------
    A quad whose boundary crosses itself:

    >>> uv = [[0.0, 0], [1, 1], [1, 0], [0, 1]]
    >>> verdict = beltrami.check_boundary(uv, [[0, 1, 2], [0, 2, 3]])
    >>> bool(verdict), verdict.boundary_crossings
    (False, 1)
    """
    return _library.check("boundary", *_uv_and_faces(uv, faces))


@dataclass(frozen=True, eq=False)
class Distortion:
    """The distortion of every face of a map, and its means. It equals itself only.

    Attributes
    ----------
    energy : Energy
        Means weighted by area in space, the greatest energy, and how many faces have none.
    singular_values : (m, 2) array of float64
        s1 >= abs(s2) of the map from the surface to the plane, in UV units per unit of length. The
        latter is negative where a face is flipped; both are NaN where it has no area in space.
    symmetric_dirichlet : (m,) array of float64
        1/2 (s1^2 + s2^2 + s1^-2 + s2^-2), at least 2; infinite for flipped and degenerate faces,
        NaN where a face has no area in space.
    symmetric_arap : (m,) array of float64
        (s1 - 1)^2 + (1/s2 - 1)^2, at least 0; the same exceptions.
    """

    energy: Energy
    singular_values: Array = field(repr=False)
    symmetric_dirichlet: Array = field(repr=False)
    symmetric_arap: Array = field(repr=False)

    @property
    def flipped(self) -> Array:
        """An (m,) array of bool: the faces of negative area, as far as rounding can tell.

        `check_triangles` counts them exactly.
        """
        flipped: Array = self.singular_values[:, 1] < 0
        return flipped

    @property
    def area(self) -> Array:
        """An (m,) array of float64: area in the plane over area in space, negative if flipped."""
        area: Array = self.singular_values[:, 0] * self.singular_values[:, 1]
        return area

    @property
    def conformal(self) -> Array:
        """An (m,) array of float64: s1 / s2, 1 where angles are kept, negative if flipped."""
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio: Array = self.singular_values[:, 0] / self.singular_values[:, 1]
        return ratio


def distortion(vertices: npt.ArrayLike, faces: npt.ArrayLike, uv: npt.ArrayLike) -> Distortion:
    """Measure how a map distorts a surface, at the scale of the UVs as given.

    Parameters
    ----------
    vertices : (n, 3) array_like of floats
        Positions; float32 and float64 are read in place.
    faces : (m, 3) array_like of integers
        Vertex numbers from 0. They need not form a disk.
    uv : (n, 2) array_like of floats
        In the unit of length of the positions, for energies that mean something.

    Returns
    -------
    Distortion
        For every face, and in the mean.

    Raises
    ------
    IndexOutOfRangeError, NonFiniteError
        With the face or the vertex.
    TypeError, ValueError
        For arrays of other shapes or types, or of different lengths.
    OutOfMemoryError
        As its name says.

    Examples
    --------
    A square that is drawn to twice its width:

    >>> vertices, uv = [[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0], [2, 0], [2, 1]]
    >>> found = beltrami.distortion(vertices, [[0, 1, 2]], uv)
    >>> found.singular_values.round(6).tolist(), found.area.round(6).tolist()
    ([[2.0, 1.0]], [2.0])
    """
    points, triangles = _arrays.positions(vertices), _arrays.indices(faces)
    coordinates = _arrays.coordinates(uv)
    if len(points) != len(coordinates):
        raise ValueError(f"there are {len(points)} vertices, but {len(coordinates)} UVs")
    energy, values = _library.measure(points, triangles, coordinates)
    return Distortion(energy, values[:, :2], values[:, 2], values[:, 3])


def _uv_and_faces(uv: npt.ArrayLike, faces: npt.ArrayLike) -> tuple[Array, Array]:
    return _arrays.coordinates(uv), _arrays.indices(faces)
