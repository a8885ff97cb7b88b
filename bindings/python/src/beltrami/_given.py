"""What callers give of a surface, as the library reads it."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Any

import numpy.typing as npt

from . import _arrays, _polygons, _straight, _trimesh
from ._surfaces import Surface


def require_arrays(vertices: Any, share_page: bool) -> None:
    """Raise TypeError where what is given beside faces brings its own, or is of scenes."""
    if _trimesh.is_mesh(vertices) or _trimesh.is_scene(vertices):
        raise TypeError(f"a {type(vertices).__name__} brings its own faces: leave faces out")
    if isinstance(vertices, (str, os.PathLike)):
        raise TypeError("the file of a path has its own faces: leave faces out")
    if share_page:
        raise TypeError(
            "share_page is for the meshes of a scene: leave it out where faces are given"
        )


def surface_of(
    vertices: npt.ArrayLike,
    faces: Any,
    corner_uvs: Any,
    labels: Any,
    densities: Any,
    seams: Any,
) -> Surface:
    """Return a surface of what a caller gives."""
    points = _arrays.positions(vertices)
    polygons = _polygons.polygons(faces, len(points))
    return Surface(
        points,
        polygons,
        None if corner_uvs is None else _polygons.corner_uvs(corner_uvs, polygons),
        None if labels is None else _polygons.labels(labels, polygons),
        None if densities is None else _polygons.densities(densities, polygons),
        None if seams is None else _polygons.seams(seams),
    )


def with_straight(surface: Surface, pins: Any, straight: Any, rectangles: Any) -> Surface:
    """Return it with pins, straight borders and rectangles."""
    faces = surface.faces
    if pins is not None:
        *held, kinds = _straight.pins(pins, faces)
        surface = replace(surface, pins=(held[0], held[1]), pin_kinds=kinds)
    return replace(
        surface,
        straight=None if straight is None else _straight.edges(straight),
        rectangles=None if rectangles is None else _straight.rectangles(rectangles, faces),
    )


def with_hints(surface: Surface, vertex_paint: Any, edge_paint: Any, materials: Any) -> Surface:
    """Return it with what draws seams."""
    faces = surface.faces
    return replace(
        surface,
        vertex_paint=None
        if vertex_paint is None
        else _polygons.vertex_paint(vertex_paint, len(surface.vertices)),
        edge_paint=None if edge_paint is None else _polygons.edge_paint(edge_paint),
        materials=None if materials is None else _polygons.labels(materials, faces, "materials"),
    )
