"""Editing sessions of the C library as Python sees them: beside `_library` what knows CFFI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._arrays import Array
from ._errors import BeltramiError
from ._library import UNWRAP, Context, Hook, buffer, options_of, refuse, sized, status_name
from ._native import ffi, lib
from ._surfaces import Surface
from ._tables import AtlasCertificate

#: Options of `beltrami.unwrap` that a session does not look at.
_WITHOUT_EFFECT = (
    *("unit_square", "cut", "hard_angle", "preset", "target_energy", "target_p99", "max_charts"),
    *("seam_budget", "concave_seams", "hidden_seams", "hard_seams", "material_seams"),
    *("symmetric_seams", "straight_seams", "flat_seams", "fill_weight"),
    *("pack", "stack", "rectify", "snap_texels", "label_pages"),
)


@dataclass(frozen=True)
class SessionReport:
    """How a session stands.

    Attributes
    ----------
    status : str
        The greatest reservation of all charts, each by itself; "BELTRAMI_NOT_CONVERGED" also where
        an update has something to do.
    charts : int
        How many there are.
    due : int
        How many of them are to be mapped further.
    corners : int
        Of all faces.
    changes : int
        Corners that the last update, pack or restore moved.
    opened : int
        Edges cut beside the seams.
    symmetric_dirichlet : float
        Mean over the area, each chart at its scale; NaN before the first update.
    seconds, cpu_seconds : float
        What the last update, pack or check took.
    """

    status: str
    charts: int
    due: int
    corners: int
    changes: int
    opened: int
    symmetric_dirichlet: float
    seconds: float
    cpu_seconds: float


@dataclass(frozen=True)
class SessionChart:
    """A chart of an editing session.

    Attributes
    ----------
    id : int
        Its number: it stays while most of the chart does, and is given once.
    status : str
        "BELTRAMI_OK", "BELTRAMI_NOT_CONVERGED" or "BELTRAMI_NOT_INJECTIVE": of it by itself.
    due : bool
        Whether it is to be mapped further.
    locked : bool
        Whether all of its faces are.
    triangles : int
        How many it has.
    first_face : int
        The least of its faces.
    symmetric_dirichlet : float
        Its mean energy, 2 at least.
    scale : float
        Lengths in the plane per length on the surface that it is to have.
    keep_frame, keep_scale, align, stack : bool
        The flags that all of its faces have: Editor.set_flags.
    stacked_on : int | None
        The number of the chart that packing has laid it on, while both stay as they are.
    """

    id: int
    status: str
    due: bool
    locked: bool
    triangles: int
    first_face: int
    symmetric_dirichlet: float
    scale: float
    keep_frame: bool
    keep_scale: bool
    align: bool
    stack: bool
    stacked_on: int | None


class SessionContext(Context):
    """A context with a session."""

    def set_session_options(self, options: Mapping[str, object]) -> None:
        """Set options of a session by keyword. Raises TypeError, ValueError."""
        known = options_of(UNWRAP)
        defaults = {name: self._option(known[name]) for name in _WITHOUT_EFFECT}
        found = self.set_options(options, UNWRAP)
        for name, default in defaults.items():
            if found.get(name, default) != default:
                said = f"the option {known[name].name}={found[name]} has no effect in a session"
                refuse("BELTRAMI_E_INVALID_ARGUMENT", f"{said}: leave it out")

    def begin(self, surface: Surface, hook: Hook) -> None:
        """Begin the session. Raises what the hook raises."""
        try:
            self.call(lib.beltrami_session_begin, (surface.struct(),), hook)
        except BeltramiError as error:
            surface.explain(error)
            raise

    def end(self) -> None:
        """End the session."""
        self._check(lib.beltrami_session_end(self._context))

    def edit(self, function: str, array: Array, *arguments: Any) -> None:
        """Call a function that takes an array and its length."""
        view = ffi.new("beltrami_buffer*", buffer(array))
        name = getattr(lib, f"beltrami_session_{function}")
        self._check(name(self._context, view, len(array), *arguments))

    def set_flags(self, charts: Array, flags: dict[str, bool]) -> None:
        """Give charts the flags that are True, by the names that C has for them in lower case."""
        given = sum(getattr(lib, f"BELTRAMI_CHART_{name.upper()}") for name in flags if flags[name])
        self.edit("set_flags", charts, given)

    def set_pins(self, corners: Array, uvs: Array) -> None:
        """Set all pins."""
        views = (ffi.new("beltrami_buffer*", buffer(array)) for array in (corners, uvs))
        self._check(lib.beltrami_session_set_pins(self._context, *views, len(corners)))

    def set_pin_kinds(self, kinds: Array, directions: Array) -> None:
        """Say what is held of each pin."""
        views = (ffi.new("beltrami_buffer*", buffer(array)) for array in (kinds, directions))
        self._check(lib.beltrami_session_set_pin_kinds(self._context, *views, len(kinds)))

    def update(self, seconds: float, steps: int, hook: Hook) -> str:
        """Return the name of the status. Raises what the hook raises."""
        return self.call(lib.beltrami_session_update, (seconds, steps), hook)

    def pack(self, charts: Array, hook: Hook) -> str:
        """Return the name of the status. Raises what the hook raises."""
        view = ffi.new("beltrami_buffer*", buffer(charts))
        return self.call(lib.beltrami_session_pack, (view, len(charts)), hook)

    def check(self) -> AtlasCertificate:
        """Return the verdict on all charts."""
        return self._fetch(
            lib.beltrami_session_check, "beltrami_atlas_certificate", AtlasCertificate
        )

    def save(self) -> int:
        """Return the number of what is saved."""
        mark = ffi.new("uint64_t*")
        self._check(lib.beltrami_session_save(self._context, mark))
        return int(mark[0])

    def restore(self, mark: int) -> None:
        """Go back to what was saved."""
        self._check(lib.beltrami_session_restore(self._context, mark))

    def forget(self, mark: int) -> None:
        """Drop what was saved."""
        self._check(lib.beltrami_session_forget(self._context, mark))

    def session_report(self) -> SessionReport:
        """Return a SessionReport."""
        out = sized("beltrami_session")
        self._check(lib.beltrami_get_session(self._context, out))
        fields = (getattr(out, name) for name in list(SessionReport.__annotations__)[1:])
        return SessionReport(status_name(out.status), *fields)

    def charts(self) -> tuple[SessionChart, ...]:
        """Return all charts, by their least faces."""
        out = sized("beltrami_session_chart")
        charts = []
        for index in range(self.session_report().charts):
            self._check(lib.beltrami_get_session_chart(self._context, index, out))
            charts.append(
                SessionChart(
                    int(out.id),
                    status_name(out.status),
                    bool(out.due),
                    bool(out.locked),
                    int(out.triangles),
                    int(out.first_face),
                    float(out.symmetric_dirichlet),
                    float(out.scale),
                    bool(out.flags & lib.BELTRAMI_CHART_KEEP_FRAME),
                    bool(out.flags & lib.BELTRAMI_CHART_KEEP_SCALE),
                    bool(out.flags & lib.BELTRAMI_CHART_ALIGN),
                    bool(out.flags & lib.BELTRAMI_CHART_STACK),
                    None if out.stacked_on == 2**64 - 1 else int(out.stacked_on),
                )
            )
        return tuple(charts)

    def corner_uvs(self, corners: int, dtype: np.dtype[Any]) -> Array:
        """Return the UVs of all corners, (corners, 2)."""
        uvs = np.empty((corners, 2), dtype)
        self._fill(lib.beltrami_get_session_uvs, uvs)
        return uvs

    def changes(self, dtype: np.dtype[Any]) -> tuple[Array, Array]:
        """Return the corners that moved, (k,), and their UVs, (k, 2)."""
        count = self.session_report().changes
        corners, uvs = np.empty(count, np.int64), np.empty((count, 2), dtype)
        first, second = buffer(corners), buffer(uvs)
        self._check(
            lib.beltrami_get_session_changes(
                self._context, first["data"], first["type"], second["data"], second["type"]
            )
        )
        return corners, uvs

    def face_charts(self, faces: int) -> Array:
        """Return the number of the chart of each face, (faces,), -1 without area."""
        charts = np.empty(faces, np.int64)
        self._fill(lib.beltrami_get_session_face_charts, charts)
        return charts

    def opened(self) -> Array:
        """Return the edges cut beside the seams, (k, 2)."""
        edges = np.empty((self.session_report().opened, 2), np.int64)
        self._fill(lib.beltrami_get_session_opened, edges)
        return edges
