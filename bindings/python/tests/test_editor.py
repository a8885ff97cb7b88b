"""Seams and pins that move."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from conftest import grid

import beltrami


def row(rows: int, at: int, first: int, last: int) -> np.ndarray:
    """Return the edges of a row of vertices of a grid, from one column to another."""
    vertices = at * (rows + 1) + np.arange(first, last + 1)
    return np.stack([vertices[:-1], vertices[1:]], 1)


def octahedron() -> tuple[np.ndarray, np.ndarray]:
    vertices = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1.0]])
    faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    return vertices, np.array(faces)


def judged(editor: beltrami.Editor, vertices: np.ndarray, faces: np.ndarray) -> bool:
    """Return whether the UVs are injective, judged anew; the editor must say the same."""
    verdict = bool(
        beltrami.check_atlas(vertices, faces, editor.corner_uvs.reshape(*faces.shape, 2))
    )
    assert editor.check().injective == verdict
    return verdict


def test_a_mesh_brings_its_faces() -> None:
    trimesh = pytest.importorskip("trimesh")
    vertices, faces = grid(3)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    with beltrami.Editor(mesh) as editor, beltrami.Editor(vertices, faces) as same:
        editor.update()
        same.update()
        assert (editor.corner_uvs == same.corner_uvs).all()
    with pytest.raises(TypeError, match="faces are missing"):
        beltrami.Editor(vertices)


@pytest.mark.parametrize(
    "options", [{"target_energy": 2.1}, {"preset": "lightmap"}, {"cut": "given"}, {"pack": "none"}]
)
def test_an_option_that_a_session_does_not_look_at_is_refused(options: dict) -> None:
    with pytest.raises(beltrami.InvalidArgumentError, match="has no effect in a session"):
        beltrami.Editor(*grid(3), **options)
    with beltrami.Editor(*grid(3), cut="auto", target_energy=None, flatten="dirichlet") as editor:
        assert editor.update().status == "BELTRAMI_OK"


def test_a_seam_is_opened_and_closed_again() -> None:
    vertices, faces = grid(12)
    with beltrami.Editor(vertices, faces) as editor:
        first = editor.update()
        assert (first.status, len(first)) == ("BELTRAMI_OK", faces.size)
        before = editor.report.symmetric_dirichlet
        editor.open_seams(row(12, 6, 0, 6))
        editor.update()
        assert judged(editor, vertices, faces)
        assert editor.report.symmetric_dirichlet < before * 1.001
        editor.close_seams(row(12, 6, 0, 6))
        editor.update()
        assert judged(editor, vertices, faces)
        assert editor.report.symmetric_dirichlet == pytest.approx(before, rel=5e-3)


def test_charts_keep_their_numbers() -> None:
    vertices, faces = grid(12)
    with beltrami.Editor(vertices, faces) as editor:
        editor.update()
        (whole,) = editor.charts
        editor.open_seams(row(12, 4, 0, 12))
        editor.update()
        ids = {chart.id: chart.triangles for chart in editor.charts}
        assert ids[whole.id] == 12 * 8 * 2
        assert sum(ids.values()) == len(faces)
        assert set(editor.chart_of_face) == set(ids)
        editor.close_seams(row(12, 4, 0, 12))
        editor.update()
        assert [chart.id for chart in editor.charts] == [whole.id]


def test_what_is_not_concerned_stays_to_the_bit() -> None:
    vertices, faces = grid(12)
    with beltrami.Editor(vertices, faces, seams=row(12, 6, 0, 12)) as editor:
        editor.update()
        uvs, charts = editor.corner_uvs, editor.chart_of_face
        editor.open_seams(row(12, 3, 0, 6))
        changes = editor.update()
        stays = np.repeat(charts == editor.charts[1].id, 3)
        assert not stays[changes.corners].any()
        after = editor.corner_uvs
        np.testing.assert_array_equal(after[stays], uvs[stays])
        np.testing.assert_array_equal(after[changes.corners], changes.uvs)
        np.testing.assert_array_equal(np.flatnonzero((after != uvs).any(axis=1)), changes.corners)


def test_pins_are_met_exactly_and_dragged() -> None:
    vertices, faces = grid(10)
    corners = np.array([0, 3 * 99 + 1, 3 * 150])
    with beltrami.Editor(vertices, faces) as editor:
        editor.update()
        places = editor.corner_uvs[corners]
        for step in range(4):
            places[1] += [0.05, -0.02]
            editor.set_pins(corners, places)
            editor.update(steps=2)
            np.testing.assert_array_equal(editor.corner_uvs[corners], places)
            assert judged(editor, vertices, faces), step


def test_pins_that_cannot_be_met_change_nothing() -> None:
    vertices, faces = grid(6)
    with beltrami.Editor(vertices, faces) as editor:
        editor.update()
        before = editor.corner_uvs
        corners = np.arange(6)
        mirrored = before[corners] * [-1, 1]
        editor.set_pins(corners, mirrored)
        with pytest.raises(beltrami.PinError) as raised:
            editor.update()
        assert raised.value.element is not None
        np.testing.assert_array_equal(editor.corner_uvs, before)


def test_undo_returns_the_same_bits_and_so_does_what_follows() -> None:
    vertices, faces = grid(12)
    with beltrami.Editor(vertices, faces) as editor:
        editor.update()
        mark = editor.save()
        before = editor.corner_uvs
        runs = []
        for _ in range(2):
            editor.open_seams(row(12, 6, 0, 8))
            editor.update()
            runs.append(editor.corner_uvs)
            assert len(editor.restore(mark)) > 0
            np.testing.assert_array_equal(editor.corner_uvs, before)
        np.testing.assert_array_equal(runs[0], runs[1])
        editor.forget(mark)
        with pytest.raises(beltrami.InvalidArgumentError, match="nothing is saved"):
            editor.restore(mark)


def test_given_uvs_stay_until_they_are_edited() -> None:
    vertices, faces = grid(12)
    atlas = beltrami.unwrap(vertices, faces)
    with beltrami.Editor(vertices, faces, corner_uvs=atlas.corner_uvs) as editor:
        assert len(editor.update()) == 0
        np.testing.assert_array_equal(editor.corner_uvs, atlas.corner_uvs.reshape(-1, 2))


def test_flags_are_those_that_were_given_last_and_twins_are_stacked() -> None:
    vertices, faces = grid(6)
    twin = vertices + np.array([20.0, 0.0, 0.0])
    both = np.concatenate([vertices, twin]), np.concatenate([faces, faces + len(vertices)])
    with beltrami.Editor(*both) as editor:
        editor.update()
        numbers = [chart.id for chart in editor.charts]
        editor.set_flags(numbers, align=True, keep_scale=True)
        editor.set_flags(numbers, stack=True, align=True)
        assert all(chart.stack and chart.align for chart in editor.charts)
        assert not any(chart.keep_scale or chart.keep_frame for chart in editor.charts)
        editor.update()
        editor.pack()
        assert [chart.stacked_on for chart in editor.charts] == [None, numbers[0]]
        assert editor.check().injective
        half = len(editor.corner_uvs) // 2
        np.testing.assert_array_equal(editor.corner_uvs[:half], editor.corner_uvs[half:])


def test_locked_and_unselected_faces_stay() -> None:
    vertices, faces = grid(12)
    with beltrami.Editor(vertices, faces, seams=row(12, 6, 0, 12)) as editor:
        editor.update()
        editor.lock([editor.charts[0].id])
        before = editor.corner_uvs
        editor.renew([chart.id for chart in editor.charts], cold=True)
        editor.update()
        locked = np.repeat(editor.chart_of_face == editor.charts[0].id, 3)
        np.testing.assert_array_equal(editor.corner_uvs[locked], before[locked])
        editor.lock([editor.charts[0].id], False)
        editor.select(np.arange(20))
        before = editor.corner_uvs
        editor.update()
        np.testing.assert_array_equal(editor.corner_uvs[60:], before[60:])


def test_closed_surfaces_say_what_had_to_be_opened() -> None:
    vertices, faces = octahedron()
    with beltrami.Editor(vertices, faces) as editor:
        editor.update()
        assert len(editor.opened) > 1
        assert judged(editor, vertices, faces)


def test_charts_are_packed_alone_and_all() -> None:
    vertices, faces = grid(12)
    with beltrami.Editor(vertices, faces, seams=row(12, 6, 0, 12)) as editor:
        editor.update()
        editor.pack()
        uvs = editor.corner_uvs
        assert uvs.min() >= 0
        assert uvs.max() <= 1
        assert judged(editor, vertices, faces)
        editor.pack([editor.charts[0].id])
        stays = np.repeat(editor.chart_of_face == editor.charts[1].id, 3)
        np.testing.assert_array_equal(editor.corner_uvs[stays], uvs[stays])
        assert judged(editor, vertices, faces)


def test_single_precision_is_delivered_and_judged() -> None:
    vertices, faces = grid(12)
    with beltrami.Editor(vertices, faces, float32=True) as editor:
        editor.update()
        editor.open_seams(row(12, 6, 0, 6))
        editor.update()
        assert editor.corner_uvs.dtype == np.float32
        assert judged(editor, vertices, faces)


def test_polygons_have_one_uv_a_corner_and_no_seam_inside() -> None:
    vertices, _ = grid(4)
    corner = (np.arange(4)[:, None] * 5 + np.arange(4)).ravel()
    quads = np.stack([corner, corner + 1, corner + 6, corner + 5], 1)
    with beltrami.Editor(vertices, quads) as editor:
        editor.update()
        assert editor.corner_uvs.shape == (64, 2)
        with pytest.raises(beltrami.InvalidArgumentError):
            editor.open_seams([[0, 6], [1, 5]])


def test_bad_edits_are_refused_in_words() -> None:
    vertices, faces = grid(4)
    with beltrami.Editor(vertices, faces) as editor:
        with pytest.raises(beltrami.InvalidArgumentError, match="is no edge"):
            editor.open_seams([[0, 24]])
        with pytest.raises(beltrami.IndexOutOfRangeError):
            editor.open_seams([[0, 99]])
        with pytest.raises(TypeError, match="whole numbers"):
            editor.open_seams([[0.0, 1.0]])
        with pytest.raises(beltrami.InvalidArgumentError, match="no chart"):
            editor.lock([7])
        with pytest.raises(beltrami.InvalidStateError, match="update"):
            editor.pack()
        with pytest.raises(ValueError, match="corners and"):
            editor.set_pins([0, 1], [[0.0, 0.0]])
    with pytest.raises(beltrami.InvalidStateError, match="no session"):
        editor.update()


def test_a_call_is_cancelled_from_another_thread_and_by_its_progress() -> None:
    vertices, faces = grid(12)
    with beltrami.Editor(vertices, faces) as editor:
        other = threading.Thread(target=editor.cancel)
        other.start()
        other.join()
        with pytest.raises(beltrami.Cancelled):
            editor.update()
        with pytest.raises(beltrami.Cancelled):
            editor.update(progress=lambda _fraction, _stage: False)
        assert editor.update().status == "BELTRAMI_OK"


@pytest.mark.parametrize("seed", range(3))
def test_random_edits_are_judged_right_and_repeat(seed: int) -> None:
    vertices, faces = grid(10)
    edges = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]]), axis=1), axis=0)

    def play() -> list[np.ndarray]:
        random = np.random.default_rng(seed)
        frames = []
        with beltrami.Editor(vertices, faces) as editor:
            editor.update()
            for _ in range(12):
                path = edges[random.choice(len(edges), 12, replace=False)]
                (editor.open_seams if random.random() < 0.6 else editor.close_seams)(path)
                editor.update(steps=2)
                frames.append(editor.corner_uvs)
                judged(editor, vertices, faces)
        return frames

    for one, other in zip(play(), play()):
        np.testing.assert_array_equal(one, other)


def test_pins_slide() -> None:
    vertices, faces = grid(8)
    with beltrami.Editor(vertices, faces) as editor:
        editor.update()
        editor.set_pins([0, 5], [[9.0, 2.0], [4.0, 7.0]], ["v", "u"])
        editor.update()
        uvs = editor.corner_uvs
        assert (uvs[0, 1], uvs[5, 0]) == (2.0, 4.0)
        editor.set_pins([0], [[1.0, 2.0]], ["line"], [[1.0, 1.0]])
        editor.update()
        u, v = editor.corner_uvs[0]
        assert v - u == pytest.approx(1, abs=1e-9)
        assert judged(editor, vertices, faces)
        with pytest.raises(ValueError, match="directions"):
            editor.set_pins([0], [[1.0, 2.0]], ["line"])
