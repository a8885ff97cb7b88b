"""Pins that slide, straight edges and rectangles, as the library takes them."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _polygons
from ._arrays import Array
from ._native import lib
from ._polygons import Polygons

_KINDS = {
    "point": lib.BELTRAMI_PIN_POINT,
    "u": lib.BELTRAMI_PIN_U,
    "v": lib.BELTRAMI_PIN_V,
    "line": lib.BELTRAMI_PIN_LINE,
}


def _kinds(values: Any, count: int, what: str) -> Array:
    words = [values] * count if isinstance(values, str) else list(values)
    if len(words) != count:
        raise ValueError(f"there are {len(words)} kinds of {what}, and {count} of these")
    odd = [word for word in words if word not in _KINDS]
    if odd:
        raise ValueError(f"{odd[0]!r} is no kind: give 'point', 'u', 'v' or 'line'")
    return np.array([_KINDS[word] for word in words], np.uint64)


def pins(values: Any, faces: Polygons) -> tuple[Array, Array, tuple[Array, Array] | None]:
    """Return corners (k,), UVs (k, 2), and kinds (k,) with directions (k, 2) where they are given.

    Raises TypeError, ValueError.
    """
    if not isinstance(values, tuple) or not 2 <= len(values) <= 4:
        raise TypeError("pins are a pair of corners and their UVs, and then kinds and directions")
    corners, uvs = _polygons.pins(values[:2], faces)
    if len(values) == 2:
        return corners, uvs, None
    return corners, uvs, held(values[2], values[3] if len(values) == 4 else None, len(corners))


def held(kinds: Any, directions: Any, count: int) -> tuple[Array, Array]:
    """Return kinds (k,) and directions (k, 2) of as many pins. Raises TypeError, ValueError."""
    numbers = _kinds(kinds, count, "pins")
    along = np.zeros((count, 2))
    if directions is not None:
        along = np.ascontiguousarray(directions, np.float64)
    elif (numbers == _KINDS["line"]).any():
        raise ValueError("pins of the kind 'line' have directions: give these after the kinds")
    if along.shape != (count, 2):
        raise ValueError(
            f"the directions of pins must have the shape ({count}, 2), not {along.shape}"
        )
    return numbers, along


def edges(values: Any) -> tuple[Array, Array]:
    """Return edges (k, 2) and their kinds (k,). Raises TypeError, ValueError."""
    if not isinstance(values, tuple) or len(values) != 2:
        raise TypeError("straight edges are a pair: edges by their vertices, and their kinds")
    ends = np.asarray(values[0])
    if ends.size == 0:
        return np.empty((0, 2), np.uint64), np.empty(0, np.uint64)
    ends = _polygons.seams(ends)
    return ends, _kinds(values[1], len(ends), "straight edges")


def rectangles(values: Any, faces: Polygons) -> tuple[Array, Array | None]:
    """Return faces (k,), and corners (k, 4) where these are given. Raises TypeError, ValueError."""
    given, corners = values if isinstance(values, tuple) else (values, None)
    numbers = np.asarray(given)
    if numbers.size == 0:
        return np.empty(0, np.uint64), None
    if numbers.dtype.kind not in "iu" or numbers.ndim != 1:
        raise TypeError(f"rectangles must be (k,) integers, numbers of faces, not {numbers.dtype}")
    odd = np.flatnonzero((numbers < 0) | (numbers >= len(faces)))
    if len(odd):
        raise ValueError(
            f"rectangle {odd[0]} names face {numbers[odd[0]]}, but there are {len(faces)}"
        )
    if corners is not None:
        corners = np.asarray(corners)
        if corners.shape != (len(numbers), 4) or corners.dtype.kind not in "iu":
            raise ValueError(
                f"corners of rectangles must be ({len(numbers)}, 4) integers, vertices of their "
                f"borders, not {corners.shape}"
            )
        if (corners < 0).any():
            raise ValueError("corners of rectangles are vertices: they count from 0")
        corners = np.ascontiguousarray(corners, np.uint64)
    return np.ascontiguousarray(numbers, np.uint64), corners
