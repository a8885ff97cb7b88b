"""Unwraps the meshes of docs/guide/unwrap.md: prints its table, and draws its picture.

    atlases.py PROGRAM MESHES FOLDER

PROGRAM is beltrami. MESHES has fish_disk.obj and penguin_disk.obj, of odedstein/meshes, cut open;
spot and nefertiti are in examples/data, the other shapes are written here. All goes into FOLDER: of
that, atlases.png is the picture. Needs Pillow.
"""

from __future__ import annotations

import json
import math
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Callable, NamedTuple

from PIL import Image, ImageDraw, ImageFont

Point = tuple[float, float, float]
Mesh = tuple[list[Point], list[tuple[int, ...]]]

COLUMNS = 4
PANEL = (480, 240)  # of a picture, at three tenths
CAPTION = 26
COLOURS = 64  # more are hardly told apart at this size


class Run(NamedTuple):
    """A mesh, and what it is unwrapped with."""

    mesh: str
    options: str


RUNS = [
    Run("spot", "--target-energy 2.1"),
    Run("spot", ""),
    Run("spot", "--target-energy 2.01"),
    Run("spot", "--preset one-chart"),
    Run("nefertiti_disk", ""),
    Run("fish_disk", ""),
    Run("penguin_disk", ""),
    Run("helix", ""),
    Run("torus", ""),
    Run("cube", "--target-energy 2.001"),
    Run("bracket", "--preset lightmap"),
    Run("gear", ""),
]


def grid(rows: int, columns: int, closed: bool, point: Callable[[float, float], Point]) -> Mesh:
    """Return a tube of points for rows, from 0 to 1, and angles; a torus where rows are closed."""
    count = rows if closed else rows + 1
    vertices = [
        point(row / rows, 2 * math.pi * column / columns)
        for row in range(count)
        for column in range(columns)
    ]
    faces: list[tuple[int, ...]] = []
    for row in range(rows):
        for column in range(columns):
            here, there = row * columns, (row + 1) % count * columns
            side = (column + 1) % columns
            faces.append((here + column, there + column, there + side))
            faces.append((here + column, there + side, here + side))
    return vertices, faces


def torus() -> Mesh:
    """Return a torus of radii 1 and 0.4."""

    def point(along: float, around: float) -> Point:
        angle, radius = 2 * math.pi * along, 1 + 0.4 * math.cos(around)
        return radius * math.cos(angle), radius * math.sin(angle), 0.4 * math.sin(around)

    return grid(96, 40, True, point)


def helix() -> Mesh:
    """Return a tube of radius 0.3 with three turns about the axis, open at both ends."""
    rise = 0.55 / math.pi

    def point(along: float, around: float) -> Point:
        angle = 6 * math.pi * along
        radius = 1 + 0.3 * math.cos(around)
        tilt, lift = (0.3 * math.sin(around) * x / math.hypot(1, rise) for x in (rise, 1))
        cos, sin = math.cos(angle), math.sin(angle)
        return radius * cos + tilt * sin, radius * sin - tilt * cos, rise * angle + lift

    return grid(300, 24, False, point)


def voxels(cells: Iterable[tuple[int, int, int]], divisions: int) -> Mesh:
    """Return the surface of unit cubes, each of their sides in divisions by divisions squares."""
    solid = set(cells)
    index: dict[tuple[int, ...], int] = {}
    faces: list[tuple[int, ...]] = []

    def corner(cell: tuple[int, ...], axis: int, side: int, first: int, second: int) -> int:
        place = [x * divisions for x in cell]
        place[axis] += side * divisions
        place[(axis + 1) % 3] += first
        place[(axis + 2) % 3] += second
        return index.setdefault(tuple(place), len(index))

    for cell in sorted(solid):
        for axis in range(3):
            for side in range(2):
                beside = list(cell)
                beside[axis] += 2 * side - 1
                if tuple(beside) in solid:
                    continue
                for number in range(divisions * divisions):
                    i, j = divmod(number, divisions)
                    square = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    a, b, c, d = (
                        corner(cell, axis, side, *place) for place in square[:: 2 * side - 1]
                    )
                    faces += [(a, b, c), (a, c, d)]
    return [tuple(x / divisions for x in place) for place in index], faces  # type: ignore[misc]


def cube() -> Mesh:
    """Return a cube."""
    return voxels([(0, 0, 0)], 24)


def bracket() -> Mesh:
    """Return a plate with a square hole, and a wall on one of its sides."""
    plate = [(x, y, 0) for x in range(6) for y in range(4) if not (x in (2, 3) and y in (1, 2))]
    return voxels(plate + [(0, y, z) for y in range(4) for z in (1, 2)], 6)


def gear() -> Mesh:
    """Return a wheel of 14 teeth with a hole."""
    teeth, steps, rings, layers, hole, height = 14, 6, 10, 8, 0.45, 0.5
    count = 2 * steps * teeth

    def point(along: float, around: float) -> Point:
        place = round(along * count)
        outer = 1.25 if place % (2 * steps) <= steps else 1.0
        step = round(around * (rings + layers) / math.pi)
        half, step = divmod(step, rings + layers)  # the top and the rim, the bottom and the hole
        sunk = max(step - rings, 0) / layers
        radius = hole + (outer - hole) * min(step / rings, 1)
        level = height * (1 - sunk)
        if half:
            radius, level = hole + outer - radius, height - level
        angle = 2 * math.pi * place / count
        return radius * math.cos(angle), radius * math.sin(angle), level

    vertices, faces = grid(count, 2 * (rings + layers), True, point)
    return vertices, [face[::-1] for face in faces]


def write(mesh: Mesh, path: Path) -> None:
    """Write an OBJ file."""
    lines = ["v " + " ".join(f"{x:.6g}" for x in vertex) for vertex in mesh[0]]
    lines += ["f " + " ".join(str(vertex + 1) for vertex in face) for face in mesh[1]]
    path.write_text("\n".join(lines) + "\n")


def panel(picture: Path, caption: str) -> Image.Image:
    """Return the program's picture at the size of the sheet, without its scale, over a caption."""
    whole = Image.open(picture).convert("RGB")
    width, height = whole.size
    whole.paste("white", (0, round(height * 0.92), width // 2, height))
    whole = whole.resize(PANEL, Image.Resampling.LANCZOS)
    result = Image.new("RGB", (PANEL[0], PANEL[1] + CAPTION), "white")
    result.paste(whole, (0, 0))
    font = ImageFont.load_default(15)
    ImageDraw.Draw(result).text((24, PANEL[1] + 2), caption, "black", font)
    return result


def draw(panels: list[Image.Image], path: Path) -> None:
    """Write the panels side by side and one below the other."""
    width, height = panels[0].size
    rows = -(-len(panels) // COLUMNS)
    sheet = Image.new("RGB", (width * COLUMNS, height * rows), "white")
    for number, image in enumerate(panels):
        sheet.paste(image, (number % COLUMNS * width, number // COLUMNS * height))
    small = sheet.quantize(COLOURS, Image.Quantize.MAXCOVERAGE, kmeans=6, dither=Image.Dither.NONE)
    small.save(path, optimize=True)


def main() -> None:
    """Print the table and write the picture."""
    program, meshes, folder = (Path(argument).resolve() for argument in sys.argv[1:])
    folder.mkdir(parents=True, exist_ok=True)
    data = Path(__file__).resolve().parent.parent / "examples" / "data"
    for shape in (torus, helix, cube, bracket, gear):
        write(shape(), folder / f"{shape.__name__}.obj")
    panels = []
    print("| | mesh | options | faces | charts | seams | mean | p99 | seconds |")
    print("|--:|---|---|--:|--:|--:|--:|--:|--:|")
    for number, run in enumerate(RUNS, 1):
        places = [place / f"{run.mesh}.obj" for place in (data, meshes, folder)]
        mesh = next(path for path in places if path.exists())
        report, picture = folder / "report.json", folder / f"{number:02}.png"
        files = [mesh, folder / f"{number:02}.obj", "--report", report, "--picture", picture]
        subprocess.run([program, "unwrap", "--quiet", *files, *run.options.split()], check=True)
        figures = json.loads(report.read_text())
        energy, name = figures["energy"], run.mesh.removesuffix("_disk")
        print(
            f"| {number} | {name} | {f'`{run.options}`' if run.options else ''}"
            f" | {figures['input']['faces']:,} | {figures['charts']}"
            f" | {figures['seam_over_root_area']:.2f} | {energy['symmetric_dirichlet']:.3f}"
            f" | {energy['p99']:.2f} | {figures['seconds']:.1f} |"
        )
        if not figures["target"]["reached"]:
            raise SystemExit(f"{name} misses its target")
        panels.append(panel(picture, f"{number}  {name} {run.options}"))
    draw(panels, folder / "atlases.png")


if __name__ == "__main__":
    main()
