"""Cost against size: one disk refined from 10,000 to 10,000,000 faces, by ours and by others.

    sizes.py [DISK.obj] [--faces 10000 10000000] [--steps 7] [--seconds 600] [--out FOLDER]
             [--rivals-python PYTHON] [--record]

The disk is refined without a change of its surface; without one it is a body with limbs of 8,000
faces, opened along a short seam. Ours, libigl's SLIM, SCAF and least-squares
conformal map (LSCM), and Blender's minimum stretch take turns at each size, each run in a process
of its own and on one thread; all maps are measured by our exact checks. What would take longer than
--seconds at the next size by what it took at this one is left out from there on. FOLDER gets the
picture, cost.svg and cost.png.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import records
from evaluate_data import BODY, Mesh, digest_of, sizes
from evaluate_pictures import COLOURS, LABELS, columns
from evaluate_process import execute
from evaluate_runs import Run, Setting

PROGRAMS = ("beltrami", "LSCM", "SLIM", "SCAF", "Blender")
NAMES = {"beltrami": "ours", **{name: name for name in PROGRAMS[1:]}}
# Between two sizes costs grow at least as the faces, mostly a little faster.
GROWTH = 1.2
WALL = 3600.0  # seconds that a run may take, its mesh and the measuring included
SEAM = 3  # points that the seam of the body joins


def figures_of(found: dict[str, Any], faces: int, program: str) -> dict[str, Any]:
    """Return what is shown and recorded of a run."""
    row = {"program": program, "faces": faces, "status": found["status"]}
    if "energies" in found:
        row["cpu_seconds"] = round(found["cpu_seconds"], 3)
        row["energy"] = found["energies"]["symmetric-dirichlet"]
        row["flips"] = found["flips"]
        row["peak_bytes"] = found["peak_bytes"]
    return row


def disk_of(path: Path | None) -> Mesh:
    """Return the disk, not yet refined."""
    if path is None:
        source = f"{BODY}1"
        return Mesh("body 1", source, digest_of(source), SEAM)
    return Mesh(path.stem, str(path.resolve()), digest_of(str(path)))


def run_all(
    disk: Mesh, counts: Sequence[int], programs: Sequence[str], setting: Setting
) -> list[dict[str, Any]]:
    """Run the programs at one size after the other; a line is printed of each."""
    rows: list[dict[str, Any]] = []
    last: dict[str, dict[str, Any]] = {}
    print(f"{'faces':>10}  {'program':8} {'CPU s':>8} {'E':>8} {'flips':>6} {'GB':>6}")
    for faces in counts:
        mesh = Mesh(**{**disk.flat(), "faces": faces})
        for program in programs:
            before = last.get(program)
            if before is not None:
                growth = (faces / before["faces"]) ** GROWTH
                if before.get("cpu_seconds", float("inf")) * growth > setting.limit:
                    continue
            run = Run(mesh, NAMES[program], faces, program=program)
            row = figures_of(execute(setting.task(run, WALL)), faces, program)
            rows.append(row)
            last[program] = row
            print(line_of(row), flush=True)
        # The next size has a mesh of its own.
        for made in (setting.folder / "meshes").glob("*.npz"):
            made.unlink()
    return rows


def line_of(row: dict[str, Any]) -> str:
    """Return the line of the table about a run."""
    head = f"{row['faces']:10,}  {row['program']:8}"
    if "energy" not in row:
        return f"{head} {row['status']}"
    return (
        f"{head} {row['cpu_seconds']:8.2f} {row['energy']:8.4f} {row['flips']:6}"
        f" {row['peak_bytes'] / 1e9:6.2f}"
    )


def draw(rows: Sequence[dict[str, Any]], out: Path) -> None:
    """Write the picture: CPU seconds and memory against faces."""
    figure, axes = columns(2, 3.6, 4.6)
    for program in PROGRAMS:
        own = [row for row in rows if row["program"] == program and "energy" in row]
        if not own:
            continue
        name = NAMES[program]
        style = {"color": COLOURS[name], "label": LABELS[name], "linewidth": 1.5}
        faces = [row["faces"] for row in own]
        axes[0].plot(faces, [row["cpu_seconds"] for row in own], "o-", **style)
        axes[1].plot(faces, [row["peak_bytes"] / 1e9 for row in own], "o-", **style)
    for place, label in zip(axes, ("CPU seconds", "GB at the peak of the process")):
        place.set(xscale="log", yscale="log", xlabel="faces", ylabel=label)
    axes[0].legend(fontsize=8)
    out.mkdir(parents=True, exist_ok=True)
    figure.savefig(out / "cost.svg", metadata={"Date": None})
    figure.savefig(out / "cost.png")


def installed(rivals: str | None) -> list[str]:
    """Return the programs that are here: Blender's has an interpreter of its own."""
    here = ["beltrami"]
    try:
        importlib.metadata.version("libigl")
        here += ["LSCM", "SLIM", "SCAF"]
    except importlib.metadata.PackageNotFoundError:
        print("sizes: libigl is not installed", file=sys.stderr)
    return here + (["Blender"] if rivals else [])


def main() -> None:
    """Run the program."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("disk", nargs="?", type=Path, metavar="DISK")
    parser.add_argument(
        "--faces", nargs=2, type=int, default=(10_000, 10_000_000), metavar=("LEAST", "MOST")
    )
    parser.add_argument("--steps", type=int, default=7, help="sizes, evenly on a logarithmic scale")
    parser.add_argument("--seconds", type=float, default=600, help="CPU seconds of a run")
    parser.add_argument("--out", type=Path, help="folder for the picture")
    parser.add_argument("--rivals-python", metavar="PYTHON", help="interpreter that has Blender")
    records.add_option(parser)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="sizes-") as folder:
        setting = Setting(
            folder=Path(folder),
            own=sys.executable,
            rivals=arguments.rivals_python or sys.executable,
            limit=arguments.seconds,
            budget=float("inf"),
        )
        counts = sizes(arguments.steps, *arguments.faces)
        disk = disk_of(arguments.disk)
        rows = run_all(disk, counts, installed(arguments.rivals_python), setting)
    if arguments.out:
        draw(rows, arguments.out)
    if arguments.record:
        records.write("sizes", [{"mesh": disk.name, **row} for row in rows])


if __name__ == "__main__":
    main()
