"""Atlases of any mesh, beside those of xatlas and uvunwrap from their wheels.

    atlas.py [FILES...] [--data FOLDER] [--most 300000]

Every file (all that trimesh reads in the folder, of at most so many triangles) is unwrapped by

- ours: the shortest cut that opens it, no more than its topology asks for;
- islands: ours along the seams that xatlas chose, which says what is left in the same charts;
- xatlas and uvunwrap with their default options.

All run one after the other in one process, ours on one thread. Seams are their length on the
surface over the root of its area, each once. E is the mean symmetric Dirichlet energy at the one
scale for the whole atlas that is best, over the triangles that are not flipped; overlaps are pairs
of triangles counted exactly (mirrored charts are taken for their mirror images), "+" where there
are more. CPU seconds carry to no other machine, their ratio does.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import records
import trimesh
import uvunwrap
import xatlas
from meshes import FOLDER

import beltrami

SUFFIXES = {".obj", ".off", ".ply", ".stl", ".glb", ".gltf"}


@dataclass
class Outcome:
    """What one program made of one mesh."""

    charts: int
    seams: float
    energy: float
    overlaps: int
    flips: int
    cpu_seconds: float
    corner_uvs: np.ndarray  # (m, 3, 2)


def load(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Read the triangles of a file, vertices at one place welded."""
    mesh = trimesh.load(path, force="mesh", process=False)
    vertices, inverse = np.unique(np.asarray(mesh.vertices, float), axis=0, return_inverse=True)
    faces = inverse.reshape(-1)[np.asarray(mesh.faces)]
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return vertices, faces[areas > 1e-14 * areas.max()]


def best_energy(vertices: np.ndarray, faces: np.ndarray, uvs: np.ndarray) -> float:
    """Return the mean of 1/2 (t |J|^2 + |J^-1|^2 / t) at the t that makes it least."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    edge, other = b - a, c - a
    length = np.linalg.norm(edge, axis=1)
    along = np.einsum("ij,ij->i", edge, other) / length
    doubled = np.linalg.norm(np.cross(edge, other), axis=1)
    height = doubled / length
    u, v = uvs[:, 1] - uvs[:, 0], uvs[:, 2] - uvs[:, 0]
    first = u / length[:, None]
    second = (v - along[:, None] * first) / height[:, None]
    determinant = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    with np.errstate(divide="ignore", invalid="ignore"):
        stretch = (first**2).sum(1) + (second**2).sum(1)
        shrink = stretch / determinant**2
    good = np.isfinite(shrink) & (determinant > 0)
    weight = doubled[good] / doubled[good].sum()
    return float(np.sqrt((weight * stretch[good]).sum() * (weight * shrink[good]).sum()))


def charts_and_seams(vertices: np.ndarray, faces: np.ndarray, uvs: np.ndarray) -> tuple[int, float]:
    """Count the charts, and measure the edges at which triangles with other UVs meet."""
    edge = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    ends = uvs[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2, 2)
    turned = faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)[:, 0] != edge[:, 0]
    ends[turned] = ends[turned][:, ::-1]
    order = np.lexsort((edge[:, 1], edge[:, 0]))
    same = (edge[order][1:] == edge[order][:-1]).all(1)
    one, two = order[1:][same], order[:-1][same]
    joined = (ends[one] == ends[two]).all((1, 2))
    lengths = np.linalg.norm(vertices[edge[:, 0]] - vertices[edge[:, 1]], axis=1)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    pairs = np.column_stack([one[joined] // 3, two[joined] // 3])
    charts = trimesh.graph.connected_components(pairs, nodes=np.arange(len(faces)), min_len=1)
    return len(charts), float(lengths[one[~joined]].sum() / np.sqrt(area))


def ours(vertices: np.ndarray, faces: np.ndarray, **options: object) -> np.ndarray:
    """Unwrap with our default options and these."""
    return np.asarray(beltrami.unwrap(vertices, faces, **options).corner_uvs).reshape(-1, 3, 2)


def run_xatlas(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Unwrap with xatlas."""
    _, indices, uvs = xatlas.parametrize(vertices.astype(np.float32), faces.astype(np.uint32))
    return np.asarray(uvs, float)[indices]


def run_uvunwrap(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Unwrap with uvunwrap."""
    mesh = uvunwrap.Mesh(vertices.astype(np.float32), faces.astype(np.uint32))
    (unwrapped,) = uvunwrap.generate([mesh]).meshes
    return np.array(unwrapped.corner_uvs, float).reshape(-1, 3, 2)


def judge(
    unwrap: Callable[[], np.ndarray], vertices: np.ndarray, faces: np.ndarray
) -> Outcome | str:
    """Run and measure; what it says where it fails."""
    start = time.process_time()
    try:
        uvs = unwrap()
    except Exception as error:  # of any program
        return type(error).__name__
    seconds = time.process_time() - start
    check = beltrami.check_atlas(vertices, faces, uvs, allow_mirrored=True)
    charts, seams = charts_and_seams(vertices, faces, uvs)
    return Outcome(
        charts,
        seams,
        best_energy(vertices, faces, uvs),
        int(check.overlaps),
        int(check.negative),
        seconds,
        uvs,
    )


def row_of(name: str, outcome: Outcome | str) -> str:
    """Return a line of the table."""
    if isinstance(outcome, str):
        return f"  {name:9} {outcome}"
    return (
        f"  {name:9} {outcome.charts:7d} {outcome.seams:8.2f} {outcome.energy:9.4f}"
        f" {outcome.overlaps:9d} {outcome.flips:7d} {outcome.cpu_seconds:8.2f}"
    )


def compare(path: Path, vertices: np.ndarray, faces: np.ndarray) -> dict[str, Outcome | str]:
    """Unwrap one mesh by all, and print what came of it."""
    print(f"{path.name}: {len(faces)} triangles")
    outcomes: dict[str, Outcome | str] = {}
    programs: dict[str, Callable[[], np.ndarray]] = {
        "ours": lambda: ours(vertices, faces),
        "xatlas": lambda: run_xatlas(vertices, faces),
        "uvunwrap": lambda: run_uvunwrap(vertices, faces),
    }
    for name, unwrap in programs.items():
        outcomes[name] = judge(unwrap, vertices, faces)
        print(row_of(name, outcomes[name]), flush=True)
    theirs = outcomes["xatlas"]
    if isinstance(theirs, Outcome):
        outcomes["islands"] = judge(
            lambda: ours(vertices, faces, cut="islands", corner_uvs=theirs.corner_uvs),
            vertices,
            faces,
        )
        print(row_of("islands", outcomes["islands"]), flush=True)
    return outcomes


def rows_of(mesh: str, outcomes: dict[str, Outcome | str]) -> list[dict[str, object]]:
    """Return what is recorded of one mesh."""
    rows: list[dict[str, object]] = []
    for program, found in outcomes.items():
        if isinstance(found, str):
            rows.append({"mesh": mesh, "program": program, "error": found})
            continue
        figures = {key: value for key, value in vars(found).items() if key != "corner_uvs"}
        rows.append({"mesh": mesh, "program": program, **figures})
    return rows


def summarise(table: list[dict[str, Outcome | str]]) -> None:
    """Print medians over the meshes that all programs took."""
    whole = [
        {name: found for name, found in row.items() if isinstance(found, Outcome)}
        for row in table
        if not any(isinstance(found, str) for found in row.values())
    ]
    if not whole:
        return
    print(f"medians over the {len(whole)} meshes that all took")
    for name in ("ours", "islands", "xatlas", "uvunwrap"):
        found = [row[name] for row in whole]
        cost = statistics.median(
            row[name].cpu_seconds / max(row["ours"].cpu_seconds, 1e-3) for row in whole
        )
        print(
            f"  {name:9} {statistics.median(o.charts for o in found):7.0f}"
            f" {statistics.median(o.seams for o in found):8.2f}"
            f" {statistics.median(o.energy for o in found):9.4f}"
            f"  {sum(o.overlaps > 0 or o.flips > 0 for o in found)} with overlaps or flips,"
            f" {cost:.2f} x our CPU"
        )


def main() -> None:
    """Compare on the files that the command line names."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("files", type=Path, nargs="*")
    parser.add_argument("--data", type=Path, default=FOLDER, help="folder of meshes")
    parser.add_argument("--most", type=int, default=300_000, help="triangles of a mesh")
    records.add_option(parser)
    arguments = parser.parse_args()
    files = arguments.files or sorted(
        path for path in arguments.data.iterdir() if path.suffix.lower() in SUFFIXES
    )
    print("  program    charts    seams         E  overlaps   flips    CPU s")
    table: dict[str, dict[str, Outcome | str]] = {}
    for path in files:
        try:
            vertices, faces = load(path)
        except Exception as error:  # of trimesh, on broken files
            print(f"{path.name}: not read: {error}")
            continue
        if len(faces) <= arguments.most:
            table[path.name] = compare(path, vertices, faces)
    summarise(list(table.values()))
    if arguments.record:
        records.write(
            "atlas", [row for name, found in table.items() for row in rows_of(name, found)]
        )


if __name__ == "__main__":
    main()
