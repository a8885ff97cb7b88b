#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the extension's operators with Blender's own, in Blender: a table in Markdown.

    compare.py --zip ZIP [--runs 3] [--pictures FOLDER]

Meshes are Blender's monkey with marked seams, a cow, and the same cow in 92,248 triangles. The
seams of the cow are those that Auto Unwrap finds and marks; all operators that respect seams get
the same. Energies, flips and overlaps are the exact verdict on the UVs that Blender holds
afterwards, whoever made them. CPU is that of the whole process during the operator, on one thread
of the extension: the least of the runs. With --pictures the layouts are drawn.
"""

from __future__ import annotations

import argparse
import importlib
import os
import sys
import tempfile
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, TextIO

import numpy as np

_user = tempfile.TemporaryDirectory(prefix="beltrami-blender-")
os.environ["BLENDER_USER_RESOURCES"] = _user.name  # before bpy reads it

import bpy  # noqa: E402

MODULE = "bl_ext.user_default.beltrami"
SPOT = Path(__file__).resolve().parents[3] / "examples" / "data" / "spot.obj"


def monkey() -> Any:
    """Return Blender's monkey with seams in its middle, from the back of the head to the chin."""
    bpy.ops.mesh.primitive_monkey_add()
    thing = bpy.context.object
    mesh = thing.data
    for edge in mesh.edges:
        ends = [mesh.vertices[k].co for k in edge.vertices]
        edge.use_seam = all(abs(end.x) < 1e-4 and end.y > -0.6 for end in ends)
    return thing


def cow() -> Any:
    """Return the cow with the seams that Auto Unwrap marks."""
    bpy.ops.wm.obj_import(filepath=str(SPOT))
    thing = bpy.context.object
    edit(thing)
    bpy.ops.uv.beltrami_auto(mark_seams=True)
    bpy.ops.object.mode_set(mode="OBJECT")
    return thing


def large_cow() -> Any:
    """Return the cow with each triangle in four, smoothed."""
    thing = cow()
    edit(thing)
    bpy.ops.mesh.subdivide(smoothness=1)
    bpy.ops.object.mode_set(mode="OBJECT")
    return thing


MESHES = {"monkey": monkey, "cow": cow, "large cow": large_cow}

#: By operator what runs it, and whether it respects seams.
OPERATORS: dict[str, Callable[[], Any]] = {
    "**Unwrap**": lambda: bpy.ops.uv.beltrami_unwrap(),
    "Blender, minimum stretch": lambda: bpy.ops.uv.unwrap(method="MINIMUM_STRETCH"),
    "Blender, angle based": lambda: bpy.ops.uv.unwrap(method="ANGLE_BASED"),
    "Blender, conformal": lambda: bpy.ops.uv.unwrap(method="CONFORMAL"),
    "**Auto Unwrap**": lambda: bpy.ops.uv.beltrami_auto(keep_seams=False),
    "**Auto Unwrap**, quick": lambda: bpy.ops.uv.beltrami_auto(keep_seams=False, effort="quick"),
    "Blender, smart project": lambda: bpy.ops.uv.smart_project(),
}


def edit(thing: Any) -> None:
    """Edit an object, with all faces selected."""
    bpy.ops.object.select_all(action="DESELECT")
    thing.select_set(True)
    bpy.context.view_layer.objects.active = thing
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")


def install(path: Path) -> None:
    """Install the extension from its zip, for one thread."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.extensions.package_install_files(
        filepath=str(path.resolve()), repo="user_default", enable_on_install=True
    )
    bpy.context.preferences.addons[MODULE].preferences.threads = 1


def run(thing: Any, operator: Callable[[], Any], runs: int) -> float:
    """Run an operator several times from the same mesh, and return its least CPU seconds."""
    least = np.inf
    for _ in range(runs):
        bpy.ops.object.mode_set(mode="OBJECT")
        zeros = np.zeros(2 * len(thing.data.loops), np.float32)
        thing.data.uv_layers.active.uv.foreach_set("vector", zeros)
        edit(thing)
        begin = time.process_time()
        operator()
        least = min(least, time.process_time() - begin)
    return float(least)


def measured(thing: Any) -> tuple[Any, Any]:
    """Return the surface, and what its UVs are worth."""
    modules = [importlib.import_module(f"{MODULE}.{name}") for name in ("bridge", "uv_logic")]
    parts = importlib.import_module(f"{MODULE}.uv_logic.parts")
    measuring = importlib.import_module(f"{MODULE}.uv_logic.measuring")
    surface = parts.joined([modules[0].read(thing, modules[0].Reading(everything=True))])
    return surface, measuring.measure(surface, surface.uvs)


def row(name: str, mesh: str, seconds: float, found: Any) -> str:
    """Return a row of the table."""
    numbers = f"{found.energy:.3f} | {found.p99:.2f} | {found.flips} | {found.overlaps}"
    return f"| {mesh} | {name} | {numbers} | {found.charts} | {found.covered:.2f} | {seconds:.2f} |"


def draw(path: Path, surface: Any, title: str) -> None:
    """Draw a layout, what is flipped in red."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    import beltrami
    from beltrami import plot

    cut = beltrami.triangulate(surface.vertices, surface.faces())
    figure, axes = plt.subplots(figsize=(4, 4.2), layout="constrained")
    plot.layout(surface.uvs, cut.corners, axes)
    axes.set(xlim=(-0.01, 1.01), ylim=(-0.01, 1.01), title=title)
    axes.axis("off")
    figure.savefig(path, dpi=90)
    plt.close(figure)


def own_output() -> TextIO:
    """Return standard output for this program alone: what Blender prints is dropped."""
    sys.stdout.flush()
    own = os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    return own


def main() -> None:
    """Run the program."""
    parser = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    parser.add_argument("--zip", type=Path, required=True)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--pictures", type=Path)
    arguments = parser.parse_args()
    table = own_output()
    install(arguments.zip)
    warnings.simplefilter("ignore")
    if arguments.pictures:
        arguments.pictures.mkdir(parents=True, exist_ok=True)
    print(f"Blender {bpy.app.version_string}\n", file=table)
    print(
        "| mesh | operator | energy | p99 | flips | overlaps | islands | covered | CPU, s |",
        file=table,
    )
    print("|---|---|--:|--:|--:|--:|--:|--:|--:|", file=table)
    for mesh, make in MESHES.items():
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        if MODULE not in bpy.context.preferences.addons:
            bpy.ops.preferences.addon_enable(module=MODULE)
        bpy.context.preferences.addons[MODULE].preferences.threads = 1
        thing = make()
        for name, operator in OPERATORS.items():
            try:
                seconds = run(thing, operator, arguments.runs)
            except TypeError:  # a method that this Blender does not have
                continue
            surface, found = measured(thing)
            print(row(name, mesh, seconds, found), file=table, flush=True)
            if arguments.pictures:
                plain = name.replace("*", "").replace(",", "").replace(" ", "-").lower()
                path = arguments.pictures / f"{mesh.replace(' ', '-')}-{plain}.png"
                draw(path, surface, name.replace("*", ""))


if __name__ == "__main__":
    main()
