# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Charts onto pages, among those that stay where they are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

import beltrami

from .jobs import Progress, silent
from .parts import Array, Layout, Surface, layout

_TILES_IN_A_ROW = 10  # of UDIM


@dataclass(frozen=True, eq=False)
class Packed:
    """Where charts lie.

    Attributes
    ----------
    uvs : (c, 2) array of float32
        Of the corners of the surface, in the tiles of UDIM.
    report : beltrami.PackingReport
        What lies on the pages.
    """

    uvs: Array
    report: beltrami.PackingReport


def tiles(pages: Array) -> Array:
    """Return the lower left corners of the tiles of pages, (n, 2)."""
    return np.stack([pages % _TILES_IN_A_ROW, pages // _TILES_IN_A_ROW], axis=1)


def obstacles(surface: Surface, pages: int) -> beltrami.UvMesh | None:
    """Return the charts that lie whole on one of so many tiles, as they are; None without any."""
    if len(surface.sizes) == 0:
        return None
    flat = layout(surface, surface.uvs)
    triangles = flat.triangles[_with_area(flat)]
    if len(triangles) == 0:
        return None
    charts = flat.chart_of_triangle[_with_area(flat)]
    tile = np.zeros(len(charts), np.int64)
    corners = surface.uvs[triangles].astype(np.float64)
    count = len(flat.uvs)
    least, most = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    for corner in range(3):
        np.minimum.at(least, charts, corners[:, corner])
        np.maximum.at(most, charts, corners[:, corner])
    corner_of = np.floor(np.where(np.isfinite(least), least, 0))
    # A chart may touch the upper edge of its tile.
    within = (most <= corner_of + 1).all(axis=1) & (corner_of >= 0).all(axis=1)
    within &= corner_of[:, 0] < _TILES_IN_A_ROW
    number = (corner_of[:, 0] + _TILES_IN_A_ROW * corner_of[:, 1]).astype(np.int64)
    within &= number < pages
    stays, tile = within[charts], number[charts]
    if not stays.any():
        return None
    uvs = flat.uvs.copy()
    of_uv = np.zeros(count, np.int64)
    of_uv[flat.uv_of_corner[triangles]] = tile[:, None]
    uvs -= tiles(of_uv).astype(np.float32)
    kept = triangles[stays]
    return beltrami.UvMesh(
        uvs,
        flat.uv_of_corner[kept],
        surface.vertices,
        surface.corners[kept],
        tile[stays],
    )


def pack(
    surface: Surface,
    uvs: Array,
    others: Surface,
    options: Mapping[str, object],
    progress: Progress = silent,
) -> Packed:
    """Pack the charts that UVs of corners, (c, 2), make of a surface, among those of the others.

    Raises what `beltrami.pack` raises, and ValueError where there is nothing to pack.
    """
    flat = layout(surface, uvs)
    seen = _with_area(flat)
    if not seen.any():
        raise ValueError("no chosen face has an area in its UVs: unwrap first")
    pages = int(str(options.get("max_pages", 0))) or 1
    mesh = beltrami.UvMesh(
        flat.uvs,
        flat.uv_triangles(),
        surface.vertices,
        surface.corners[flat.triangles],
        np.full(len(flat.triangles), -1),
    )
    kept = obstacles(others, pages)
    packing = beltrami.pack(
        [mesh] if kept is None else [mesh, kept],
        progress=progress,
        **options,  # type: ignore[arg-type]
    )
    return Packed(packing.udim_uvs[0][flat.uv_of_corner].astype(np.float32), packing.report)


def _with_area(flat: Layout) -> Array:
    """Return which triangles have an area in the plane."""
    a, b, c = (flat.uvs[flat.uv_triangles()[:, k]].astype(np.float64) for k in range(3))
    doubled = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    seen: Array = doubled != 0
    return seen
