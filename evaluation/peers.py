"""Compare with libigl's SLIM and with xatlas, from their wheels, on one mesh.

    peers.py [MESH.obj] [--rounds 3] [--energy-tolerance 1e-4]

All run in one process, one after the other in every round, on one thread where they can; what
counts is CPU time, and its ratio to ours in the same round. Energies are measured, and flips
counted, by our checks, which are exact. Read this with it:

- SLIM starts from Tutte's embedding on a circle of the mesh's area, and iterates until an iteration
  lowers the energy by less than the tolerance, as ours does. It does not see to overlaps.
- xatlas cuts the mesh into charts, for which it needs no injective map of the whole: its energy is
  not that of the same task. It is measured at the scale that makes the areas agree.
"""

from __future__ import annotations

import argparse
import statistics
import time
from dataclasses import dataclass
from pathlib import Path

import igl
import numpy as np
import records
import xatlas
from meshes import FOLDER, areas, read_obj

import beltrami

MOST_ITERATIONS = 500


@dataclass
class Outcome:
    """What one run of one program gave."""

    cpu_seconds: float
    vertices: np.ndarray  # (n, 3): with xatlas more than the mesh has
    faces: np.ndarray  # (m, 3)
    uv: np.ndarray  # (n, 2)
    note: str


def run_beltrami(vertices: np.ndarray, faces: np.ndarray, _tolerance: float) -> Outcome:
    """Flatten with the default options."""
    start = time.process_time()
    result = beltrami.parameterize(vertices, faces)
    seconds = time.process_time() - start
    return Outcome(seconds, vertices, faces, result.uv, result.status)


def run_slim(vertices: np.ndarray, faces: np.ndarray, tolerance: float) -> Outcome:
    """Flatten with SLIM; looking at its energy does not count."""
    start = time.process_time()
    boundary = igl.boundary_loop(faces)
    circle = igl.map_vertices_to_circle(np.asfortranarray(vertices), boundary.astype(np.int32))
    uniform = igl.harmonic(
        vertices, faces, boundary.astype(np.int64), np.ascontiguousarray(circle), 1
    )
    if (areas(uniform, faces) <= 0).any():  # the cotangents may flip faces, Tutte's weights do not
        uniform = tutte(vertices, faces)
    uv = uniform / np.sqrt(abs(areas(uniform, faces).sum()))
    data = igl.slim_precompute(
        np.asfortranarray(vertices),
        np.asfortranarray(faces.astype(np.int32)),
        np.asfortranarray(np.column_stack([uv, np.zeros(len(uv))])[:, :2]),
        igl.MappingEnergyType.SYMMETRIC_DIRICHLET,
        np.zeros(0, np.int32),
        np.zeros((0, 2), order="F"),
        0.0,
    )
    seconds = time.process_time() - start
    before = np.inf
    iterations = 0
    while iterations < MOST_ITERATIONS:
        iterations += 1
        start = time.process_time()
        uv = igl.slim_solve(data, 1)[:, :2]
        seconds += time.process_time() - start
        energy = beltrami.distortion(vertices, faces, uv).energy.symmetric_dirichlet
        if not before - energy > tolerance * energy:
            break
        before = energy
    return Outcome(seconds, vertices, faces, np.ascontiguousarray(uv), f"{iterations} iterations")


def tutte(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Return Tutte's embedding, (n, 2)."""
    return beltrami.parameterize(vertices, faces, method="tutte").uv


def run_xatlas(vertices: np.ndarray, faces: np.ndarray, _tolerance: float) -> Outcome:
    """Cut into charts and flatten those."""
    start = time.process_time()
    atlas = xatlas.Atlas()
    atlas.add_mesh(vertices.astype(np.float32), faces.astype(np.uint32))
    atlas.generate()
    seconds = time.process_time() - start
    mapping, indices, uv = atlas[0]
    points, corners = vertices[mapping], indices.astype(np.int64)
    uv = uv * np.array([atlas.width, atlas.height], float)
    uv *= np.sqrt(areas(points, corners).sum() / abs(areas(uv, corners)).sum())
    # It mirrors charts, which is no flip inside them.
    chart = atlas.get_mesh_vertex_assignment(0)[1].astype(np.int64)
    signed = np.bincount(chart[corners[:, 0]], areas(uv, corners), chart.max() + 1)
    uv[signed[chart] < 0, 0] *= -1
    note = f"{atlas.chart_count} charts, {len(mapping) - len(vertices)} more vertices"
    return Outcome(seconds, points, corners, uv, note)


PROGRAMS = {"beltrami": run_beltrami, "libigl SLIM": run_slim, "xatlas": run_xatlas}


def describe(name: str, rounds: list[dict[str, Outcome]]) -> str:
    """Return the line of the table for one program."""
    seconds = statistics.median(outcomes[name].cpu_seconds for outcomes in rounds)
    ratio = statistics.median(
        outcomes[name].cpu_seconds / outcomes["beltrami"].cpu_seconds for outcomes in rounds
    )
    last = rounds[-1][name]
    energy = beltrami.distortion(last.vertices, last.faces, last.uv).energy
    triangles = beltrami.check_triangles(last.uv, last.faces)
    try:
        injective = "yes" if beltrami.check_injective(last.uv, last.faces) else "no"
    except beltrami.NotADiskError:
        injective = "-"  # not one chart
    return (
        f"{name:12} {seconds:8.2f} {ratio:7.1f}x {energy.symmetric_dirichlet:10.4f} "
        f"{energy.left_out:8} {triangles.negative:6} {triangles.degenerate:6} {injective:>9}  "
        f"{last.note}"
    )


def main() -> None:
    """Run the program."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    bust = FOLDER / "nefertiti_disk.obj"
    parser.add_argument("mesh", nargs="?", type=Path, default=bust, metavar="MESH.obj")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--energy-tolerance", type=float, default=1e-4)
    records.add_option(parser)
    arguments = parser.parse_args()
    vertices, faces = read_obj(arguments.mesh)
    print(f"{arguments.mesh.name}: {len(vertices)} vertices, {len(faces)} faces")
    rounds = [
        {name: run(vertices, faces, arguments.energy_tolerance) for name, run in PROGRAMS.items()}
        for _ in range(arguments.rounds)
    ]
    print(
        f"{'':12} {'CPU s':>8} {'ratio':>8} {'energy':>10} {'left out':>8} {'flips':>6} "
        f"{'empty':>6} {'injective':>9}"
    )
    for name in PROGRAMS:
        print(describe(name, rounds))
    if arguments.record:
        seconds = {name: min(found[name].cpu_seconds for found in rounds) for name in PROGRAMS}
        records.write("peers", [{"mesh": arguments.mesh.stem, "cpu_seconds": seconds}])


if __name__ == "__main__":
    main()
