# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Charts onto pages, among those that stay where they are."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import beltrami

from .jobs import Progress, silent
from .parts import Array, Layout, Part, Surface, both, joined, layout, spread

_TILES_IN_A_ROW = 10  # of UDIM
_MOST_ROWS = 99
_LESS_DENSE = (0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.05, 0.02, 0.01)


@dataclass(frozen=True, eq=False)
class Packed:
    """Where charts lie.

    Attributes
    ----------
    uvs : (c, 2) array of float32
        Of the corners of the surface, in the tiles of UDIM.
    report : beltrami.PackingReport
        What lies on the pages.
    density : float
        Lengths in texels over those that the charts that stay would give them: 1, or less where
        there was no room for that.
    """

    uvs: Array
    report: beltrami.PackingReport
    density: float


def tiles(pages: Array) -> Array:
    """Return the lower left corners of the tiles of pages, (n, 2)."""
    return np.stack([pages % _TILES_IN_A_ROW, pages // _TILES_IN_A_ROW], axis=1)


def obstacles(surface: Surface, pages: int) -> list[beltrami.UvMesh]:
    """Return what of a surface lies on the first tiles, so many, as charts that stay there."""
    if len(surface.sizes) == 0:
        return []
    flat = layout(surface, surface.uvs)
    triangles = flat.triangles[_with_area(flat)]
    corners = surface.uvs[triangles].astype(np.float64)
    least, most = corners.min(axis=1), corners.max(axis=1)
    found = []
    for page, tile in enumerate(tiles(np.arange(pages))):
        inside = (least >= tile).all(axis=1) & (most <= tile + 1).all(axis=1)
        touched = (most > tile).all(axis=1) & (least < tile + 1).all(axis=1) & ~inside
        if inside.any():
            kept = triangles[inside]
            uvs = (flat.uvs - tile).astype(np.float32)
            of_vertices = surface.corners[kept]
            on_page = np.full(len(kept), page)
            found.append(
                beltrami.UvMesh(
                    uvs, flat.uv_of_corner[kept], surface.vertices, of_vertices, on_page
                )
            )
        if touched.any():
            found += _clipped(surface, triangles[touched], tile, page)
    return found


def _clipped(surface: Surface, triangles: Array, tile: Array, page: int) -> list[beltrami.UvMesh]:
    """Return the parts on a tile of triangles that reach beyond it, each a chart of its own."""
    rows, faces, count = [], [], 0
    for corners in triangles:
        uvs = surface.uvs[corners].astype(np.float64) - tile
        polygon = np.concatenate([uvs, surface.vertices[surface.corners[corners]]], axis=1)
        for axis in (0, 1):
            for side in (0, 1):
                polygon = _cut(polygon, axis, side)
        for last in range(2, len(polygon)):
            rows.append(polygon[[0, last - 1, last]])
            faces.append(count + np.arange(3))
            count += 3
    if not rows:
        return []
    found = np.concatenate(rows)
    uvs = np.clip(found[:, :2], 0, 1).astype(np.float32)
    on_page = np.full(len(faces), page)
    numbers = np.array(faces)
    seen = doubled_areas(uvs[::3], uvs[1::3], uvs[2::3]) != 0
    if not seen.any():
        return []
    return [beltrami.UvMesh(uvs, numbers[seen], found[:, 2:], numbers[seen], on_page[seen])]


def _cut(polygon: Array, axis: int, side: int) -> Array:
    """Return the part of a polygon, rows whose first two are UVs, within one side of [0, 1]^2."""
    inward = polygon[:, axis] if side == 0 else 1 - polygon[:, axis]
    kept = []
    for k in range(len(polygon)):
        before = k - 1
        if (inward[k] >= 0) != (inward[before] >= 0):
            share = inward[before] / (inward[before] - inward[k])
            kept.append(polygon[before] + share * (polygon[k] - polygon[before]))
        if inward[k] >= 0:
            kept.append(polygon[k])
    return np.array(kept).reshape(-1, polygon.shape[1])


def pages_of(others: Surface, options: Mapping[str, Any]) -> int:
    """Return on how many tiles something may be in the way."""
    most = int(options.get("max_pages", 0))
    if most or not options.get("texels_per_unit", 0) or len(others.uvs) == 0:
        return most or 1
    corner = np.floor(np.clip(others.uvs, 0, [_TILES_IN_A_ROW - 0.5, _MOST_ROWS]))
    return int((corner @ [1, _TILES_IN_A_ROW]).max()) + 1


def pack(
    surface: Surface,
    uvs: Array,
    others: Surface,
    options: Mapping[str, Any],
    progress: Progress = silent,
) -> Packed:
    """Pack the charts that UVs of corners, (c, 2), make of a surface, among those of the others.

    Raises what `beltrami.pack` raises, and ValueError where there is nothing to pack.
    """
    flat = layout(surface, uvs)
    seen = _with_area(flat)
    if not seen.any():
        raise ValueError("no chosen face has an area in its UVs: unwrap first")
    mesh = beltrami.UvMesh(
        flat.uvs,
        flat.uv_triangles(),
        surface.vertices,
        surface.corners[flat.triangles],
        np.full(len(flat.triangles), -1),
    )
    around = obstacles(others, pages_of(others, options))
    packing, density = _placed([mesh, *around], options, progress)
    uvs = packing.udim_uvs[0][flat.uv_of_corner].astype(np.float32)
    return Packed(uvs, packing.report, density)


def _placed(
    meshes: list[beltrami.UvMesh], options: Mapping[str, Any], progress: Progress
) -> tuple[beltrami.Packing, float]:
    """Pack at the density of the charts that stay, or as near to it as there is room."""
    try:
        return _quietly(meshes, options, progress), 1.0
    except beltrami.NoRoomError:
        if options.get("texels_per_unit", 0) or len(meshes) == 1:
            raise
    whole = _density(meshes[1:]) * options.get("resolution", 1024)
    for share in _LESS_DENSE:
        smaller = {**options, "texels_per_unit": share * whole}
        smaller["max_pages"] = max(1, options.get("max_pages", 0))
        try:
            return _quietly(meshes, smaller, progress), share
        except beltrami.NoRoomError:
            continue
    raise beltrami.NoRoomError(
        "the faces that are not chosen leave no room on the page: move them off it, or choose "
        "all faces"
    )


def _quietly(
    meshes: list[beltrami.UvMesh], options: Mapping[str, Any], progress: Progress
) -> beltrami.Packing:
    """Pack without a warning of charts that overlap: what stays may be meant so."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", beltrami.NotInjectiveWarning)
        return beltrami.pack(meshes, progress=progress, **options)


def _density(meshes: list[beltrami.UvMesh]) -> float:
    """Return lengths in the plane over those in space."""
    plane = space = 0.0
    for mesh in meshes:
        uvs, points = np.asarray(mesh.uvs, float), np.asarray(mesh.vertices, float)
        a, b, c = (uvs[np.asarray(mesh.uv_faces)[:, k]] for k in range(3))
        plane += float(np.abs(doubled_areas(a, b, c)).sum())
        a, b, c = (points[np.asarray(mesh.faces)[:, k]] for k in range(3))
        space += float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    return float(np.sqrt(plane / max(space, 1e-300)))


def doubled_areas(a: Array, b: Array, c: Array) -> Array:
    """Return twice the signed areas of triangles in the plane, whose corners are rows."""
    u, v = b - a, c - a
    areas: Array = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    return areas


def pack_parts(
    parts: Sequence[Part],
    options: Mapping[str, Any],
    keep_pins: bool = True,
    progress: Progress = silent,
) -> tuple[Packed, list[Array]]:
    """Pack the charts of the chosen faces of all parts; those with pins may stay where they are.

    Returns where charts lie, and for each part the UVs of all of its corners, (c, 2). Raises what
    `pack` raises.
    """
    surface, others = joined(parts), joined(parts, chosen=False)
    stays = np.zeros(len(surface.sizes), bool)
    if keep_pins and surface.pinned.any():
        flat = layout(surface, surface.uvs)
        held = flat.chart_of_triangle[surface.pinned[flat.triangles].any(axis=1)]
        stays[flat.face_of_triangle[np.isin(flat.chart_of_triangle, held)]] = True
        if stays.all():
            raise ValueError("all islands are pinned: unpin some")
    moves = surface.only(~stays)
    packed = pack(moves, moves.uvs, both(others, surface.only(stays)), options, progress)
    uvs = surface.uvs.copy()
    uvs[np.repeat(~stays, surface.sizes)] = packed.uvs
    return packed, spread(parts, surface, uvs)


def _with_area(flat: Layout) -> Array:
    """Return which triangles have an area in the plane."""
    a, b, c = (flat.uvs[flat.uv_triangles()[:, k]].astype(np.float64) for k in range(3))
    seen: Array = doubled_areas(a, b, c) != 0
    return seen
