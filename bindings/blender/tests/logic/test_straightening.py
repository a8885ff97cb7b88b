# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Straight edges and grids of quads; Blender is not needed."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import shapes
from uv_logic import straightening, unwrapping
from uv_logic.parts import RefusedError, joined
from uv_logic.unwrapping import Request

import beltrami

SIDE = 8


def bent(turned: float = 0.2, **given: object):
    """Return a sheet of quads with a hump, its UVs turned a little."""
    vertices, faces = shapes.bumpy(SIDE)
    turn = np.array([[np.cos(turned), np.sin(turned)], [-np.sin(turned), np.cos(turned)]])
    uvs = (vertices[faces.ravel(), :2] @ turn).astype(np.float32)
    return shapes.part(vertices, faces, uvs=uvs, **given)


def with_edges(part, wanted):
    """Return the part with those edges selected whose ends are both wanted, (n,) bool."""
    return dataclasses.replace(part, selected=wanted[part.edges].all(axis=1))


def along(part, axis: int, value: float):
    """Return which vertices have that coordinate."""
    return np.isclose(part.positions[:, axis], value)


def of_vertices(part, uvs, wanted):
    """Return the UVs of corners at vertices that are wanted."""
    return uvs[wanted[part.corners]]


def test_quads_become_grids():
    part = bent()
    result = unwrapping.unwrap([part], Request("islands", options={"rectify": "grids"}))
    assert result.measures.sound
    quads = result.uvs[0].reshape(-1, 4, 2)
    for axis in (0, 1):
        of_rows = [np.unique(np.sort(quad[:, axis])).size for quad in quads]
        assert set(of_rows) == {2}


def test_selected_edges_lie_along_the_nearer_axis():
    part = bent()
    low, left = along(part, 1, 0), along(part, 0, 0)
    part = with_edges(part, low)
    surface = joined([part])
    assert set(straightening.kinds(surface)) == {"v"}
    result = unwrapping.unwrap([part], Request("islands", straight="axes"))
    assert result.measures.sound
    assert np.unique(of_vertices(part, result.uvs[0], low)[:, 1]).size == 1
    assert np.unique(of_vertices(part, result.uvs[0], left)[:, 0]).size > 1


def test_a_border_that_goes_around_becomes_a_rectangle():
    part = bent(0.1)
    sides = [along(part, axis, value) for axis in (0, 1) for value in (0, 1)]
    edges = np.any([side[part.edges].all(axis=1) for side in sides], axis=0)
    part = dataclasses.replace(part, selected=edges)
    result = unwrapping.unwrap([part], Request("islands", straight="axes"))
    assert result.measures.sound
    for side, axis in zip(sides, (0, 0, 1, 1)):
        assert np.unique(of_vertices(part, result.uvs[0], side)[:, axis]).size == 1


def test_a_direction_that_is_given_is_taken():
    part = with_edges(bent(), along(bent(), 1, 0))
    options = {"pack_turns": "none"}
    result = unwrapping.unwrap([part], Request("islands", options=options, straight="u"))
    assert np.unique(of_vertices(part, result.uvs[0], along(part, 1, 0))[:, 0]).size == 1


def test_islands_without_a_selected_edge_are_not_chosen():
    vertices, faces = shapes.bumpy(SIDE)
    uvs = vertices[faces.ravel(), :2].astype(np.float32)
    right = np.repeat(vertices[faces].mean(axis=1)[:, 0] > 0.5, 4)
    uvs[right, 0] += 1
    part = shapes.part(vertices, faces, uvs=uvs)
    part = with_edges(part, along(part, 0, 1))
    chosen = straightening.with_islands_of_edges(part).chosen
    np.testing.assert_array_equal(chosen, right[::4])
    straightening.require_edges([straightening.with_islands_of_edges(part)])


def test_without_edges_that_is_said():
    with pytest.raises(RefusedError, match="no edge is selected"):
        straightening.require_edges([straightening.with_islands_of_edges(bent())])


def test_pins_in_an_island_with_straight_edges_are_refused_with_a_sentence():
    part = with_edges(bent(0), along(bent(0), 1, 0))
    pinned = np.zeros(len(part.corners), bool)
    pinned[np.flatnonzero(along(part, 1, 1)[part.corners])[[0, -1]]] = True
    part = dataclasses.replace(part, pinned=pinned)
    with pytest.raises(beltrami.InvalidArgumentError, match="one of both"):
        unwrapping.unwrap([part], Request("islands", straight="v"))
    result = unwrapping.unwrap([part], Request("islands", keep_pins=False, straight="v"))
    assert result.measures.sound
