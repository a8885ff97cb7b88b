# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of Blender, made of the library's table of options."""

# Blender evaluates annotations where a class is registered: they must be no strings.

import os
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

from .uv_logic import settings

Class = TypeVar("Class", bound=type)


def of_option(name: str) -> Any:
    """Return the property for an option of the library, by its keyword."""
    shown = settings.property_of(name)
    option = shown.option
    words = {"name": shown.label, "description": option.summary.rstrip(".")}
    if option.kind == "bool":
        return BoolProperty(default=bool(option.default), **words)
    if option.kind == "choice":
        items = [(choice, settings.choice_label(choice), "") for choice in option.choices]
        return EnumProperty(items=items, default=option.default, **words)
    if option.kind == "int":
        most = min(int(option.maximum), 2**31 - 1)
        soft = {"soft_min": int(shown.soft[0]), "soft_max": min(int(shown.soft[1]), most)}
        least = int(option.minimum)
        return IntProperty(default=int(option.default), min=least, max=most, **soft, **words)
    return FloatProperty(
        default=float(option.default),
        min=option.minimum,
        max=min(option.maximum, 3e38),
        soft_min=shown.soft[0],
        soft_max=min(shown.soft[1], 3e38),
        precision=3,
        **words,
    )


def with_options(names: Iterable[str]) -> Callable[[Class], Class]:
    """Give a class the properties for some options of the library, before its own."""

    def give(cls: Class) -> Class:
        own = dict(cls.__dict__.get("__annotations__", {}))
        cls.__annotations__ = {**{name: of_option(name) for name in names}, **own}
        return cls

    return give


def values_of(holder: Any, names: Iterable[str]) -> dict[str, Any]:
    """Return the values of options that an operator or the settings of a scene hold."""
    return {name: getattr(holder, name) for name in names}


ISLANDS = [
    ("given", "Marked Seams", "Cut along marked seams; open what cannot be flat without a cut"),
    ("islands", "Islands", "Keep the islands that the UVs have, and flatten them anew"),
]
MATERIALS = [
    ("ignore", "Ignore", "Materials do not matter"),
    ("seek", "Seek", "Seams are sooner where materials differ"),
    ("cut", "Cut", "Seams run wherever materials differ"),
]


def islands() -> Any:
    """Return the property that says what cuts."""
    words = {"name": "Cut Along", "description": "What parts islands"}
    return EnumProperty(items=ISLANDS, default="given", **words)


def materials(most: int) -> Any:
    """Return the property that says what materials mean, with so many choices and no cut else."""
    items = MATERIALS if most == len(MATERIALS) else [MATERIALS[0], MATERIALS[2]]
    words = {"name": "Materials", "description": "Whether seams run between materials"}
    return EnumProperty(items=items, default="ignore", **words)


STRAIGHT = [
    ("grids", "Quads", "Selected faces that are rows and columns of quads become grids"),
    ("axes", "Edges", "Selected edges become straight, along the axes that are nearer to them"),
    ("u", "Edges at One U", "Selected edges become straight and upright"),
    ("v", "Edges at One V", "Selected edges become straight and level"),
    ("line", "Edges in Any Direction", "Selected edges become straight"),
]


def straight() -> Any:
    """Return the property that says what becomes straight."""
    words = {"name": "Straighten", "description": "What becomes straight"}
    return EnumProperty(items=STRAIGHT, default="grids", **words)


def switch(name: str, description: str, default: bool) -> Any:
    """Return a property that is on or off."""
    return BoolProperty(name=name, description=description, default=default)


SWITCHES = {
    "sharp_seams": (
        "Cut Sharp Edges",
        "Cut along edges that are marked sharp, too",
        False,
    ),
    "keep_pins": ("Keep Pins", "Pinned UVs stay, and their islands follow them", True),
    "keep_seams": ("Keep Seams", "Cut along marked seams, beside those found", True),
    "mark_seams": ("Mark Seams", "Mark the edges along which the UVs part as seams", False),
    "scaled": (
        "Object Scale",
        "Measure lengths as objects are scaled in the scene; else as their meshes have them",
        True,
    ),
    "allow_mirrored": ("Allow Mirrored", "Islands that are mirrored as a whole are sound", False),
    "selected_only": ("Selected Only", "Judge the selected faces alone", False),
    "select_faces": ("Select Faces", "Select the faces that are flipped or overlap", True),
    "colours": (
        "Stretch Colours",
        "Colour faces by their size in the UVs: red is smaller than the mean, blue is larger",
        False,
    ),
}


def with_switches(*names: str) -> Callable[[Class], Class]:
    """Give a class some of the properties that are on or off, after its own."""

    def give(cls: Class) -> Class:
        own = dict(cls.__dict__.get("__annotations__", {}))
        cls.__annotations__ = {**own, **{name: switch(*SWITCHES[name]) for name in names}}
        return cls

    return give


def _switch_live(_held: Any, context: Any) -> None:
    from . import following  # which needs this module

    following.switch(context)


ALL_OPTIONS = tuple(dict.fromkeys((*settings.AUTO_OPTIONS, *settings.UNWRAP_OPTIONS)))


@with_switches(*SWITCHES)
@with_options(ALL_OPTIONS)
class BeltramiSettings(bpy.types.PropertyGroup):
    """What the panel shows, and hands to operators."""

    cut: islands()
    materials: materials(len(MATERIALS))
    straight: straight()


class BeltramiPreferences(bpy.types.AddonPreferences):
    """Preferences of the extension."""

    bl_idname = __package__

    threads: IntProperty(
        name="Threads",
        description="Threads to use; 0 takes all. UVs do not depend on it",
        default=0,
        min=0,
        max=1024,
        soft_max=64,
    )

    def draw(self, context: Any) -> None:
        """Draw them."""
        self.layout.prop(self, "threads")


def threads(context: Any) -> int:
    """Return how many threads to use."""
    addon = context.preferences.addons.get(__package__)
    wanted = addon.preferences.threads if addon is not None and addon.preferences else 0
    return wanted or os.cpu_count() or 1


CLASSES = (BeltramiSettings, BeltramiPreferences)


def register() -> None:
    """Register."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.beltrami = PointerProperty(type=BeltramiSettings)
    # Of the window manager, which no undo changes and no file keeps.
    bpy.types.WindowManager.beltrami_live = BoolProperty(
        name="Live Unwrap",
        description="While a mesh is edited, its islands follow seams and pins",
        default=False,
        update=_switch_live,
    )


def unregister() -> None:
    """Unregister."""
    del bpy.types.WindowManager.beltrami_live
    del bpy.types.Scene.beltrami
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
