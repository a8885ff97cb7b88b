"""A mesh in Blender, as a user has it who has opened it there and goes on to its UVs."""

from __future__ import annotations

from typing import Any

import numpy as np


def edited(vertices: np.ndarray, faces: np.ndarray, uvs: np.ndarray | None = None) -> Any:
    """Return a mesh that is edited with all of it selected, in an empty scene.

    Vertices are (n, 3), faces (m, 3); ``uvs`` of vertices are (n, 2). Without any the mesh has a
    layer of UVs that Blender makes.
    """
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    mesh = bpy.data.meshes.new("mesh")
    mesh.from_pydata(vertices.tolist(), [], faces.tolist())
    layer = mesh.uv_layers.new()
    if uvs is not None:
        layer.uv.foreach_set("vector", uvs[corners_of(mesh, faces)].astype(np.float32).ravel())
    thing = bpy.data.objects.new("mesh", mesh)
    bpy.context.collection.objects.link(thing)
    bpy.context.view_layer.objects.active = thing
    thing.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    return mesh


def corners_of(mesh: Any, faces: np.ndarray) -> np.ndarray:
    """Return the vertex of each corner; raises ValueError where Blender has other triangles."""
    corners = np.zeros(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    if not np.array_equal(corners, faces.ravel()):
        raise ValueError("Blender changed the triangles")
    return corners


def uvs_of(mesh: Any, faces: np.ndarray) -> np.ndarray:
    """End editing, and return the UVs of the corners, (m, 3, 2); raises as corners_of does."""
    import bpy

    bpy.ops.object.mode_set(mode="OBJECT")
    corners = corners_of(mesh, faces)
    uvs = np.zeros(2 * len(corners), np.float32)
    mesh.uv_layers.active.uv.foreach_get("vector", uvs)
    return uvs.astype(float).reshape(-1, 3, 2)
