"""What ./dev bench atlas measures, and how it keeps runs of programs apart from itself."""

from __future__ import annotations

import dataclasses
import json
import math
import sys
from pathlib import Path

import atlas_runs
import numpy as np
import pytest
from atlas_figures import Figures, measure, weld
from atlas_runs import Cache, Limits, Mesh, Program, Row, run
from atlas_tables import ratios, summary

# A floor and a wall, unit squares that meet along an edge, of two triangles each.
VERTICES = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 1], [1, 1, 1]], float)
FACES = np.array([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]])
UNFOLDED = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [2, 1]], float)[FACES]
LIMITS = Limits(seconds=60, gigabytes=4)


def apart(floor: tuple[float, float], wall: tuple[float, float]) -> np.ndarray:
    """Return UVs with the two squares scaled by these along u and v, the wall moved aside."""
    uvs = UNFOLDED.copy()
    uvs[:2] *= floor
    uvs[2:] = uvs[2:] * wall + [10, 0]
    return uvs


def test_an_unfolded_surface_is_one_chart_without_seams_at_the_least_energy():
    found = measure(VERTICES, FACES, 3 * UNFOLDED)
    two = pytest.approx(2)
    expected = Figures(1, 0, two, two, two, overlaps=0, flips=0, failed=0)
    assert dataclasses.replace(found, filled=expected.filled) == expected
    assert found.filled == pytest.approx(9 * 2)  # on a page of unit size
    assert found.sound()


def test_figures_of_two_charts_are_those_computed_by_hand():
    found = measure(VERTICES, FACES, apart((2, 2), (4, 2)))
    # |J|^2 is 8 and 20, that of the inverse 1/2 and 5/16: their means are 14 and 13/32.
    scale = math.sqrt(13 / 32 / 14)
    wall = (20 * scale + 5 / 16 / scale) / 2
    assert (found.charts, found.overlaps, found.flips, found.failed) == (2, 0, 0, 0)
    assert found.seams == pytest.approx(1 / math.sqrt(2))
    assert found.energy == pytest.approx(math.sqrt(14 * 13 / 32))
    assert found.p99 == found.largest == pytest.approx(wall)


def test_the_99th_percentile_is_of_area_on_the_surface():
    vertices = np.array([[0, 0, 0], [10, 0, 0], [0, 10, 0], [20, 0, 0], [20.5, 0, 0], [20, 1, 0]])
    faces = np.array([[0, 1, 2], [3, 4, 5]])
    uvs = vertices[faces][:, :, :2] * np.array([1, 3])[:, None, None]
    found = measure(vertices, faces, uvs)
    assert found.p99 == pytest.approx(2, abs=0.1)
    assert found.largest > 8


def test_a_page_that_was_squeezed_is_measured_as_it_was_packed():
    page = 4.0, 0.5
    squeezed = measure(VERTICES, FACES, UNFOLDED / page, page)
    assert squeezed.energy == pytest.approx(2)
    assert squeezed.filled == pytest.approx(2 / 16)
    assert measure(VERTICES, FACES, UNFOLDED / page).energy > 3


def test_every_triangle_that_meets_no_other_at_an_edge_of_three_counts_half():
    vertices = np.array([[0, 0, 0], [0, 2, 0], [1, 0, 0], [-1, 0, 0], [0, 0, 1]], float)
    faces = np.array([[1, 0, 2], [0, 1, 3], [1, 0, 4]])
    corners = np.array([[[0, 2], [0, 0], [1, 0]], [[0, 0], [0, 2], [-1, 0]]], float)
    root = math.sqrt(3)
    joined = np.concatenate([corners, corners[:1] + 5])
    assert measure(vertices, faces, joined).seams == pytest.approx(0.5 * 2 / root)
    parted = joined + np.array([0, 10, 20])[:, None, None]
    assert measure(vertices, faces, parted).seams == pytest.approx(1.5 * 2 / root)


def test_flips_overlaps_and_lost_triangles_are_counted():
    mirrored = apart((1, 1), (-1, 1))
    assert measure(VERTICES, FACES, mirrored).sound()
    flipped = UNFOLDED.copy()
    flipped[1, 2] = [0.6, 0.4]  # the far corner, over the diagonal
    found = measure(VERTICES, FACES, flipped)
    assert (found.charts, found.flips, found.failed) == (1, 1, 0)
    assert not found.sound()
    flat = UNFOLDED.copy()
    flat[1, 2] = [0.5, 0.5]
    assert (measure(VERTICES, FACES, flat).flips, measure(VERTICES, FACES, flat).failed) == (0, 1)
    heaped = UNFOLDED.copy()
    heaped[2:] -= [0.5, 0]
    assert measure(VERTICES, FACES, heaped).overlaps > 0
    lost = UNFOLDED.copy()
    lost[3] = np.nan
    found = measure(VERTICES, FACES, lost)
    assert (found.failed, found.charts) == (1, 2)  # the floor, and the other half of the wall
    assert found.energy == pytest.approx(2)
    assert found.seams == pytest.approx((1 + math.sqrt(2)) / math.sqrt(2))


def test_vertices_at_one_place_are_welded_and_triangles_without_area_left_out():
    soup = VERTICES[FACES].reshape(-1, 3)
    faces = np.vstack([np.arange(12).reshape(4, 3), [[0, 1, 1]]])
    vertices, welded = weld(soup, faces)
    assert len(vertices) == 6
    mesh = Mesh("", vertices, welded)
    assert len(welded) == 4
    assert mesh.parts() == 1
    assert not mesh.closed()
    assert measure(vertices, welded, UNFOLDED).seams == 0


def test_ours_runs_in_a_process_and_is_measured():
    row = run(Path(sys.executable), Program("ours", keywords={}), mesh(), LIMITS)
    assert row.error == ""
    assert row.figures is not None
    assert row.figures.sound()
    assert row.figures.energy == pytest.approx(2)


def test_a_program_that_fails_is_a_row(tmp_path, monkeypatch):
    lines = {
        "import os; os.abort()": "crashed: SIGABRT",
        "import sys; sys.exit(3)": "ended with status 3",
        "limit(0.1, 1 << 34)\nwhile True: pass": "stopped at the time limit",
    }
    folder = str(Path(atlas_runs.WORKER).parent)
    for code, error in lines.items():
        worker = tmp_path / "worker.py"
        start = f"import sys; sys.path.insert(0, {folder!r}); from atlas_programs import limit"
        worker.write_text(f"{start}\n{code}\n")
        monkeypatch.setattr(atlas_runs, "WORKER", worker)
        row = run(Path(sys.executable), Program("rival", "1"), mesh(), LIMITS)
        assert (row.figures, row.error) == (None, error)


def test_rows_serve_again_for_the_same_mesh_and_version(tmp_path):
    path = tmp_path / "rows.jsonl"
    rival = Program("rival", "rival 1.0")
    row = Row("m", mesh().digest(), 4, "rival", rival.version, measured(seams=2), cpu_seconds=3)
    failed = Row("n", "digest", 4, "rival", rival.version, error="hung", limits=LIMITS)
    for each in (row, failed):
        Cache(path).add(each)
    cache = Cache(path)
    assert cache.knows("rival")
    assert cache.find(row.digest, rival, LIMITS) == row
    assert cache.find(row.digest, Program("rival"), LIMITS) == row
    assert cache.find(row.digest, Program("rival", "rival 1.1"), LIMITS) is None
    assert cache.find(row.digest, rival, Limits(2, 4)) is None  # it took 3 seconds
    moved = Mesh("m", VERTICES + 1, FACES)
    assert cache.find(moved.digest(), rival, LIMITS) is None
    assert cache.find("digest", rival, LIMITS) == failed
    assert cache.find("digest", rival, Limits(600, 4)) is None
    assert [json.loads(line)["mesh"] for line in path.read_text().splitlines()] == ["m", "n"]


def test_tables_compare_where_both_have_figures_and_name_the_worst():
    programs = [Program("auto", keywords={"target_energy": 2.1}), Program("rival", "1")]
    table = [
        rows("a", measured(seams=1, energy=2.05), measured(seams=4, energy=2.02)),
        rows("b", measured(seams=3, energy=2.3), measured(seams=4, energy=2.1)),
        rows("c", measured(seams=3, energy=2.1), measured(seams=4, energy=2.2)),
        rows("d", measured(seams=9), None),
    ]
    assert ratios("seams", table, "auto", "rival") == {"a": 0.25, "b": 0.75, "c": 0.75}
    text = "\n".join(summary(table, programs))
    assert "medians over the 3 of 4 meshes" in text
    assert "seams   / rival        0.750 on   3 meshes, worst    0.750 b" in text
    assert "auto reaches 2.1 on 1 of the 2 meshes where a rival does, on 3 of all 4" in text
    assert "the worst of the others: b, 2.3000" in text


def mesh() -> Mesh:
    return Mesh("m", VERTICES, FACES)


def measured(seams: float = 0, energy: float = 2) -> Figures:
    return Figures(1, seams, energy, energy, energy, overlaps=0, flips=0, failed=0)


def rows(name: str, ours: Figures, theirs: Figures | None) -> dict[str, Row]:
    return {
        "auto": Row(name, "", 1, "auto", "", ours, 1),
        "rival": Row(name, "", 1, "rival", "1", theirs, 1, "" if theirs else "hung", LIMITS),
    }
