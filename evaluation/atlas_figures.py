"""What an atlas is worth, measured from positions and corners' UVs alone, whoever made it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from meshes import edges

import beltrami

# Of the largest triangle's: what has less area is left out of a mesh before anybody unwraps it.
LEAST_AREA = 1e-14


@dataclass
class Figures:
    """One atlas of one mesh.

    `seams` is the length on the surface over the root of its area: each edge between two triangles
    once, open borders not at all. Of an edge of more triangles every one that meets no other there
    counts half. The energies are symmetric Dirichlet, 2 at least, at the one scale for the
    whole atlas that makes their mean least, over the triangles that have area in the plane: mean
    and the value that 99 percent of the area keep to are weighted by area on the surface.
    `overlaps` are pairs of triangles and `flips` triangles, both counted exactly, mirrored charts
    taken for their mirror images. `failed` are triangles with no area in the plane, or no UVs.
    `filled` is the area of all triangles over that of the square that the page fits into.
    """

    charts: int
    seams: float
    energy: float
    p99: float
    largest: float
    overlaps: int
    flips: int
    failed: int
    filled: float = 0.0  # of rows that were written without

    def sound(self) -> bool:
        """Return whether the map is injective, and of all triangles."""
        return self.overlaps == 0 and self.flips == 0 and self.failed == 0


class Stretch(NamedTuple):
    """The Jacobian of every triangle, as far as energies ask."""

    areas: np.ndarray  # (m,) on the surface
    stretch: np.ndarray  # (m,) squared Frobenius norm
    squeeze: np.ndarray  # (m,) that of the inverse; not finite where the triangle has no area


def doubled_areas(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Return twice the area of each triangle in space."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1)


def weld(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Make vertices at one place one, and leave out triangles without area."""
    vertices, inverse = np.unique(vertices + 0.0, axis=0, return_inverse=True)  # no -0.0
    faces = inverse.reshape(-1)[faces]
    areas = doubled_areas(vertices, faces)
    return vertices, faces[areas > LEAST_AREA * areas.max(initial=0)]


def stretch_of(vertices: np.ndarray, faces: np.ndarray, uvs: np.ndarray) -> Stretch:
    """Return what the map does to each triangle; (m, 3, 2) are the UVs of its corners."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    edge, other = b - a, c - a
    length = np.linalg.norm(edge, axis=1)
    along = np.einsum("ij,ij->i", edge, other) / length
    doubled = np.linalg.norm(np.cross(edge, other), axis=1)
    u, v = uvs[:, 1] - uvs[:, 0], uvs[:, 2] - uvs[:, 0]
    first = u / length[:, None]
    second = (v - along[:, None] * first) / (doubled / length)[:, None]
    determinant = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    stretch = (first**2).sum(1) + (second**2).sum(1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return Stretch(doubled / 2, stretch, stretch / determinant**2)


def energies(found: Stretch) -> tuple[float, float, float]:
    """Return mean, 99th percentile and largest energy of the triangles with area in the plane."""
    good = np.isfinite(found.squeeze)
    if not good.any():
        return np.inf, np.inf, np.inf
    weight = found.areas[good] / found.areas[good].sum()
    stretch, squeeze = found.stretch[good], found.squeeze[good]
    total = (weight * stretch).sum(), (weight * squeeze).sum()
    scale = np.sqrt(total[1] / total[0])  # of areas
    each = 0.5 * (stretch * scale + squeeze / scale)
    order = np.argsort(each, kind="stable")
    within = np.searchsorted(np.cumsum(weight[order]), 0.99)
    p99 = each[order[min(int(within), len(order) - 1)]]
    return float(np.sqrt(total[0] * total[1])), float(p99), float(each.max())


def components(count: int, pairs: np.ndarray) -> int:
    """Count the components of a graph of `count` nodes with edges (k, 2)."""
    label = np.arange(count)
    while True:
        lower = np.minimum(label[pairs[:, 0]], label[pairs[:, 1]])
        new = label.copy()
        for side in (0, 1):
            np.minimum.at(new, label[pairs[:, side]], lower)
        new = new[new]
        if (new == label).all():
            return len(np.unique(label))
        label = new


def sides_of(faces: np.ndarray) -> np.ndarray:
    """Return the three sides of each triangle, (3 m, 2), from its first corner on."""
    return faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)


def charts_and_seams(
    vertices: np.ndarray, faces: np.ndarray, uvs: np.ndarray, mapped: np.ndarray
) -> tuple[int, float]:
    """Count the charts of the triangles that are mapped, and measure the seams."""
    sides = sides_of(faces)
    ends = uvs[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 4)
    turned = sides[:, 0] > sides[:, 1]
    ends[turned] = ends[turned][:, [2, 3, 0, 1]]
    edge, of_side, uses = edges(faces)
    # A triangle that is not mapped meets none: it gets a number of its own.
    alone = np.where(np.repeat(mapped, 3), -1, np.arange(len(sides)))
    order = np.lexsort((*ends.T, alone, of_side.ravel()))
    keys = (of_side.ravel()[order], alone[order], *ends[order].T)
    same = np.logical_and.reduce([key[1:] == key[:-1] for key in keys])
    pairs = np.column_stack([order[1:][same], order[:-1][same]]) // 3
    charts = components(len(faces), pairs) - int((~mapped).sum())
    # Of those that meet two by two are joined, and an odd one is left.
    starts = np.flatnonzero(np.r_[True, ~same])
    odd = np.diff(np.r_[starts, len(order)]) % 2 == 1
    left = np.bincount(keys[0][starts[odd]], minlength=len(edge))
    lengths = np.linalg.norm(vertices[edge[:, 0]] - vertices[edge[:, 1]], axis=1)
    seams = 0.5 * (lengths * left)[uses > 1].sum()
    return charts, float(seams / np.sqrt(doubled_areas(vertices, faces).sum() / 2))


def measure(
    vertices: np.ndarray,
    faces: np.ndarray,
    uvs: np.ndarray,
    page: tuple[float, float] = (1.0, 1.0),
) -> Figures:
    """Measure an atlas: positions (n, 3), triangles (m, 3) with area, corners' UVs (m, 3, 2).

    Programs that fit a page into the unit square stretch it: energies are those on a page of this
    width and height. The exact checks are on the very UVs.
    """
    uvs = np.array(uvs, float).reshape(-1, 3, 2)
    lost = ~np.isfinite(uvs).all((1, 2))
    uvs[lost] = 0
    u, v = uvs[:, 1] - uvs[:, 0], uvs[:, 2] - uvs[:, 0]
    lost |= u[:, 0] * v[:, 1] == u[:, 1] * v[:, 0]
    charts, seams = charts_and_seams(vertices, faces, uvs, ~lost)
    check = beltrami.check_atlas(vertices, faces, uvs, allow_mirrored=True)
    mean, p99, largest = energies(stretch_of(vertices, faces, uvs * np.array(page)))
    on_page = uvs * np.array(page)
    u, v = on_page[:, 1] - on_page[:, 0], on_page[:, 2] - on_page[:, 0]
    covered = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2
    filled = float(covered / max(page) ** 2)
    return Figures(
        charts=charts,
        seams=seams,
        energy=mean,
        p99=p99,
        largest=largest,
        overlaps=int(check.overlaps),
        flips=int(check.negative),
        failed=int(lost.sum()),
        filled=filled,
    )
