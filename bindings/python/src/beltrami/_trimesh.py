"""``trimesh.Trimesh`` in and out, without needing trimesh."""

from __future__ import annotations

import copy
import errno
import os
import sys
from pathlib import Path
from typing import Any

import numpy as np

from ._arrays import Array
from ._errors import NotADiskError

# What a disk becomes where the vertices on both sides of its seam are made one.
_SEWN = ["BELTRAMI_E_CLOSED", "BELTRAMI_E_BOUNDARIES", "BELTRAMI_E_GENUS"]


def is_mesh(thing: object) -> bool:
    """Whether `thing` is a ``trimesh.Trimesh``: none is before trimesh has been imported."""
    return isinstance(thing, getattr(sys.modules.get("trimesh"), "Trimesh", ()))


def explain(error: NotADiskError, mesh: Any) -> None:
    """Has the message say how a cut is kept open, where trimesh may have closed it."""
    if error.status in _SEWN and mesh.metadata.get("processed"):
        hint = "if it was cut open, trimesh has merged the vertices along the seam"
        error.args = (f"{error}; {hint}: load or make the mesh with process=False",)


def with_uv(mesh: Any, uv: Array, faces: Array) -> Any:
    """Return a copy of a ``trimesh.Trimesh`` with UVs, and with these faces.

    What else the mesh carried stays, but for its colours: a mesh has either those or UVs.
    """
    from trimesh.visual import TextureVisuals

    copied = mesh.copy()
    if not (copied.faces == faces).all():
        copied.faces = faces
    material = getattr(mesh.visual, "material", None)
    copied.visual = TextureVisuals(uv=uv, material=material)
    return copied


def is_scene(thing: object) -> bool:
    """Whether `thing` is a ``trimesh.Scene``."""
    return isinstance(thing, getattr(sys.modules.get("trimesh"), "Scene", ()))


def load(path: Any) -> Any:
    """Return the mesh in a file, or the scene where it holds several. Vertices stay as they are.

    Raises FileNotFoundError and IsADirectoryError with the path, and ImportError without trimesh.
    """
    if Path(path).is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), os.fspath(path))
    Path(path).stat()  # trimesh takes the path of no file for what it is to read
    try:
        import trimesh
    except ModuleNotFoundError as missing:
        raise ModuleNotFoundError(
            f"files are read by trimesh, which is not there: pip install trimesh ({missing})"
        ) from None

    loaded = trimesh.load(path, process=False)
    if is_mesh(loaded) or is_scene(loaded):
        return loaded
    raise TypeError(f"{os.fspath(path)} holds a {type(loaded).__name__}, and no mesh")


def corner_uvs(mesh: Any) -> Array | None:
    """Return the UVs that a mesh has for its corners, (m, 3, 2), or None."""
    uv = getattr(mesh.visual, "uv", None)
    if uv is None or len(uv) != len(mesh.vertices):
        return None
    of_corners: Array = np.asarray(uv)[mesh.faces]
    return of_corners


def split(mesh: Any, origins: Array, faces: Array | list[Array], uvs: Array) -> Any:
    """Return a mesh with the UVs, its vertices copied along the seams, and all else that it had.

    Colours become attributes, for a mesh has either those or UVs: of vertices what exporters write
    beside UVs, of faces ``face_attributes["color"]``.
    """
    import trimesh
    from trimesh.visual import TextureVisuals

    material = getattr(mesh.visual, "material", None)
    visual = TextureVisuals(
        uv=uvs,
        material=None if material is None else material.copy(),
        face_materials=copy.copy(getattr(mesh.visual, "face_materials", None)),
    )
    face_attributes = {name: np.array(values) for name, values in mesh.face_attributes.items()}
    if mesh.visual.kind == "vertex":
        visual.vertex_attributes["color"] = np.asarray(mesh.visual.vertex_colors)[origins]
    elif mesh.visual.kind == "face":
        face_attributes["color"] = np.array(mesh.visual.face_colors)
    elif "color" in getattr(mesh.visual, "vertex_attributes", {}):
        colours = mesh.visual.vertex_attributes["color"]
        visual.vertex_attributes["color"] = np.asarray(colours)[origins]
    return trimesh.Trimesh(
        vertices=np.asarray(mesh.vertices)[origins],
        faces=faces,
        vertex_normals=np.asarray(mesh.vertex_normals)[origins],
        vertex_attributes={k: np.asarray(v)[origins] for k, v in mesh.vertex_attributes.items()},
        face_attributes=face_attributes,
        metadata=copy.deepcopy(mesh.metadata),
        visual=visual,
        process=False,
    )


def joined(scene: Any) -> Any:
    """Return all meshes of a scene as one, at their places, each with its UVs; None without any."""
    import trimesh
    from trimesh.visual import TextureVisuals

    placed = []
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        if is_mesh(scene.geometry[name]):
            mesh = scene.geometry[name].copy()
            placed.append(mesh.apply_transform(matrix))
    if len(placed) <= 1:
        return placed[0] if placed else None
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in placed[:-1])])
    return trimesh.Trimesh(
        vertices=np.concatenate([mesh.vertices for mesh in placed]),
        faces=np.concatenate([mesh.faces + start for mesh, start in zip(placed, starts)]),
        vertex_normals=np.concatenate([mesh.vertex_normals for mesh in placed]),
        visual=TextureVisuals(uv=np.concatenate([mesh.visual.uv for mesh in placed])),
        process=False,
    )


def at_largest_place(scene: Any, name: str, vertices: Array) -> Array:
    """Return vertices of a mesh where a scene has it at the largest size, or as they are."""
    matrices = [scene.graph[node][0] for node in scene.graph.geometry_nodes.get(name, ())]
    if not matrices:
        return vertices
    matrix = max(matrices, key=lambda m: abs(float(np.linalg.det(m[:3, :3]))))
    placed: Array = vertices @ matrix[:3, :3].T + matrix[:3, 3]
    return placed


def with_meshes(scene: Any, meshes: dict[str, Any]) -> Any:
    """Return a copy of a scene with other meshes in the place of some."""
    copied = scene.copy()
    for name, mesh in meshes.items():
        copied.geometry[name] = mesh
    return copied
