"""What seams cost: ours at each effort beside xatlas, uvunwrap and UVAtlas, in one run.

    effort.py [FILES OR FOLDERS...] [--generated 40000 150000] [--record]

All programs get the same triangles, one thread each, as in atlas.py. The last table has geometric
means by size class over the meshes that a program and xatlas took: CPU seconds, length of seams and
texels per unit of length on a square page, each over those of xatlas, and how many maps of ours
miss the energy of 2.05. With --generated meshes are made, of about so many triangles; see
generated.py.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import records
from atlas import SPOT, loaded
from atlas_runs import Limits, Mesh, Program, Row, run, versions
from atlas_tables import HEAD, LEAST_SECONDS, line, reaches
from generated import generated

RIVALS = ("xatlas", "uvunwrap", "UVAtlas")
LEVELS = ("quick", "normal", "high")
TARGET = 2.05
# Triangles up to which a mesh is of a class.
CLASSES = (900, 4_000, 20_000, 100_000, 2_000_000)


def meshes_of(arguments: argparse.Namespace) -> Iterator[Mesh]:
    """Yield the meshes of files, and those that are made."""
    for mesh in loaded(arguments.meshes):
        if len(mesh.faces) <= arguments.most:
            yield mesh
    for target in arguments.generated:
        yield from generated(target)


def ratio(what: str, row: Row | None, rival: Row | None) -> float:
    """Return a figure over that of xatlas, NaN where there is none."""
    if row is None or rival is None or row.figures is None or rival.figures is None:
        return np.nan
    if what == "CPU":
        return max(row.cpu_seconds, LEAST_SECONDS) / max(rival.cpu_seconds, LEAST_SECONDS)
    if what == "seams":
        return row.figures.seams / rival.figures.seams if rival.figures.seams > 0 else np.nan
    return float(np.sqrt(row.figures.filled / rival.figures.filled))


def mean_of(ratios: list[float]) -> str:
    """Return the geometric mean of those that there are and are above zero."""
    found = [each for each in ratios if each > 0]
    return f"{np.exp(np.mean(np.log(found))):9.3f}" if found else f"{'-':>9}"


def summary(table: list[dict[str, Row]], names: list[str]) -> list[str]:
    """Return a line per size class and program."""
    head = f"  {'program':10} {'meshes':>7} {'CPU':>9} {'seams':>9} {'density':>9} {'missed':>7}"
    lines = []
    least = 0
    for most in CLASSES:
        rows = [each for each in table if least < next(iter(each.values())).faces <= most]
        if rows:
            lines += [f"{least + 1:,} to {most:,} triangles, over xatlas", head]
        for name in names if rows else ():
            means = "".join(
                f" {mean_of([ratio(what, each.get(name), each.get('xatlas')) for each in rows])}"
                for what in ("CPU", "seams", "density")
            )
            taken = sum(each[name].figures is not None for each in rows if name in each)
            missed = sum(not reaches(each.get(name), TARGET + 1e-4) for each in rows)
            note = f" {missed:7d}" if name in LEVELS else ""
            lines.append(f"  {name:10} {taken:7d}{means}{note}")
        least = most
    return lines


def options() -> argparse.Namespace:
    """Return the arguments of the program."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("meshes", type=Path, nargs="*", help="files, and folders of files")
    add("--most", type=int, default=100_000, help="triangles of a mesh in a file")
    add("--generated", type=int, nargs="+", default=[], metavar="FACES", help="meshes to make")
    add("--levels", nargs="*", choices=LEVELS, default=LEVELS, help="of ours")
    add("--programs", nargs="*", choices=RIVALS, default=RIVALS, help="the rivals")
    add("--seconds", type=float, default=120, help="CPU seconds of a run")
    add("--gigabytes", type=float, default=8, help="memory of a run")
    add("--rivals-python", type=Path, default=Path(sys.executable), metavar="PYTHON")
    records.add_option(parser)
    arguments = parser.parse_args()
    if not arguments.meshes and not arguments.generated:
        arguments.meshes = [SPOT]
    return arguments


def main() -> None:
    """Compare on the meshes that the command line names."""
    arguments = options()
    installed = versions(arguments.rivals_python)
    programs = [Program(level, keywords={"effort": level}) for level in arguments.levels]
    programs += [Program(name, installed[name]) for name in arguments.programs if name in installed]
    limits = Limits(arguments.seconds, arguments.gigabytes)
    print(HEAD)
    table = []
    with np.errstate(over="ignore", divide="ignore"):  # of energies of nearly flat triangles
        for mesh in meshes_of(arguments):
            print(f"{mesh.name}: {len(mesh.faces)} triangles")
            rows = {}
            for program in programs:
                rows[program.name] = run(arguments.rivals_python, program, mesh, limits)
                print(line(rows[program.name]), flush=True)
            table.append(rows)
        print()
        print("\n".join(summary(table, [program.name for program in programs])))
    if arguments.record:
        records.write("effort", [row.flat() for rows in table for row in rows.values()])


if __name__ == "__main__":
    main()
