"""The figures of ./dev evaluate as pictures, each an SVG and a PNG.

A picture is a function from the tables to a Matplotlib figure, or to None where nothing is recorded
that it could show. The numbers of figures are those of the paper.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from evaluate_data import make
from evaluate_figures import (
    Row,
    Tables,
    equal_energy,
    failures,
    histograms,
    known,
    modes_of,
    repairs,
    stage_shares,
    stopped_row,
)
from evaluate_plan import COARSE_FACES, DataSet, picture_runs
from evaluate_runs import Book, Run
from evaluate_worker import BIN_EDGES
from matplotlib.figure import Figure
from meshes import areas

mpl.use("Agg")
mpl.rcParams.update(
    {
        "axes.grid": True,
        "axes.spines.right": False,
        "axes.spines.top": False,
        "figure.dpi": 90,
        "font.size": 9,
        "grid.alpha": 0.25,
        "legend.frameon": False,
        "lines.markersize": 4,
        "svg.fonttype": "none",  # text stays text
        "svg.hashsalt": "beltrami",  # the same file from the same records
    }
)

COLOURS = {
    "ours": "#1f5fa8",
    "gif": "#3a9a55",
    "cm": "#333333",
    "plain gif": "#c8553d",
    "uv prolongation": "#b08a1e",
    "flim": "#79b88c",
    "dirichlet": "#7fb3d5",
    "refine": "#7b4fa0",
    "LSCM": "#4aa3a2",
    "SLIM": "#b06ab3",
    "SCAF": "#d98c5f",
    "Blender": "#8c8c8c",
}
LABELS = {
    "ours": "ours (default)",
    "gif": "ours, the paper's mode",
    "cm": "CM",
    "plain gif": "GIF without prolongation",
    "uv prolongation": "UV prolongation",
    "flim": "ours, flim",
    "dirichlet": "ours, dirichlet",
    "refine": "CM started from ours",
    "LSCM": "libigl LSCM",
    "SLIM": "libigl SLIM",
    "SCAF": "libigl SCAF",
    "Blender": "Blender, minimum stretch",
}
# The paper's shares of its stages, beside which its own mode is set here.
PAPER_SHARES = {"simplify": 0.11, "coarse": 0.14, "prolong": 0.04, "flatten": 0.71}
USUAL_COARSE = 10_000  # faces that the default simplifies to at least
STAGE_COLOURS = mpl.colormaps["tab20"].colors


def columns(count: int, height: float = 3.2, width: float = 4.2) -> tuple[Figure, Any]:
    """Return a figure with axes side by side, an array of them."""
    figure = Figure(figsize=(width * count, height), layout="constrained")
    return figure, figure.subplots(1, count, squeeze=False)[0]


def draw_histograms(
    axes: Any, rows: Sequence[Row], modes: Sequence[str], name: str, least: float
) -> bool:
    """Draw shares of the area by energy; return whether there were any."""
    shares = histograms(rows, modes, name)
    edges = np.concatenate([[BIN_EDGES[1] / 2], BIN_EDGES[1:], [BIN_EDGES[-1] * 1.4]])
    for mode, share in shares.items():
        axes.stairs(share, edges, color=COLOURS[mode], label=LABELS[mode], linewidth=1.3)
    axes.set_xscale("log")
    axes.set_xlabel(f"energy of a face{f' - {least:g}' if least else ''}")
    axes.set_ylabel("share of the area")
    if shares:
        axes.legend(fontsize=7)
    return bool(shares)


def distortion(tables: Tables) -> Figure | None:
    """Figure 5: how the distortion is distributed, over faces and over meshes."""
    figure, axes = columns(2)
    modes = ("ours", "gif", "cm", "plain gif", "uv prolongation")
    if not draw_histograms(axes[0], tables.main, modes, "symmetric-dirichlet", 2.0):
        return None
    excess_histogram(axes[1], tables.main, ("ours", "gif", "dirichlet", "plain gif"))
    return figure


def excess_histogram(axes: Any, rows: Sequence[Row], modes: Sequence[str]) -> None:
    """Draw how many meshes have which energy over CM's."""
    edges = np.concatenate([[-0.02, 0], np.logspace(-5, 1.5, 27)])
    for mode in modes:
        excess = np.array([v - 1 for v in known(row.excess(mode) for row in rows)])
        counts, _ = np.histogram(np.clip(excess, edges[0], edges[-1] * 0.999), edges)
        axes.stairs(counts, edges, color=COLOURS[mode], label=LABELS[mode], linewidth=1.3)
    axes.set_xscale("symlog", linthresh=1e-5)
    axes.set_xticks([0, 1e-4, 1e-2, 1], ["below", "0.01%", "1%", "100%"])
    axes.set_xlabel("energy above CM's")
    axes.set_ylabel("meshes")
    axes.legend(fontsize=7)


def other_energies(tables: Tables) -> Figure | None:
    """Figure 11: the same for the other energies."""
    found = {name: rows for name, rows in tables.energies.items() if rows}
    if not found:
        return None
    figure, axes = columns(2 * len(found))
    for k, (name, rows) in enumerate(found.items()):
        draw_histograms(axes[2 * k], rows, ("ours", "gif", "cm"), name, 0.0)
        axes[2 * k].set_title(name, fontsize=9)
        excess_histogram(axes[2 * k + 1], rows, ("ours", "gif"))
    return figure


def scatter(tables: Tables) -> Figure | None:
    """Figure 8: energies against those of CM and of GIF without prolongation."""
    figure, axes = columns(2)
    for place, other in zip(axes, ("cm", "plain gif")):
        for mode in ("gif", "ours"):
            pairs = [
                (row.energy(row.reference() if other == "cm" else other), row.energy(mode))
                for row in tables.main
            ]
            pairs = [pair for pair in pairs if all(math.isfinite(value) for value in pair)]
            if not pairs:
                return None
            x, y = np.array(pairs).T
            place.plot(
                x, y, "o" if mode == "ours" else "x", color=COLOURS[mode], label=LABELS[mode]
            )
        ends = [2, place.get_xlim()[1]]
        place.plot(ends, ends, color="#999999", linewidth=0.8)
        place.set_xscale("log")
        place.set_yscale("log")
        plain_ticks(place)
        place.set_xlabel(f"E of {LABELS[other]}")
        place.set_ylabel("E of ours")
        place.legend(fontsize=7)
    return figure


def plain_ticks(axes: Any) -> None:
    """Write the numbers of logarithmic axes as numbers, about as many as there is room for."""
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        if axis.get_scale() != "log" or not 0 < low < high:  # nothing is drawn yet
            continue
        decades = math.log10(high / low)
        axis.set_minor_formatter(mpl.ticker.NullFormatter())
        axis.set_major_formatter(mpl.ticker.FuncFormatter(lambda value, _: plain(value)))
        if decades < 0.7:
            axis.set_major_locator(mpl.ticker.MaxNLocator(4))
            axis.set_minor_locator(mpl.ticker.NullLocator())
        else:
            subs = (1, 2, 5) if decades < 2.5 else (1,)
            axis.set_major_locator(mpl.ticker.LogLocator(subs=subs, numticks=8))


def plain(value: float) -> str:
    """Write a number without an exponent where it is short."""
    for unit, letter in ((1_000_000, "M"), (1_000, "k")):
        if unit <= value < 1000 * unit:
            return f"{value / unit:g}{letter}"
    return f"{value:.4g}"


def against_faces(axes: Any, points: Sequence[tuple[int, float]], mode: str, marker: str) -> None:
    """Draw a value of meshes against their faces."""
    sound = [(faces, value) for faces, value in points if math.isfinite(value)]
    if sound:
        x, y = np.array(sound, float).T
        axes.plot(x, y, marker, color=COLOURS[mode], label=LABELS[mode])


def speedups(tables: Tables) -> Figure | None:
    """Figure 9: what ours saves of CM's time: in all, at equal energy, and started from ours."""
    if not any(known(row.speedup("ours") for row in tables.main)):
        return None
    figure, axes = columns(3)
    for mode, marker in (("ours", "o"), ("gif", "x")):
        points = [(row.faces, row.speedup(mode)) for row in tables.main]
        against_faces(axes[0], points, mode, marker)
    equal = [(row.faces, equal_energy(row, stopped_row(tables, row))) for row in tables.main]
    against_faces(axes[1], equal, "ours", "o")
    refined = [(row.faces, row.speedup("refine")) for row in tables.main]
    against_faces(axes[2], refined, "refine", "o")
    titles = ("CM / ours, in all", "CM up to our energy / ours", "CM / CM started from ours")
    for place, title in zip(axes, titles):
        place.axhline(1, color="#999999", linewidth=0.8)
        place.set_xscale("log")
        place.set_yscale("log")
        plain_ticks(place)
        place.set_title(title, fontsize=9)
        place.set_xlabel("faces")
        place.set_ylabel("ratio of CPU seconds")
    axes[0].legend(fontsize=7)
    return figure


def run_times(tables: Tables) -> Figure | None:
    """Figure 10: CPU seconds against faces."""
    if not tables.main:
        return None
    figure, axes = columns(1, 3.8, 6)
    for mode in ("cm", "refine", "plain gif", "flim", "gif", "dirichlet", "ours"):
        points = [(row.faces, row.seconds(mode)) for row in tables.main]
        against_faces(axes[0], points, mode, "o")
    axes[0].set_xscale("log")
    axes[0].set_yscale("log")
    plain_ticks(axes[0])
    axes[0].set_xlabel("faces")
    axes[0].set_ylabel("CPU seconds, one thread")
    axes[0].legend(fontsize=7)
    return figure


def punctured(tables: Tables) -> Figure | None:
    """Figure 12: closed meshes without one triangle."""
    rows = tables.punctured
    if not rows:
        return None
    figure, axes = columns(1, 0.9 + 0.28 * len(rows), 7)
    modes = ("ours", "gif", "plain gif", "cm")
    highest = max([v for row in rows for v in known(map(row.energy, modes)) if v < math.inf] + [3])
    for mode in modes:
        energies = np.array([row.energy(mode) for row in rows])
        sound = np.isfinite(energies)
        at = np.arange(len(rows))
        shape = "o" if mode == "ours" else "x"
        axes[0].plot(energies[sound], at[sound], shape, color=COLOURS[mode], label=LABELS[mode])
        lost = ~sound
        axes[0].plot(
            np.full(lost.sum(), highest * 3), at[lost], ">", color=COLOURS[mode], mfc="none"
        )
    axes[0].set_yticks(range(len(rows)), [row.mesh for row in rows], fontsize=7)
    axes[0].set_xscale("log")
    axes[0].set_xlabel("E (to the right of all: no map, or flips)")
    axes[0].legend(fontsize=7, loc="center left", bbox_to_anchor=(1, 0.5))
    return figure


def simplification(tables: Tables) -> Figure | None:
    """Figure 14: energy and time against the faces of the coarse mesh."""
    usual = str(USUAL_COARSE)
    found = {
        mode: [row for row in rows if row.seconds(usual) > 0 and math.isfinite(row.energy(usual))]
        for mode, rows in tables.coarse.items()
    }
    if not any(found.values()):
        return None
    figure, axes = columns(2)
    for mode, rows in found.items():
        against_coarse(axes[0], [(row, Row.energy) for row in rows], mode)
        against_coarse(axes[1], [(row, Row.seconds) for row in rows], mode)
    for place, title in zip(axes, ("energy", "CPU seconds")):
        place.set_xscale("log")
        place.set_yscale("log")
        plain_ticks(place)
        place.set_xlabel("faces of the coarse mesh")
        place.set_title(f"{title}, 1 at {USUAL_COARSE:,} faces", fontsize=9)
    axes[0].legend(fontsize=7)
    return figure


def against_coarse(
    axes: Any, rows: Sequence[tuple[Row, Callable[[Row, str], float]]], mode: str
) -> None:
    """Draw a value of meshes, in units of that of the usual coarse mesh, and the median of them."""
    listed: dict[int, list[float]] = {}
    for row, value in rows:
        points = [(n, value(row, str(n)) / value(row, str(USUAL_COARSE))) for n in COARSE_FACES]
        points = [point for point in points if math.isfinite(point[1])]
        axes.plot(*zip(*points), color=COLOURS[mode], alpha=0.25, linewidth=0.8)
        for count, ratio in points:
            listed.setdefault(count, []).append(ratio)
    counts = sorted(listed)
    if counts:
        medians = [statistics.median(listed[count]) for count in counts]
        axes.plot(counts, medians, "o-", color=COLOURS[mode], label=LABELS[mode])


def flips_and_repairs(tables: Tables) -> Figure | None:
    """Section 4's counts: flips before repair, and what ended them."""
    modes = [
        mode
        for mode in ("ours", "gif", "flim", "dirichlet")
        if repairs(tables.main, mode)["meshes"]
    ]
    if not modes:
        return None
    figure, axes = columns(2)
    keys = {
        "without": "none flipped",
        "kernel_fixes": "kernel",
        "patch_fixes": "patch",
        "global_fixes": "global",
        "restarts": "restart",
    }
    for k, mode in enumerate(modes):
        found = repairs(tables.main, mode)
        at = np.arange(len(keys)) + 0.8 * (k / len(modes) - 0.4)
        heights = [found[key] / found["meshes"] for key in keys]
        axes[0].bar(at, heights, 0.75 / len(modes), color=COLOURS[mode], label=LABELS[mode])
        flips = [
            (row.faces, row.modes[mode]["flips_before"] + 0.5)
            for row in tables.main
            if "flips_before" in row.modes.get(mode, {})
        ]
        against_faces(axes[1], flips, mode, "o")
    axes[0].set_xticks(range(len(keys)), keys.values())
    axes[0].set_ylabel("share of meshes")
    axes[0].legend(fontsize=7)
    axes[1].set_xscale("log")
    plain_ticks(axes[1])
    axes[1].set_yscale("log")
    axes[1].set_yticks([0.5, 1.5, 10.5, 100.5, 1000.5], ["0", "1", "10", "100", "1000"])
    axes[1].set_xlabel("faces")
    axes[1].set_title("flips before repair", fontsize=9)
    return figure


def equal_time(tables: Tables) -> Figure | None:
    """Draw the energy that CM has reached when ours has ended, and what others fail at."""
    points = [(row.faces, row.excess("cm in our time", "ours")) for row in tables.main]
    if not known(value for _, value in points):
        return None
    figure, axes = columns(2)
    against_faces(axes[0], points, "cm", "o")
    axes[0].axhline(1, color="#999999", linewidth=0.8)
    axes[0].set_xscale("log")
    axes[0].set_yscale("log")
    axes[0].set_xlabel("faces")
    axes[0].set_title("E of CM stopped at our time / ours", fontsize=9)
    plain_ticks(axes[0])
    modes = modes_of(tables.main)
    modes = [mode for mode in LABELS if mode in modes]
    found = [failures(tables.main, mode) for mode in modes]
    left = np.zeros(len(modes))
    for label, colour, values in (
        ("injective", "#3a9a55", [each.injective() for each in found]),
        ("boundary crosses", "#e0b040", [each.crossing for each in found]),
        ("flipped faces", "#c8553d", [each.flipped for each in found]),
        ("no map", "#555555", [each.failed for each in found]),
    ):
        axes[1].barh(range(len(modes)), values, left=left, color=colour, label=label)
        left += values
    axes[1].set_yticks(range(len(modes)), [LABELS[mode] for mode in modes], fontsize=7)
    axes[1].set_xlabel("meshes")
    axes[1].legend(fontsize=7, ncols=2, loc="lower center", bbox_to_anchor=(0.4, 1))
    return figure


def shares(tables: Tables) -> Figure | None:
    """Draw what part of the time the stages take, beside the paper's."""
    found: dict[str, Mapping[str, float]] = {
        LABELS[mode]: stage_shares(tables.main, mode) for mode in ("ours", "gif")
    }
    if not all(found.values()):
        return None
    found["the paper"] = PAPER_SHARES
    figure, axes = columns(1, 2.4, 7)
    stages = list(dict.fromkeys(stage for each in found.values() for stage in each))
    left = np.zeros(len(found))
    for stage, colour in zip(stages, STAGE_COLOURS):
        widths = np.array([each.get(stage, 0.0) for each in found.values()])
        axes[0].barh(range(len(found)), widths, left=left, color=colour, label=stage)
        left += widths
    axes[0].set_yticks(range(len(found)), found.keys())
    axes[0].invert_yaxis()
    axes[0].set_xlabel("share of the CPU seconds")
    axes[0].legend(fontsize=7, ncols=1, loc="center left", bbox_to_anchor=(1, 0.5))
    return figure


def rivals(tables: Tables) -> Figure | None:
    """Time and energy of the programs of others, in units of ours."""
    modes = [mode for mode in ("SLIM", "SCAF", "Blender") if mode in modes_of(tables.rivals)]
    if not modes:
        return None
    figure, axes = columns(1, 3.4, 5.5)
    for mode in modes:
        pairs = [(row.speedup("ours", mode), row.excess(mode, "ours")) for row in tables.rivals]
        sound = [pair for pair in pairs if all(math.isfinite(value) for value in pair)]
        if sound:
            x, y = np.array(sound).T
            axes[0].plot(x, y, "o", color=COLOURS[mode], label=LABELS[mode])
    axes[0].plot([1], [1], "*", markersize=10, color=COLOURS["ours"], label=LABELS["ours"])
    axes[0].set_xscale("log")
    axes[0].set_yscale("log")
    plain_ticks(axes[0])
    axes[0].set_xlabel("CPU seconds / ours")
    axes[0].set_ylabel("E / ours")
    axes[0].legend(fontsize=7)
    return figure


def textures(data: DataSet, book: Book, folder: Path) -> Figure | None:
    """Figure 6: stripes through the UVs of ours and of UV prolongation, and the flips of both."""
    found = kept_maps(data, book, folder, ("ours", "uv prolongation"))
    if len(found) < 2:
        return None
    import beltrami.plot

    figure, axes = columns(4, 3.0, 2.6)
    for k, (run, uv) in enumerate(found):
        vertices, faces = make(run.mesh)
        flips = (book.find(run) or {}).get("flips", 0)
        # A checkerboard of one row is stripes.
        stripes = uv * np.array([1.0, 1e-6])
        beltrami.plot.checkered(vertices, faces, stripes, axes[2 * k], cells=60, resolution=420)
        beltrami.plot.layout(uv, faces, axes[2 * k + 1], edges=False, resolution=420)
        mark_flips(axes[2 * k + 1], uv, faces)
        axes[2 * k].set_title(LABELS[run.mode], fontsize=9)
        axes[2 * k + 1].set_title(f"{flips} faces flipped", fontsize=9)
    return figure


def mark_flips(axes: Any, uv: np.ndarray, faces: np.ndarray) -> None:
    """Draw a ring around every flipped face: most are smaller than a pixel."""
    centres = uv[faces[areas(uv, faces) <= 0]].mean(axis=1)
    axes.plot(centres[:, 0], centres[:, 1], "o", color="#d01010", mfc="none", markersize=5)


def kept_maps(
    data: DataSet, book: Book, folder: Path, modes: Sequence[str]
) -> list[tuple[Run, np.ndarray]]:
    """Return the maps of these modes on a mesh that has them all."""
    runs = [run for run in picture_runs(data, book) if book.find(run) is not None]
    for mesh in dict.fromkeys(run.mesh for run in runs):
        found = []
        for run in runs:
            path = folder / "uvs" / run.uv_name()
            if run.mesh == mesh and run.mode in modes and path.exists():
                with np.load(path) as read:
                    found.append((run, read["uv"]))
        if len(found) == len(modes):
            return found
    return []


PICTURES: dict[str, Callable[[Tables], Figure | None]] = {
    "distortion": distortion,
    "other-energies": other_energies,
    "scatter": scatter,
    "speed-up": speedups,
    "run-times": run_times,
    "punctured": punctured,
    "simplification": simplification,
    "repairs": flips_and_repairs,
    "equal-time": equal_time,
    "shares": shares,
    "rivals": rivals,
}


def save(figure: Figure, path: Path) -> None:
    """Write a picture as SVG and PNG."""
    figure.savefig(path.with_suffix(".svg"), metadata={"Date": None})
    figure.savefig(path.with_suffix(".png"), metadata={"Software": None})


def write_pictures(data: DataSet, book: Book, tables: Tables, folder: Path) -> list[str]:
    """Write all pictures that there is something for; return their names."""
    folder.mkdir(parents=True, exist_ok=True)
    names = []
    for name, draw in PICTURES.items():
        figure = draw(tables)
        if figure is not None:
            save(figure, folder / name)
            names.append(name)
    figure = textures(data, book, folder)
    if figure is not None:
        save(figure, folder / "textures")
        names.append("textures")
    return names
