# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension in Blender, installed from its zip by Blender's own operator.

Needs Blender's module bpy, and the zip: BELTRAMI_EXTENSION is its path, as ``./dev blender`` sets
it.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

_user = tempfile.TemporaryDirectory(prefix="beltrami-blender-")
os.environ["BLENDER_USER_RESOURCES"] = _user.name  # before bpy reads it

bpy = pytest.importorskip("bpy", reason="needs Blender's module bpy: ./dev blender installs it")
ZIP = Path(os.environ.get("BELTRAMI_EXTENSION", ""))
MODULE = "bl_ext.user_default.beltrami"


def pytest_collection_modifyitems(items: list[Any]) -> None:
    """Skip all tests without the zip."""
    if not ZIP.is_file():
        mark = pytest.mark.skip(reason="BELTRAMI_EXTENSION is no zip: ./dev blender builds it")
        for item in items:
            item.add_marker(mark)


@pytest.fixture(scope="session")
def installed() -> Any:
    """Return the modules of the extension as Blender has installed it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    done = bpy.ops.extensions.package_install_files(
        filepath=str(ZIP), repo="user_default", enable_on_install=True
    )
    assert done == {"FINISHED"}
    import importlib

    names = (
        "bridge",
        "following",
        "operators",
        "panels",
        "properties",
        "running",
        "uv_logic.settings",
    )
    modules = {name.split(".")[-1]: importlib.import_module(f"{MODULE}.{name}") for name in names}
    return SimpleNamespace(**modules)


@pytest.fixture
def scene(installed: Any) -> Iterator[Any]:
    """Yield Blender with an empty scene."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    if MODULE not in bpy.context.preferences.addons:
        bpy.ops.preferences.addon_enable(module=MODULE)
    yield bpy
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


@pytest.fixture
def monkey(scene: Any) -> Any:
    """Return Blender's monkey, edited, with all faces selected and a few seams marked."""
    scene.ops.mesh.primitive_monkey_add()
    thing = scene.context.object
    mark_middle(thing)
    edit(thing)
    return thing


def mark_middle(thing: Any) -> None:
    """Mark the seams in the plane x = 0, from the back of the head to the chin."""
    mesh = thing.data
    for edge in mesh.edges:
        ends = [mesh.vertices[k].co for k in edge.vertices]
        edge.use_seam = all(abs(end.x) < 1e-4 and end.y > -0.6 for end in ends)


def edit(*things: Any) -> None:
    """Edit some objects, with all faces selected."""
    bpy.ops.object.select_all(action="DESELECT")
    for thing in things:
        thing.select_set(True)
    bpy.context.view_layer.objects.active = things[0]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")


def leave() -> None:
    """Leave edit mode."""
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def uvs_of(thing: Any) -> np.ndarray:
    """Return the UVs of all corners, (c, 2); leaves edit mode."""
    leave()
    layer = thing.data.uv_layers.active
    uvs = np.zeros(2 * len(thing.data.loops), np.float32)
    layer.uv.foreach_get("vector", uvs)
    return uvs.reshape(-1, 2)


def verdict(*things: Any) -> Any:
    """Return the exact verdict on the UVs of objects, by Blender's own triangles."""
    import beltrami

    points, faces, uvs, before = [], [], [], 0
    for thing in things:
        of_corner = uvs_of(thing)
        mesh = thing.data
        mesh.calc_loop_triangles()
        count = len(mesh.loop_triangles)
        corners, vertices = np.zeros(3 * count, np.int32), np.zeros(3 * count, np.int32)
        mesh.loop_triangles.foreach_get("loops", corners)
        mesh.loop_triangles.foreach_get("vertices", vertices)
        positions = np.zeros(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", positions)
        points.append(positions.reshape(-1, 3))
        faces.append(vertices.reshape(-1, 3) + before)
        uvs.append(of_corner[corners].reshape(-1, 3, 2))
        before += len(mesh.vertices)
    return beltrami.check_atlas(*(np.concatenate(rows) for rows in (points, faces, uvs)))
