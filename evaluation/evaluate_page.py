"""The page of ./dev evaluate: the figures, the numbers behind them, and the paper's beside them."""

from __future__ import annotations

import html
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import records
from evaluate_figures import Tables, atlas_medians, summary, tables_of
from evaluate_pictures import LABELS, write_pictures
from evaluate_plan import DataSet, base_energy, base_run
from evaluate_runs import Book, succeeded

STYLE = """
body { font: 15px/1.45 sans-serif; max-width: 62em; margin: 2em auto; padding: 0 1em; color: #222 }
img { max-width: 100%; height: auto }
table { border-collapse: collapse; margin: 1em 0 }
td, th { padding: .2em .7em; text-align: right; border-bottom: 1px solid #ddd }
td:first-child, th:first-child { text-align: left }
figure { margin: 1.5em 0 } figcaption { color: #555; font-size: 90% }
"""
INTRODUCTION = """
Energies E are mean symmetric Dirichlet energies on a mesh of area 1, 2 at least; seconds are CPU
seconds of one thread. CM is our composite majorization on the whole mesh, as the literature has it;
where its map overlaps, energies are held against CM with contact. Verdicts are exact.
"""
# Name of the picture, heading, and what it shows.
SECTIONS = (
    (
        "distortion",
        "Distortion (the paper's Figure 5)",
        (
            "Left: the share of the area by the energy of its faces, flipped ones last on the "
            "right. Right: meshes by their energy above CM's."
        ),
    ),
    (
        "textures",
        "UV prolongation (Figure 6)",
        "Stripes through the UVs, and the layouts.",
    ),
    (
        "scatter",
        "Energy against CM and GIF (Figure 8)",
        "On the line the energies are equal, below it ours is less.",
    ),
    (
        "speed-up",
        "Speed-up over CM (Figure 9)",
        "In all; up to the moment where CM has our energy; and of CM that starts from our map.",
    ),
    ("run-times", "Run times (Figure 10)", "CPU seconds of one thread."),
    ("other-energies", "Other energies (Figure 11)", "As in Figure 5, minimising another energy."),
    (
        "punctured",
        "Closed meshes without one triangle (Figure 12)",
        "All of the surface is pressed through a boundary of three edges.",
    ),
    (
        "simplification",
        "How far to simplify (Figure 14)",
        "Thin lines are meshes, thick ones their medians.",
    ),
    (
        "repairs",
        "Fold-overs and what ends them",
        (
            "Left: the share of meshes without a flip before repair, and of those that needed each "
            "repair. Right: flips before repair."
        ),
    ),
    (
        "equal-time",
        "In the same time, and what fails",
        "Left: CM stopped when ours had ended. Right: what the maps of each method are.",
    ),
    ("shares", "Where the time goes", "Of meshes from 100,000 faces on, each counting the same."),
    ("rivals", "Programs of others", "At their best scale, with default options, on small meshes."),
)
RATIOS = (
    ("E / CM, ours (default)", ("excess", "ours")),
    ("E / CM, ours, the paper's mode", ("excess", "gif")),
    ("E / CM, dirichlet", ("excess", "dirichlet")),
    ("E / CM, CM started from ours", ("excess", "refine")),
    ("E / CM, GIF without prolongation", ("excess of plain gif",)),
    ("speed-up over CM, ours (default)", ("speed-up", "ours")),
    ("speed-up over CM, ours, the paper's mode", ("speed-up", "gif")),
    ("the same from 500,000 faces on, ours", ("speed-up of large meshes", "ours")),
    ("the same from 500,000 faces on, the paper's mode", ("speed-up of large meshes", "gif")),
    ("speed-up over CM at equal energy, ours", ("speed-up at equal energy",)),
    ("speed-up of CM started from ours", ("speed-up", "refine")),
    ("E of CM stopped at our time / ours", ("energy of CM in our time",)),
    ("CPU seconds of CM stopped at our time / ours", ("CPU of CM in our time",)),
)


def number(value: Any) -> str:
    """Write a number with the digits that it needs."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "-"
    if isinstance(value, int):
        return f"{value:,}"
    if not isinstance(value, float):
        return str(value)
    return f"{value:.4f}" if abs(value) < 10 else f"{value:.4g}"


def table(heads: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Return a table of HTML."""
    lines = ["<table><tr>", *(f"<th>{html.escape(head)}</th>" for head in heads), "</tr>"]
    for row in rows:
        cells = "".join(f"<td>{html.escape(number(cell))}</td>" for cell in row)
        lines.append(f"<tr>{cells}</tr>")
    return "\n".join([*lines, "</table>"])


def at(numbers: Mapping[str, Any], path: Sequence[str]) -> Any:
    """Return what is at a path of keys."""
    found: Any = numbers
    for key in path:
        found = found.get(key) if isinstance(found, Mapping) else None
    return found


def ratio_table(numbers: Mapping[str, Any]) -> str:
    """Return the table of energies and speed-ups."""
    keys = ("count", "least", "median", "greatest")
    rows = [(label, at(numbers, path)) for label, path in RATIOS]
    for name, modes in numbers["energies"].items():
        for mode in modes:
            rows.append((f"E / CM, {name}, {LABELS[mode]}", modes[mode]))
    listed = [(label, *(found[key] for key in keys)) for label, found in rows if found]
    return table(("", "meshes", "least", "median", "greatest"), listed)


def verdicts(numbers: Mapping[str, Any], key: str) -> str:
    """Return the table of what maps are."""
    rows = [
        (
            LABELS.get(mode, mode),
            found["maps"],
            found["maps"] - found["flipped"] - found["crossing"],
            found["flipped"],
            found["crossing"],
            found["flips"],
            found["failed"],
        )
        for mode, found in numbers[key].items()
    ]
    heads = ("", "maps", "injective", "with flips", "only crossing", "flips in all", "no map")
    return table(heads, rows)


def repair_table(numbers: Mapping[str, Any]) -> str:
    """Return the table of flips before repair."""
    keys = ("meshes", "faces", "flips", "without")
    ends = ("kernel_fixes", "patch_fixes", "global_fixes", "cleaned_patches", "restarts")
    rows = [
        (LABELS[mode], *(found[key] for key in keys + ends))
        for mode, found in numbers["repairs"].items()
        if found["meshes"]
    ]
    heads = (
        "",
        "meshes",
        "faces",
        "flips",
        "no flip",
        "kernel",
        "patch",
        "global",
        "cleaned",
        "restart",
    )
    return table(heads, rows)


def base_table(data: DataSet, book: Book) -> str:
    """Return the table of base meshes, and of what gave none."""
    rows: list[tuple[Any, ...]] = []
    for base in data.main():
        record = book.find(base_run(base))
        if record is None:
            continue
        if not succeeded(record):
            rows.append((base.mesh.name, base.faces, None, record["status"]))
            continue
        kept = "kept" if base_energy(record) >= 0 else "left out"
        rows.append((base.mesh.name, base.faces, record["energies"]["symmetric-dirichlet"], kept))
    rows += [(name, None, None, reason) for name, reason in data.refused.items()]
    return table(("base mesh", "faces", "E of CM", ""), rows)


def origin(book: Book) -> str:
    """Say what the records come from."""
    commits: dict[str, list[str]] = {}
    for record in book.records.values():
        place = ", ".join(str(record.get(key, "")) for key in ("date", "processor", "build"))
        commits.setdefault(place, []).append(str(record.get("commit", "")))
    lines = (f"{place}; at {', '.join(dict.fromkeys(found))}" for place, found in commits.items())
    return "<br>".join(html.escape(line) for line in lines)


def document(
    data: DataSet, book: Book, tables: Tables, numbers: Mapping[str, Any], names: Sequence[str]
) -> str:
    """Return the page."""
    parts = [
        "<!doctype html><html lang=en><meta charset=utf-8><title>beltrami, evaluated</title>",
        f"<style>{STYLE}</style><h1>beltrami, evaluated</h1>",
        (
            f"<p>{numbers['meshes']} meshes of {number(numbers['faces'])} faces in all, the "
            f"largest of {number(numbers['largest'])}. {INTRODUCTION}</p>"
        ),
        f"<p>{origin(book)}</p>",
        "<h2>In short</h2>",
        ratio_table(numbers),
        verdicts(numbers, "failures"),
        "<h3>Outliers</h3>",
        outlier_list(numbers["outliers"]),
    ]
    for name, heading, text in SECTIONS:
        if name in names:
            parts.append(f"<h2>{html.escape(heading)}</h2><figure><img src='{name}.svg' alt=''>")
            parts.append(f"<figcaption>{html.escape(text)}</figcaption></figure>")
            parts += tables_below(name, tables, numbers)
    parts += [atlas_section(), "<h2>Base meshes</h2>", base_table(data, book), "</html>"]
    return "\n".join(parts) + "\n"


def tables_below(name: str, tables: Tables, numbers: Mapping[str, Any]) -> list[str]:
    """Return the tables that belong to a picture."""
    if name == "repairs":
        return [repair_table(numbers)]
    if name == "punctured":
        modes = ("ours", "gif", "plain gif", "cm")
        rows = [(row.mesh, *(row.energy(mode) for mode in modes)) for row in tables.punctured]
        heads = ("E", *(LABELS[mode] for mode in modes))
        return [table(heads, rows), verdicts(numbers, "punctured")]
    if name == "rivals":
        listed = [
            (
                row.mesh,
                row.faces,
                mode,
                row.energy(mode),
                row.energy("ours"),
                row.seconds(mode),
                row.seconds("ours"),
            )
            for row in tables.rivals
            for mode in row.modes
            if mode != "ours"
        ]
        return [table(("mesh", "faces", "", "E", "E of ours", "CPU s", "CPU s of ours"), listed)]
    return []


def outlier_list(outliers: Sequence[str]) -> str:
    """Return a list, or that there is none."""
    if not outliers:
        return (
            "<p>None: all maps that are to be are certified, none has 1.05 times CM's energy.</p>"
        )
    return "<ul>" + "".join(f"<li>{html.escape(each)}</li>" for each in outliers) + "</ul>"


def atlas_section() -> str:
    """Return the medians of the last comparison of atlases that is recorded in the repository."""
    found = atlas_medians(records.ROOT / "benchmarks" / "history" / "atlas.jsonl")
    if not found:
        return ""
    keys = ("program", "meshes", "cpu_seconds", "charts", "seams", "energy", "unsound")
    heads = ("", "meshes", "CPU s", "charts", "seams / root of area", "E", "with flips or overlaps")
    return (
        "<h2>Atlases</h2><p>Medians of the comparison recorded last by ./dev bench atlas, on "
        "another machine perhaps, of the meshes that all programs unwrap.</p>"
        + table(heads, ([each[key] for key in keys] for each in found))
    )


def written(value: Any) -> Any:
    """Return figures as JSON can hold them: what is not finite is null."""
    if isinstance(value, dict):
        return {key: written(each) for key, each in value.items()}
    if isinstance(value, list):
        return [written(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def write_page(data: DataSet, book: Book, folder: Path) -> Path:
    """Write pictures, numbers and the page; return the page."""
    tables = tables_of(data, book)
    numbers = summary(tables)
    names = write_pictures(data, book, tables, folder)
    text = json.dumps(written(numbers), indent=1, allow_nan=False)
    (folder / "figures.json").write_text(text + "\n")
    page = folder / "index.html"
    page.write_text(document(data, book, tables, numbers, names))
    return page
