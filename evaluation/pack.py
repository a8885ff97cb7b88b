"""Packings of the same charts by ours and by others: utilisation of a page, and time.

    pack.py [FILES OR FOLDERS...] [--resolution 1024] [--margin 2] [--most-charts 400]
            [--many 1000 10000 100000] [--rivals-python PYTHON [--rivals NAMES...]]
            [--record]

Every mesh (all that trimesh reads in a folder; without any the examples' spot) gives two sets of
charts: those of our unwrap, and those of xatlas. Each set is packed from its UVs alone onto one
page by ours, and by xatlas, which pads charts by half the margin, rounded up, with its random
places and, up to --most-charts, with its search of all places. Utilisation is the area of the
charts over that of the page. xatlas makes pages of about the resolution: what it makes is scaled
to the square around it, as it is; and the densities next to that are tried, at the resolution
itself, in search of the largest that fits on one page. What it shrinks or stretches, which it
does to charts that are longer than the page, does not count: large charts must have one scale.
With --rivals-python Blender's packer, of shapes with holes at any angle, and uvunwrap's pack them,
too: see pack_rivals.py. CPU seconds are those of one call. With --many made-up charts are packed,
so many at once, for the time alone.
"""

from __future__ import annotations

import argparse
import json
import math
import multiprocessing
import statistics
import subprocess
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import records
import xatlas
from atlas import SPOT, files_of
from atlas_runs import load

import beltrami

# Charts of this share of the largest one's area are to differ by no more in scale. Of smaller ones
# xatlas rounds the sides to texels.
LARGE = 0.2
SAME_SCALE = 1.02
MOST_DENSITIES = 8
MOST_FOR_RIVALS = 1000
RIVAL_SECONDS = 60  # of wall time: what takes longer has no packing


@dataclass
class Charts:
    """UVs whose connected faces are charts."""

    uvs: np.ndarray  # (k, 2)
    faces: np.ndarray  # (m, 3)

    def areas(self, uvs: np.ndarray) -> np.ndarray:
        """Return the area of each face, for UVs of the same faces."""
        a, b, c = (uvs[self.faces[:, k]] for k in range(3))
        return np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2

    def labels(self) -> np.ndarray:
        """Return the chart of each face."""
        parent = np.arange(len(self.uvs))
        while True:
            low = parent[self.faces].min(axis=1)
            new = parent.copy()
            for k in range(3):
                np.minimum.at(new, self.faces[:, k], low)
            new = new[new]
            if np.array_equal(new, parent):
                return np.unique(parent[self.faces[:, 0]], return_inverse=True)[1]
            parent = new

    def count(self) -> int:
        """Count the charts."""
        return int(self.labels().max()) + 1

    def one_scale(self, uvs: np.ndarray) -> bool:
        """Return whether the large charts have one scale."""
        labels = self.labels()
        given = np.bincount(labels, self.areas(self.uvs))
        large = given > LARGE * given.max()
        ratios = np.bincount(labels, self.areas(uvs))[large] / given[large]
        mean = self.areas(uvs).sum() / given.sum()
        return bool(ratios.min() >= mean / SAME_SCALE**2 and ratios.max() <= mean * SAME_SCALE**2)


@dataclass
class Packed:
    """One packing of one set of charts."""

    mesh: str
    charts_by: str
    charts: int
    program: str
    utilisation: float
    cpu_seconds: float


class Rival:
    """A program of pack_rivals.py on one set of charts."""

    def __init__(
        self, python: Path, program: str, charts: Charts, resolution: int, margin: float
    ) -> None:
        self.python, self.program, self.charts = python, program, charts
        self.resolution, self.margin = resolution, margin

    def best(self) -> tuple[float, float]:
        """Return the utilisation of the page, 0 where there is none, and the seconds."""
        script = Path(__file__).with_name("pack_rivals.py")
        with tempfile.TemporaryDirectory() as folder:
            given, out = Path(folder, "charts.npz"), Path(folder, "out.npz")
            np.savez(given, uvs=self.charts.uvs, faces=self.charts.faces)
            command = [self.python, script, self.program, given, out]
            command += [str(self.resolution), str(self.margin)]
            try:
                subprocess.run(command, stdout=subprocess.DEVNULL, timeout=RIVAL_SECONDS)
            except subprocess.TimeoutExpired:
                return 0.0, float(RIVAL_SECONDS)
            if not out.exists():
                return 0.0, 0.0
            with np.load(out) as read:
                corners, seconds = read["uvs"], float(read["seconds"])
        placed = np.zeros_like(self.charts.uvs)
        placed[self.charts.faces.ravel()] = corners.reshape(-1, 2)
        inside = placed.min() >= -1e-6 and placed.max() <= 1 + 1e-6
        fits = inside and self.charts.one_scale(placed)
        return float(self.charts.areas(placed).sum()) if fits else 0.0, seconds


def rivals_of(python: Path | None) -> list[str]:
    """Return the programs that an interpreter has."""
    if python is None:
        return []
    script = Path(__file__).with_name("pack_rivals.py")
    listed = subprocess.run([python, script, "--programs"], capture_output=True, check=True)
    return list(json.loads(listed.stdout.splitlines()[-1]))


def ours(charts: Charts, resolution: int, margin: float) -> tuple[float, float]:
    """Return utilisation and seconds."""
    start = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", beltrami.NotInjectiveWarning)
        packing = beltrami.pack(
            beltrami.UvMesh(charts.uvs, charts.faces), resolution=resolution, margin=margin
        )
    return float(packing.page_utilisations[0]), time.process_time() - start


class Xatlas:
    """The packer of xatlas on one set of charts."""

    def __init__(self, charts: Charts, resolution: int, margin: float, brute_force: bool) -> None:
        self.charts, self.resolution, self.brute_force = charts, resolution, brute_force
        self.padding = math.ceil(margin / 2)
        self.materials = charts.labels().astype(np.uint32)[:, None]

    def pack(self, density: float) -> tuple[np.ndarray, tuple[int, int], int, float]:
        """Return UVs in texels, the size of the page, the number of pages, and seconds."""
        atlas = xatlas.Atlas()
        atlas.add_uv_mesh(
            self.charts.uvs.astype(np.float32), self.charts.faces.astype(np.uint32), self.materials
        )
        options = xatlas.PackOptions()
        options.resolution, options.padding = self.resolution, self.padding
        options.bilinear, options.bruteForce = False, self.brute_force
        options.texels_per_unit = density
        start = time.process_time()
        atlas.generate(pack_options=options)
        seconds = time.process_time() - start
        origins, corners, uvs = atlas.get_mesh(0)
        placed = np.zeros_like(self.charts.uvs)
        placed[self.charts.faces.ravel()] = uvs[corners.ravel()] * [atlas.width, atlas.height]
        del origins
        return placed, (atlas.width, atlas.height), atlas.atlas_count, seconds

    def best(self) -> tuple[float, float]:
        """Return the utilisation of the best page, and the seconds of the first call."""
        charts = self.charts
        placed, size, pages, seconds = self.pack(0.0)
        area = float(charts.areas(placed).sum())
        best = area / max(size) ** 2 if pages == 1 and charts.one_scale(placed) else 0.0
        given = float(charts.areas(charts.uvs).sum())
        density, low, high = math.sqrt(max(best, 0.3) * self.resolution**2 / given), 0.0, 0.0
        for _ in range(2 if self.brute_force else MOST_DENSITIES):
            placed, size, pages, _ = self.pack(density)
            area = float(charts.areas(placed).sum())
            fits = pages == 1 and max(size) <= self.resolution and charts.one_scale(placed)
            if fits:
                best, low = max(best, area / self.resolution**2), density
            else:
                high = density
            density = (low + high) / 2 if low and high else density * (1.05 if fits else 0.95)
        return best, seconds


def limited(run: Callable[[], tuple[float, float]]) -> tuple[float, float]:
    """Run in a process of its own, which is ended where it takes too long."""
    context = multiprocessing.get_context("fork")
    ours_end, its_end = context.Pipe()
    process = context.Process(target=lambda: its_end.send(run()))
    process.start()
    found = ours_end.recv() if ours_end.poll(RIVAL_SECONDS) else (0.0, float(RIVAL_SECONDS))
    process.kill()
    process.join()
    return found


def charts_of(path: Path) -> Iterator[tuple[str, Charts]]:
    """Yield the charts that each program cuts a mesh into."""
    mesh = load(path)
    atlas = beltrami.unwrap(mesh.vertices, mesh.faces, pack="none")
    yield "beltrami", Charts(np.asarray(atlas.uvs, float), np.asarray(atlas.uv_triangles))
    _, faces, uvs = xatlas.parametrize(mesh.vertices, mesh.faces)
    yield "xatlas", Charts(uvs.astype(float), faces.astype(np.int64))


def made_up(count: int) -> Charts:
    """Return fans of sizes that differ much."""
    numbers = np.random.default_rng(1)
    angle = 2 * np.pi * np.arange(7) / 7
    star = np.column_stack([np.cos(angle), np.sin(angle)])
    uvs = np.zeros((count, 8, 2))
    uvs[:, 1:] = star * numbers.uniform(0.4, 1, (count, 7, 1))
    uvs *= np.exp(numbers.normal(0, 0.7, (count, 1, 1))) * numbers.uniform(0.2, 1, (count, 1, 2))
    ring = np.arange(7)
    fan = np.column_stack([np.zeros(7, int), 1 + ring, 1 + (ring + 1) % 7])
    faces = fan[None] + 8 * np.arange(count)[:, None, None]
    return Charts(uvs.reshape(-1, 2), faces.reshape(-1, 3))


def rows_of(name: str, by: str, charts: Charts, args: argparse.Namespace) -> Iterator[Packed]:
    """Pack charts by every program, printing each."""
    count = charts.count()
    programs: dict[str, Callable[[], tuple[float, float]]] = {
        "ours": lambda: ours(charts, args.resolution, args.margin),
        "xatlas": Xatlas(charts, args.resolution, args.margin, False).best,
    }
    if count <= args.most_charts:
        brute = Xatlas(charts, args.resolution, args.margin, True)
        programs["xatlas brute"] = lambda: limited(brute.best)
    for rival in args.rivals if count <= MOST_FOR_RIVALS else []:
        python = args.rivals_python
        programs[rival] = Rival(python, rival, charts, args.resolution, args.margin).best
    for program, run in programs.items():
        utilisation, seconds = run()
        row = Packed(name, by, count, program, utilisation, seconds)
        print(f"{name:32} {by:9} {count:6} {program:12} {utilisation:6.3f} {seconds:8.2f} s")
        yield row


def summary(rows: list[Packed]) -> str:
    """Return the median and the least ratio of ours to the best rival's utilisation."""
    best: dict[tuple[str, str], dict[bool, float]] = {}
    for row in rows:
        found = best.setdefault((row.mesh, row.charts_by), {})
        is_ours = row.program == "ours"
        found[is_ours] = max(found.get(is_ours, 0.0), row.utilisation)
    ratios = [b[True] / b[False] for b in best.values() if b.get(False) and True in b]
    if not ratios:
        return "no packing to compare with"
    return (
        f"utilisation to the best rival's: median {statistics.median(ratios):.3f}, "
        f"least {min(ratios):.3f}, of {len(ratios)} sets of charts"
    )


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("paths", nargs="*", type=Path, default=[SPOT])
    parser.add_argument("--resolution", type=int, default=1024)
    parser.add_argument("--margin", type=float, default=2.0)
    parser.add_argument("--most-charts", type=int, default=400)
    parser.add_argument("--many", nargs="*", type=int, default=[])
    parser.add_argument("--rivals-python", type=Path)
    parser.add_argument("--rivals", nargs="*", help="of those that it has, not all")
    records.add_option(parser)
    args = parser.parse_args()
    chosen = args.rivals
    args.rivals = [
        rival for rival in rivals_of(args.rivals_python) if chosen is None or rival in chosen
    ]
    rows: list[Packed] = []
    for path in files_of(args.paths):
        try:
            for by, charts in charts_of(path):
                rows += rows_of(path.stem, by, charts, args)
        except (beltrami.BeltramiError, ValueError, RuntimeError) as error:
            print(f"{path.stem}: {error}")
    print(summary(rows))
    for count in args.many:
        rows += rows_of("made up", "nobody", made_up(count), args)
    if args.record:
        records.write("pack", [asdict(row) for row in rows])


if __name__ == "__main__":
    main()
