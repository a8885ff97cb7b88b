"""The page for browsers that ``beltrami unwrap --html`` writes: a model beside its layout."""

from __future__ import annotations

import base64
import json
import math
import os
import zlib
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from . import _layouts, _view
from ._arrays import Array

_PAGE = Path(__file__).parent / "report.html"  # the viewer, with places for what it shows
_NO_CHART = 0xFFFFFFFF


def write(atlas: Any, path: str | os.PathLike[str]) -> None:
    """Write the page of an `Atlas`."""
    before, rest = _PAGE.read_text(encoding="utf-8").split("@report@", 1)
    between, after = rest.split("@arrays@", 1)
    mesh, arrays = _mesh(atlas)
    said = json.dumps({"mesh": mesh, "report": _report(atlas, Path(path).stem)}, allow_nan=False)
    # A script of HTML ends at "</script": in JSON this sign is in strings alone.
    said = said.replace("<", "\\u003c")
    with Path(path).open("w", encoding="utf-8", newline="\n") as file:
        file.write(before + said + between + arrays + after)


def _mesh(atlas: Any) -> tuple[dict[str, Any], str]:
    """Return counts and from where to look, and the arrays in base64."""
    found = _layouts.layout(atlas)
    used = found.space[found.triangles].reshape(-1, 3)
    middle = (used.min(axis=0) + used.max(axis=0)) / 2 if len(used) else np.zeros(3)
    charts = atlas.chart_of_face[atlas.face_of_triangle]
    corners = found.triangles.ravel().astype(np.uint32)
    numbers = [
        _floats(found.space - middle),
        _floats(atlas.udim_uvs),
        _floats(found.energies),
        np.diff(corners, prepend=np.uint32(0)),  # modulo 2^32
        np.where(charts < 0, _NO_CHART, charts).astype(np.uint32),
    ]
    # The first bytes of all numbers, then the second ones: deflate finds more in them.
    words = np.concatenate(numbers).astype("<u4")
    planes = words.view(np.uint8).reshape(-1, 4).T.tobytes()
    frame = _view.frame(found.space, found.triangles, _boundary(found), None, None)
    description = {
        "vertices": len(found.space),
        "triangles": len(found.triangles),
        "frame": [float(x) for x in frame.ravel()],
    }
    return description, base64.b64encode(zlib.compress(planes, 6)).decode("ascii")


def _floats(values: Array) -> Array:
    """Return the bits of values in single precision."""
    with np.errstate(over="ignore"):
        bits: Array = np.ascontiguousarray(values.ravel(), np.float32).view(np.uint32)
    return bits


def _boundary(found: _layouts.Layout) -> Array:
    """Return the places of vertices on seams and borders."""
    sides = np.sort(found.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, counts = np.unique(sides, axis=0, return_counts=True)
    places: Array = found.space[edges[counts == 1][:, 0]]
    return places


def _report(atlas: Any, name: str) -> dict[str, Any]:
    """Return the keys of the program's report that the viewer reads."""
    report, verdict = atlas.report, atlas.certificate
    found: dict[str, Any] = {
        "status": atlas.status,
        "input": {"path": name, "faces": report.faces, "triangles": report.triangles},
        "charts": report.charts,
        "seam_over_root_area": report.seam_length / max(report.area, 1e-300) ** 0.5,
        "utilisation": report.utilisation,
        "injective": {
            "result": verdict.injective,
            "positive": verdict.positive,
            "negative": verdict.negative,
            "degenerate": verdict.degenerate,
            "overlaps": verdict.overlaps,
            "float32": atlas.float32_certificate.injective,
        },
        "energy": {key: getattr(report, key) for key in ("symmetric_dirichlet", "p99", "max")},
        "packing": None if atlas.packing is None else asdict(atlas.packing),
        "seconds": report.seconds,
    }
    plain: dict[str, Any] = _plain(found)
    return plain


def _plain(value: Any) -> Any:
    """Return what JSON has: None for numbers that are not finite."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value
