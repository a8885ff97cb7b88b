"""Meshes of an atlas of `beltrami.xatlas`: as they were added, and what became of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arrays
from . import _atlas as _results
from ._arrays import Array
from ._errors import IndexOutOfRangeError, NoRoomError
from ._pack import Packing, UvMesh, pack
from ._tables import PackTurnsChoice
from ._unwrap import unwrap
from ._xatlas_options import ChartType, PackOptions

SIDE = 1024  # texels of a page, where no resolution is asked for
LONGEST_SIDE = 32_768
NO_CHART = np.uint32(0xFFFFFFFF)


@dataclass(frozen=True, eq=False)
class Pages:
    """How `PackOptions` say it to beltrami."""

    resolution: int
    texels_per_unit: float
    margin: float
    turns: PackTurnsChoice
    block: int

    @classmethod
    def of(cls, options: PackOptions) -> Pages:
        turns: PackTurnsChoice = "any" if options.rotate_charts else "quarter"
        return cls(
            options.resolution,
            options.texels_per_unit,
            2.0 * options.padding + (2.0 if options.bilinear else 1.0),
            turns if options.rotate_charts_to_axis else "none",
            4 if options.blockAlign else 1,
        )

    @property
    def measured(self) -> bool:
        """Whether the texels of a page are still to be found."""
        return self.resolution == 0 and self.texels_per_unit > 0


@dataclass(frozen=True, eq=False)
class AddedMesh:
    """A mesh as it was added."""

    positions: Array
    faces: Array
    uvs: Array | None

    def unwrapped(self, keep_uvs: bool, options: dict[str, Any]) -> _results.Atlas:
        of_corners = self.uvs[self.faces] if keep_uvs and self.uvs is not None else None
        if of_corners is not None:
            options = {**options, "cut": "islands"}
        atlas: _results.Atlas = unwrap(
            self.positions, self.faces, corner_uvs=of_corners, float32=True, **options
        )
        return atlas


@dataclass(frozen=True, eq=False)
class AddedUvs:
    """A mesh of UVs as it was added: `vmapping` are the UV vertices that `faces` name."""

    uvs: Array
    faces: Array
    vmapping: Array
    materials: Array | None


@dataclass(frozen=True, eq=False)
class Made:
    """What became of a mesh."""

    vmapping: Array
    faces: Array
    uvs: Array
    chart_of_face: Array  # counted in the mesh, -1 for none
    page_of_chart: Array
    types: Array
    materials: Array | None

    def assignment(self, first_chart: int) -> tuple[Array, Array]:
        chart = np.full(len(self.vmapping), -1, np.int64)
        chart[self.faces] = self.chart_of_face[:, None]
        page, number = np.full((2, len(chart)), NO_CHART)
        page[chart >= 0] = self.page_of_chart[chart[chart >= 0]]
        number[chart >= 0] = chart[chart >= 0] + first_chart
        return page, number


def made_of(atlas: _results.Atlas, uvs: Array, page_of_chart: Array) -> Made:
    """Return what became of a mesh, with its UVs on the pages."""
    if isinstance(atlas.uv_faces, list):  # of triangles it is an array
        raise AssertionError("faces are no array")
    types = [
        ChartType.LSCM if chart.error == "BELTRAMI_OK" else ChartType.Invalid
        for chart in atlas.charts
    ]
    return Made(
        atlas.origins,
        atlas.uv_faces,
        uvs,
        atlas.chart_of_face,
        page_of_chart,
        np.array(types, np.int64),
        None,
    )


def packed_onto(meshes: Sequence[UvMesh | _results.Atlas], pages: Pages, threads: int) -> Packing:
    """Pack charts; where the pages have no size yet, onto one that is just large enough."""

    def packed(resolution: int, texels_per_unit: float, max_pages: int) -> Packing:
        return pack(
            meshes,
            threads=threads,
            float32=True,
            resolution=resolution,
            margin=pages.margin,
            texels_per_unit=texels_per_unit,
            max_pages=max_pages,
            pack_turns=pages.turns,
            pack_block=pages.block,
        )

    if not pages.measured:
        return packed(pages.resolution or SIDE, pages.texels_per_unit, 0)
    density = packed(SIDE, 0.0, 1).report.texels_per_unit
    side = int(np.clip(np.ceil(SIDE * pages.texels_per_unit / density), 8, LONGEST_SIDE))
    while True:
        try:
            return packed(side, pages.texels_per_unit, 1)
        except NoRoomError:
            if side == LONGEST_SIDE:
                raise
            side = min(side + 1 + side // 50, LONGEST_SIDE)


def shaped(name: str, values: npt.ArrayLike, columns: int, rows: int | None = None) -> Array:
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] != columns:
        raise ValueError(f"{name}: an array Nx{columns} is expected, not {array.shape}")
    if rows is not None and len(array) != rows:
        raise ValueError(f"{name}: {rows} are expected in the first dimension, not {len(array)}")
    return array


def faces_of(values: npt.ArrayLike, vertices: int) -> Array:
    faces = _arrays.indices(shaped("indices", values, 3))
    odd = np.flatnonzero(((faces < 0) | (faces >= vertices)).any(axis=1))
    if len(odd):
        raise IndexOutOfRangeError(
            f"face {odd[0]} has an index out of range: {faces[odd[0]].tolist()}, but there are "
            f"{vertices} vertices",
            status="BELTRAMI_E_INDEX_OUT_OF_RANGE",
            element=int(odd[0]),
            element_kind="face",
        )
    return faces


def colours(count: int) -> Array:
    """Return a colour for each chart, (count, 3) of uint8, bright ones."""
    steps = np.array([0.61803399, 0.75487767, 0.56984029])
    shares = (np.arange(count)[:, None] * steps + 0.5) % 1
    colours: Array = (96 + 127 * shares).astype(np.uint8)
    return colours
