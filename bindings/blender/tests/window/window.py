# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user does in a window, as events: see run.sh beside this file. Ends Blender."""

from __future__ import annotations

import importlib
import os
import sys
import time
import traceback
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bmesh
import bpy
import numpy as np

MODULE = "beltrami_uv"
PATIENCE = 60  # seconds after which what waits has failed
TICK = 0.01


def older_layer(layer: Any, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Read UVs and pins as Blender before 3.5 has them."""
    uvs, pinned = np.zeros((count, 2), np.float32), np.zeros(count, bool)
    if layer is not None:
        layer.data.foreach_get("uv", uvs.reshape(-1))
        layer.data.foreach_get("pin_uv", pinned)
    return uvs, pinned


def load() -> Any:
    """Load the sources as an add-on, and return the module that runs operators."""
    bridge = importlib.import_module(f"{MODULE}.bridge")
    if not hasattr(bpy.types.MeshUVLoopLayer, "uv"):
        bridge._uvs_and_pins = older_layer
    addon = importlib.import_module(MODULE)
    addon.register()
    return importlib.import_module(f"{MODULE}.running")


def uvs_of(thing: Any) -> np.ndarray:
    """Return the UVs of what is edited, (c, 2)."""
    edited = bmesh.from_edit_mesh(thing.data)
    layer = edited.loops.layers.uv.verify()
    return np.array([loop[layer].uv[:] for face in edited.faces for loop in face.loops])


def view() -> dict[str, Any]:
    """Return the 3D view, as an override of the context."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    return {"window": window, "screen": window.screen, "area": area, "region": region}


def event(kind: str, value: str = "PRESS", **modifiers: bool) -> None:
    """Send an event to the middle of the 3D view."""
    held = view()
    region = held["region"]
    at = {"x": region.x + region.width // 2, "y": region.y + region.height // 2}
    held["window"].event_simulate(type=kind, value=value, **at, **modifiers)


def key(kind: str, *modifiers: str) -> Iterator[None]:
    """Press a key with others held down, and let them go."""
    held: dict[str, bool] = {}
    event("MOUSEMOVE", "NOTHING")
    yield
    for modifier in modifiers:
        held[modifier] = True
        event(f"LEFT_{modifier.upper()}", "PRESS", **held)
        yield
    event(kind, "PRESS", **held)
    event(kind, "RELEASE", **held)
    yield
    for modifier in reversed(modifiers):
        del held[modifier]
        event(f"LEFT_{modifier.upper()}", "RELEASE", **held)
        yield


def invoke(operator: Any, **options: Any) -> set[str]:
    """Invoke an operator as a menu does."""
    with bpy.context.temp_override(**view()):
        return operator("INVOKE_DEFAULT", True, **options)


def until(is_so: Any) -> Iterator[None]:
    """Wait for something; raises AssertionError after a long time."""
    end = time.monotonic() + PATIENCE
    while not is_so():
        assert time.monotonic() < end, "waited in vain"
        yield


def story(running: Any) -> Iterator[None]:
    """Tell what a user does, and look at what comes of it. Yields wherever Blender is to go on."""
    shown = running.shown
    yield from key("ESC")  # the splash screen
    bpy.ops.object.select_all(action="DESELECT")
    bpy.ops.mesh.primitive_monkey_add()
    thing = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide(number_cuts=7, smoothness=1)
    bpy.ops.ed.undo_push(message="a large monkey")
    yield
    first = uvs_of(thing)

    # Esc in the midst of a run.
    assert invoke(bpy.ops.uv.beltrami_auto, effort="high") == {"RUNNING_MODAL"}
    job = shown["job"]
    yield from until(lambda: job.fraction > 0.1)
    with bpy.context.temp_override(**view()):
        if os.environ["BELTRAMI_PICTURE"] != "/dev/null":
            bpy.ops.screen.screenshot(filepath=os.environ["BELTRAMI_PICTURE"])
    yield
    assert not job.done, "the run was over before Esc: the mesh is to be larger"
    turns = [time.monotonic()]
    for _ in range(5):
        yield
        turns.append(time.monotonic())
    pressed = time.monotonic()
    event("ESC", "PRESS")
    yield from until(lambda: shown["job"] is None)
    took, turn = time.monotonic() - pressed, float(np.diff(turns).mean())
    print(
        f"window: Esc took {1000 * took:.0f} ms, where a turn of the window takes {1000 * turn:.0f}"
    )
    event("ESC", "RELEASE")
    np.testing.assert_array_equal(uvs_of(thing), first)
    yield from until(lambda: job.done)
    yield
    np.testing.assert_array_equal(uvs_of(thing), first)
    print("window: nothing changed after Esc")

    # A run to its end, then undo and redo.
    assert invoke(bpy.ops.uv.beltrami_auto, effort="quick") == {"RUNNING_MODAL"}
    yield from until(lambda: shown["job"] is None)
    second = uvs_of(thing)
    assert (second != first).any()
    assert second.min() >= 0
    assert second.max() <= 1
    print("window: a run wrote its UVs")
    yield
    yield from key("Z", "ctrl")
    yield from until(lambda: np.array_equal(uvs_of(bpy.context.object), first))
    print("window: undo brought the old UVs back")
    yield from key("Z", "ctrl", "shift")
    yield from until(lambda: np.array_equal(uvs_of(bpy.context.object), second))
    print("window: redo brought the new UVs back")

    # The panel of the last operation: undo, and the operator anew with another option.
    invoke(bpy.ops.uv.beltrami_pack, margin=2)
    yield from until(lambda: shown["job"] is None)
    packed = uvs_of(bpy.context.object)
    yield
    last = bpy.context.window_manager.operators[-1]
    assert last.bl_idname == "UV_OT_beltrami_pack"
    last.properties.margin = 40
    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo_redo()
    yield
    again = uvs_of(bpy.context.object)
    assert (again != packed).any()
    assert again.min() >= 20 / 1024 - 1e-6
    print("window: the last operation was adjusted")

    # The check colours faces, and leaves a text for the panel.
    invoke(bpy.ops.uv.beltrami_check, colours=True)
    yield from until(lambda: shown["job"] is None)
    assert shown["check"]
    print("window: the check says", ", ".join(shown["check"]))
    yield from live()


def live() -> Iterator[None]:
    """Have islands follow a seam that is marked, and undo and redo."""
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=20, y_subdivisions=20)
    thing = bpy.context.object
    for vertex in thing.data.vertices:
        vertex.co.z = 0.5 * np.exp(-6 * (vertex.co.x**2 + vertex.co.y**2))
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    with bpy.context.temp_override(**view()):
        bpy.ops.uv.beltrami_unwrap("EXEC_DEFAULT", True)
    yield
    before = uvs_of(bpy.context.object)
    bpy.context.window_manager.beltrami_live = True
    bpy.ops.ed.undo_push(message="live")
    for _ in range(50):
        yield
    np.testing.assert_array_equal(uvs_of(bpy.context.object), before)
    edited = bmesh.from_edit_mesh(bpy.context.object.data)
    for edge in edited.edges:
        edge.seam = all(abs(v.co.x) < 1e-6 and v.co.y < 0.1 for v in edge.verts)
    bmesh.update_edit_mesh(bpy.context.object.data)
    bpy.ops.ed.undo_push(message="mark a seam")
    yield from until(lambda: (uvs_of(bpy.context.object) != before).any())
    print("window: live, a seam has opened")
    yield from key("Z", "ctrl")
    yield from until(lambda: np.array_equal(uvs_of(bpy.context.object), before))
    for _ in range(50):
        yield
    np.testing.assert_array_equal(uvs_of(bpy.context.object), before)
    print("window: live, undo has closed it")
    yield from key("Z", "ctrl", "shift")
    yield from until(lambda: (uvs_of(bpy.context.object) != before).any())
    print("window: live, redo has opened it again")
    bpy.context.window_manager.beltrami_live = False
    yield


def main() -> None:
    """Run the story between Blender's own events, and end with an exit code."""
    bpy.context.preferences.view.show_splash = False
    running = load()
    steps = story(running)

    def step() -> float | None:
        try:
            next(steps)
        except StopIteration:
            print("window: passed", flush=True)
            os._exit(0)
        except BaseException:
            traceback.print_exc()
            print("window: failed", flush=True)
            os._exit(1)
        return TICK

    bpy.app.timers.register(step, first_interval=0.5)


sys.path.append(str(Path(os.environ["BLENDER_USER_SCRIPTS"]) / "addons"))
main()
