# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Live unwrapping: while it is on, islands of edited meshes follow their seams and pins."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.app.handlers import persistent

from . import bridge, properties
from .running import redraw, shown
from .uv_logic.live import Live
from .uv_logic.parts import RefusedError

_INTERVAL = 0.05  # seconds from one look at the meshes to the next

_followed: dict[str, Live] = {}  # by the name of the mesh
_changed: set[str] = set()  # names of meshes that Blender has told of


def step(context: Any) -> None:
    """Let the islands follow once, of meshes that have changed or that are on their way."""
    if context.mode != "EDIT_MESH" or shown["job"] is not None:
        _forget()
        return
    held = context.scene.beltrami
    how = bridge.Reading(held.sharp_seams, held.scaled, everything=True)
    for thing in bridge.objects(context):
        name = thing.data.name
        is_new = name not in _followed
        live = _followed.setdefault(name, Live(properties.threads(context)))
        if not is_new and name not in _changed and not live.is_due:
            continue
        _changed.discard(name)
        part = bridge.read(thing, how)
        try:
            uvs = live.follow(part)
            shown["live"] = ""
        except RefusedError as error:
            uvs, shown["live"] = None, str(error)
        if uvs is not None:
            bridge.write_uvs(thing, part, uvs)
        redraw(context)


def switch(context: Any) -> None:
    """Begin or end, as the setting says."""
    is_on = bpy.app.timers.is_registered(_tick)
    if context.window_manager.beltrami_live and not is_on:
        bpy.app.timers.register(_tick, first_interval=_INTERVAL, persistent=True)
        bpy.app.handlers.depsgraph_update_post.append(_told)
        for handlers in _of_undo():
            handlers.append(_undone)
    elif is_on and not context.window_manager.beltrami_live:
        unregister()


def unregister() -> None:
    """End."""
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    if _told in bpy.app.handlers.depsgraph_update_post:
        bpy.app.handlers.depsgraph_update_post.remove(_told)
    for handlers in _of_undo():
        if _undone in handlers:
            handlers.remove(_undone)
    _forget()


def _tick() -> float | None:
    if not bpy.context.window_manager.beltrami_live:  # another file
        unregister()
        return None
    step(bpy.context)
    return _INTERVAL


@persistent
def _told(_scene: Any, depsgraph: Any) -> None:
    for update in depsgraph.updates:
        thing = update.id
        if isinstance(thing, bpy.types.Object) and thing.type == "MESH":
            thing = thing.data
        if isinstance(thing, bpy.types.Mesh):
            _changed.add(thing.name)


@persistent
def _undone(_scene: Any, _depsgraph: Any = None) -> None:
    _forget()  # what is there now was not made here


def _of_undo() -> tuple[Any, Any]:
    return bpy.app.handlers.undo_post, bpy.app.handlers.redo_post


def _forget() -> None:
    for live in _followed.values():
        live.close()
    _followed.clear()
    _changed.clear()
    shown["live"] = ""
