# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's meshes as arrays, and back.

In edit mode a mesh is read from a copy of it, and written face by face: no mode is left, so that
undo, shape keys and what is edited beside it stay as they are. Else all is read and written at
once.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import bmesh
import bpy
import numpy as np

from .uv_logic.parts import Array, Part

STRETCH = "UV Stretch"  # the name of the colour attribute
_UV_MAP = "UVMap"


@dataclass(frozen=True)
class Reading:
    """How meshes are read.

    Attributes
    ----------
    sharp : bool
        Whether edges that are marked sharp are seams.
    scaled : bool
        Whether lengths are those of the objects in the scene, not those of their meshes.
    by_uvs : bool
        Whether of faces that are selected only those count whose UVs are selected, too.
    everything : bool
        Whether all faces that are seen count, selected or not.
    """

    sharp: bool = False
    scaled: bool = True
    by_uvs: bool = False
    everything: bool = False


def objects(context: Any) -> list[Any]:
    """Return the objects to work on, each mesh once: those that are edited, or are selected."""
    if context.mode == "EDIT_MESH":
        # Timers have no screen, whose context would list them.
        found = [thing for thing in context.view_layer.objects if thing.mode == "EDIT"]
    elif context.mode == "OBJECT":
        found = context.selected_objects
    else:
        return []
    once = {thing.data: thing for thing in reversed(list(found)) if thing.type == "MESH"}
    return [thing for thing in reversed(once.values()) if thing.data.library is None]


def by_uvs(context: Any) -> bool:
    """Return whether the UV editor is where users choose, by a selection of its own."""
    space = context.space_data
    in_editor = space is not None and space.type == "IMAGE_EDITOR" and context.mode == "EDIT_MESH"
    return in_editor and not context.scene.tool_settings.use_uv_select_sync


def read(thing: Any, how: Reading) -> Part:
    """Return the mesh of an object as arrays. Without UVs all of them are 0."""
    with _readable(thing) as mesh:
        faces = mesh.polygons
        layer = mesh.uv_layers.active
        count = len(mesh.loops)
        seams = _values(mesh.edges, "use_seam", bool)
        if how.sharp:
            seams |= _values(mesh.edges, "use_edge_sharp", bool)
        sizes = _values(faces, "loop_total", np.int32)
        chosen = np.ones(len(faces), bool)
        if thing.mode == "EDIT":
            chosen = ~_values(faces, "hide", bool)
            if not how.everything:
                chosen &= _values(faces, "select", bool)
        if how.by_uvs and layer is not None and not how.everything:
            chosen &= _selected_in_uvs(mesh, layer, sizes)
        uvs, pinned = _uvs_and_pins(layer, count)
        positions = _values(mesh.vertices, "co", np.float32, 3).astype(np.float64)
        return Part(
            thing.name,
            _placed(thing, positions) if how.scaled else positions,
            _values(mesh.loops, "vertex_index", np.int32),
            sizes,
            _values(mesh.edges, "vertices", np.int32, 2),
            seams,
            _values(faces, "material_index", np.int32),
            chosen,
            np.where(np.isfinite(uvs), uvs, np.float32(0)),
            pinned,
            _selected_edges(thing, mesh, layer, how),
        )


def write_uvs(thing: Any, part: Part, uvs: Array) -> None:
    """Give the chosen faces of the mesh that a part was read from their UVs, (c, 2)."""
    mesh = thing.data
    if mesh.uv_layers.active is None:
        mesh.uv_layers.new(name=_UV_MAP)
    if thing.mode != "EDIT":
        values = np.ascontiguousarray(uvs, np.float32)
        mesh.uv_layers.active.uv.foreach_set("vector", values.reshape(-1))
        mesh.update()
        return
    edited = bmesh.from_edit_mesh(mesh)
    layer = edited.loops.layers.uv.verify()
    rows, begin = uvs.astype(np.float64).tolist(), 0
    for face, chosen, size in zip(edited.faces, part.chosen.tolist(), part.sizes.tolist()):
        if chosen:
            for loop, row in zip(face.loops, rows[begin : begin + size]):
                loop[layer].uv = row
        begin += size
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def mark_seams(thing: Any, part: Part, pairs: Array) -> None:
    """Mark edges as seams, by their vertices (k, 2); of the chosen faces others are unmarked."""
    count = np.int64(max(len(part.positions), 1))
    edges = np.sort(part.edges.astype(np.int64), axis=1)
    wanted = np.sort(pairs.astype(np.int64), axis=1)
    is_seam = np.isin(edges[:, 0] * count + edges[:, 1], wanted[:, 0] * count + wanted[:, 1])
    mesh = thing.data
    if thing.mode != "EDIT":
        marked = _values(mesh.edges, "use_seam", bool) | is_seam
        mesh.edges.foreach_set("use_seam", marked)
        mesh.update()
        return
    edited = bmesh.from_edit_mesh(mesh)
    edited.edges.ensure_lookup_table()
    for edge in np.flatnonzero(is_seam).tolist():
        edited.edges[edge].seam = True
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def select(thing: Any, faces: Array, in_uvs: bool) -> None:
    """Select some faces of a mesh, (m,) bool, and no others; or only their UVs, of those shown."""
    mesh = thing.data
    if thing.mode != "EDIT":
        mesh.polygons.foreach_set("select", faces)
        _select_around(mesh, faces)
        mesh.update()
        return
    edited = bmesh.from_edit_mesh(mesh)
    if in_uvs:
        _select_uvs(edited, faces)
    else:
        for face, wanted in zip(edited.faces, faces.tolist()):
            face.select_set(wanted)
        for face, wanted in zip(edited.faces, faces.tolist()):
            if wanted:  # what the faces beside it have taken away
                face.select_set(True)
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def write_colours(thing: Any, faces: Array, colours: Array) -> None:
    """Give the corners of some faces, (m,) bool, colours, (m, 4), in an attribute of its own."""
    mesh = thing.data
    attribute = mesh.color_attributes.get(STRETCH)
    if attribute is not None and (attribute.domain, attribute.data_type) != (
        "CORNER",
        "BYTE_COLOR",
    ):
        mesh.color_attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.color_attributes.new(STRETCH, "BYTE_COLOR", "CORNER")
    mesh.color_attributes.active_color = attribute
    if thing.mode == "EDIT":
        edited = bmesh.from_edit_mesh(mesh)
        layer = edited.loops.layers.color[STRETCH]
        for face, wanted, colour in zip(edited.faces, faces.tolist(), colours.tolist()):
            if wanted:
                for loop in face.loops:
                    loop[layer] = colour
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
        return
    sizes = _values(mesh.polygons, "loop_total", np.int32)
    values = np.zeros((len(mesh.loops), 4), np.float32)
    attribute.data.foreach_get("color_srgb", values.reshape(-1))
    of_corners = np.repeat(faces, sizes)
    values[of_corners] = np.repeat(colours, sizes, axis=0)[of_corners]
    attribute.data.foreach_set("color_srgb", values.reshape(-1))
    mesh.update()


@contextmanager
def _readable(thing: Any) -> Iterator[Any]:
    """Yield a mesh whose arrays can be read: a copy of one that is edited."""
    if thing.mode != "EDIT":
        yield thing.data
        return
    thing.update_from_editmode()
    copy = thing.data.copy()
    try:
        yield copy
    finally:
        bpy.data.meshes.remove(copy)


def _uvs_and_pins(layer: Any, count: int) -> tuple[Array, Array]:
    """Return the UVs of so many corners, (c, 2), and which are pinned, (c,); without a layer 0."""
    uvs = np.zeros((count, 2), np.float32)
    pinned = np.zeros(count, bool)
    if layer is not None:
        layer.uv.foreach_get("vector", uvs.reshape(-1))
        if len(layer.pin) == count:  # from Blender 5.0 on it may have none
            layer.pin.foreach_get("value", pinned)
    return uvs, pinned


def _values(items: Any, name: str, dtype: Any, columns: int = 1) -> Array:
    values = np.zeros(len(items) * columns, dtype)
    items.foreach_get(name, values)
    return values if columns == 1 else values.reshape(-1, columns)


def _placed(thing: Any, positions: Array) -> Array:
    """Return positions in the scene."""
    matrix = np.array(thing.matrix_world, np.float64)
    placed: Array = positions @ matrix[:3, :3].T + matrix[:3, 3]
    return placed


def _selected_in_uvs(mesh: Any, layer: Any, sizes: Array) -> Array:
    """Return the faces whose UVs are all selected, (m,) bool."""
    if hasattr(layer, "vertex_selection"):  # before Blender 5.0
        corners = _values(layer.vertex_selection, "value", bool)
        starts = np.cumsum(sizes) - sizes
        return np.logical_and.reduceat(corners, starts) if len(starts) else corners
    selected = mesh.attributes.get(".uv_select_face")
    if selected is None or len(selected.data) != len(sizes):
        return np.ones(len(sizes), bool)
    return _values(selected.data, "value", bool)


def _selected_edges(thing: Any, mesh: Any, layer: Any, how: Reading) -> Array:
    """Return the edges that are selected, (e,) bool; of UVs those with a side that is."""
    if thing.mode != "EDIT":
        return np.zeros(len(mesh.edges), bool)
    if not how.by_uvs or layer is None:
        return _values(mesh.edges, "select", bool)
    selected = np.zeros(len(mesh.edges), bool)
    if hasattr(layer, "edge_selection"):  # before Blender 5.0
        sides = _values(layer.edge_selection, "value", bool)
    else:
        attribute = mesh.attributes.get(".uv_select_edge")
        if attribute is None or len(attribute.data) != len(mesh.loops):
            return _values(mesh.edges, "select", bool)
        sides = _values(attribute.data, "value", bool)
    selected[_values(mesh.loops, "edge_index", np.int32)[sides]] = True
    return selected


def _select_uvs(edited: Any, faces: Array) -> None:
    layer = edited.loops.layers.uv.verify()
    newer = hasattr(edited, "uv_select_sync_valid")  # from Blender 5.0 on
    for face, wanted in zip(edited.faces, faces.tolist()):
        if newer:
            face.uv_select_set(wanted)
            continue
        for loop in face.loops:
            loop[layer].select = wanted
            loop[layer].select_edge = wanted
    if newer:
        edited.uv_select_sync_valid = True


def _select_around(mesh: Any, faces: Array) -> None:
    """Select the edges and vertices of faces that are selected, and no others."""
    sizes = _values(mesh.polygons, "loop_total", np.int32)
    of_faces = np.repeat(faces, sizes)
    vertices = np.zeros(len(mesh.vertices), bool)
    vertices[_values(mesh.loops, "vertex_index", np.int32)[of_faces]] = True
    edges = np.zeros(len(mesh.edges), bool)
    edges[_values(mesh.loops, "edge_index", np.int32)[of_faces]] = True
    mesh.vertices.foreach_set("select", vertices)
    mesh.edges.foreach_set("select", edges)
