"""Atlases of surfaces of every kind: what is promised of each of them."""

from __future__ import annotations

import contextlib
import inspect
import os
import pickle
import signal
import threading

import numpy as np
import pytest
from conftest import grid

import beltrami

CUBE = np.array(
    [
        *([0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]),
        *([0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]),
    ],
    float,
)
QUADS = np.array(
    [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
)
# The upper side as two triangles.
MIXED = [QUADS[0], [4, 5, 6], [4, 6, 7], *QUADS[2:].tolist()]
TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
TETRAHEDRON_FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def two_components():
    vertices = np.concatenate([TETRAHEDRON, TETRAHEDRON + np.array([3, 0, 0])])
    return vertices, np.concatenate([TETRAHEDRON_FACES, TETRAHEDRON_FACES + 4])


def moebius(rungs=12):
    turn = 2 * np.pi * np.arange(rungs) / rungs
    ends = []
    for width in (-0.3, 0.3):
        radius, height = 1 + width * np.cos(turn / 2), width * np.sin(turn / 2)
        ends.append(np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height]))
    vertices = np.stack(ends, 1).reshape(-1, 3)
    faces = []
    for i in range(rungs):
        a, b, c, d = 2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3
        if i == rungs - 1:
            c, d = 1, 0
        faces += [[a, c, b], [b, c, d]]
    return vertices, np.array(faces)


def doubled():
    vertices, faces = grid(4)
    return vertices, np.concatenate([faces, faces[:, ::-1]])


def three_leaves():
    vertices = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [-1, 1, 0], [-1, -1, 0]], float)
    return vertices, np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])


SURFACES = {
    "cube": (CUBE, QUADS),
    "polygons": (CUBE, MIXED),
    "tetrahedron": (TETRAHEDRON, TETRAHEDRON_FACES),
    "two components": two_components(),
    "moebius": moebius(),
    "doubled": doubled(),
    "three leaves": three_leaves(),
    "disk": grid(5),
}


@pytest.fixture(params=SURFACES)
def surface(request):
    return SURFACES[request.param]


# ---- What is promised ---------------------------------------------------------------------


def test_every_surface_gets_an_atlas_that_is_injective(surface):
    vertices, faces = surface
    atlas = beltrami.unwrap(vertices, faces)
    assert atlas.injective
    assert atlas.status == "BELTRAMI_OK"
    assert atlas.certificate.positive == len(atlas.triangles)
    assert atlas.float32_certificate.negative == 0
    assert np.isfinite(atlas.uvs).all()
    assert atlas.energy >= 2
    assert 0 < atlas.utilisation <= 1
    assert atlas.seam_length >= 0
    assert {chart.error for chart in atlas.charts} == {"BELTRAMI_OK"}
    assert {stage.name for stage in atlas.stages} >= {"admit", "cut", "flatten", "certify"}
    found = beltrami.check_atlas(vertices, faces, atlas.corner_uvs)
    assert found
    assert len(found.pairs) == 0


def test_the_parts_of_an_atlas_fit_together(surface):
    vertices, faces = surface
    atlas = beltrami.unwrap(vertices, faces)
    corners = np.concatenate([np.asarray(face) for face in faces])
    uv_corners = np.concatenate([np.asarray(face) for face in atlas.uv_faces])
    assert (atlas.origins[uv_corners] == corners).all()
    assert (np.unique(uv_corners) == np.arange(len(atlas.uvs))).all()
    assert len(atlas.uvs) == atlas.report.uv_vertices
    assert len(atlas.charts) == atlas.report.charts
    assert set(atlas.chart_of_face) == set(range(len(atlas.charts)))
    assert (atlas.corner_uvs.reshape(-1, 2) == atlas.uvs[uv_corners]).all()
    assert sum(chart.triangles for chart in atlas.charts) == len(atlas.triangles)
    assert np.bincount(atlas.face_of_triangle).tolist() == [len(face) - 2 for face in faces]
    for number, chart in enumerate(atlas.charts):
        of_chart = atlas.chart_of_face[atlas.face_of_triangle] == number
        uvs = atlas.uvs[atlas.uv_triangles[of_chart]].reshape(-1, 2)
        assert (*uvs.min(axis=0), *uvs.max(axis=0)) == chart.box


def test_a_vertex_buffer_has_each_vertex_once_for_each_side_of_a_seam(surface):
    vertices, faces = surface
    atlas = beltrami.unwrap(vertices, faces)
    split, split_faces, uvs = atlas.split()
    assert len(split) == len(uvs)
    for face, of_split in zip(faces, split_faces):
        assert (split[of_split] == vertices[face]).all()
    pairs = np.column_stack([atlas.origins, uvs])
    assert len(np.unique(pairs, axis=0)) == len(pairs)
    split, triangles, uvs = atlas.split(triangles=True)
    assert triangles.shape == (atlas.report.triangles, 3)
    assert beltrami.check_triangles(uvs, triangles)
    assert beltrami.distortion(split, triangles, uvs).energy.left_out == 0


def test_the_number_of_threads_changes_no_bit_and_the_input_stays(surface):
    vertices, faces = surface
    before = pickle.dumps((vertices, faces))
    one, two = (beltrami.unwrap(vertices, faces, threads=threads) for threads in (1, 2))
    assert one.uvs.tobytes() == two.uvs.tobytes()
    assert one.corner_uvs.tobytes() == two.corner_uvs.tobytes()
    assert pickle.dumps((vertices, faces)) == before


def test_float32_in_is_float32_out_and_judged_as_such(surface):
    vertices, faces = surface
    single = vertices.astype(np.float32)
    atlas = beltrami.unwrap(single, faces)
    assert atlas.uvs.dtype == np.float32
    assert atlas.injective
    assert atlas.certificate == atlas.float32_certificate
    assert beltrami.check_atlas(single, faces, atlas.corner_uvs)
    assert beltrami.unwrap(vertices, faces, float32=True).uvs.dtype == np.float32
    assert beltrami.unwrap(vertices, faces).uvs.dtype == np.float64


# ---- What surfaces are --------------------------------------------------------------------


def test_counts_tell_what_was_met():
    counts = {name: beltrami.unwrap(*surface).report for name, surface in SURFACES.items()}
    assert counts["cube"].closed_components == 1
    assert counts["cube"].triangles == 12
    assert counts["two components"].components == counts["two components"].charts == 2
    assert counts["moebius"].one_sided_edges > 0
    assert counts["doubled"].copies == 32
    assert counts["three leaves"].crowded_edges == 1
    assert counts["disk"].seam_length == 0
    assert counts["disk"].uv_vertices == 36


def test_faces_may_be_rows_or_polygons_of_any_kind():
    quads = beltrami.unwrap(CUBE, QUADS)
    assert quads.uv_faces.shape == (6, 4)
    assert quads.corner_uvs.shape == (6, 4, 2)
    ways = [
        QUADS.tolist(),
        QUADS.astype(np.int32),
        QUADS.astype(np.uint8),
        np.asfortranarray(QUADS),
        np.repeat(QUADS, 2, axis=0)[::2],
        [tuple(face) for face in QUADS],
    ]
    for way in ways:
        assert beltrami.unwrap(CUBE, way).corner_uvs.tobytes() == quads.corner_uvs.tobytes()
    mixed = beltrami.unwrap(CUBE, MIXED)
    assert [len(face) for face in mixed.uv_faces] == [len(face) for face in MIXED]
    assert mixed.corner_uvs.shape == (26, 2)
    objects = np.empty(len(MIXED), object)
    objects[:] = [np.array(face) for face in MIXED]
    for way in [objects, list(objects), tuple(map(tuple, MIXED))]:
        assert beltrami.unwrap(CUBE, way).uvs.tobytes() == mixed.uvs.tobytes()


@pytest.mark.parametrize("dtype", [np.int32, np.int64, np.uint32, np.uint64])
def test_indices_come_back_in_the_type_that_they_had(dtype):
    atlas = beltrami.unwrap(TETRAHEDRON, TETRAHEDRON_FACES.astype(dtype))
    assert atlas.uv_faces.dtype == atlas.origins.dtype == dtype


def test_triangles_of_any_layout_are_read_as_they_are():
    vertices, faces = grid(5)
    expected = beltrami.unwrap(vertices, faces).uvs.tobytes()
    wide = np.zeros((len(vertices), 5))
    wide[:, 1:4] = vertices
    assert beltrami.unwrap(wide[:, 1:4], np.asfortranarray(faces)).uvs.tobytes() == expected
    assert beltrami.unwrap(vertices.tolist(), faces.tolist()).uvs.tobytes() == expected


# ---- Seams that are given -----------------------------------------------------------------


def test_labels_part_charts():
    vertices, faces = grid(4)
    right = vertices[faces].mean(axis=1)[:, 0] > 0
    for labels in (right, right.astype(np.int8), np.where(right, "wood", "stone"), right - 5):
        atlas = beltrami.unwrap(vertices, faces, face_labels=labels, cut="given")
        assert len(atlas.charts) == 2
        assert (atlas.chart_of_face[right] != atlas.chart_of_face[~right][0]).all()
        assert atlas.injective


def test_seams_are_cut():
    vertices, faces = grid(4)
    middle = np.flatnonzero(vertices[:, 0] == 0)
    seams = np.column_stack([middle[:-1], middle[1:]])
    for given in (seams, seams[:, ::-1].astype(np.uint32), {tuple(seam) for seam in seams}):
        atlas = beltrami.unwrap(vertices, faces, seams=given, cut="given")
        assert len(atlas.charts) == 2
        assert atlas.seam_length > 2
    assert len(beltrami.unwrap(vertices, faces, seams=[], cut="given").charts) == 1
    no_edge = beltrami.unwrap(vertices, faces, seams=[[0, 24]], cut="given")
    assert len(no_edge.charts) == 1


def test_seams_are_found_for_a_target_and_make_the_same_charts_again(surface):
    vertices, faces = surface
    atlas = beltrami.unwrap(vertices, faces)
    assert atlas.report.searched
    assert atlas.reached_target == (atlas.energy <= 2.05 + 1e-4)
    assert atlas.seams.shape == (atlas.report.seams, 2)
    assert (atlas.seams[:, 0] < atlas.seams[:, 1]).all()
    again = beltrami.unwrap(vertices, faces, seams=atlas.seams, cut="given")
    assert again.reached_target is None
    if surface is not SURFACES["doubled"]:  # its layers lie on one another
        assert (again.seams == atlas.seams).all()
        assert (again.chart_of_face == atlas.chart_of_face).all()


def test_a_target_that_is_missed_is_no_error():
    atlas = beltrami.unwrap(CUBE, QUADS, seam_budget=0.01)
    assert atlas.reached_target is False


def test_a_preset_sets_what_is_not_given():
    atlas = beltrami.unwrap(CUBE, QUADS, preset="lightmap")
    assert atlas.options["target_energy"] == 2.1
    assert atlas.options["hidden_seams"] == 0
    assert atlas.options["max_charts"] == 0
    given = beltrami.unwrap(CUBE, QUADS, preset="lightmap", target_energy=2.05)
    assert given.options["target_energy"] == 2.05
    assert given.options["hidden_seams"] == 0
    with pytest.raises(ValueError, match="preset=lightmap has no effect with cut=minimal"):
        beltrami.unwrap(CUBE, QUADS, preset="lightmap", cut="minimal")
    with pytest.raises(TypeError):
        beltrami.unwrap(CUBE, QUADS, threads=None)


def test_paint_and_materials_draw_seams():
    words = ["wood"] * 3 + ["steel"] * 3
    edges = np.array([[0, 1], [1, 3]])
    atlas = beltrami.unwrap(
        CUBE, QUADS, vertex_paint=np.ones(8), edge_paint=(edges, [0.1, 0.1]), materials=words
    )
    assert atlas.injective
    for hints, message in [
        ({"vertex_paint": np.ones(7)}, r"vertex_paint must have the shape \(8,\)"),
        ({"vertex_paint": [1, 1, 1, -1, 1, 1, 1, 1]}, "vertex 3"),
        ({"edge_paint": (edges, [1])}, "factors of edge_paint"),
        ({"edge_paint": (edges, [1, np.nan])}, "painted edge 1"),
        ({"materials": [1, 2]}, "materials must have the shape"),
    ]:
        with pytest.raises(ValueError, match=message):
            beltrami.unwrap(CUBE, QUADS, **hints)


def test_islands_stay():
    vertices, faces = grid(4)
    uv = vertices[:, :2].copy()
    corner_uvs = uv[faces]
    right = vertices[faces].mean(axis=1)[:, 0] > 0
    corner_uvs[right] += [5, 0]
    atlas = beltrami.unwrap(vertices, faces, corner_uvs=corner_uvs, cut="islands")
    assert len(atlas.charts) == 2
    flat = corner_uvs.reshape(-1, 2).astype(np.float32)
    again = beltrami.unwrap(vertices, faces, corner_uvs=flat, cut="islands")
    assert (again.chart_of_face == atlas.chart_of_face).all()
    assert len(beltrami.unwrap(vertices, faces, corner_uvs=corner_uvs, cut="minimal").charts) == 1
    kept = beltrami.unwrap(CUBE, MIXED)
    islands = beltrami.unwrap(CUBE, MIXED, corner_uvs=kept.corner_uvs, cut="islands")
    assert islands.seam_length == kept.seam_length
    listed = np.split(kept.corner_uvs, np.cumsum([len(face) for face in MIXED])[:-1])
    other = beltrami.unwrap(CUBE, MIXED, corner_uvs=listed, cut="islands")
    assert other.uvs.tobytes() == islands.uvs.tobytes()


def test_densities_scale_charts():
    vertices, faces = two_components()
    densities = np.repeat([1.0, 2.0], 4)
    atlas = beltrami.unwrap(vertices, faces, densities=densities)
    one, two = (
        np.abs(np.linalg.det(np.diff(atlas.corner_uvs[atlas.chart_of_face == chart], axis=1))).sum()
        for chart in (0, 1)
    )
    assert two / one == pytest.approx(4)
    assert [chart.density for chart in atlas.charts] == [1, 2]


def test_options_of_unwrapping():
    hard = beltrami.unwrap(CUBE, QUADS, hard_angle=45)
    assert len(hard.charts) == 6
    assert hard.options["hard_angle"] == 45
    soup = CUBE[QUADS].reshape(-1, 3)
    apart = np.arange(24).reshape(6, 4)
    assert len(beltrami.unwrap(soup, apart, cut="minimal").charts) == 1
    assert len(beltrami.unwrap(soup, apart, weld="off").charts) == 6
    shared = beltrami.unwrap(*doubled(), share_copies=True)
    assert shared.injective
    assert shared.certificate.excepted == 32
    cubes = np.concatenate([CUBE, CUBE + np.array([3, 0, 0])])
    stacked = beltrami.unwrap(cubes, np.concatenate([QUADS, QUADS + 8]), stack="copies")
    assert stacked.report.stacked_parts == 1
    assert np.array_equal(stacked.corner_uvs[:6], stacked.corner_uvs[6:])
    unit = beltrami.unwrap(CUBE, QUADS, pack="none", unit_square=True)
    assert unit.uvs.min() == 0
    assert 0.5 <= unit.uvs.max() <= 1


def test_faces_without_area_get_a_point():
    faces = np.concatenate([TETRAHEDRON_FACES, [[0, 0, 1]]])
    atlas = beltrami.unwrap(TETRAHEDRON, faces)
    assert atlas.report.repeated_faces == 1
    assert atlas.chart_of_face.tolist() == [0, 0, 0, 0, -1]
    assert atlas.injective


# ---- Refusals -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"corner_uvs": np.zeros((8, 2)), "cut": "islands"}, r"give uv\[faces\]"),
        ({"corner_uvs": np.zeros((6, 3, 2))}, r"\(6, 4, 2\)"),
        ({"cut": "islands"}, "give them as corner_uvs"),
        ({"face_labels": [1, 2]}, "one for each face"),
        ({"densities": np.ones(5)}, "one for each face"),
        ({"densities": np.array(["a"] * 6)}, "real numbers"),
        ({"densities": np.zeros(6)}, "density of face 0"),
        ({"seams": [0, 1]}, r"\(k, 2\)"),
        ({"seams": [[0.5, 1]]}, "vertex numbers"),
        ({"seams": [[0, 9]]}, "seam 0 names vertex 9"),
        ({"hard_angle": 190}, "hard-angle"),
        ({"weld": "maybe"}, "'auto' or 'on' or 'off'"),
    ],
)
def test_what_does_not_fit_is_refused_in_words(arguments, words):
    with pytest.raises((TypeError, ValueError), match=words):
        beltrami.unwrap(CUBE, QUADS, **arguments)


@pytest.mark.parametrize(
    ("faces", "error", "words"),
    [
        ([[0, 1]], ValueError, "shape"),
        ([[0, 1, 2], [0, 1]], ValueError, "face 1 has 2 corners"),
        ([[0, 1, 2], [0, 1, 2.5, 3]], TypeError, "whole numbers"),
        (np.full((20, 4), 3), ValueError, "counts of VTK"),
        (QUADS + 1, IndexError, "these from 1: give faces - 1"),
        ([[0, 1, 2], [0, 1, 2, 8]], IndexError, "face 1 names vertex 8, but there are 8"),
        ([[0, 1, 2], [0, -1, 2, 3]], IndexError, "face 1 names vertex -1: indices count from 0"),
        ([[0, 0, 1]], beltrami.MeshError, "area"),
        (np.empty((0, 3), int), beltrami.MeshError, "no faces"),
    ],
)
def test_faces_that_are_none_are_refused_with_the_face(faces, error, words):
    calls = [lambda: beltrami.unwrap(CUBE, faces)]
    if error is not beltrami.MeshError:
        calls.append(lambda: beltrami.triangulate(CUBE, faces))
    for call in calls:
        with pytest.raises(error, match=words) as caught:
            call()
        if error is IndexError:
            assert caught.value.element == next(
                i for i, face in enumerate(faces) if not all(0 <= v < 8 for v in face)
            )


def test_a_number_that_is_not_finite_is_refused_where_a_face_uses_it():
    vertices = np.concatenate([CUBE, [[np.nan, 0, 0]]])
    assert beltrami.unwrap(vertices, QUADS).report.unused_vertices == 1
    vertices[3, 1] = np.inf
    with pytest.raises(beltrami.NonFiniteError) as caught:
        beltrami.unwrap(vertices, QUADS)
    assert (caught.value.element, caught.value.element_kind) == (3, "vertex")


def test_options_of_flattening_are_no_keywords_of_unwrapping_and_the_other_way_round():
    of_run = inspect.signature(beltrami.parameterize).parameters
    of_unwrap = inspect.signature(beltrami.unwrap).parameters
    assert "delaunay" in of_run
    assert "delaunay" not in of_unwrap
    assert "weld" in of_unwrap
    assert "weld" not in of_run
    with pytest.raises(TypeError, match="there is no option 'weld'"):
        beltrami.Flattener().set_options(weld="off")


# ---- Progress, Ctrl-C ---------------------------------------------------------------------


def test_progress_rises_to_1_and_may_cancel():
    seen = []
    beltrami.unwrap(*grid(12), progress=lambda *now: seen.append(now))
    fractions = [fraction for fraction, _ in seen]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1
    assert "certify" in {stage for _, stage in seen}
    with pytest.raises(beltrami.Cancelled):
        beltrami.unwrap(*grid(12), progress=lambda *_: False)


def test_what_progress_raises_ends_the_run():
    def stop(_fraction, _stage):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        beltrami.unwrap(*grid(12), progress=stop)


def test_ctrl_c_at_any_time_raises_keyboard_interrupt():
    vertices, faces = grid(60)
    expected = beltrami.unwrap(vertices, faces).uvs.tobytes()
    for delay in (0.01, 0.03, 0.05):
        with contextlib.suppress(KeyboardInterrupt):
            threading.Timer(delay, os.kill, (os.getpid(), signal.SIGINT)).start()
            while True:
                beltrami.unwrap(vertices, faces)
        assert beltrami.unwrap(vertices, faces).uvs.tobytes() == expected


def test_an_atlas_that_is_not_injective_comes_with_a_warning_at_the_caller(bust):
    with pytest.warns(beltrami.NotInjectiveWarning, match="flipped triangles") as caught:
        atlas = beltrami.unwrap(*bust, method="uv-prolongation")
    assert caught[0].filename == __file__
    assert not atlas.injective
    assert "BELTRAMI_NOT_INJECTIVE" in {chart.status for chart in atlas.charts}


# ---- Checks -------------------------------------------------------------------------------


def test_faces_that_overlap_are_listed():
    vertices, faces = grid(4)
    uv = vertices[:, :2]
    assert beltrami.check_atlas(vertices, faces, uv[faces])
    corner_uvs = uv[faces].copy()
    corner_uvs[0] += [0.6, 0.6]
    found = beltrami.check_atlas(vertices, faces, corner_uvs)
    assert not found
    assert not found.injective
    assert found.overlaps == len(found.pairs) > 0
    assert set(found.first_overlap) in [set(pair) for pair in found.pairs.tolist()]
    assert (found.pairs[:, 0] == 0).all()
    assert len(beltrami.check_atlas(vertices, faces, corner_uvs, most_pairs=1).pairs) == 1
    assert len(beltrami.check_atlas(vertices, faces, corner_uvs, most_pairs=0).pairs) == 0


def test_mirrored_charts_are_allowed_where_they_are():
    vertices, faces = two_components()
    corner_uvs = beltrami.unwrap(vertices, faces).corner_uvs
    corner_uvs[:4, :, 0] = corner_uvs[:4, :, 0].sum() - corner_uvs[:4, :, 0] - 100
    found = beltrami.check_atlas(vertices, faces, corner_uvs)
    assert found.negative == 4
    found = beltrami.check_atlas(vertices, faces, corner_uvs, allow_mirrored=True)
    assert found
    assert (found.mirrored_charts, found.mirrored_faces) == (1, 4)


def test_uvs_of_polygons_are_judged():
    uvs = beltrami.unwrap(CUBE, MIXED).corner_uvs
    assert beltrami.check_atlas(CUBE, MIXED, uvs)
    uvs[0] = uvs[2]
    assert not beltrami.check_atlas(CUBE, MIXED, uvs)
    uvs[0] = np.nan
    with pytest.raises(beltrami.NonFiniteError) as caught:
        beltrami.check_atlas(CUBE, MIXED, uvs)
    assert (caught.value.element, caught.value.element_kind) == (0, "face")


def test_triangles_of_polygons():
    found = beltrami.triangulate(CUBE, MIXED)
    corners = np.concatenate([np.asarray(face) for face in MIXED])
    assert (corners[found.corners] == found.triangles).all()
    assert np.bincount(found.face_of_triangle).tolist() == [len(face) - 2 for face in MIXED]
    assert found.first_repeating is None
    # A chevron: the diagonal between its tips lies outside.
    chevron = np.array([[0, 0, 0], [2, 1, 0], [0, 2, 0], [1, 1, 0]], float)
    triangles = beltrami.triangulate(chevron, [[0, 1, 2, 3]]).triangles
    assert all({1, 3} < set(triangle) for triangle in triangles.tolist())
    assert beltrami.triangulate(chevron, [[0, 1, 2, 1]]).first_repeating == 0
    assert (beltrami.triangulate(*grid(3)).triangles == grid(3)[1]).all()


def test_pins_are_met_to_the_bit():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0.25], [0, 1, 0]])
    corners, uvs = [0, 1, 2, 5], np.array([[0.1, 0.2], [1.3, 0.0], [1.1, 1.2], [-0.2, 0.9]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    atlas = beltrami.unwrap(vertices, faces, pins=(corners, uvs))
    assert atlas.certificate.injective
    np.testing.assert_array_equal(np.asarray(atlas.corner_uvs).reshape(-1, 2)[corners], uvs)


def test_pins_that_no_map_meets_are_named():
    vertices, faces = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])
    with pytest.raises(beltrami.PinError) as caught:
        beltrami.unwrap(vertices, faces, pins=([0, 2, 1], [[0, 0], [1, 0], [0, 1]]))
    assert caught.value.element_kind == "corner"
    assert caught.value.element in (0, 1, 2)
    with pytest.raises(ValueError, match="there are 3"):
        beltrami.unwrap(vertices, faces, pins=([3], [[0, 0]]))
    with pytest.raises(ValueError, match="shape"):
        beltrami.unwrap(vertices, faces, pins=([0], [0, 0]))
    with pytest.raises(TypeError, match="pair"):
        beltrami.unwrap(vertices, faces, pins=[0])
