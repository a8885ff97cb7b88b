# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators: Unwrap, Auto Unwrap, Straighten, Pack and Check."""

# Blender evaluates annotations where a class is registered: they must be no strings.

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import bpy
import numpy as np

from . import bridge, properties
from .properties import with_options, with_switches
from .running import RunningMixin, shown
from .uv_logic import measuring, packing, settings, straightening, unwrapping
from .uv_logic.jobs import Progress
from .uv_logic.parts import Part, RefusedError, joined
from .uv_logic.unwrapping import Request

_OPTIONS = {"REGISTER", "UNDO"}


@dataclass
class Target:
    """An object, and its mesh when it was read."""

    thing: Any
    part: Part

    def require_unchanged(self) -> None:
        """Raise ValueError where the mesh has other corners by now, or is gone."""
        try:
            self.thing.update_from_editmode()
            same = len(self.thing.data.loops) == len(self.part.corners)
        except ReferenceError:
            same = False
        if not same:
            raise ValueError(f"{self.part.name} has changed in the meantime: run it again")


def read_all(context: Any, how: bridge.Reading) -> list[Target]:
    """Return the objects to work on with their meshes; raises RefusedError without any face."""
    context.view_layer.update()  # where objects are, after a script has moved them
    targets = [Target(thing, bridge.read(thing, how)) for thing in bridge.objects(context)]
    targets = [target for target in targets if len(target.part.sizes)]
    if not any(target.part.chosen.any() for target in targets):
        raise RefusedError("no face is selected: select the faces to work on")
    return targets


def describe(found: measuring.Measures) -> str:
    """Return what UVs are worth, in one line."""
    flips = counted(found.flips, "flipped triangle") if found.flips else "no flips"
    overlaps = counted(found.overlaps, "overlap") if found.overlaps else "no overlaps"
    sentence = f"{counted(found.charts, 'island')}, {flips}, {overlaps}"
    if not np.isfinite(found.energy):
        return f"{sentence}, no face with an area both in space and in the UVs"
    return (
        f"{sentence}, distortion {found.energy:.4g} in the mean (2 is none), {found.p99:.4g} at 99%"
    )


def counted(number: int, what: str) -> str:
    """Return a number of things in words."""
    return f"1 {what}" if number == 1 else f"{number} {what}s"


def details(found: measuring.Measures) -> tuple[str, ...]:
    """Return what UVs are worth, in short lines."""
    smallest, largest = np.exp(found.stretch.min()), np.exp(found.stretch.max())
    return (
        f"Islands: {found.charts}",
        f"Flipped: {found.flips}",
        f"Overlaps: {found.overlaps}",
        f"Distortion: {found.energy:.4g} (2 is none)",
        f"Of 99%: {found.p99:.4g}",
        f"Lengths: {smallest:.2g} to {largest:.2g}",
        f"Page covered: {100 * found.covered:.0f}%",
    )


class UnwrapMixin(RunningMixin):
    """What `Unwrap` and `Auto Unwrap` have in common."""

    bl_options = _OPTIONS
    names: tuple[str, ...]

    def request(self, context: Any) -> Request:
        """Return what to do."""
        raise NotImplementedError

    def invoke(self, context: Any, event: Any) -> set[str]:
        """Take the resolution of the picture that is shown, where none is given."""
        take_resolution(self, context)
        return super().invoke(context, event)

    def prepare(self, context: Any) -> Callable[[Progress], Any]:
        """Read meshes, and return the work."""
        how = bridge.Reading(self.sharp_seams, self.scaled, bridge.by_uvs(context))
        self.targets = read_all(context, how)
        parts = [target.part for target in self.targets]
        if not getattr(self, "keep_seams", True):
            parts = [replace(part, seams=np.zeros_like(part.seams)) for part in parts]
        request = self.request(context)
        return lambda progress: unwrapping.unwrap(parts, request, progress)

    def finish(self, context: Any, result: unwrapping.Unwrapped) -> None:
        """Write UVs, and seams where they are to be marked."""
        for target in self.targets:
            target.require_unchanged()
        for target, uvs, seams in zip(self.targets, result.uvs, result.seams):
            bridge.write_uvs(target.thing, target.part, uvs)
            if self.mark_seams:
                bridge.mark_seams(target.thing, target.part, seams)
        sentence = describe(result.measures)
        if result.reached is False:
            sentence += "; the distortion asked for was not reached"
        if result.density < 1:
            sentence += f"; {100 * result.density:.0f}% of the others' density, for want of room"
        level = "INFO" if result.measures.sound and result.reached is not False else "WARNING"
        self.report({level}, sentence)

    def draw(self, context: Any) -> None:
        """Draw the properties."""
        draw_properties(self.layout, self)


@with_switches("sharp_seams", "keep_pins", "mark_seams", "scaled")
@with_options(settings.UNWRAP_OPTIONS)
class UV_OT_beltrami_unwrap(UnwrapMixin, bpy.types.Operator):
    """Flatten the selected faces along marked seams without flips or overlaps, and pack them."""

    bl_idname = "uv.beltrami_unwrap"
    bl_label = "Unwrap (beltrami)"
    names = settings.UNWRAP_OPTIONS

    cut: properties.islands()
    materials: properties.materials(2)

    def request(self, context: Any) -> Request:
        """Return what to do."""
        values = properties.values_of(self, self.names)
        given = settings.given(values, "unwrap")
        count = properties.threads(context)
        return Request(
            self.cut, self.materials, self.keep_pins, given, count, tell_seams=self.mark_seams
        )


@with_switches("keep_seams", "sharp_seams", "mark_seams", "scaled")
@with_options(settings.AUTO_OPTIONS)
class UV_OT_beltrami_auto(UnwrapMixin, bpy.types.Operator):
    """Find short seams for the distortion asked for, flatten the selected faces and pack them."""

    bl_idname = "uv.beltrami_auto"
    bl_label = "Auto Unwrap (beltrami)"
    names = settings.AUTO_OPTIONS

    materials: properties.materials(3)

    def request(self, context: Any) -> Request:
        """Return what to do."""
        values = properties.values_of(self, self.names)
        given = settings.given(values, "unwrap")
        count = properties.threads(context)
        return Request("auto", self.materials, False, given, count, tell_seams=self.mark_seams)


@with_switches("keep_pins", "mark_seams", "scaled")
@with_options(settings.STRAIGHTEN_OPTIONS)
class UV_OT_beltrami_straighten(UnwrapMixin, bpy.types.Operator):
    """Flatten islands anew with quads as grids or with straight edges, and pack them."""

    bl_idname = "uv.beltrami_straighten"
    bl_label = "Straighten (beltrami)"
    names = settings.STRAIGHTEN_OPTIONS

    straight: properties.straight()

    def request(self, context: Any) -> Request:
        """Return what to do."""
        given = settings.given(properties.values_of(self, self.names), "unwrap")
        count = properties.threads(context)
        kinds = "" if self.straight == "grids" else self.straight
        if not kinds:
            given["rectify"] = "grids"
        if kinds in ("u", "v"):
            given["pack_turns"] = "none"  # a quarter turn would make one of the other
        return Request(
            "islands", "ignore", self.keep_pins, given, count, self.mark_seams, straight=kinds
        )

    def prepare(self, context: Any) -> Callable[[Progress], Any]:
        """Read meshes, and return the work: of selected faces, or of islands of selected edges."""
        edges = self.straight != "grids"
        how = bridge.Reading(scaled=self.scaled, by_uvs=bridge.by_uvs(context), everything=edges)
        self.targets = read_all(context, how)
        if edges:
            for target in self.targets:
                target.part = straightening.with_islands_of_edges(target.part)
            straightening.require_edges([target.part for target in self.targets])
        parts = [target.part for target in self.targets]
        request = self.request(context)
        return lambda progress: unwrapping.unwrap(parts, request, progress)


@with_switches("keep_pins", "scaled")
@with_options(settings.PAGE_OPTIONS)
class UV_OT_beltrami_pack(RunningMixin, bpy.types.Operator):
    """Pack the islands of the selected faces, around those that are not selected."""

    bl_idname = "uv.beltrami_pack"
    bl_label = "Pack (beltrami)"
    bl_options = _OPTIONS

    def invoke(self, context: Any, event: Any) -> set[str]:
        """Take the resolution of the picture that is shown, where none is given."""
        take_resolution(self, context)
        return super().invoke(context, event)

    def prepare(self, context: Any) -> Callable[[Progress], Any]:
        """Read meshes, and return the work."""
        how = bridge.Reading(scaled=self.scaled, by_uvs=bridge.by_uvs(context))
        self.targets = read_all(context, how)
        parts = [target.part for target in self.targets]
        options = settings.given(properties.values_of(self, settings.PAGE_OPTIONS), "pack")
        options["threads"] = properties.threads(context)

        keep_pins = self.keep_pins
        return lambda progress: packing.pack_parts(parts, options, keep_pins, progress)

    def finish(self, context: Any, result: Any) -> None:
        """Write UVs."""
        packed, uvs = result
        for target in self.targets:
            target.require_unchanged()
        for target, of_part in zip(self.targets, uvs):
            bridge.write_uvs(target.thing, target.part, of_part)
        report = packed.report
        where = f"{counted(report.charts, 'island')} on {counted(report.pages, 'tile')}"
        sentence = (
            f"{where}, {100 * report.utilisation:.0f}% covered, "
            f"margin {report.margin:.2f} texels of {report.resolution}"
        )
        if packed.density < 1:
            sentence += f"; {100 * packed.density:.0f}% of the others' density, for want of room"
        self.report({"INFO"}, sentence)


@with_switches("allow_mirrored", "selected_only", "select_faces", "colours", "scaled")
class UV_OT_beltrami_check(RunningMixin, bpy.types.Operator):
    """Judge the UVs by exact predicates: flips, overlaps, stretch; select the faces concerned."""

    bl_idname = "uv.beltrami_check"
    bl_label = "Check (beltrami)"
    bl_options = _OPTIONS

    def prepare(self, context: Any) -> Callable[[Progress], Any]:
        """Read meshes, and return the work."""
        self.in_uvs = bridge.by_uvs(context)
        by_uvs, everything = self.in_uvs, not self.selected_only
        how = bridge.Reading(scaled=self.scaled, by_uvs=by_uvs, everything=everything)
        self.targets = read_all(context, how)
        parts = [target.part for target in self.targets]

        def work(progress: Progress) -> measuring.Measures:
            surface = joined(parts)
            return measuring.measure(surface, surface.uvs, self.allow_mirrored)

        return work

    def finish(self, context: Any, result: measuring.Measures) -> None:
        """Select faces, colour them, and say what was found."""
        for target in self.targets:
            target.require_unchanged()
        if self.select_faces and not result.sound:
            self._select(context, result.flipped | result.overlapping)
        if self.colours:
            colours = measuring.colours(result.stretch)
            for target, of_part in zip(self.targets, self._parted(colours)):
                bridge.write_colours(target.thing, target.part.chosen, of_part)
        sentence = describe(result)
        shown["check"] = details(result)
        self.report({"INFO" if result.sound else "WARNING"}, sentence)

    def _select(self, context: Any, bad: Any) -> None:
        if context.mode == "EDIT_MESH" and not self.in_uvs:
            context.tool_settings.mesh_select_mode = (False, False, True)
        for target, faces in zip(self.targets, self._parted(bad)):
            bridge.select(target.thing, faces.astype(bool), self.in_uvs)

    def _parted(self, of_chosen: Any) -> list[Any]:
        """Return what there is for each chosen face as that of all faces of each object."""
        found, before = [], 0
        for target in self.targets:
            chosen = target.part.chosen
            after = before + int(chosen.sum())
            whole = np.zeros((len(chosen), *of_chosen.shape[1:]), of_chosen.dtype)
            whole[chosen] = of_chosen[before:after]
            found.append(whole)
            before = after
        return found


def take_resolution(operator: Any, context: Any) -> None:
    """Set the resolution to that of the picture in the UV editor, where none is given."""
    image = getattr(context.space_data, "image", None)
    if image is None or operator.properties.is_property_set("resolution"):
        return
    longest = max(image.size)
    option = settings.TABLE["resolution"]
    if option.minimum <= longest <= option.maximum:
        operator.resolution = longest


def draw_properties(layout: Any, operator: Any) -> None:
    """Draw what an operator has: of the surface and the seams first, of the pages in a box."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    box = layout.box()
    for name in operator.__class__.__annotations__:
        place = box if name in settings.PAGE_OPTIONS or name == "fill_weight" else layout
        place.prop(operator, name)


CLASSES = (
    UV_OT_beltrami_unwrap,
    UV_OT_beltrami_auto,
    UV_OT_beltrami_straighten,
    UV_OT_beltrami_pack,
    UV_OT_beltrami_check,
)


def register() -> None:
    """Register."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    """Unregister."""
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
