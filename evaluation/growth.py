"""Cost of unwrapping against size: a figure and a turned part from 100 to 10,000,000 triangles.

    growth.py [--faces 100 10000000] [--steps 11] [--levels quick normal] [--out FOLDER] [--record]

A smooth line without a cliff is what this looks for. The figure is one of marching cubes
(generated.py), so that small ones have less of its folds; the turned part is a stepped shaft, whose
sharp edges stay as it is divided. Each run has a process of its own and one thread. FOLDER gets the
picture, growth.svg and growth.png.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import records
from atlas_runs import Limits, Mesh, Program, Row, run
from atlas_tables import HEAD, line
from evaluate_data import sizes
from evaluate_pictures import columns
from generated import figure, marching_cubes, sized

# Radius and place along the axis of the corners of a stepped shaft.
PROFILE = ((0, 0), (1, 0), (1, 0.8), (0.6, 0.8), (0.6, 2.4), (0.9, 2.4), (0.9, 2.8), (0, 2.8))
LEAST_SIDES = 6  # around it


def shaft(target: int) -> Mesh:
    """Return a stepped shaft of about so many triangles, which are about as wide as long."""
    corners = np.array(PROFILE, float)
    lengths = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    around = max(LEAST_SIDES, round(np.sqrt(target * np.pi / lengths.sum())))
    step = 2 * np.pi / around
    profile = [corners[:1]]
    for a, b, length in zip(corners[:-1], corners[1:], lengths, strict=True):
        cuts = max(1, round(length / step)) if around > LEAST_SIDES else 1
        profile.append(a + (b - a) * np.linspace(0, 1, cuts + 1)[1:, None])
    radius, height = np.concatenate(profile)[1:-1].T
    angle = step * np.arange(around)
    rings = np.stack(
        [
            radius[:, None] * np.cos(angle),
            radius[:, None] * np.sin(angle),
            np.repeat(height[:, None], around, 1),
        ],
        -1,
    ).reshape(-1, 3)
    count = len(radius)
    ends = np.array([[0, 0, PROFILE[0][1]], [0, 0, PROFILE[-1][1]]])
    this, after = np.arange(around), np.roll(np.arange(around), -1)
    faces = [np.stack([np.full(around, count * around), after, this], 1)]
    for ring in range(count - 1):
        low, high = ring * around, (ring + 1) * around
        faces.append(np.stack([low + this, low + after, high + after], 1))
        faces.append(np.stack([low + this, high + after, high + this], 1))
    top = (count - 1) * around
    faces.append(np.stack([np.full(around, count * around + 1), top + this, top + after], 1))
    return Mesh(f"shaft@{target}", np.concatenate([rings, ends]), np.concatenate(faces))


def draw(rows: Sequence[tuple[str, Row]], out: Path) -> None:
    """Write the picture: CPU seconds against triangles, a line per mesh and level."""
    picture, axes = columns(1, 3.6, 4.6)
    for label in dict.fromkeys(label for label, _ in rows):
        own = [row for each, row in rows if each == label and row.figures is not None]
        axes[0].plot([r.faces for r in own], [r.cpu_seconds for r in own], "o-", label=label)
    axes[0].set(xscale="log", yscale="log", xlabel="triangles", ylabel="CPU seconds")
    axes[0].legend(fontsize=8)
    out.mkdir(parents=True, exist_ok=True)
    picture.savefig(out / "growth.svg", metadata={"Date": None})
    picture.savefig(out / "growth.png")


def main() -> None:
    """Run the program."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("--faces", nargs=2, type=int, default=(100, 10_000_000), metavar=("LEAST", "MOST"))
    add("--steps", type=int, default=11, help="sizes, evenly on a logarithmic scale")
    add("--levels", nargs="+", default=["quick", "normal"], help="of effort")
    add("--seconds", type=float, default=600, help="CPU seconds of a run")
    add("--gigabytes", type=float, default=16, help="memory of a run")
    add("--out", type=Path, help="folder for the picture")
    records.add_option(parser)
    arguments = parser.parse_args()
    limits = Limits(arguments.seconds, arguments.gigabytes)
    rows: list[tuple[str, Row]] = []
    print(HEAD)
    with np.errstate(over="ignore", divide="ignore"):  # of energies of nearly flat triangles
        for faces in sizes(arguments.steps, *arguments.faces):
            for mesh in (sized("figure", figure, marching_cubes, faces), shaft(faces)):
                print(f"{mesh.name}: {len(mesh.faces)} triangles")
                for level in arguments.levels:
                    program = Program(level, keywords={"effort": level})
                    row = run(Path(sys.executable), program, mesh, limits)
                    rows.append((f"{mesh.name.split('@')[0]}, {level}", row))
                    print(line(row), flush=True)
    if arguments.out:
        draw(rows, arguments.out)
    if arguments.record:
        records.write("growth", [row.flat() for _, row in rows])


if __name__ == "__main__":
    main()
