# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that follow seams and pins while a user moves these: a session of the library."""

from __future__ import annotations

from typing import Any

import numpy as np

import beltrami

from .parts import Array, Part, RefusedError, Surface, joined, spread

_STEPS = 1  # of Newton's method at a time: what is left follows at the next call


class Live:
    """Follows one mesh.

    Parameters
    ----------
    threads : int
        How many to use.
    """

    def __init__(self, threads: int):
        self._threads = threads
        self._editor: beltrami.Editor | None = None
        self._shape: tuple[Array, Array, Array] | None = None
        self._seams: set[tuple[int, int]] = set()
        self._pins: tuple[Array, Array] = (np.empty(0, np.int64), np.empty((0, 2)))
        self._uvs = np.empty((0, 2), np.float32)

    @property
    def is_due(self) -> bool:
        """Whether the next call goes on with maps that are on their way."""
        return self._editor is not None and self._editor.report.due > 0

    def close(self) -> None:
        """Forget the mesh."""
        if self._editor is not None:
            self._editor.close()
        self._editor = None

    def follow(self, part: Part) -> Array | None:
        """Return the UVs of all corners after what has changed, (c, 2), or None where nothing has.

        A mesh with another shape, or with UVs that were not made here, is begun with anew. Raises
        RefusedError with what is in the way: the UVs stay, and the next call tries again.
        """
        surface = joined([part])
        if not len(surface.sizes):
            self.close()
            return None
        if not self._goes_on(surface):
            self._begin(surface)
        editor = self._editor
        assert editor is not None
        try:
            edited = self._edit(editor, surface)
            if not edited and not self.is_due:
                return None
            changes = editor.update(steps=_STEPS)
        except beltrami.BeltramiError as error:
            self.close()
            raise RefusedError(str(error)) from error
        uvs = surface.uvs.copy()
        uvs[changes.corners] = changes.uvs
        self._uvs = uvs
        return spread([part], surface, uvs)[0]

    def _goes_on(self, surface: Surface) -> bool:
        if self._editor is None or self._shape is None:
            return False
        shape = (surface.vertices, surface.corners, surface.sizes)
        if not all(np.array_equal(a, b) for a, b in zip(shape, self._shape)):
            return False
        same = (surface.uvs == self._uvs).all(axis=1)
        return bool(same[~surface.pinned].all())

    def _begin(self, surface: Surface) -> None:
        self.close()
        given: dict[str, Any] = {}
        if np.ptp(surface.uvs, axis=0).all():
            given["corner_uvs"] = surface.uvs
        try:
            self._editor = beltrami.Editor(
                surface.vertices,
                surface.faces(),
                weld="off",
                float32=True,
                threads=self._threads,
                **given,
            )
        except beltrami.BeltramiError as error:
            raise RefusedError(str(error)) from error
        self._shape = (surface.vertices, surface.corners, surface.sizes)
        self._seams = set()
        self._pins = (np.empty(0, np.int64), np.empty((0, 2)))
        self._uvs = surface.uvs.copy()

    def _edit(self, editor: beltrami.Editor, surface: Surface) -> bool:
        """Note what has changed; whether anything has."""
        pairs = np.sort(surface.seam_pairs(), axis=1).tolist()
        seams = {(int(a), int(b)) for a, b in pairs}
        opened, closed = seams - self._seams, self._seams - seams
        if opened:
            editor.open_seams(sorted(opened))
        if closed:
            editor.close_seams(sorted(closed))
        self._seams = seams
        corners = np.flatnonzero(surface.pinned)
        places = surface.uvs[corners].astype(np.float64)
        moved = not (
            np.array_equal(corners, self._pins[0]) and np.array_equal(places, self._pins[1])
        )
        if moved:
            editor.set_pins(corners, places)
            self._pins = (corners, places)
        return bool(opened or closed or moved)
