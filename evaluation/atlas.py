"""Atlases of any mesh, beside those of xatlas, uvunwrap, UVAtlas and Blender.

    atlas.py [FILES OR FOLDERS...] [--closed-or-parts] [--refine 100000 1000000]
             [--rivals ROWS.jsonl] [--record]

Every mesh (all that trimesh reads in a folder; without any the examples' spot) is unwrapped by

- ours, with the keywords of each variant;
- with --islands ours along the seams that xatlas chose: what is left in the same charts;
- xatlas and uvunwrap from their wheels, UVAtlas by open3d, and Smart UV Project by Blender's wheel,
  with their default options. One that is not installed is left out, but for rows of --rivals.

Each run has a process of its own, on one thread where the program can be told so: one that crashes,
hangs, or takes more than its limits is a line of the table. All meet the same triangles, vertices
at one place welded and those without area left out, and all are measured by one function, whose
figures `atlas_figures.Figures` describes. CPU seconds are those of the call alone, and carry to no
other machine: rows that --rivals reuses have those of the run that wrote them.
"""

from __future__ import annotations

import argparse
import dataclasses
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import records
from atlas_runs import Cache, Limits, Mesh, Program, Row, load, run, versions
from atlas_tables import HEAD, line, summary
from meshes import FOLDER, edges, refine

SUFFIXES = {".obj", ".off", ".ply", ".stl", ".glb", ".gltf"}
SPOT = FOLDER / "spot.obj"
RIVALS = ("xatlas", "uvunwrap", "UVAtlas", "Blender")
# Our variants, by name, with the keywords of unwrap.
OURS: dict[str, dict[str, object]] = {
    "quick": {"effort": "quick"},
    "default": {},
    "auto 2.1": {"target_energy": 2.1},
    "auto 2.01": {"target_energy": 2.01},
}
ISLANDS: dict[str, dict[str, object]] = {
    "islands": {"cut": "islands"},
}


def files_of(given: list[Path]) -> Iterator[Path]:
    """Yield the files given, and those in the folders given."""
    for path in given:
        if path.is_dir():
            yield from sorted(file for file in path.iterdir() if file.suffix.lower() in SUFFIXES)
        else:
            yield path


def refined(mesh: Mesh, target: int) -> Mesh | None:
    """Return a finer mesh, None of a surface that is not closed and manifold, or fine enough."""
    if len(mesh.faces) >= target or not (edges(mesh.faces)[2] == 2).all():
        return None
    vertices, faces = refine(mesh.vertices, mesh.faces, target)
    return Mesh(f"{mesh.name}@{target}", vertices, faces)


def loaded(given: list[Path]) -> Iterator[Mesh]:
    """Yield the meshes of files and folders, and say which are not read."""
    for path in files_of(given):
        try:
            yield load(path)
        except Exception as error:  # of trimesh, on broken files
            print(f"{path.name}: not read: {error}")


def meshes_of(arguments: argparse.Namespace) -> Iterator[Mesh]:
    """Yield the meshes to unwrap."""
    for mesh in loaded(arguments.meshes):
        if arguments.closed_or_parts and not mesh.closed() and mesh.parts() == 1:
            continue
        if len(mesh.faces) <= arguments.most:
            yield mesh
        for target in arguments.refine:
            finer = refined(mesh, target)
            if finer is not None:
                yield finer


def programs_of(arguments: argparse.Namespace, cache: Cache) -> list[Program]:
    """Return ours, and the rivals that are installed or that the cache knows."""
    variants = {**OURS, **ISLANDS} if arguments.islands else OURS
    programs = [Program(name, keywords=keywords) for name, keywords in variants.items()]
    if arguments.only_rivals:
        programs = []
    installed = versions(arguments.rivals_python)
    for name in arguments.programs:
        if name in installed or cache.knows(name):
            programs.append(Program(name, installed.get(name, "")))
        else:
            print(f"{name} is not installed", file=sys.stderr)
    return programs


def compare(
    mesh: Mesh, programs: list[Program], cache: Cache, arguments: argparse.Namespace
) -> dict[str, Row]:
    """Unwrap one mesh by all, and print what came of it."""
    limits = Limits(arguments.seconds, arguments.gigabytes)
    print(f"{mesh.name}: {len(mesh.faces)} triangles")
    rows: dict[str, Row] = {}
    for program in programs:
        rival = program.keywords is None
        row = cache.find(mesh.digest(), program, limits) if rival else None
        if row is None and rival and not program.version:
            continue
        if row is None:
            row = run(arguments.rivals_python, program, mesh, limits)
            if rival:
                cache.add(row)
        rows[program.name] = dataclasses.replace(row, mesh=mesh.name)
        print(line(row), flush=True)
    return rows


def options() -> argparse.Namespace:
    """Return the arguments of the program."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("meshes", type=Path, nargs="*", help="files, and folders of files")
    add("--most", type=int, default=300_000, help="triangles of a mesh as it is in its file")
    add("--closed-or-parts", action="store_true", help="leave out open meshes of one part")
    add(
        "--refine",
        type=int,
        nargs="+",
        default=[],
        metavar="FACES",
        help="closed manifold meshes also refined to about so many triangles",
    )
    add("--islands", action="store_true", help="ours along the seams of xatlas, too")
    add("--programs", nargs="*", choices=RIVALS, default=RIVALS, help="the rivals")
    add("--only-rivals", action="store_true", help="leave out ours: to fill --rivals")
    add("--seconds", type=float, default=120, help="CPU seconds of a run")
    add("--gigabytes", type=float, default=8, help="memory of a run")
    add("--rivals", type=Path, metavar="ROWS.jsonl", help="reuse rivals' rows, and append new ones")
    add(
        "--rivals-python",
        type=Path,
        default=Path(sys.executable),
        metavar="PYTHON",
        help="that of the environment that has the rivals",
    )
    records.add_option(parser)
    arguments = parser.parse_args()
    arguments.meshes = arguments.meshes or [SPOT]
    return arguments


def main() -> None:
    """Compare on the meshes that the command line names."""
    arguments = options()
    cache = Cache(arguments.rivals)
    programs = programs_of(arguments, cache)
    print(HEAD)
    with np.errstate(over="ignore"):  # of energies of nearly flat triangles
        table = [compare(mesh, programs, cache, arguments) for mesh in meshes_of(arguments)]
    print()
    print("\n".join(summary(table, programs)))
    if arguments.record:
        records.write("atlas", [row.flat() for rows in table for row in rows.values()])


if __name__ == "__main__":
    main()
