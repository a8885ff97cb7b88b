"""UV meshes of the C library as Python sees them: beside `_library` and `_surfaces` knows CFFI."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._arrays import Array
from ._library import Hook, buffer, sized
from ._native import ffi, lib
from ._surfaces import AtlasContext


@dataclass(frozen=True, eq=False)
class UvArrays:
    """A UV mesh in arrays of `_arrays`."""

    uvs: Array
    uv_faces: Array
    vertices: Array | None = None
    faces: Array | None = None
    kept_pages: Array | None = None  # int64, -1 for faces whose charts are placed
    page_labels: Array | None = None  # int64

    def struct(self) -> Any:
        """Return the ``beltrami_uv_mesh``, which is good as long as the arrays are."""
        mesh = sized("beltrami_uv_mesh")
        mesh.uv_count, mesh.face_count = len(self.uvs), len(self.uv_faces)
        mesh.uvs, mesh.uv_indices = buffer(self.uvs), buffer(self.uv_faces)
        if self.vertices is not None:
            mesh.vertex_count, mesh.positions = len(self.vertices), buffer(self.vertices)
            if self.faces is not None:
                mesh.indices = buffer(self.faces)
        if self.kept_pages is not None:
            mesh.kept_pages = buffer(self.kept_pages)
        if self.page_labels is not None:
            mesh.page_labels = buffer(self.page_labels)
        return mesh


class PackContext(AtlasContext):
    """A context that packs."""

    def pack(self, meshes: Sequence[UvArrays], hook: Hook) -> str:
        """Pack; returns the name of the status. Raises what the hook raises."""
        structs = [mesh.struct() for mesh in meshes]
        pointers = ffi.new("beltrami_uv_mesh*[]", structs)
        return self.call(lib.beltrami_pack, (pointers, len(structs)), hook)

    def packed_uvs(self, mesh: int, like: Array, dtype: np.dtype[Any]) -> Array:
        """Return the UVs of a mesh, as many as `like` has."""
        return self._filled(self._of_mesh(lib.beltrami_get_packed_uvs, mesh), like.shape, dtype)

    def packed_charts(self, mesh: int, count: int) -> Array:
        """Return the chart of each face of a mesh, (count,)."""
        charts = self._of_mesh(lib.beltrami_get_packed_charts, mesh)
        return self._filled(charts, (count,), np.dtype(np.int64))

    @staticmethod
    def _of_mesh(function: Any, mesh: int) -> Any:
        return lambda context, *room: function(context, mesh, *room)
