"""``trimesh.Trimesh`` in and out, without needing trimesh."""

from __future__ import annotations

import sys
from typing import Any

from ._arrays import Array
from ._errors import NotADiskError

# What a disk becomes where the vertices on both sides of its seam are made one.
_SEWN = ["BELTRAMI_E_CLOSED", "BELTRAMI_E_BOUNDARIES", "BELTRAMI_E_GENUS"]


def is_mesh(thing: object) -> bool:
    """Whether `thing` is a ``trimesh.Trimesh``: none is before trimesh has been imported."""
    return isinstance(thing, getattr(sys.modules.get("trimesh"), "Trimesh", ()))


def explain(error: NotADiskError, mesh: Any) -> None:
    """Has the message say how a cut is kept open, where trimesh may have closed it."""
    if error.status in _SEWN and mesh.metadata.get("processed"):
        hint = "if it was cut open, trimesh has merged the vertices along the seam"
        error.args = (f"{error}; {hint}: load or make the mesh with process=False",)


def with_uv(mesh: Any, uv: Array, faces: Array) -> Any:
    """Return a copy of a ``trimesh.Trimesh`` with UVs, and with these faces.

    What else the mesh carried stays, but for its colours: a mesh has either those or UVs.
    """
    from trimesh.visual import TextureVisuals

    copied = mesh.copy()
    if not (copied.faces == faces).all():
        copied.faces = faces
    material = getattr(mesh.visual, "material", None)
    copied.visual = TextureVisuals(uv=uv, material=material)
    return copied
