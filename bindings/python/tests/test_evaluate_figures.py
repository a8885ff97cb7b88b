"""What ./dev evaluate makes of records: ratios, counts, outliers, pictures and the page."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from evaluate_data import Base, Mesh
from evaluate_plan import COARSE_FACES, DataSet, plan_of
from evaluate_runs import Book, Run
from evaluate_worker import BIN_EDGES, histogram

pytest.importorskip("matplotlib")
from evaluate_figures import (
    Row,
    equal_energy,
    failures,
    histograms,
    outliers,
    rows_of,
    summary,
    tables_of,
)
from evaluate_page import document, write_page
from evaluate_pictures import PICTURES, write_pictures

VERSIONS = {"beltrami": "v1", "SLIM": "libigl 1", "SCAF": "libigl 1"}
ENERGIES = ("symmetric-dirichlet", "symmetric-arap", "another")
SESSIONS = ("bases", "main", "large", "energies", "punctured", "simplification", "rivals")
# Energy and seconds of a mode in units of those of CM.
MADE_UP = {
    "ours": (1.001, 0.1),
    "gif": (1.01, 0.2),
    "cm": (1.0, 1.0),
    "plain gif": (4.0, 0.3),
    "refine": (1.0, 0.4),
    "SLIM": (1.02, 5.0),
    "SCAF": (1.0005, 8.0),
}


def record_of(run: Run) -> dict[str, Any]:
    """Return a record as a run would, with energies that depend on the mode alone."""
    if run.mode.startswith("cm at"):
        count = int(run.mode[6:])
        stopped = map_of(3 + 0.1 * 2.0**-count, 0.1 * count)
        return {**stopped, "stages": {"cm": [0.1 * count, count]}}
    if run.mode == "cm in our time":
        return map_of(3.3, 0.1)
    energy, seconds = MADE_UP.get(run.mode, (1.02, 0.15))
    flips = 7 if run.mode == "uv prolongation" else 0
    return map_of(3 * energy, seconds * run.faces / 1e5, flips=flips)


def map_of(energy: float, seconds: float, flips: int = 0, crossings: int = 0) -> dict[str, Any]:
    """Return the figures of a map."""
    share = np.zeros(len(BIN_EDGES))
    share[20] = 1
    return {
        "status": "BELTRAMI_OK",
        "certified": not flips and not crossings,
        "injective": not flips and not crossings,
        "flips": flips,
        "crossings": crossings,
        "energies": dict.fromkeys(ENERGIES, energy),
        "histograms": {name: share.tolist() for name in ENERGIES[:2]},
        "cpu_seconds": seconds,
        "seconds": seconds,
        "wall": seconds + 1,
        "stages": {"coarse": [0.25 * seconds, 9], "cm": [0.75 * seconds, 12]},
        "flips_before": 2,
        "restarts": 0,
        "repair": {"kernel_fixes": 2, "patch_fixes": 0, "global_fixes": 0, "cleaned_patches": 0},
    }


@pytest.fixture
def known(tmp_path) -> tuple[DataSet, Book]:
    """Return a data set with all that belongs to it recorded."""
    bases = [Base(Mesh(name, f"{name}.obj", name), 10_000, main=True) for name in "abc"]
    bases.append(Base(Mesh("closed", "closed.obj", "closed", punctured=True), 9_999, main=False))
    data = DataSet(bases, ENERGIES, rivals=("SLIM", "SCAF"))
    book = Book(tmp_path / "runs.jsonl", VERSIONS)
    while True:
        listed = [(name, list(runs)) for name, (_, runs) in plan_of(data, book).items()]
        left = [(name, run) for name, runs in listed for run in runs if book.find(run) is None]
        if not left:
            return data, book
        for name, run in left:
            book.add(name, run, record_of(run), {"commit": "c"})


def test_the_summary_is_what_the_records_say(known):
    numbers = summary(tables_of(*known))
    assert numbers["excess"]["ours"]["median"] == pytest.approx(1.001)
    assert numbers["excess"]["gif"]["greatest"] == pytest.approx(1.01)
    assert numbers["speed-up"]["ours"]["median"] == pytest.approx(10)
    assert numbers["speed-up"]["refine"]["least"] == pytest.approx(2.5)
    assert numbers["energy of CM in our time"]["median"] == pytest.approx(3.3 / 3.003)
    found = numbers["failures"]["uv prolongation"]
    assert found["flipped"] == found["maps"] > 0
    assert found["flips"] == 7 * found["maps"]
    assert numbers["failures"]["ours"]["flips"] == 0
    assert numbers["repairs"]["ours"]["kernel_fixes"] == numbers["meshes"]
    assert numbers["repairs"]["ours"]["flips"] == 2 * numbers["meshes"]
    assert numbers["shares"]["gif"] == pytest.approx({"coarse": 0.25, "cm": 0.75})
    assert set(numbers["energies"]) == {"symmetric-arap", "another"}
    assert numbers["outliers"] == []
    json.dumps(numbers, allow_nan=True)


def test_the_search_for_equal_energy_ends_at_the_first_iteration_that_has_it(known):
    tables = tables_of(*known)
    row = min(tables.equal, key=lambda found: found.faces)
    tried = {int(mode[6:]) for mode in row.modes}
    # 3 + 0.1 / 2^k is at most 3.003 from k = 6 on, of 12 iterations.
    assert {5, 6} <= tried
    assert len(tried) <= 6
    main = next(found for found in tables.main if found.faces == row.faces)
    assert equal_energy(main, row) == pytest.approx(0.6 / main.seconds("ours"))
    assert math.isnan(equal_energy(main, None))


def test_outliers_are_what_is_uncertified_failed_or_above_the_limit():
    def row(ours: dict[str, Any], **others: dict[str, Any]) -> Row:
        found = {"ours": ours, "cm": map_of(3, 1), **others}
        return Row("m", 10, {mode: {**each, "options": {}} for mode, each in found.items()})

    assert not list(outliers([row(map_of(3.1, 1))]))
    assert "1.067" in "".join(outliers([row(map_of(3.2, 1))]))
    assert "not certified" in "".join(outliers([row(map_of(3, 1, crossings=2))]))
    assert "CRASHED" in "".join(outliers([row({"status": "CRASHED", "error": "SIGSEGV"})]))
    overlapping = row(map_of(3.2, 1), cm=map_of(3, 1, crossings=5))
    overlapping.modes["cm, global"] = {**map_of(3.19, 1), "options": {}}
    assert not list(outliers([overlapping]))
    assert "1.100" in "".join(outliers([row(map_of(3, 1), gif=map_of(3.3, 1))]))
    flipped = row(map_of(3, 1), **{"uv prolongation": map_of(3, 1, flips=4)})
    assert not list(outliers([flipped]))
    assert flipped.energy("uv prolongation") == math.inf
    assert failures([flipped], "uv prolongation").injective() == 0


def test_histograms_are_shares_of_area_with_flips_in_the_last_bin():
    values = np.array([2.0, 2.5, np.inf, np.nan, 1e9])
    shares = histogram(values, np.array([4.0, 3, 2, 5, 1]), 2.0)
    assert sum(shares) == pytest.approx(1)
    assert shares[0] == pytest.approx(0.4)
    assert shares[-1] == pytest.approx(0.3)
    assert shares[np.searchsorted(BIN_EDGES, 0.5, side="right") - 1] == pytest.approx(0.3)


def test_a_mesh_counts_in_no_histogram_unless_in_all(known):
    rows = tables_of(*known).main
    rows[0].modes["gif"] = {"status": "CRASHED"}
    found = histograms(rows, ("ours", "gif"), "symmetric-dirichlet")
    assert found["ours"].sum() == pytest.approx(1)
    assert histograms(rows[:1], ("ours", "gif"), "symmetric-dirichlet") == {}


def test_all_pictures_and_the_page_are_made_of_records(known, tmp_path):
    data, book = known
    page = write_page(data, book, tmp_path / "out")
    for name in PICTURES:
        for suffix in (".svg", ".png"):
            assert (tmp_path / "out" / f"{name}{suffix}").stat().st_size > 1000
        assert f"src='{name}.svg'" in page.read_text()
    assert json.loads((tmp_path / "out" / "figures.json").read_text())["outliers"] == []
    assert sum(path.stat().st_size for path in (tmp_path / "out").iterdir()) < 2_000_000


def test_pictures_are_made_of_whatever_is_recorded_so_far(known):
    data, book = known
    records = list(book.records.items())
    first = [[found[1]["experiment"] for found in records].index(name) for name in SESSIONS]
    orders = [records[:count] for start in first for count in (start, start + 1, start + 4)]
    orders += [records[::-1][:count] for count in range(1, len(records), 80)]
    # An experiment alone has what others are to be held against missing.
    orders += [[found for found in records if found[1]["experiment"] == name] for name in SESSIONS]
    for listed in orders:
        part = Book(None, VERSIONS)
        part.records = dict([*records[:3], *listed])
        tables = tables_of(data, part)
        summary(tables)
        for draw in PICTURES.values():
            draw(tables)


def test_nothing_recorded_makes_an_empty_page(tmp_path):
    data, book = DataSet([], ENERGIES), Book(None, VERSIONS)
    tables = tables_of(data, book)
    assert write_pictures(data, book, tables, tmp_path) == []
    assert "<h1>" in document(data, book, tables, summary(tables), [])


def test_rows_have_runs_that_are_recorded_alone(tmp_path):
    book = Book(None, VERSIONS)
    mesh = Mesh("a", "a.obj", "a", faces=20_000)
    runs = [Run(mesh, "ours", 20_000), Run(mesh, "cm", 20_000, (("method", "cm"),))]
    book.add("main", runs[0], map_of(3, 1), {})
    (row,) = rows_of(runs, book)
    assert list(row.modes) == ["ours"]
    assert math.isnan(row.excess("ours"))
    assert Path(tmp_path).exists()
    assert 10_000 in COARSE_FACES
