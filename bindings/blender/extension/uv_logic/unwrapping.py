# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""New UVs for the chosen faces of several meshes, all onto the same pages."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

import beltrami

from . import measuring, packing, straightening
from .jobs import Progress, part_of, silent
from .parts import Array, Part, RefusedError, Surface, both, joined, layout, regions, spread
from .settings import PAGE_OPTIONS

_SHARE_OF_UNWRAPPING = 0.8  # of the progress, where packing is a call of its own


@dataclass(frozen=True)
class Request:
    """What to do.

    Attributes
    ----------
    cut : {"given", "islands", "auto"}
        Where seams go beside the marked ones: nowhere; where the UVs part; where the search finds
        short ones.
    materials : {"ignore", "seek", "cut"}
        Whether seams run where materials differ; "seek" draws them there, with the cut "auto".
    keep_pins : bool
        Whether pinned UVs stay, and charts follow them.
    options : mapping
        Keywords of `beltrami.unwrap`, those of pages among them.
    threads : int
        How many to use.
    tell_seams : bool
        Whether the seams of the result are wanted.
    straight : {"", "axes", "u", "v", "line"}
        How edges that are selected become straight: not, along the nearer axis, at one U, at one V,
        or in any direction.
    """

    cut: str = "given"
    materials: str = "ignore"
    keep_pins: bool = True
    options: Mapping[str, object] = field(default_factory=dict)
    threads: int = 1
    tell_seams: bool = False
    straight: str = ""


@dataclass(frozen=True, eq=False)
class Unwrapped:
    """New UVs.

    Attributes
    ----------
    uvs : list of (c, 2) arrays of float32
        For each part those of all of its corners: the faces that were not chosen keep theirs.
    seams : list of (k, 2) arrays of integers
        For each part the edges along which its chosen faces are cut, by its vertices; empty where
        they are not wanted.
    measures : measuring.Measures
        What the new UVs are worth.
    reached : bool or None
        Whether the target was reached; None without a search.
    density : float
        Of charts that were packed beside others: 1, or less where there was no room for their
        texels per unit.
    """

    uvs: list[Array]
    seams: list[Array]
    measures: measuring.Measures
    reached: bool | None
    density: float = 1.0


def unwrap(parts: Sequence[Part], request: Request, progress: Progress = silent) -> Unwrapped:
    """Return new UVs of the chosen faces; raises RefusedError, and what the package raises."""
    surface = joined(parts)
    if len(surface.sizes) == 0:
        raise RefusedError("no face is chosen: select some faces")
    others = joined(parts, chosen=False)
    held = np.zeros(len(surface.sizes), bool)
    if request.keep_pins and surface.pinned.any():
        held = _pinned_regions(surface, request)
    alone = not held.any() and not packing.obstacles(
        others, packing.pages_of(others, request.options)
    )
    if alone:
        atlas = _atlas_of(surface, request, progress, packed=True)
        return _outcome(parts, surface, _corner_uvs(atlas), request, atlas.reached_target)
    if {"stack", "fill_weight"} & request.options.keys():
        raise RefusedError(
            "stacking and splits need the pages for themselves: select all faces, and unpin UVs"
        )
    return _among_others(parts, surface, others, held, request, progress)


def _among_others(
    parts: Sequence[Part],
    surface: Surface,
    others: Surface,
    held: Array,
    request: Request,
    progress: Progress,
) -> Unwrapped:
    """Unwrap what is pinned in its place, and pack the rest around it and around the others."""
    uvs = np.zeros((len(surface.corners), 2), np.float32)
    stays = np.zeros(len(surface.sizes), bool)
    before, density, reached = 0.0, 1.0, None
    for faces, pinned in ((held, True), (~held, False)):
        if not faces.any():
            continue
        share = _SHARE_OF_UNWRAPPING * float(faces.mean())
        piece = _at_scale_of_uvs(surface.only(faces), request) if pinned else surface.only(faces)
        atlas = _atlas_of(piece, request, part_of(progress, before, share), packed=False)
        uvs[np.repeat(faces, surface.sizes)] = _corner_uvs(atlas)
        if pinned:
            stays[faces] = _with_pins(atlas, piece)
        reached = atlas.reached_target
        before += share
    if not stays.all():
        moves = np.repeat(~stays, surface.sizes)
        # What is pinned is an obstacle like the faces that were not chosen.
        around = both(others, replace(surface.only(stays), uvs=uvs[~moves]))
        options = {name: request.options[name] for name in PAGE_OPTIONS if name in request.options}
        options["threads"] = request.threads
        rest = part_of(progress, before, 1 - before)
        placed = packing.pack(surface.only(~stays), uvs[moves], around, options, rest)
        uvs[moves], density = placed.uvs, placed.density
    return replace(_outcome(parts, surface, uvs, request, reached), density=density)


def _atlas_of(
    surface: Surface, request: Request, progress: Progress, packed: bool
) -> beltrami.Atlas:
    options: dict[str, Any] = {**request.options, "cut": request.cut}
    if not packed:
        options = {name: value for name, value in options.items() if name not in PAGE_OPTIONS}
        options["pack"] = "none"  # the unit is that of the surface, or of the pins
    if request.cut != "auto" or len(np.unique(surface.part)) > 1:
        options.setdefault("weld", "off")  # what Blender does not join is apart
    if request.cut == "islands":
        options["corner_uvs"] = surface.uvs
    if request.materials == "cut":
        options["face_labels"] = surface.materials
    elif request.materials == "seek" and request.cut == "auto":
        options["materials"] = surface.materials
    if request.straight:
        edges = surface.edges[surface.selected]
        axes = request.straight == "axes"
        kinds = straightening.kinds(surface) if axes else [request.straight] * len(edges)
        options["straight"] = (edges, kinds)
    pins = np.flatnonzero(surface.pinned)
    if request.keep_pins and len(pins):
        options["pins"] = (pins, surface.uvs[pins])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", beltrami.NotInjectiveWarning)  # the measures tell
        atlas: beltrami.Atlas = beltrami.unwrap(
            surface.vertices,
            surface.faces(),
            seams=surface.seam_pairs(),
            threads=request.threads,
            progress=progress,
            **options,
        )
    return atlas


# ---- Pins ---------------------------------------------------------------------------------


def _pinned_regions(surface: Surface, request: Request) -> Array:
    """Return the faces of regions with a pin, (m,) bool."""
    region = regions(surface, request.materials == "cut")
    with_pin = np.zeros(len(region), bool)
    with_pin[region[surface.face_of_corner()[surface.pinned]]] = True
    held: Array = with_pin[region]
    return held


def _at_scale_of_uvs(surface: Surface, request: Request) -> Surface:
    """Return the surface with each region at the size that its UVs have, and apart from others.

    One pin says where a chart goes, and not how large it is: so it stays as large as it was.
    """
    region = np.unique(regions(surface, request.materials == "cut"), return_inverse=True)[1]
    count = len(surface.vertices)
    of_corner = region[surface.face_of_corner()]
    number = of_corner.astype(np.int64) * count + surface.corners
    used, corners = np.unique(number, return_inverse=True)
    scale = _scales(surface, region)
    vertices = surface.vertices[used % count] * scale[used // count][:, None]
    # Each region has the edges that it uses; an edge between two of them is of both.
    edges, cuts, selected = [], [], []
    for end in np.unique(region):
        place = np.searchsorted(used, end * count + surface.edges)
        place = np.minimum(place, len(used) - 1)
        mine = (used[place] == end * count + surface.edges).all(axis=1)
        edges.append(place[mine])
        cuts.append(surface.seams[mine])
        selected.append(surface.selected[mine])
    return Surface(
        vertices.astype(np.float32),
        corners.astype(np.int64),
        surface.sizes,
        surface.materials,
        surface.part,
        surface.uvs,
        surface.pinned,
        np.concatenate(edges),
        np.concatenate(cuts),
        np.concatenate(selected),
        surface.origins[used % count],
    )


def _scales(surface: Surface, region: Array) -> Array:
    """Return for each region the lengths of its UVs over those in space."""
    cut = beltrami.triangulate(surface.vertices, surface.faces())
    of = region[cut.face_of_triangle]
    a, b, c = (surface.vertices[cut.triangles[:, k]].astype(np.float64) for k in range(3))
    space = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    a, b, c = (surface.uvs[cut.corners[:, k]].astype(np.float64) for k in range(3))
    plane = np.abs(packing.doubled_areas(a, b, c))
    areas, of_uvs = np.bincount(of, space), np.bincount(of, plane)
    whole = of_uvs.sum() / areas.sum() if of_uvs.sum() > 0 else 2 / max(areas.sum(), 1e-30)
    with np.errstate(divide="ignore", invalid="ignore"):
        scales: Array = np.sqrt(np.where((of_uvs > 0) & (areas > 0), of_uvs / areas, whole))
    return scales


def _with_pins(atlas: beltrami.Atlas, surface: Surface) -> Array:
    """Return the faces of charts that have a pin, (m,) bool."""
    charts = atlas.chart_of_face[surface.face_of_corner()[surface.pinned]]
    stays: Array = np.isin(atlas.chart_of_face, charts)
    return stays


# ---- Results ------------------------------------------------------------------------------


def _flat(rows: Any) -> Array:
    """Return what there is for each corner as one array."""
    array: Array = np.concatenate(rows) if isinstance(rows, list) else rows.ravel()
    return array


def _corner_uvs(atlas: beltrami.Atlas) -> Array:
    uvs: Array = atlas.udim_uvs[_flat(atlas.uv_faces)].astype(np.float32)
    return uvs


def _outcome(
    parts: Sequence[Part],
    surface: Surface,
    corner_uvs: Array,
    request: Request,
    reached: bool | None,
) -> Unwrapped:
    """Lead UVs of the surface's corners back to the parts."""
    flat = layout(surface, corner_uvs)
    cuts = np.empty((0, 2), np.int64)
    if request.tell_seams:
        cuts = measuring.seams(surface, flat)
    of_vertex = np.zeros(len(surface.vertices), np.int64)
    of_vertex[surface.corners] = np.repeat(surface.part, surface.sizes)
    seams = [surface.origins[cuts[of_vertex[cuts[:, 0]] == k]] for k in range(len(parts))]
    measures = measuring.measure(surface, corner_uvs, flat=flat)
    return Unwrapped(spread(parts, surface, corner_uvs), seams, measures, reached)
