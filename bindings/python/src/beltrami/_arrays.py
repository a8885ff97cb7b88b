"""Whatever users call vertices, faces and UVs, as arrays that the library reads in place.

The library takes rows of 2 or 3 consecutive numbers of four types, with any positive distance from
row to row. Arrays like that go in without a copy; all else is converted.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _hints

Array = npt.NDArray[Any]


def positions(vertices: npt.ArrayLike) -> Array:
    """Return vertices as an (n, 3) array of float32 or float64."""
    return _rows("vertices", _as_floats("vertices", vertices), 3)


def coordinates(uv: npt.ArrayLike) -> Array:
    """Return UVs as an (n, 2) array of float32 or float64."""
    return _rows("uv", _as_floats("uv", uv), 2)


def indices(faces: npt.ArrayLike) -> Array:
    """Return faces as an (m, 3) array of integers of 4 or 8 bytes, signed or not.

    The library reads all of them as unsigned: a negative number is out of range, too.
    """
    array = _as_array("faces", faces)
    if array.size == 0:
        array = array.astype(np.int64)
    if array.dtype.kind not in "iu":
        hint = _hints.for_type("faces", array)
        raise TypeError(f"faces must be whole numbers, not {array.dtype}{hint}")
    size = max(array.dtype.itemsize, 4)
    return _rows("faces", array.astype(f"={array.dtype.kind}{size}", copy=False), 3)


def _as_array(name: str, values: npt.ArrayLike) -> Array:
    try:
        array = np.asarray(values)
    except ValueError as error:
        if "inhomogeneous" not in str(error):
            raise
        hint = ": cut polygons into triangles" if name == "faces" else ""
        raise ValueError(f"{name} has rows of different lengths{hint}") from None
    if array.dtype.kind in "OSU":
        instead = _hints.for_thing(values)
        if instead is not None:
            raise TypeError(f"{name} is {instead}")
    return array


def _as_floats(name: str, values: npt.ArrayLike) -> Array:
    array = _as_array(name, values)
    if array.size == 0:
        array = array.astype(np.float64)
    if array.dtype.kind not in "fiu":
        hint = _hints.for_type(name, array)
        raise TypeError(f"{name} must be real numbers, not {array.dtype}{hint}")
    single = array.dtype.kind == "f" and array.dtype.itemsize <= 4
    return array.astype(np.float32 if single else np.float64, copy=False)


def _rows(name: str, array: Array, columns: int) -> Array:
    if array.ndim == 1 and array.size == 0:
        array = array.reshape(0, columns)
    if array.ndim != 2 or array.shape[1] != columns:
        hint = _hints.for_shape(name, array, columns)
        raise ValueError(f"{name} must have the shape (n, {columns}), not {array.shape}{hint}")
    return array if _readable(array) else np.ascontiguousarray(array)


def _readable(array: Array) -> bool:
    """Whether rows are consecutive numbers, each at a distance after the one before."""
    row, number = array.strides
    item = array.dtype.itemsize
    return number == item and (row >= array.shape[1] * item or len(array) <= 1)


def stride(array: Array) -> int:
    """Return the bytes from row to row of an array of this module; of a lone row, its own."""
    return int(max(array.strides[0], array[:1].nbytes))
