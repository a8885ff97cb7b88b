# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as arrays, and those of several objects as one surface.

A corner is one vertex of one face, what Blender calls a loop. Corners are counted from 0, face
after face.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[Any]]


class RefusedError(ValueError):
    """What is asked for cannot be done; the message says what to do."""


@dataclass(frozen=True, eq=False)
class Part:
    """The mesh of one object.

    Attributes
    ----------
    name : str
        Of the object, for messages.
    positions : (n, 3) array of float64
        Of its vertices, in the unit in which lengths are to be kept.
    corners : (c,) array of integers
        The vertex of each corner.
    sizes : (m,) array of integers
        How many corners each face has, 3 at least.
    edges : (e, 2) array of integers
        The vertices of its edges.
    seams : (e,) array of bool
        The edges along which it is to be cut.
    materials : (m,) array of integers
        The material of each face.
    chosen : (m,) array of bool
        The faces that an operation is about; the others keep their UVs.
    uvs : (c, 2) array of float32
        The UVs that it has.
    pinned : (c,) array of bool
        The corners whose UVs are to stay.
    selected : (e,) array of bool
        The edges that are to be straight, where that is asked for.
    """

    name: str
    positions: Array
    corners: Array
    sizes: Array
    edges: Array
    seams: Array
    materials: Array
    chosen: Array
    uvs: Array
    pinned: Array
    selected: Array

    def chosen_corners(self) -> Array:
        """Return which corners are of faces that are chosen, (c,) bool."""
        return np.repeat(self.chosen, self.sizes)


@dataclass(frozen=True, eq=False)
class Surface:
    """Faces of several parts as one surface. Vertices are those of its faces, each part its own.

    Attributes
    ----------
    vertices : (n, 3) array of float32
        Around the middle of their box.
    corners, sizes, materials, uvs, pinned
        As of a part.
    part : (m,) array of integers
        The part of each face.
    edges : (e, 2) array of integers
        Its edges, by vertices of the surface.
    seams : (e,) array of bool
        Those to cut along.
    selected : (e,) array of bool
        As of a part.
    origins : (n,) array of integers
        The vertex of its part that each vertex is.
    """

    vertices: Array
    corners: Array
    sizes: Array
    materials: Array
    part: Array
    uvs: Array
    pinned: Array
    edges: Array
    seams: Array
    selected: Array
    origins: Array

    def faces(self) -> Any:
        """Return the faces as the package takes them."""
        return as_faces(self.corners, self.sizes)

    def seam_pairs(self) -> Array:
        """Return the seams as pairs of vertices, (k, 2)."""
        pairs: Array = self.edges[self.seams]
        return pairs

    def face_of_corner(self) -> Array:
        """Return the face of each corner, (c,)."""
        return np.repeat(np.arange(len(self.sizes)), self.sizes)

    def only(self, faces: Array) -> Surface:
        """Return the surface of some faces, (m,) bool, with the vertices of this one."""
        corners = np.repeat(faces, self.sizes)
        return Surface(
            self.vertices,
            self.corners[corners],
            self.sizes[faces],
            self.materials[faces],
            self.part[faces],
            self.uvs[corners],
            self.pinned[corners],
            self.edges,
            self.seams,
            self.selected,
            self.origins,
        )


def as_faces(corners: Array, sizes: Array) -> Any:
    """Return faces as the package takes them: rows, or a list where they are of several sizes."""
    if len(sizes) and (sizes == sizes[0]).all():
        return corners.reshape(-1, int(sizes[0]))
    ends = np.cumsum(sizes).tolist()
    return [corners[begin:end] for begin, end in zip([0, *ends], ends)]


def joined(parts: Sequence[Part], chosen: bool = True) -> Surface:
    """Return the chosen faces of all parts as one surface, or with False the others.

    Raises RefusedError where one of their vertices is nowhere.
    """
    vertices, corners, sizes, materials, numbers = [], [], [], [], []
    uvs, pinned, edges, seams, selected, origins = [], [], [], [], [], []
    before = 0
    for number, part in enumerate(parts):
        faces = part.chosen == chosen
        of_faces = np.repeat(faces, part.sizes)
        used = np.zeros(len(part.positions), bool)
        used[part.corners[of_faces]] = True
        _require_finite(part, used)
        new = np.cumsum(used) - 1 + before
        within = used[part.edges].all(axis=1)
        vertices.append(part.positions[used])
        origins.append(np.flatnonzero(used))
        corners.append(new[part.corners[of_faces]])
        sizes.append(part.sizes[faces])
        materials.append(part.materials[faces])
        numbers.append(np.full(int(faces.sum()), number))
        uvs.append(part.uvs[of_faces])
        pinned.append(part.pinned[of_faces])
        edges.append(new[part.edges[within]])
        seams.append(part.seams[within])
        selected.append(part.selected[within])
        before += int(used.sum())
    points = np.concatenate(vertices) if vertices else np.empty((0, 3))
    if len(points):
        points = points - (points.min(axis=0) + points.max(axis=0)) / 2
    return Surface(
        points.astype(np.float32),
        np.concatenate(corners).astype(np.int64),
        np.concatenate(sizes).astype(np.int64),
        np.concatenate(materials),
        np.concatenate(numbers),
        np.concatenate(uvs).astype(np.float32),
        np.concatenate(pinned),
        np.concatenate(edges).astype(np.int64).reshape(-1, 2),
        np.concatenate(seams),
        np.concatenate(selected),
        np.concatenate(origins),
    )


def both(one: Surface, other: Surface) -> Surface:
    """Return two surfaces as one, which share no vertex; without edges."""
    return Surface(
        np.concatenate([one.vertices, other.vertices]),
        np.concatenate([one.corners, other.corners + len(one.vertices)]),
        np.concatenate([one.sizes, other.sizes]),
        np.concatenate([one.materials, other.materials]),
        np.concatenate([one.part, other.part]),
        np.concatenate([one.uvs, other.uvs]),
        np.concatenate([one.pinned, other.pinned]),
        np.empty((0, 2), np.int64),
        np.empty(0, bool),
        np.empty(0, bool),
        np.concatenate([one.origins, other.origins]),
    )


def spread(parts: Sequence[Part], surface: Surface, corner_uvs: Array) -> list[Array]:
    """Return for each part the UVs of all of its corners, new ones where faces are chosen."""
    of_corner = np.repeat(surface.part, surface.sizes)
    uvs = []
    for number, part in enumerate(parts):
        new = part.uvs.astype(np.float32, copy=True)
        new[part.chosen_corners()] = corner_uvs[of_corner == number]
        uvs.append(new)
    return uvs


def _require_finite(part: Part, used: Array) -> None:
    odd = np.flatnonzero(used & ~np.isfinite(part.positions).all(axis=1))
    if len(odd):
        raise RefusedError(
            f"vertex {odd[0]} of {part.name} has a coordinate that is infinite or not a number: "
            "repair or remove it"
        )


def labels(count: int, pairs: Array) -> Array:
    """Return the least node of the component of each node, (count,), of a graph of pairs (k, 2)."""
    label = np.arange(count)
    while True:
        lower = np.minimum(label[pairs[:, 0]], label[pairs[:, 1]])
        new = label.copy()
        for side in (0, 1):
            np.minimum.at(new, label[pairs[:, side]], lower)
        new = new[new]
        if (new == label).all():
            return label
        label = new


def next_corners(surface: Surface) -> Array:
    """Return the corner that follows each corner around its face, (c,)."""
    ends = np.cumsum(surface.sizes)
    following = np.arange(len(surface.corners)) + 1
    following[ends - 1] = ends - surface.sizes
    return following


def sides(surface: Surface) -> tuple[Array, Array]:
    """Return the sides of all faces as (c, 2) pairs, lesser vertex first, and the face of each."""
    following = next_corners(surface)
    pairs = np.sort(np.column_stack([surface.corners, surface.corners[following]]), axis=1)
    return pairs, surface.face_of_corner()


def regions(surface: Surface, by_material: bool) -> Array:
    """Return the region of each face, (m,): faces joined by edges that are no seams."""
    pairs, face = sides(surface)
    number = pairs[:, 0] * np.int64(len(surface.vertices)) + pairs[:, 1]
    cuts = np.sort(surface.seam_pairs(), axis=1)
    cut = np.isin(number, cuts[:, 0] * np.int64(len(surface.vertices)) + cuts[:, 1])
    order = np.argsort(number, kind="stable")
    same = (number[order[1:]] == number[order[:-1]]) & ~cut[order[1:]]
    links = np.column_stack([face[order[1:]][same], face[order[:-1]][same]])
    if by_material:
        links = links[surface.materials[links[:, 0]] == surface.materials[links[:, 1]]]
    return labels(len(surface.sizes), links)


@dataclass(frozen=True, eq=False)
class Layout:
    """A surface as triangles of UV vertices.

    Attributes
    ----------
    uvs : (k, 2) array of float32
        Of the UV vertices: corners at one vertex with one UV are one of them.
    uv_of_corner : (c,) array of int64
        The UV vertex of each corner.
    triangles : (t, 3) array of int64
        The corners of the triangles.
    face_of_triangle : (t,) array of int64
        The face that each is a part of.
    chart_of_triangle : (t,) array of int64
        Triangles that share a UV vertex are of one chart.
    """

    uvs: Array
    uv_of_corner: Array
    triangles: Array
    face_of_triangle: Array
    chart_of_triangle: Array

    def uv_triangles(self) -> Array:
        """Return the UV vertices of the triangles, (t, 3)."""
        triangles: Array = self.uv_of_corner[self.triangles]
        return triangles


def layout(surface: Surface, corner_uvs: Array) -> Layout:
    """Return the layout that UVs of corners, (c, 2), make of a surface."""
    import beltrami

    uvs = np.ascontiguousarray(corner_uvs, np.float32) + np.float32(0)  # no -0.0
    order = np.lexsort((uvs[:, 1], uvs[:, 0], surface.corners))
    rows = uvs[order]
    new = np.ones(len(order), bool)
    new[1:] = (surface.corners[order[1:]] != surface.corners[order[:-1]]) | (
        rows[1:] != rows[:-1]
    ).any(axis=1)
    of_corner = np.empty(len(order), np.int64)
    of_corner[order] = np.cumsum(new) - 1
    cut = beltrami.triangulate(surface.vertices, surface.faces())
    triangles = of_corner[cut.corners]
    links = np.concatenate([triangles[:, :2], triangles[:, 1:]])
    chart = labels(int(new.sum()), links)[triangles[:, 0]]
    return Layout(rows[new], of_corner, cut.corners, cut.face_of_triangle, chart)
