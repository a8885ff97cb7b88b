"""What notebooks show of an atlas: its layout as a picture, and its figures. NumPy is enough."""

from __future__ import annotations

import base64
import html
import struct
import zlib
from typing import Any

import numpy as np

from . import _layouts, _raster
from ._arrays import Array

_PIXELS = 320  # to the side of a page
_SAMPLES = 2  # per pixel and direction, against jagged edges
_MOST_PAGES = 4  # that are shown
_MOST_MESHES = 8
_GAP = 0.03  # between pages
_LEAST_LIMIT = 2.2  # of the scale of colours
_VIRIDIS = (
    "440154",
    "472d7b",
    "3b528b",
    "2c728e",
    "21918c",
    "28ae80",
    "5ec962",
    "addc30",
    "fde725",
)
_COLOURS = np.array([[int(code[k : k + 2], 16) for k in (0, 2, 4)] for code in _VIRIDIS], float)
_BAD = (219, 26, 26)
_LINE = (33, 41, 56)
_PAGE = (236, 238, 241)


def of_atlas(atlas: Any) -> str:
    """Return a picture and a table of an `Atlas`, in one element that needs nothing else."""
    found = _layouts.layout(atlas)
    limit = _layouts.rounded_up(max(_LEAST_LIMIT, _layouts.most(found.energies, found.areas)))
    picture = base64.b64encode(_png(_picture(atlas, found, limit))).decode("ascii")
    gradient = ", ".join(f"#{code}" for code in _VIRIDIS)
    rows = "".join(
        f'<tr><td style="text-align:left">{name}</td>'
        f'<td style="text-align:left">{html.escape(value)}</td></tr>'
        for name, value in _figures(atlas).items()
    )
    return (
        '<div style="display:flex;flex-wrap:wrap;gap:1em;align-items:flex-start">'
        f'<div><img alt="the layout, coloured by its distortion" style="max-width:100%" '
        f'src="data:image/png;base64,{picture}"/>'
        '<div style="display:flex;gap:0.5em;align-items:center;font-size:80%">2'
        f'<span style="width:10em;height:0.8em;background:linear-gradient(90deg, {gradient})">'
        f"</span>{limit:g} symmetric Dirichlet energy</div></div>"
        f"<table><tbody>{rows}</tbody></table></div>"
    )


def of_scene(scene: Any) -> str:
    """Return those of `SceneAtlases`, each below its name."""
    names = list(scene.atlases)
    parts = [
        f"<div><b>{html.escape(str(name))}</b>{of_atlas(scene.atlases[name])}</div>"
        for name in names[:_MOST_MESHES]
    ]
    if len(names) > _MOST_MESHES:
        parts.append(f"<div>and {len(names) - _MOST_MESHES} more</div>")
    return f"<div>{''.join(parts)}</div>"


def _figures(atlas: Any) -> dict[str, str]:
    """Return what the table says, by what it is."""
    report, found = atlas.report, atlas.certificate
    verdict = "yes, proven"
    if not found.injective:
        verdict = (
            f"no: {found.negative} flipped, {found.degenerate} without area, "
            f"{found.overlaps} overlaps"
        )
    figures = {
        "injective": verdict,
        "faces": f"{report.faces:,}",
        "charts": f"{len(atlas.charts):,}",
        "UV vertices": f"{report.uv_vertices:,}",
        "seams": f"{report.seam_length / max(report.area, 1e-300) ** 0.5:.3g} roots of the area",
        "energy, mean": f"{report.symmetric_dirichlet:.4g} (2 keeps all lengths)",
        "energy, 99% of the area": f"{report.p99:.4g}",
        "energy, greatest": f"{report.max:.4g}",
    }
    if atlas.packing is not None:
        pages, side = atlas.packing.pages, atlas.packing.resolution
        figures["pages"] = f"{pages} of {side:,} x {side:,} texels"
        figures["texels for a unit of length"] = f"{atlas.packing.texels_per_unit:.4g}"
    figures["utilisation"] = f"{100 * report.utilisation:.1f}%"
    figures["time"] = f"{report.seconds:.3g} s"
    if atlas.status != "BELTRAMI_OK":
        figures["status"] = atlas.status
    return figures


def _picture(atlas: Any, found: _layouts.Layout, limit: float) -> Array:
    """Return the layout as pixels, (height, width, 4) of uint8, rows from the top."""
    points, triangles = atlas.uvs.astype(float), found.triangles
    if atlas.packing is None:
        frames = np.zeros((0, 2))
        used = points[triangles].reshape(-1, 2)
        low, high = used.min(axis=0), used.max(axis=0)
        shown = np.ones(len(triangles), bool)
    else:
        frames = np.array([[k * (1 + _GAP), 0] for k in range(atlas.packing.pages)])[:_MOST_PAGES]
        page = atlas.page_of_uv[triangles[:, 0]]
        shown = page < len(frames)
        points = points.copy()
        points[:, 0] += atlas.page_of_uv * (1 + _GAP)
        low, high = np.zeros(2), frames[-1] + 1
    side = max(float(high[1] - low[1]), float(high[0] - low[0]) / _MOST_PAGES) or 1.0
    scale = _SAMPLES * _PIXELS / side
    size = np.maximum(np.ceil((high - low) * scale / _SAMPLES).astype(int), 1) * _SAMPLES
    width, height = int(size[0]), int(size[1])
    image = np.zeros((height, width, 4))
    for x, y in (frames - low) * scale:
        right, top = int(x + scale), int(y + scale)
        image[int(y) : top, int(x) : right] = (*_PAGE, 255)
    number = np.flatnonzero(shown)
    at = (points - low) * scale
    raster = _raster.rasterize(at, np.zeros(len(points)), triangles[number], width, height)
    covered = raster.face >= 0
    face = number[raster.face[covered]]
    image[covered, :3] = _colours(found.energies[face], limit)
    image[covered, 3] = 255
    chart = np.full((height, width), -2)
    chart[covered] = atlas.chart_of_face[atlas.face_of_triangle[face]]
    line = np.zeros((height, width), bool)
    line[1:] |= chart[1:] != chart[:-1]
    line[:, 1:] |= chart[:, 1:] != chart[:, :-1]
    image[line] = (*_LINE, 255)
    alpha = image[:, :, 3:] / 255
    image[:, :, :3] *= alpha
    shape = (height // _SAMPLES, _SAMPLES, width // _SAMPLES, _SAMPLES, 4)
    image = image.reshape(shape).mean(axis=(1, 3))
    image[:, :, :3] /= np.maximum(image[:, :, 3:] / 255, 1e-6)
    pixels: Array = np.clip(np.rint(image[::-1]), 0, 255).astype(np.uint8)
    return pixels


def _colours(energies: Array, limit: float) -> Array:
    """Return colours of energies from 2 to `limit`, (k, 3) from 0 to 255; red where infinite."""
    bad = ~np.isfinite(energies)
    share = np.log(np.clip(np.where(bad, 2, energies), 2, limit) / 2) / np.log(limit / 2)
    stops = np.linspace(0, 1, len(_COLOURS))
    colours = np.stack([np.interp(share, stops, _COLOURS[:, k]) for k in range(3)], axis=1)
    colours[bad] = _BAD
    return colours


def _png(image: Array) -> bytes:
    """Return a picture (height, width, 4) of uint8 as a PNG file."""
    height, width = image.shape[:2]

    def chunk(kind: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    lines = np.zeros((height, 1 + 4 * width), np.uint8)  # each begins with its filter, none
    lines[:, 1:] = image.reshape(height, -1)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(lines.tobytes(), 6))
        + chunk(b"IEND", b"")
    )
