# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Menus, and the panel in the UV editor."""

from __future__ import annotations

from typing import Any

import bpy

from . import properties
from .operators import CLASSES as OPERATORS
from .operators import (
    UV_OT_beltrami_auto,
    UV_OT_beltrami_check,
    UV_OT_beltrami_pack,
    UV_OT_beltrami_straighten,
    UV_OT_beltrami_unwrap,
)
from .running import shown
from .uv_logic import settings

_ICONS = ("MOD_UVPROJECT", "UV", "UV_EDGESEL", "PACKAGE", "CHECKMARK")
_HAND_SET = ("target_energy", "preset", "effort")


class UV_MT_beltrami(bpy.types.Menu):
    """All operators."""

    bl_idname = "UV_MT_beltrami"
    bl_label = "beltrami"

    def draw(self, context: Any) -> None:
        """Draw them."""
        self.layout.operator_context = "INVOKE_DEFAULT"
        for cls, icon in zip(OPERATORS, _ICONS):
            self.layout.operator(cls.bl_idname, icon=icon)


class IMAGE_PT_beltrami(bpy.types.Panel):
    """The panel in the sidebar of the UV editor."""

    bl_idname = "IMAGE_PT_beltrami"
    bl_label = "beltrami"
    bl_space_type = "IMAGE_EDITOR"
    bl_region_type = "UI"
    bl_category = "beltrami"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """Return whether UVs are shown."""
        return context.space_data.show_uvedit or context.mode == "OBJECT"

    def draw(self, context: Any) -> None:
        """Draw buttons, and what they need to know."""
        layout, held = self.layout, context.scene.beltrami
        job = shown["job"]
        if job is not None:
            layout.progress(factor=job.fraction, text=f"{job.stage} (Esc: cancel)")
            return
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column()
        for name in ("cut", "keep_pins", "sharp_seams"):
            column.prop(held, name)
        handed = ("cut", "keep_pins", *_COMMON, *settings.UNWRAP_OPTIONS)
        self._button(UV_OT_beltrami_unwrap, "Unwrap", handed, held)
        layout.prop(context.window_manager, "beltrami_live", toggle=True)
        if shown["live"]:
            layout.label(text=shown["live"], icon="ERROR")
        layout.separator()
        column = layout.column()
        for name in (*_HAND_SET, "keep_seams", "mark_seams"):
            column.prop(held, name, slider=name == "target_energy")
        handed = ("keep_seams", *_COMMON, *settings.AUTO_OPTIONS)
        self._button(UV_OT_beltrami_auto, "Auto Unwrap", handed, held)
        layout.separator()
        layout.column().prop(held, "straight")
        handed = ("straight", "keep_pins", "mark_seams", "scaled", *settings.STRAIGHTEN_OPTIONS)
        self._button(UV_OT_beltrami_straighten, "Straighten", handed, held)
        layout.separator()
        self._button(
            UV_OT_beltrami_pack, "Pack", ("keep_pins", "scaled", *settings.PAGE_OPTIONS), held
        )
        layout.separator()
        column = layout.column()
        names = ("allow_mirrored", "colours", "selected_only", "select_faces")
        for name in names:
            column.prop(held, name)
        self._button(UV_OT_beltrami_check, "Check", ("scaled", *names), held)
        for line in shown["check"]:
            layout.label(text=line)

    def _button(self, cls: Any, text: str, names: tuple[str, ...], held: Any) -> None:
        button = self.layout.operator(cls.bl_idname, text=text)
        for name in names:
            setattr(button, name, getattr(held, name))
        taken = button.bl_rna.properties.get("materials")
        if taken is not None and held.materials in taken.enum_items:
            button.materials = held.materials


_COMMON = ("sharp_seams", "mark_seams", "scaled")


class _Section:
    bl_space_type = "IMAGE_EDITOR"
    bl_region_type = "UI"
    bl_category = "beltrami"
    bl_parent_id = "IMAGE_PT_beltrami"
    bl_options = {"DEFAULT_CLOSED"}
    names: tuple[str, ...]

    def draw(self, context: Any) -> None:
        """Draw the settings."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for name in self.names:
            self.layout.prop(context.scene.beltrami, name)


class IMAGE_PT_beltrami_pages(_Section, bpy.types.Panel):
    """Options of pages."""

    bl_label = "Pages"
    names = (*settings.PAGE_OPTIONS, "fill_weight")


class IMAGE_PT_beltrami_seams(_Section, bpy.types.Panel):
    """Options of seams and of the surface."""

    bl_label = "Seams"
    names = (
        "materials",
        *(
            name
            for name in properties.ALL_OPTIONS
            if name not in (*settings.PAGE_OPTIONS, "fill_weight", *_HAND_SET)
        ),
        "scaled",
    )


CLASSES = (UV_MT_beltrami, IMAGE_PT_beltrami, IMAGE_PT_beltrami_pages, IMAGE_PT_beltrami_seams)
_MENUS = ("IMAGE_MT_uvs", "VIEW3D_MT_uv_map")


def draw_menu(self: Any, context: Any) -> None:
    """Add the menu to another."""
    self.layout.separator()
    self.layout.menu(UV_MT_beltrami.bl_idname)


def register() -> None:
    """Register."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    for name in _MENUS:
        getattr(bpy.types, name).append(draw_menu)


def unregister() -> None:
    """Unregister."""
    for name in _MENUS:
        getattr(bpy.types, name).remove(draw_menu)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
