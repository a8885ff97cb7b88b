"""The figures of ./dev evaluate as numbers: what the records of the experiments say together.

Functions of records alone: tests make some up. A row is a mesh with the records of its modes.
"""

from __future__ import annotations

import json
import math
import statistics
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from evaluate_plan import EQUAL, DataSet, energy, iterations, plan_of
from evaluate_runs import Book, Record, Run, succeeded

WORST = 1.05  # of our energy over CM's: more is an outlier
OURS = ("ours", "gif", "flim", "dirichlet", "refine")
SHARES_FROM = 100_000  # faces
CERTIFIED = ("ours", "gif", "dirichlet", "refine")  # modes that promise an injective map
REPAIRS = ("kernel_fixes", "patch_fixes", "global_fixes", "cleaned_patches")


@dataclass
class Row:
    """A mesh, and what came of the modes on it."""

    mesh: str
    faces: int
    modes: dict[str, Record] = field(default_factory=dict)

    def energy(self, mode: str) -> float:
        """Return the energy of a mode; infinite where its map has flips, NaN without a map."""
        record = self.modes.get(mode)
        if record is None or not succeeded(record):
            return math.nan
        return math.inf if record["flips"] else energy(record)

    def seconds(self, mode: str) -> float:
        """Return the CPU seconds of a mode, NaN without a map."""
        record = self.modes.get(mode)
        if record is None or not succeeded(record):
            return math.nan
        return float(record["cpu_seconds"])

    def reference(self) -> str:
        """Return the CM that promises what ours does: another one where the plain one overlaps."""
        plain = self.modes.get("cm")
        overlaps = plain is not None and succeeded(plain) and plain["crossings"] > 0
        return "cm, global" if overlaps and "cm, global" in self.modes else "cm"

    def excess(self, mode: str, other: str = "") -> float:
        """Return the energy of a mode over that of another, or of CM."""
        below = self.energy(other or self.reference())
        return self.energy(mode) / below if below > 0 else math.nan

    def speedup(self, mode: str, other: str = "cm") -> float:
        """Return the seconds of CM over those of a mode."""
        seconds = self.seconds(mode)
        return self.seconds(other) / seconds if seconds > 0 else math.nan


def rows_of(runs: Iterable[Run], book: Book) -> list[Row]:
    """Return the recorded runs by mesh, in the order of the runs."""
    rows: dict[str, Row] = {}
    for run in runs:
        record = book.find(run)
        if record is not None:
            row = rows.setdefault(run.mesh.key(), Row(run.mesh.name, run.faces))
            row.modes.setdefault(run.mode, {**record, "mode": run.mode})
    return list(rows.values())


def known(values: Iterable[float]) -> list[float]:
    """Return the values that are numbers, infinite ones among them."""
    return [value for value in values if not math.isnan(value)]


def spread_of(values: Iterable[float]) -> dict[str, float] | None:
    """Return number, least, median and greatest of values, None without any."""
    found = known(values)
    if not found:
        return None
    return {
        "count": len(found),
        "least": min(found),
        "median": statistics.median(found),
        "greatest": max(found),
    }


def bins(values: Sequence[list[float]]) -> np.ndarray:
    """Return the mean of histograms."""
    mean: np.ndarray = np.array(values, float).mean(axis=0)
    return mean


def histograms(rows: Sequence[Row], modes: Sequence[str], name: str) -> dict[str, np.ndarray]:
    """Return the share of the area by its energy, every mesh counting the same, by mode.

    Meshes that one of the modes has no map of are left out of all.
    """
    whole = [row for row in rows if all(succeeded(row.modes.get(mode)) for mode in modes)]
    found = {mode: [row.modes[mode]["histograms"].get(name) for row in whole] for mode in modes}
    return {mode: bins(lists) for mode, lists in found.items() if lists and None not in lists}


def equal_energy(row: Row, stopped: Row | None) -> float:
    """Return the seconds of CM up to our energy over ours, NaN where that is not known.

    CM that ends above our energy never gets there: all its time counts.
    """
    if not (succeeded(row.modes.get("ours")) and succeeded(row.modes.get("cm"))):
        return math.nan
    target = row.energy("ours") * (1 + EQUAL)
    if row.energy("cm") > target:
        return row.speedup("ours")
    tries = list(stopped.modes.values()) if stopped is not None else []
    tries = [record for record in [*tries, row.modes["cm"]] if succeeded(record)]
    reached = [record for record in tries if energy(record) <= target]
    missed = [iterations(record) for record in tries if energy(record) > target]
    first = min(reached, key=iterations)
    if iterations(first) - max(missed, default=0) > 1:  # the search has not ended
        return math.nan
    seconds = row.seconds("ours")
    return float(first["cpu_seconds"]) / seconds if seconds > 0 else math.nan


def stage_shares(rows: Sequence[Row], mode: str) -> dict[str, float]:
    """Return what part of the CPU seconds each stage takes, every mesh counting the same.

    Meshes that are hardly larger than the coarse one are left out, where there are others.
    """
    shares: dict[str, float] = {}
    rows = [row for row in rows if row.faces >= SHARES_FROM] or rows
    records = [row.modes[mode] for row in rows if succeeded(row.modes.get(mode))]
    for record in records:
        whole = sum(seconds for seconds, _ in record["stages"].values()) or 1.0
        for stage, (seconds, _) in record["stages"].items():
            shares[stage] = shares.get(stage, 0.0) + seconds / whole / len(records)
    return shares


def repairs(rows: Sequence[Row], mode: str) -> dict[str, int]:
    """Count flips before repair, meshes by what ended them, and all faces."""
    found = dict.fromkeys(("meshes", "faces", "flips", "without", "restarts", *REPAIRS), 0)
    for row in rows:
        record = row.modes.get(mode)
        if not succeeded(record) or record is None:
            continue
        found["meshes"] += 1
        found["faces"] += row.faces
        found["flips"] += record["flips_before"]
        found["without"] += record["flips_before"] == 0
        found["restarts"] += record["restarts"] > 0
        for repair in REPAIRS:
            found[repair] += record["repair"][repair] > 0
    return found


@dataclass
class Failures:
    """How a mode fails: maps that are not injective, and runs without a map."""

    maps: int = 0
    flipped: int = 0  # maps with flips
    crossing: int = 0  # maps whose boundary crosses itself, without flips
    flips: int = 0  # of all maps
    failed: int = 0  # runs without a map

    def injective(self) -> int:
        """Return how many maps are injective."""
        return self.maps - self.flipped - self.crossing


def failures(rows: Sequence[Row], mode: str) -> Failures:
    """Count the failures of a mode."""
    found = Failures()
    for row in rows:
        record = row.modes.get(mode)
        if record is None:
            continue
        if not succeeded(record):
            found.failed += 1
            continue
        found.maps += 1
        found.flips += record["flips"]
        found.flipped += record["flips"] > 0
        found.crossing += record["flips"] == 0 and record["crossings"] > 0
    return found


def outliers(rows: Sequence[Row]) -> Iterator[str]:
    """Yield a sentence for each run of ours that is worse than it may be."""
    for row in rows:
        for mode, record in row.modes.items():
            where = f"{row.mesh}, {row.faces} faces, {mode}"
            if not succeeded(record):
                yield f"{where}: {record['status']}, {record.get('error', '')}"
            elif mode in CERTIFIED and not record.get("certified", False):
                counts = f"{record['flips']} flips, {record['crossings']} crossings"
                yield f"{where}: not certified ({counts})"
        for mode in ("ours", "gif"):
            if row.excess(mode) > WORST:
                name = row.modes[mode]["options"].get("energy", "E")
                found = f"{name} {row.energy(mode):.4f}, {row.excess(mode):.3f} times that of"
                yield f"{row.mesh}, {row.faces} faces, {mode}: {found} {row.reference()}"


@dataclass
class Tables:
    """All rows, by experiment."""

    bases: list[Row]
    main: list[Row]  # the ladder, with what is larger
    equal: list[Row]
    energies: dict[str, list[Row]]
    punctured: list[Row]
    coarse: dict[str, list[Row]]  # by mode: modes of a row are numbers of coarse faces
    rivals: list[Row]


def tables_of(data: DataSet, book: Book) -> Tables:
    """Return what is recorded of the experiments."""
    runs = {name: list(listed) for name, (_, listed) in plan_of(data, book).items()}
    by_energy = {
        name: rows_of(
            (run for run in runs.get("energies", []) if ("energy", name) in run.options), book
        )
        for name in data.energies[1:]
    }
    return Tables(
        bases=rows_of(runs["bases"], book),
        main=rows_of([*runs.get("main", []), *runs.get("large", [])], book),
        equal=rows_of(runs.get("equal energy", []), book),
        energies=by_energy,
        punctured=rows_of(runs.get("punctured", []), book),
        coarse={
            mode: coarse_rows(runs.get("simplification", []), book, mode)
            for mode in ("gif", "ours")
        },
        rivals=rows_of(runs.get("rivals", []), book),
    )


def coarse_rows(runs: Iterable[Run], book: Book, mode: str) -> list[Row]:
    """Return rows whose modes are the numbers of coarse faces that were asked for."""
    rows: dict[str, Row] = {}
    for run in runs:
        record = book.find(run)
        if record is not None and run.mode == mode:
            row = rows.setdefault(run.mesh.key(), Row(run.mesh.name, run.faces))
            row.modes[str(dict(run.options)["coarse_faces"])] = record
    return list(rows.values())


def stopped_row(tables: Tables, row: Row) -> Row | None:
    """Return the row of the search for equal energy on the same mesh."""
    same = (found for found in tables.equal if (found.mesh, found.faces) == (row.mesh, row.faces))
    return next(same, None)


def excesses(rows: Sequence[Row], modes: Sequence[str]) -> dict[str, dict[str, float] | None]:
    """Return the spread of energies over CM's, by mode."""
    return {mode: spread_of(row.excess(mode) for row in rows) for mode in modes}


def speedups(rows: Sequence[Row], modes: Sequence[str]) -> dict[str, dict[str, float] | None]:
    """Return the spread of CM's seconds over those of modes."""
    return {mode: spread_of(row.speedup(mode) for row in rows) for mode in modes}


def summary(tables: Tables) -> dict[str, Any]:
    """Return the figures that the text speaks of."""
    main = tables.main
    large = [row for row in main if row.faces >= 500_000]

    whole = [row for row in main if not math.isnan(row.seconds("cm") + row.seconds("refine"))]
    return {
        "meshes": len(main),
        "faces": sum(row.faces for row in main),
        "largest": max((row.faces for row in main), default=0),
        "excess": excesses(main, OURS),
        "excess of plain gif": excesses(main, ["plain gif"])["plain gif"],
        "speed-up": speedups(main, OURS),
        "speed-up of large meshes": speedups(large, ("ours", "gif")),
        "speed-up at equal energy": spread_of(
            equal_energy(row, stopped_row(tables, row)) for row in main
        ),
        "energy of CM in our time": spread_of(row.excess("cm in our time", "ours") for row in main),
        "CPU of CM in our time": spread_of(row.speedup("ours", "cm in our time") for row in main),
        "seconds of CM": sum(row.seconds("cm") for row in whole),
        "seconds of refine": sum(row.seconds("refine") for row in whole),
        "failures": {mode: vars(failures(main, mode)) for mode in modes_of(main)},
        "repairs": {mode: repairs(main, mode) for mode in OURS[:4]},
        "shares": {mode: stage_shares(main, mode) for mode in ("ours", "gif")},
        "energies": {
            name: excesses(rows, ("ours", "gif")) for name, rows in tables.energies.items()
        },
        "punctured": {
            mode: vars(failures(tables.punctured, mode)) for mode in modes_of(tables.punctured)
        },
        "outliers": sorted(outliers([*main, *tables.punctured, *all_of(tables.energies)])),
    }


def all_of(rows: Mapping[str, list[Row]]) -> list[Row]:
    """Return the rows of all energies."""
    return [row for listed in rows.values() for row in listed]


def modes_of(rows: Iterable[Row]) -> list[str]:
    """Return the modes of rows, in the order in which they first occur."""
    return list(dict.fromkeys(mode for row in rows for mode in row.modes))


def atlas_medians(history: Path) -> list[dict[str, Any]]:
    """Return medians of the last recorded comparison of atlases, by program; none without one."""
    if not history.exists():
        return []
    rows = [json.loads(line) for line in history.read_text().splitlines()]
    last = max((row["date"], row["commit"]) for row in rows) if rows else None
    rows = [row for row in rows if (row["date"], row["commit"]) == last]
    programs = list(dict.fromkeys(row["program"] for row in rows))
    by_mesh: dict[str, dict[str, Any]] = {}
    for row in rows:
        if "error" not in row:
            by_mesh.setdefault(row["mesh"], {})[row["program"]] = row
    shared = [found for found in by_mesh.values() if len(found) == len(programs)]
    return [
        {
            "program": program,
            "meshes": len(shared),
            **{
                key: statistics.median(found[program][key] for found in shared)
                for key in ("cpu_seconds", "charts", "seams", "energy")
            },
            "unsound": sum(
                found[program].get("overlaps", 0) + found[program].get("flips", 0) > 0
                for found in shared
            ),
        }
        for program in programs
        if shared
    ]
