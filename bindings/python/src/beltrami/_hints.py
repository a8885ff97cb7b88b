"""What to write instead, where something else than the arrays of a mesh was given."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

#: Things that hold a mesh, by the attributes that tell them, and the arrays that are meant.
_ARRAYS_OF = [
    (("uv", "faces", "certificate"), "result.uv and result.faces"),  # our own results
    (("vertices", "faces"), "mesh.vertices and mesh.faces"),
    (("vertices", "triangles"), "mesh.vertices and mesh.triangles"),  # Open3D
    (
        ("vertex", "triangle"),  # Open3D with tensors
        "mesh.vertex.positions.numpy() and mesh.triangle.indices.numpy()",
    ),
    (("points", "regular_faces"), "mesh.points and mesh.regular_faces"),  # PyVista
    (("points", "cells_dict"), "mesh.points and mesh.cells_dict['triangle']"),  # meshio
    (("vertices", "cells"), "mesh.vertices and mesh.cells"),  # vedo
    (("vertex_matrix", "face_matrix"), "mesh.vertex_matrix() and mesh.face_matrix()"),  # PyMeshLab
]


def for_thing(thing: object) -> str | None:
    """Return what a thing is and what to give instead of it, or None where nothing is known."""
    if isinstance(thing, (str, bytes, os.PathLike)):
        return _for_path(os.fsdecode(thing))
    if isinstance(thing, (list, tuple)):
        return _for_sequence(thing)
    if isinstance(thing, dict) and thing.keys() >= {"vertices", "faces"}:
        return "a dict: give its arrays, mesh['vertices'] and mesh['faces']"
    names = set(dir(thing))  # nothing is evaluated, as hasattr would
    kind = f"{type(thing).__module__.partition('.')[0]}.{type(thing).__name__}"
    if names.issuperset(("geometry", "graph", "dump")):  # trimesh.Scene
        count = len(thing.geometry)  # type: ignore[attr-defined]
        one = "give the mesh in it, scene.dump()[0]"
        more = f"give one of its {count} meshes after the other, for mesh in scene.dump()"
        return f"a {kind}: {one if count == 1 else more}"
    for attributes, arrays in _ARRAYS_OF:
        if names.issuperset(attributes):
            return f"a {kind}: give its arrays, {arrays}"
    return None


def _for_path(path: str) -> str:
    # trimesh merges vertices that coincide unless it is told not to, and so closes cuts. The files
    # of STL have nothing but such vertices.
    keep = "" if path.lower().endswith(".stl") else ", process=False"
    return (
        f"a path: give the mesh in it, trimesh.load_mesh({path!r}{keep}), "
        f"or have the file flattened, beltrami.batch([{path!r}], 'folder')"
    )


def _for_sequence(things: list[object] | tuple[object, ...]) -> str | None:
    for thing in things:
        of_one = None if isinstance(thing, (list, tuple)) else for_thing(thing)
        if of_one is not None:
            return f"a {type(things).__name__}: give one mesh at a time; the first is {of_one}"
    if isinstance(things, tuple) and len(things) == 2:
        return "a tuple: give its vertices and faces one by one, as (*mesh) does"
    return None


def _has_counts(faces: npt.NDArray[Any]) -> bool:
    """Whether every triangle comes after its count, as VTK has them: 3, a, b, c, 3, ..."""
    fits = faces.size > 0 and faces.size % 4 == 0 and faces.shape[1:] in [(), (4,)]
    return fits and bool((faces.ravel()[::4] == 3).all())


def for_shape(name: str, array: npt.NDArray[Any], columns: int) -> str:
    """Return what to do to an array of another shape than (n, columns), or "" if nothing is known.

    It begins with ": ".
    """
    if name == "faces" and _has_counts(array):
        return ": give faces.reshape(-1, 4)[:, 1:], without the counts"
    if array.ndim == 1 and array.size % columns == 0:
        return f": give {name}.reshape(-1, {columns})"
    if array.ndim == 3 and len(array) == 1:
        return f": give {name}[0]"
    if array.ndim != 2:
        return ""
    if name == "faces" and array.shape[1] == 4:
        return (
            ": cut the quads into triangles, "
            "np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])"
        )
    if name == "vertices" and array.shape[1] == 2:
        return ": in a plane, give np.column_stack([vertices, np.zeros(len(vertices))])"
    if array.shape[0] == columns:
        return f": give {name}.T"
    if name != "faces" and array.shape[1] > columns and not array[:, columns:].any():
        return f": give {name}[:, :{columns}]"
    return ""


def for_type(name: str, array: npt.NDArray[Any]) -> str:
    """Return what to do to an array of another type, as `for_shape` does."""
    if {"x", "y", "z"} <= set(array.dtype.names or ()):  # as plyfile has them
        return f": give np.column_stack([{name}['x'], {name}['y'], {name}['z']])"
    if array.dtype.kind == "O" and array.ndim == 1 and all(map(np.ndim, array)):
        return f": give np.stack({name})"
    if array.dtype.kind == "O" and array.ndim > 0:
        return f": give np.array({name}, {'np.int64' if name == 'faces' else 'float'})"
    if name == "faces" and array.dtype.kind == "f":
        if bool((array == np.floor(array)).all()):
            return ": give faces.astype(np.int64)"
        return ": are the arguments in their order?"
    return ""
