"""Global maps of long seams: closed meshes, opened along cuts of which each contains the last.

    seams.py [--data FOLDER] [--points 5 10 20 40] [--faces 300000] [--methods local default scaf]

Every closed mesh of genus 0 in the folder is opened along shortest paths that join far points, and
flattened by the default method and by others, one after the other on one thread:

- local: without global injectivity. Its boundary may cross itself: what the others are held to.
- refine and cm: the same promise as the default, at the cost of the full mesh.
- scaf: libigl's SCAF from its wheel, 50 iterations from Tutte's embedding, where it is installed.

E is the symmetric Dirichlet energy on a mesh of area 1, 2 at least; SCAF's is that at its best
scale, ours at the scale delivered. "x/f" counts boundary crossings and faces that are not
positive, exactly. CPU seconds carry to no other machine, their ratio does. A larger cut leaves more
freedom, so that the least energy cannot rise: by how much each method's does is printed last.
"""

from __future__ import annotations

import argparse
import dataclasses
import importlib.util
import statistics
import time
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import records
from meshes import FOLDER, areas, is_sphere, nested_seams, open_along, read_obj, refine

import beltrami

OURS: dict[str, dict[str, object]] = {
    "local": {"injectivity": "local"},
    "default": {},
    "refine": {"refine": True},
    "cm": {"method": "cm", "injectivity": "global"},
}
METHODS = [*OURS, "scaf"]
SCAF_ITERATIONS = 50


@dataclass
class Outcome:
    """What one method made of one disk."""

    energy: float
    crossings: int
    flips: int
    cpu_seconds: float
    converged: bool


@dataclass
class Row:
    """One disk, and what the methods made of it."""

    mesh: str
    points: int
    boundary: int  # edges
    outcomes: dict[str, Outcome]

    def over(self, method: str, other: str) -> float:
        """Return the ratio of two energies, NaN where a method did not run."""
        if {method, other} <= self.outcomes.keys():
            return self.outcomes[method].energy / self.outcomes[other].energy
        return np.nan

    def cost(self) -> float:
        """Return what the default costs in units of the local method, NaN where one did not run."""
        if {"default", "local"} <= self.outcomes.keys():
            return self.outcomes["default"].cpu_seconds / self.outcomes["local"].cpu_seconds
        return np.nan


def run_ours(method: str, vertices: np.ndarray, faces: np.ndarray) -> Outcome:
    """Flatten with one of our methods."""
    start = time.process_time()
    with warnings.catch_warnings():  # the checks of the table say it
        warnings.simplefilter("ignore", beltrami.NotInjectiveWarning)
        result = beltrami.parameterize(vertices, faces, threads=1, **OURS[method])
    seconds = time.process_time() - start
    energy = result.energy.symmetric_dirichlet
    return judge(result.uv, faces, energy, seconds, result.converged)


def run_scaf(vertices: np.ndarray, faces: np.ndarray) -> Outcome:
    """Flatten with SCAF; its start does not count."""
    uv, seconds = scaf(vertices, faces, SCAF_ITERATIONS)
    if not np.isfinite(uv).all():
        return Outcome(np.nan, 0, len(faces), seconds, False)
    return judge(uv, faces, energy_at_best_scale(vertices, faces, uv), seconds, True)


def scaf(vertices: np.ndarray, faces: np.ndarray, iterations: int) -> tuple[np.ndarray, float]:
    """Return the UVs of SCAF from Tutte's embedding, and its CPU seconds without that."""
    import igl
    import igl.triangle

    uv = beltrami.parameterize(vertices, faces, method="tutte").uv
    uv = uv / np.sqrt(areas(uv, faces).sum())
    start = time.process_time()
    data = igl.triangle.SCAFData()
    igl.triangle.scaf_precompute(
        vertices,
        faces.astype(np.int32),
        uv,
        igl.MappingEnergyType.SYMMETRIC_DIRICHLET,
        np.zeros(0, np.int32),
        np.zeros((0, 2)),
        0.0,
        data,
    )
    found = np.array(igl.triangle.scaf_solve(iterations, data))[: len(vertices), :2]
    return np.ascontiguousarray(found), time.process_time() - start


def energy_at_best_scale(vertices: np.ndarray, faces: np.ndarray, uv: np.ndarray) -> float:
    """Return the symmetric Dirichlet energy at the scale where it is least."""
    singular = beltrami.distortion(vertices, faces, uv).singular_values
    if not (singular[:, 1] > 0).all():
        return np.inf
    weights = areas(vertices, faces)[:, None]
    stretch, squeeze = ((weights * singular**power).sum() for power in (2, -2))
    return float(np.sqrt(stretch * squeeze) / weights.sum())


def judge(
    uv: np.ndarray, faces: np.ndarray, energy: float, seconds: float, converged: bool
) -> Outcome:
    """Count crossings and flips by the exact checks."""
    uv = np.ascontiguousarray(uv)
    triangles = beltrami.check_triangles(uv, faces)
    crossings = beltrami.check_boundary(uv, faces).boundary_crossings
    flips = triangles.negative + triangles.degenerate
    return Outcome(energy, crossings, flips, seconds, converged)


def rows_of(path: Path, points: list[int], target: int, methods: list[str]) -> list[Row]:
    """Open a mesh along nested cuts and run the methods; print the energies of each at once."""
    vertices, faces = read_obj(path)
    if not is_sphere(vertices, faces):
        print(f"{path.stem}: left out, for it is not a closed mesh of genus 0")
        return []
    vertices, faces = refine(vertices, faces, target)
    vertices = vertices / np.sqrt(areas(vertices, faces).sum())
    rows = []
    for count, seams in zip(points, nested_seams(vertices, faces, points)):
        disk = open_along(vertices, faces, seams)
        outcomes = {
            method: run_scaf(*disk) if method == "scaf" else run_ours(method, *disk)
            for method in methods
        }
        rows.append(Row(path.stem, count, 2 * len(seams), outcomes))
        print(energy_line(rows[-1], methods), flush=True)
    return rows


def label(row: Row) -> str:
    """Return the columns that name a disk."""
    return f"{row.mesh[:20]:20} {row.points:4} {row.boundary:6}"


def ratio(value: float, digits: int) -> str:
    """Return a column of ratios."""
    return f"{'-':>10}" if np.isnan(value) else f"{value:10.{digits}f}"


def energy_line(row: Row, methods: list[str]) -> str:
    """Return a row of the table of energies; a star marks an end in NOT_CONVERGED."""
    cells = [
        f"{row.outcomes[m].energy:9.4f}{' ' if row.outcomes[m].converged else '*'}" for m in methods
    ]
    ratios = (ratio(row.over("default", other), 4) for other in ("local", "scaf"))
    return f"{label(row)} {''.join(cells)} {' '.join(ratios)}"


def check_line(row: Row, methods: list[str]) -> str:
    """Return a row of the table of checks and costs."""
    checks = (f"{row.outcomes[m].crossings}/{row.outcomes[m].flips}" for m in methods)
    costs = (f"{row.outcomes[m].cpu_seconds:10.2f}" for m in methods)
    checked = "".join(f"{check:>12}" for check in checks)
    return f"{label(row)} {checked} {''.join(costs)} {ratio(row.cost(), 2)}"


def summary(name: str, ratios: list[float]) -> str:
    """Return median and worst of the ratios that are numbers."""
    known = [ratio for ratio in ratios if not np.isnan(ratio)]
    if not known:
        return f"{name:22} -"
    return f"{name:22} median {statistics.median(known):.4f}, worst {max(known):.4f}"


def nesting(rows: list[Row], method: str) -> str:
    """Return by how much the energy rises at most from a cut to one that contains it."""
    pairs = [
        (b.outcomes[method].energy / a.outcomes[method].energy - 1, a, b)
        for a in rows
        for b in rows
        if a.mesh == b.mesh and a.points < b.points
    ]
    if not pairs:
        return f"{method:10} -"
    rise, a, b = max(pairs, key=lambda pair: pair[0])
    return f"{method:10} {100 * rise:+.2f}%  {a.mesh}, {a.points} to {b.points} points"


def arguments() -> argparse.Namespace:
    """Return the arguments of the program."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--data", type=Path, default=FOLDER, metavar="FOLDER")
    parser.add_argument("--points", type=int, nargs="+", default=[5, 10, 20, 40])
    parser.add_argument("--faces", type=int, default=0, help="refine smaller meshes to about these")
    parser.add_argument("--methods", nargs="+", choices=METHODS, default=METHODS)
    records.add_option(parser)
    given = parser.parse_args()
    given.points = sorted(set(given.points))
    if given.points[0] < 3:
        parser.error("--points: 3 or more make a disk")
    if not any(given.data.glob("*.obj")):
        parser.error(f"--data: there is no .obj file in {given.data}")
    if importlib.util.find_spec("igl") is None:
        given.methods = [method for method in given.methods if method != "scaf"]
    return given


def main() -> None:
    """Run the program."""
    given = arguments()
    methods = given.methods
    head = f"{'mesh':20} {'pts':>4} {'edges':>6}"
    energies = "".join(f"{'E ' + method:>9} " for method in methods)
    print(f"{head} {energies} {'def/local':>10} {'def/scaf':>10}")
    rows: list[Row] = []
    for path in sorted(given.data.glob("*.obj")):
        rows += rows_of(path, given.points, given.faces, methods)
    checks = "".join(f"{'x/f ' + method:>12}" for method in methods)
    costs = "".join(f"{'s ' + method:>10}" for method in methods)
    print(f"\n{head} {checks} {costs} {'def/local':>10}")
    for row in rows:
        print(check_line(row, methods))
    print()
    print(summary("E default / local", [row.over("default", "local") for row in rows]))
    print(summary("E default / scaf", [row.over("default", "scaf") for row in rows]))
    print(summary("CPU s default / local", [row.cost() for row in rows]))
    print("\nlargest rise of E from a cut to a larger one that contains it")
    for method in methods:
        print(nesting(rows, method))
    if given.record:
        records.write("seams", [dataclasses.asdict(row) for row in rows])


if __name__ == "__main__":
    main()
