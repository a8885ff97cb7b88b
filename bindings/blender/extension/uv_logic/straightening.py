# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which islands have edges that are to be straight, and along which axis each of these runs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .parts import Array, Part, RefusedError, Surface, joined, labels, layout, next_corners, sides

_LONG = 2.0  # a run of edges so many times as long as wide in the UVs has one direction


def with_islands_of_edges(part: Part) -> Part:
    """Return the part with those faces chosen whose islands have an edge that is selected.

    Of the faces that are chosen already; raises RefusedError as `joined` does.
    """
    surface = joined([part])
    if not len(surface.sizes) or not surface.selected.any():
        return replace(part, chosen=np.zeros_like(part.chosen))
    flat = layout(surface, surface.uvs)
    island = np.full(len(surface.sizes), -1)
    island[flat.face_of_triangle] = flat.chart_of_triangle
    at, face = _sides_that_are_selected(surface)
    wanted = np.isin(island, island[face[at]])
    chosen = part.chosen.copy()
    chosen[part.chosen] = wanted
    return replace(part, chosen=chosen)


def require_edges(parts: list[Part]) -> None:
    """Raise RefusedError where no edge is selected."""
    if not any(part.chosen.any() for part in parts):
        raise RefusedError("no edge is selected: in edit mode select the edges to straighten")


def kinds(surface: Surface) -> list[str]:
    """Return "u" or "v" for each edge that is selected: what stays the same along it.

    Runs of edges that are long have one axis, and edges of others the one that each is nearer to.
    """
    edges = surface.edges[surface.selected].astype(np.int64)
    run = labels(len(surface.vertices), edges)[edges[:, 0]]
    at, _ = _sides_that_are_selected(surface)
    places = np.stack([surface.uvs[at], surface.uvs[next_corners(surface)[at]]]).astype(np.float64)
    extent = np.abs(places[1] - places[0])
    edge = _places(np.sort(edges, axis=1), sides(surface)[0][at], len(surface.vertices))
    of_edge = np.zeros((len(edges), 2))
    np.add.at(of_edge, edge, extent)
    low, high = (
        np.full((len(surface.vertices), 2), np.inf),
        np.full((len(surface.vertices), 2), -np.inf),
    )
    for end in places:
        np.minimum.at(low, run[edge], end)
        np.maximum.at(high, run[edge], end)
    box = (high - low)[run]
    is_long = box.max(axis=1) > _LONG * box.min(axis=1)
    across = np.where(is_long[:, None], box, of_edge)
    return ["v" if wide else "u" for wide in (across[:, 0] >= across[:, 1]).tolist()]


def _sides_that_are_selected(surface: Surface) -> tuple[Array, Array]:
    """Return the corners at which sides of faces begin that are selected, and the face of each."""
    pairs, face = sides(surface)
    edges = np.sort(surface.edges[surface.selected].astype(np.int64), axis=1)
    count = np.int64(len(surface.vertices))
    wanted = edges[:, 0] * count + edges[:, 1]
    return np.flatnonzero(np.isin(pairs[:, 0] * count + pairs[:, 1], wanted)), face


def _places(edges: Array, pairs: Array, count: int) -> Array:
    """Return for each pair its place among the edges, which has it."""
    numbers = edges[:, 0] * np.int64(count) + edges[:, 1]
    order = np.argsort(numbers)
    wanted = pairs[:, 0] * np.int64(count) + pairs[:, 1]
    places: Array = order[np.searchsorted(numbers[order], wanted)]
    return places
