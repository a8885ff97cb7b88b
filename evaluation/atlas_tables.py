"""The tables of ./dev bench atlas: every run, medians, and ours in units of each rival."""

from __future__ import annotations

import statistics
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from atlas_runs import Program, Row

Table = Sequence[Mapping[str, Row]]  # a mapping for each mesh, by names of programs

# What ours is compared by.
COMPARED = ("seams", "charts", "CPU")
# CPU seconds below this are the clock's noise.
LEAST_SECONDS = 1e-3
# What energies may be above a target: the rounding of the measurement.
ROUNDING = 1e-6

HEAD = (
    f"  {'program':12} {'charts':>7} {'seams':>8} {'E':>9} {'p99':>9} {'max':>9}"
    f" {'overlaps':>9} {'flips':>6} {'failed':>6} {'CPU s':>8}"
)


def line(row: Row) -> str:
    """Return the line of one run."""
    found = row.figures
    if found is None:
        return f"  {row.program:12} {row.error}"
    return (
        f"  {row.program:12} {found.charts:7d} {found.seams:8.3f} {found.energy:9.4f}"
        f" {found.p99:9.3f} {found.largest:9.3g} {found.overlaps:9d} {found.flips:6d}"
        f" {found.failed:6d} {row.cpu_seconds:8.2f}"
    )


def value(what: str, row: Row | None) -> float:
    """Return what a row is compared by, NaN where it has no figures."""
    if row is None or row.figures is None:
        return np.nan
    if what == "CPU":
        return max(row.cpu_seconds, LEAST_SECONDS)
    return float(row.figures.seams if what == "seams" else row.figures.charts)


def ratios(what: str, table: Table, variant: str, rival: str) -> dict[str, float]:
    """Return ours over a rival's by mesh, where both have figures and the rival's is above 0."""
    found = {}
    for rows in table:
        one, other = value(what, rows.get(variant)), value(what, rows.get(rival))
        if one >= 0 and other > 0:
            found[rows[variant].mesh] = one / other
    return found


def names_of(table: Table, programs: Iterable[Program]) -> list[str]:
    """Return the names of programs that have rows."""
    return [program.name for program in programs if any(program.name in rows for rows in table)]


def medians(table: Table, programs: list[Program]) -> list[str]:
    """Return medians over the meshes that all programs took, and what became of the others."""
    names = names_of(table, programs)
    whole = [rows for rows in table if all(name in rows and rows[name].figures for name in names)]
    lines = [f"medians over the {len(whole)} of {len(table)} meshes that all took"]
    lines.append(
        f"  {'program':12} {'charts':>7} {'seams':>8} {'E':>9} {'p99':>9} {'CPU s':>8}"
        f" {'taken':>6} {'sound':>6}"
    )
    for name in names:
        rows = [row[name] for row in table if name in row]
        taken = [row.figures for row in rows if row.figures]
        middle = [np.nan] * 5
        if whole:
            found = [row[name].figures for row in whole]
            middle = [
                statistics.median(getattr(each, key) for each in found)
                for key in ("charts", "seams", "energy", "p99")
            ]
            middle.append(statistics.median(row[name].cpu_seconds for row in whole))
        sound = sum(figures.sound() for figures in taken)
        lines.append(
            f"  {name:12} {middle[0]:7.0f} {middle[1]:8.3f} {middle[2]:9.4f} {middle[3]:9.3f}"
            f" {middle[4]:8.2f} {len(taken):6d} {sound:6d}"
        )
    return lines


def by_mesh(table: Table, variant: str, rivals: list[str]) -> list[str]:
    """Return ours over the rivals' on each mesh."""
    lines = [f"{variant} over each rival: seams, charts, CPU"]
    lines.append(f"  {'':32}" + "".join(f"{rival:>24}" for rival in rivals))
    found = {
        (what, rival): ratios(what, table, variant, rival) for what in COMPARED for rival in rivals
    }
    for rows in table:
        if variant not in rows:
            continue
        mesh = rows[variant].mesh
        cells = (
            "".join(f"{found[what, rival].get(mesh, np.nan):8.3f}" for what in COMPARED)
            for rival in rivals
        )
        lines.append(f"  {mesh[:32]:32}" + "".join(cells).replace("nan", "  -"))
    return lines


def over(table: Table, variant: str, rivals: list[str]) -> list[str]:
    """Return the medians of the ratios, and the worst mesh of each."""
    lines = [f"{variant}, medians of the ratios, and the worst"]
    for what in COMPARED:
        for rival in rivals:
            found = ratios(what, table, variant, rival)
            if not found:
                continue
            worst = max(found, key=lambda mesh: found[mesh])
            lines.append(
                f"  {what:7} / {rival:9} {statistics.median(found.values()):8.3f}"
                f" on {len(found):3d} meshes, worst {found[worst]:8.3f} {worst}"
            )
    return lines


def reaches(row: Row | None, target: float) -> bool:
    """Return whether a map is injective at an energy."""
    if row is None or row.figures is None or not row.figures.sound():
        return False
    return row.figures.energy <= target + ROUNDING


def share(table: Table, variant: str, target: float, rivals: list[str]) -> list[str]:
    """Return on how many meshes ours reaches its target, of those where a rival does."""
    asked = [rows for rows in table if variant in rows]
    theirs = [rows for rows in asked if any(reaches(rows.get(r), target) for r in rivals)]
    missed = [rows[variant] for rows in theirs if not reaches(rows[variant], target)]
    every = sum(reaches(rows[variant], target) for rows in asked)
    reached = f"{len(theirs) - len(missed)} of the {len(theirs)} meshes where a rival does"
    lines = [f"{variant} reaches {target} on {reached}, on {every} of all {len(asked)}"]
    if missed:
        worst = max(missed, key=lambda row: row.figures.energy if row.figures else np.inf)
        found = f"{worst.figures.energy:.4f}" if worst.figures else worst.error
        lines.append(f"  the worst of the others: {worst.mesh}, {found}")
    return lines


def summary(table: Table, programs: list[Program]) -> list[str]:
    """Return all tables over the meshes."""
    rivals = names_of(table, (program for program in programs if program.keywords is None))
    lines = medians(table, programs)
    for program in programs:
        if program.keywords is None:
            continue
        if rivals:
            lines += ["", *by_mesh(table, program.name, rivals)]
            lines += ["", *over(table, program.name, rivals)]
        target = program.target()
        if target is not None:
            lines += share(table, program.name, target, rivals)
    return lines
