"""Atlases of the C library as Python sees them: beside `_library` what knows CFFI."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _library
from ._arrays import Array
from ._cancel import CancelToken
from ._errors import BeltramiError
from ._library import Context, Hook, buffer, cancellable, fail, record, sized
from ._native import ffi, lib
from ._polygons import Polygons
from ._tables import AtlasCertificate, AtlasReport, Chart, PackingReport, Stage


@dataclass(frozen=True, eq=False)
class Surface:
    """Faces in space and what comes with them, in arrays of `_arrays` and `_polygons`."""

    vertices: Array
    faces: Polygons
    corner_uvs: Array | None = None
    labels: Array | None = None
    densities: Array | None = None
    seams: Array | None = None
    pins: tuple[Array, Array] | None = None  # corners and UVs
    vertex_paint: Array | None = None
    edge_paint: tuple[Array, Array] | None = None  # edges and factors
    materials: Array | None = None
    pin_kinds: tuple[Array, Array] | None = None  # numbers BELTRAMI_PIN_, and directions
    straight: tuple[Array, Array] | None = None  # edges and numbers BELTRAMI_PIN_
    rectangles: tuple[Array, Array | None] | None = None  # faces and corners

    def struct(self) -> Any:
        """Return the ``beltrami_surface``, which is good as long as the arrays are."""
        surface = sized("beltrami_surface")
        surface.vertex_count, surface.face_count = len(self.vertices), len(self.faces)
        surface.positions = buffer(self.vertices)
        surface.indices = buffer(self.faces.indices)
        if self.faces.sizes is not None:
            surface.corner_count = self.faces.corner_count
            surface.face_sizes = buffer(self.faces.sizes)
        if self.corner_uvs is not None:
            surface.corner_uvs = buffer(self.corner_uvs)
        if self.labels is not None:
            surface.face_labels = buffer(self.labels)
        if self.densities is not None:
            surface.densities = buffer(self.densities)
        if self.seams is not None and len(self.seams):
            surface.seams = buffer(self.seams)
            surface.seam_count = len(self.seams)
        if self.pins is not None and len(self.pins[0]):
            surface.pins, surface.pin_uvs = buffer(self.pins[0]), buffer(self.pins[1])
            surface.pin_count = len(self.pins[0])
        if self.vertex_paint is not None:
            surface.vertex_paint = buffer(self.vertex_paint)
        if self.edge_paint is not None and len(self.edge_paint[0]):
            edges, factors = self.edge_paint
            surface.painted_edges, surface.edge_paint = buffer(edges), buffer(factors)
            surface.painted_edge_count = len(edges)
        if self.materials is not None:
            surface.materials = buffer(self.materials)
        self._straighten(surface)
        return surface

    def _straighten(self, surface: Any) -> None:
        if self.pin_kinds is not None and len(self.pin_kinds[0]):
            kinds, directions = self.pin_kinds
            surface.pin_kinds, surface.pin_directions = buffer(kinds), buffer(directions)
        if self.straight is not None and len(self.straight[0]):
            edges, kinds = self.straight
            surface.straight_edges, surface.straight_kinds = buffer(edges), buffer(kinds)
            surface.straight_edge_count = len(edges)
        if self.rectangles is not None and len(self.rectangles[0]):
            faces, corners = self.rectangles
            surface.rectangles = buffer(faces)
            surface.rectangle_count = len(faces)
            if corners is not None:
                surface.rectangle_corners = buffer(corners)

    def explain(self, error: BeltramiError) -> None:
        """Has the message show an index as it was given, where one is out of range."""
        faces = self.faces
        _library.name_index(error, faces.face, faces.indices, len(self.vertices), "vertices")

    def first_odd_face(self) -> int:
        """Return the first face that names no vertex, or BELTRAMI_NO_ELEMENT."""
        flat = self.faces.indices.ravel()
        odd = np.flatnonzero((flat < 0) | (flat >= len(self.vertices)))
        if len(odd) == 0:
            return int(lib.BELTRAMI_NO_ELEMENT)
        return int(np.searchsorted(self.faces.ends(), odd[0], side="right"))


class AtlasContext(Context):
    """A context that unwraps."""

    def unwrap(self, surface: Surface, hook: Hook) -> str:
        """Unwrap; returns the name of the status. Raises what the hook raises."""
        try:
            return self.call(lib.beltrami_unwrap, (surface.struct(),), hook)
        except BeltramiError as error:
            surface.explain(error)
            raise

    def atlas(self) -> AtlasReport:
        """Return counts, energy and cost."""
        return self._fetch(lib.beltrami_get_atlas, "beltrami_atlas", AtlasReport)

    def charts(self, count: int) -> tuple[Chart, ...]:
        """Return the charts, of which there are so many."""
        charts = []
        out = sized("beltrami_chart")
        for index in range(count):
            self._check(lib.beltrami_get_chart(self._context, index, out))
            charts.append(record(out, Chart))
        return tuple(charts)

    def atlas_certificate(self, dtype: np.dtype[Any]) -> AtlasCertificate:
        """Return the verdict on the UVs in float32 or float64."""
        out = sized("beltrami_atlas_certificate")
        kind = lib.BELTRAMI_F32 if dtype == np.float32 else lib.BELTRAMI_F64
        self._check(lib.beltrami_get_atlas_certificate(self._context, kind, out))
        return record(out, AtlasCertificate)

    def atlas_stages(self) -> tuple[Stage, ...]:
        """Return the stages of the last run in their order."""
        stages = []
        for index in range(lib.beltrami_atlas_stage_count(self._context)):
            out = sized("beltrami_stage")
            self._check(lib.beltrami_get_atlas_stage(self._context, index, out))
            stages.append(record(out, Stage))
        return tuple(stages)

    def uv_vertices(self, count: int, dtype: np.dtype[Any]) -> Array:
        """Return the UVs, (count, 2)."""
        return self._filled(lib.beltrami_get_uv_vertices, (count, 2), dtype)

    def corner_uv_vertices(self, count: int, dtype: np.dtype[Any]) -> Array:
        """Return the UV vertex of each corner, (count,)."""
        return self._filled(lib.beltrami_get_corner_uv_vertices, (count,), dtype)

    def origins(self, count: int, dtype: np.dtype[Any]) -> Array:
        """Return the vertex that each UV vertex is a copy of, (count,)."""
        return self._filled(lib.beltrami_get_uv_vertex_origins, (count,), dtype)

    def face_charts(self, count: int) -> Array:
        """Return the chart of each face, (count,), -1 for a face without area."""
        return self._filled(lib.beltrami_get_face_charts, (count,), np.dtype(np.int64))

    def seams(self, count: int, dtype: np.dtype[Any]) -> Array:
        """Return the seams as pairs of vertices, (count, 2)."""
        return self._filled(lib.beltrami_get_seams, (count, 2), dtype)

    def triangles(self, count: int) -> Array:
        """Return the corners of the triangles that were computed on, (count, 3)."""
        return self._filled(lib.beltrami_get_triangles, (count, 3), np.dtype(np.int64))

    def corner_pages(self, count: int) -> Array:
        """Return the page of each corner, (count,)."""
        return self._filled(lib.beltrami_get_corner_pages, (count,), np.dtype(np.int64))

    def packing(self) -> PackingReport:
        """Return what lies on the pages that were packed last."""
        return self._fetch(lib.beltrami_get_packing, "beltrami_packing", PackingReport)

    def page_utilisations(self, count: int) -> Array:
        """Return the share of each page that charts cover, (count,)."""
        return self._filled(lib.beltrami_get_page_utilisations, (count,), np.dtype(np.float64))

    def chart_pages(self, count: int) -> Array:
        """Return the page of each chart, (count,)."""
        return self._filled(lib.beltrami_get_chart_pages, (count,), np.dtype(np.int64))

    def packing_certificate(self, dtype: np.dtype[Any]) -> AtlasCertificate:
        """Return the verdict on what was packed last, in float32 or float64."""
        out = sized("beltrami_atlas_certificate")
        kind = lib.BELTRAMI_F32 if dtype == np.float32 else lib.BELTRAMI_F64
        self._check(lib.beltrami_get_packing_certificate(self._context, kind, out))
        return record(out, AtlasCertificate)

    def page_mask(self, page: int, resolution: int) -> Array:
        """Return a byte for each texel of a page, rows from the top."""
        mask = np.empty((resolution, resolution), np.uint8)
        pointer = ffi.cast("uint8_t*", mask.ctypes.data)
        self._check(lib.beltrami_get_page_mask(self._context, page, pointer, mask.strides[0]))
        return mask

    def _filled(self, function: Any, shape: tuple[int, ...], dtype: np.dtype[Any]) -> Array:
        out = np.empty(shape, dtype)
        self._fill(function, out)
        return out


# ---- Without a context --------------------------------------------------------------------


def triangulate(surface: Surface) -> tuple[Array, int | None]:
    """Return the triangles as corners, (t, 3), and the first face that repeats something."""
    out = np.empty((surface.faces.corner_count - 2 * len(surface.faces), 3), np.int64)
    struct, room = surface.struct(), buffer(out)
    repeating = ffi.new("uint64_t*", lib.BELTRAMI_NO_ELEMENT)
    status = cancellable(
        struct,
        lambda: lib.beltrami_triangulate(
            struct, room["data"], room["type"], room["stride"], repeating
        ),
    )
    if status < 0:
        _fail_on(surface, status, surface.first_odd_face(), lib.BELTRAMI_ELEMENT_FACE)
    return out, None if repeating[0] == lib.BELTRAMI_NO_ELEMENT else int(repeating[0])


def check(
    surface: Surface, allow_mirrored: bool, capacity: int, token: CancelToken | None = None
) -> tuple[AtlasCertificate, Array]:
    """Return the verdict on corner UVs, and (k, 2) faces of at most `capacity` overlaps."""
    out = sized("beltrami_atlas_certificate")
    pairs = np.full((capacity, 2), -1, np.int64)
    struct = surface.struct()
    room = ffi.cast("uint64_t*", pairs.ctypes.data)
    status = cancellable(
        struct,
        lambda: lib.beltrami_check_atlas(struct, allow_mirrored, out, room, capacity),
        token,
    )
    if status < 0:
        _fail_on(surface, status, out.error_element, out.error_element_kind)
    # Of triangles, so that those of polygons come several times.
    listed = np.unique(np.sort(pairs[pairs[:, 0] >= 0], axis=1), axis=0)
    return record(out, AtlasCertificate), listed


def _fail_on(surface: Surface, status: int, element: int, kind: int) -> None:
    try:
        fail(status, "", element, kind)
    except BeltramiError as error:
        surface.explain(error)
        raise
