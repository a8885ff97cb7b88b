"""Several atlases on the same pages."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from . import _trimesh
from ._atlas import Atlas
from ._cancel import CancelToken
from ._library import Hook
from ._pack import Packing, UvMesh, packed
from ._tables import UnwrapOptions

#: Options of `beltrami.pack`: those of every call, and those of pages.
_OF_CALLS = ("threads", "float32")
_OF_PAGES = ("resolution", "margin", "texels_per_unit", "max_pages", "pack_turns", "pack_block")
#: Options that say how the charts of one atlas lie to each other, and what they may be here.
_OF_ONE_ATLAS: dict[str, tuple[object, ...]] = {
    "pack": ("pages",),
    "fill_weight": (0, 10.0),  # its default, which has no say in pages that are shared
    "stack": ("none",),
    "share_copies": (False,),
}


def options(given: dict[str, object]) -> tuple[dict[str, object], dict[str, object]]:
    """Return the options that pack all atlases, and those that unwrap each.

    Raises ValueError for options that only one atlas on its own pages can have.
    """
    for name, possible in _OF_ONE_ATLAS.items():
        if given[name] not in possible:
            raise ValueError(f"share_page does not go with {name}={given[name]!r}")
    of_pack = {name: given[name] for name in (*_OF_CALLS, *_OF_PAGES)}
    not_of_each = (*_OF_PAGES, "fill_weight")
    of_each = {name: value for name, value in given.items() if name not in not_of_each}
    return of_pack, {**of_each, "pack": "none"}


def onto_common_pages(
    scene: Any,
    atlases: Mapping[str, Atlas],
    meshes: Mapping[str, Any],
    given: dict[str, object],
    hook: Hook,
    cancel: CancelToken | None = None,
) -> dict[str, Atlas]:
    """Return atlases that share pages. What they say of pages and of overlaps is on all of them.

    Areas are those that the scene shows: nodes scale their meshes.
    """
    placed = [
        UvMesh(
            atlas.uvs,
            atlas.uv_triangles,
            _trimesh.at_largest_place(scene, name, atlas.vertices[atlas.origins]),
        )
        for name, atlas in atlases.items()
    ]
    packing = packed(placed, given, False, hook, cancel)
    return {
        name: _placed(atlas, packing, number, meshes[name])
        for number, (name, atlas) in enumerate(atlases.items())
    }


def _placed(atlas: Atlas, packing: Packing, number: int, mesh: Any) -> Atlas:
    uvs, report = packing.uvs[number], packing.report
    page = packing.page_of_chart[packing.chart_of_face[number]]  # of triangles
    triangles, chart = atlas.uv_triangles, atlas.chart_of_face[atlas.face_of_triangle]
    page_of_uv = np.zeros(len(uvs), np.int64)
    page_of_uv[triangles] = page[:, None]
    low = np.full((len(atlas.charts), 2), np.inf)
    high, of_chart = -low, np.zeros(len(low), np.int64)
    placed = chart >= 0
    for k in range(3):
        corners = uvs[triangles[placed, k]].astype(float)
        np.minimum.at(low, chart[placed], corners)
        np.maximum.at(high, chart[placed], corners)
    of_chart[chart[placed]] = page[placed]
    charts = [
        replace(before, box=(*low[k].tolist(), *high[k].tolist()), page=int(of_chart[k]))
        for k, before in enumerate(atlas.charts)
    ]
    used: dict[str, Any] = {**atlas.options, **packing.options, "pack": "pages"}
    return replace(
        atlas,
        uvs=uvs,
        charts=tuple(charts),
        status=atlas.status if packing.status == "BELTRAMI_OK" else packing.status,
        certificate=packing.certificate,
        float32_certificate=packing.float32_certificate,
        report=replace(atlas.report, pages=report.pages, utilisation=report.utilisation),
        options=UnwrapOptions(**used),  # type: ignore[typeddict-item]
        page_of_uv=page_of_uv,
        packing=report,
        page_utilisations=packing.page_utilisations,
        mesh=_trimesh.split(mesh, atlas.origins, atlas.uv_faces, uvs),
    )
