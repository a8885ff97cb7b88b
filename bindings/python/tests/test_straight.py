"""Straight borders: grids of quads, rectangles, edges and pins that slide."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

import beltrami

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

COLUMNS, ROWS = 30, 4


def road() -> tuple[Floats, Integers]:
    """Return a road that bends, and its quads."""
    u, v = np.meshgrid(np.linspace(0, 1, COLUMNS + 1), np.linspace(0, 1, ROWS + 1))
    radius, angle = 4 + 0.9 * (v - 0.5), 2.4 * u
    places = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.5 * np.sin(5 * u)], -1)
    corner = np.arange((COLUMNS + 1) * (ROWS + 1)).reshape(ROWS + 1, COLUMNS + 1)
    quads = [corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]]
    return places.reshape(-1, 3), np.stack(quads, -1).reshape(-1, 4)


def triangles(quads: Integers) -> Integers:
    """Return both halves of each quad."""
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def of_vertices(atlas: beltrami.Atlas, faces: Integers, count: int) -> Floats:
    """Return one UV for each vertex of a surface without seams."""
    uvs = np.empty((count, 2))
    uvs[faces.ravel()] = np.asarray(atlas.corner_uvs, np.float64).reshape(-1, 2)
    return uvs


def test_grids_of_quads_have_straight_rows_and_columns() -> None:
    vertices, quads = road()
    atlas = beltrami.unwrap(vertices, quads, cut="minimal", rectify="grids")
    assert atlas.report.symmetric_dirichlet < 2.05
    uvs = of_vertices(atlas, quads, len(vertices)).reshape(ROWS + 1, COLUMNS + 1, 2)
    turned = len(np.unique(uvs[0, :, 0])) == 1
    u, v = (1, 0) if turned else (0, 1)
    assert all(len(np.unique(row)) == 1 for row in uvs[:, :, v])
    assert all(len(np.unique(column)) == 1 for column in uvs[:, :, u].T)


def test_a_rectangle_has_straight_sides() -> None:
    vertices, quads = road()
    faces = triangles(quads)
    last = len(vertices) - 1
    corners = [[0, COLUMNS, last, last - COLUMNS]]
    for rectangles in ([5], ([5], corners)):
        atlas = beltrami.unwrap(vertices, faces, cut="minimal", rectangles=rectangles)
        assert atlas.injective
        uvs = of_vertices(atlas, faces, len(vertices)).reshape(ROWS + 1, COLUMNS + 1, 2)
        for side in (uvs[0], uvs[-1], uvs[:, 0], uvs[:, -1]):
            assert min(len(np.unique(side[:, 0])), len(np.unique(side[:, 1]))) == 1


def test_a_side_is_straight() -> None:
    vertices, quads = road()
    faces = triangles(quads)
    side = np.arange(COLUMNS)
    edges = np.stack([side, side + 1], -1)
    atlas = beltrami.unwrap(vertices, faces, cut="minimal", pack="none", straight=(edges, "v"))
    uvs = of_vertices(atlas, faces, len(vertices))
    assert len(np.unique(uvs[: COLUMNS + 1, 1])) == 1


def test_pins_slide() -> None:
    vertices, quads = road()
    corners = np.flatnonzero(quads.ravel() % (COLUMNS + 1) == 0)
    uvs = np.full((len(corners), 2), 0.25)
    atlas = beltrami.unwrap(vertices, quads, cut="minimal", pins=(corners, uvs, "u"))
    found = np.asarray(atlas.corner_uvs, np.float64).reshape(-1, 2)[corners]
    assert (found[:, 0] == 0.25).all()
    assert len(np.unique(found[:, 1])) == ROWS + 1


def test_what_is_wrong_is_named() -> None:
    vertices, quads = road()
    with pytest.raises(ValueError, match="no kind"):
        beltrami.unwrap(vertices, quads, straight=([[0, 1]], ["w"]))
    with pytest.raises(ValueError, match="directions"):
        beltrami.unwrap(vertices, quads, pins=([0], [[0, 0]], ["line"]))
    with pytest.raises(ValueError, match="names face"):
        beltrami.unwrap(vertices, quads, rectangles=[len(quads)])
    with pytest.raises(beltrami.PinError, match="not on its border"):
        beltrami.unwrap(vertices, quads, cut="minimal", rectangles=([0], [[0, 1, 2, COLUMNS + 3]]))
