# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What UVs are worth: exact verdicts, energies, and colours for them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

import beltrami

from .parts import Array, Layout, Surface, layout, sides

_MOST_PAIRS = 200_000  # of triangles whose overlaps are listed
_STRETCHED = 0.75  # of the logarithm of lengths, where colours are full: a factor of 2.1
_LARGER = np.array([0.05, 0.25, 0.85])
_EVEN = np.array([0.85, 0.85, 0.85])
_SMALLER = np.array([0.85, 0.10, 0.05])


@dataclass(frozen=True, eq=False)
class Measures:
    """What UVs of a surface are worth.

    Attributes
    ----------
    charts : int
        Triangles that share a UV vertex are of one chart.
    energy, p99, largest : float
        Symmetric Dirichlet energy at the one scale that makes its mean least: the mean over the
        area on the surface, 2 where lengths are kept; what it exceeds on a hundredth of the area;
        and the greatest. Of triangles that are not flipped and have an area; inf without any.
    flips : int
        Triangles that are flipped or without area in the plane, exactly.
    overlaps : int
        Pairs of triangles that overlap, exactly; at least so many where there are very many.
    covered : float
        The area of the UVs.
    flipped, overlapping : (m,) arrays of bool
        The faces with such triangles: of an overlap those that are listed, of which one at least
        lies at a border of its chart.
    stretch : (m,) array of float64
        The logarithm of the lengths that a face has in the plane, over the mean of all faces.
    """

    charts: int
    energy: float
    p99: float
    largest: float
    flips: int
    overlaps: int
    covered: float
    flipped: Array = field(repr=False)
    overlapping: Array = field(repr=False)
    stretch: Array = field(repr=False)

    @property
    def sound(self) -> bool:
        """Whether nothing is flipped and nothing overlaps."""
        return self.flips == 0 and self.overlaps == 0


def measure(
    surface: Surface,
    corner_uvs: Array,
    allow_mirrored: bool = False,
    flat: Layout | None = None,
) -> Measures:
    """Measure UVs of corners, (c, 2), whose layout may be known; mirrored charts may be sound."""
    flat = flat or layout(surface, corner_uvs)
    given = _as_given(surface, corner_uvs)
    verdict = beltrami.check_atlas(
        surface.vertices, surface.faces(), given, allow_mirrored, most_pairs=_MOST_PAIRS
    )
    found = beltrami.distortion(surface.vertices[surface.corners], flat.triangles, corner_uvs)
    count = len(surface.sizes)
    overlapping = np.zeros(count, bool)
    overlapping[verdict.pairs.ravel()] = True
    flipped = np.zeros(count, bool)
    flips = verdict.negative + verdict.degenerate
    if flips:  # else the signs that follow are those of faces that wind against their chart
        flipped[flat.face_of_triangle[_flipped(flat, found, allow_mirrored)]] = True
    areas = _areas(surface, flat)
    energies = _energies(found.singular_values, areas)
    return Measures(
        len(np.unique(flat.chart_of_triangle)),
        *energies,
        flips,
        verdict.overlaps,
        float(np.nansum(np.abs(found.area) * areas)),
        flipped,
        overlapping,
        _stretch(count, flat, found.area, areas),
    )


def _as_given(surface: Surface, corner_uvs: Array) -> Array:
    """Return UVs of corners in the shape that goes with the faces."""
    if len(surface.sizes) and (surface.sizes == surface.sizes[0]).all():
        return corner_uvs.reshape(len(surface.sizes), -1, 2)
    return corner_uvs


def _areas(surface: Surface, flat: Layout) -> Array:
    """Return the areas of the triangles in space."""
    corners = surface.corners[flat.triangles]
    a, b, c = (surface.vertices[corners[:, k]].astype(np.float64) for k in range(3))
    areas: Array = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    return areas


def _flipped(flat: Layout, found: beltrami.Distortion, allow_mirrored: bool) -> Array:
    """Return the triangles that are flipped or without area in the plane."""
    areas = np.nan_to_num(found.area)
    in_space = ~np.isnan(found.area)
    if allow_mirrored:
        # A chart counts as its mirror image where all of it is negative.
        chart = np.unique(flat.chart_of_triangle, return_inverse=True)[1]
        positive = np.bincount(chart, areas > 0)
        areas = np.where((positive == 0)[chart], -areas, areas)
    flipped: Array = in_space & (areas <= 0)
    return flipped


def _energies(singular: Array, areas: Array) -> tuple[float, float, float]:
    """Return mean, 99th percentile and largest energy, at the scale where the mean is least."""
    good = np.isfinite(singular).all(axis=1) & (singular[:, 1] > 0) & (areas > 0)
    if not good.any():
        return np.inf, np.inf, np.inf
    weight = areas[good] / areas[good].sum()
    with np.errstate(over="ignore", divide="ignore"):
        squares = singular[good] ** 2
        stretch, squeeze = squares.sum(axis=1), (1 / squares).sum(axis=1)
    total = weight @ stretch, weight @ squeeze
    if not np.isfinite(total).all() or min(total) <= 0:
        return np.inf, np.inf, np.inf
    scale = np.sqrt(total[1] / total[0])  # of areas
    each = 0.5 * (stretch * scale + squeeze / scale)
    order = np.argsort(each, kind="stable")
    within = int(np.searchsorted(np.cumsum(weight[order]), 0.99))
    p99 = each[order[min(within, len(order) - 1)]]
    return float(np.sqrt(total[0] * total[1])), float(p99), float(each.max())


def _stretch(count: int, flat: Layout, area: Array, areas: Array) -> Array:
    """Return for each face the logarithm of its lengths in the plane, the mean of all taken off."""
    in_plane = np.bincount(flat.face_of_triangle, np.nan_to_num(np.abs(area)) * areas, count)
    in_space = np.bincount(flat.face_of_triangle, areas, count)
    good = (in_plane > 0) & (in_space > 0)
    stretch = np.zeros(count)
    if good.any():
        whole = np.log(in_plane[good].sum() / in_space[good].sum()) / 2
        stretch[good] = np.log(in_plane[good] / in_space[good]) / 2 - whole
    return stretch


def colours(stretch: Array) -> Array:
    """Return a colour for each stretch, (m, 4) in [0, 1]: blue is larger than the mean.

    Red is smaller, where texels are few; grey is the mean.
    """
    share = np.clip(stretch / _STRETCHED, -1, 1)[:, None]
    end = np.where(share > 0, _LARGER, _SMALLER)
    colour = _EVEN + np.abs(share) * (end - _EVEN)
    return np.concatenate([colour, np.ones((len(stretch), 1))], axis=1)


def seams(surface: Surface, flat: Layout) -> Array:
    """Return the edges between two faces along which a layout is cut, (k, 2) vertices."""
    pairs, _ = sides(surface)
    ends = np.cumsum(surface.sizes)
    following = np.arange(len(surface.corners)) + 1
    following[ends - 1] = ends - surface.sizes
    uv = np.sort(np.column_stack([flat.uv_of_corner, flat.uv_of_corner[following]]), axis=1)
    order = np.lexsort((uv[:, 1], uv[:, 0], pairs[:, 1], pairs[:, 0]))
    first, second = order[:-1], order[1:]
    same_edge = (pairs[first] == pairs[second]).all(axis=1)
    parts = same_edge & (uv[first] != uv[second]).any(axis=1)
    cut: Array = np.unique(pairs[first[parts]], axis=0)
    return cut
