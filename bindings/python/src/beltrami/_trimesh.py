"""``trimesh.Trimesh`` in and out, without needing trimesh."""

from __future__ import annotations

import sys
from typing import Any

from ._arrays import Array


def is_mesh(thing: object) -> bool:
    """Whether `thing` is a ``trimesh.Trimesh``: none is before trimesh has been imported."""
    return isinstance(thing, getattr(sys.modules.get("trimesh"), "Trimesh", ()))


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
