"""Editing: one surface whose seams and pins move, and maps that follow."""

from __future__ import annotations

import types
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _polygons, _straight, _trimesh
from ._arrays import Array
from ._errors import NotInjectiveWarning
from ._polygons import Faces
from ._progress import Progress, hook_for
from ._sessions import SessionChart, SessionContext, SessionReport
from ._surfaces import Surface
from ._tables import AtlasCertificate, UnwrapOptions

if TYPE_CHECKING:
    from typing_extensions import Unpack


@dataclass(frozen=True, eq=False)
class Changes:
    """What a call moved. It equals itself only.

    Attributes
    ----------
    corners : (k,) array of int64
        Corners that moved, increasing: counted from 0, face after face.
    uvs : (k, 2) array of float32 or float64
        Where they are now.
    status : str
        "BELTRAMI_OK"; "BELTRAMI_NOT_CONVERGED" where the next update would go on; or
        "BELTRAMI_NOT_INJECTIVE" where a chart by itself is not.
    """

    corners: Array
    uvs: Array
    status: str

    def __len__(self) -> int:
        return len(self.corners)


def _integers(name: str, values: npt.ArrayLike, columns: int | None) -> Array:
    """Return whole numbers as the library reads them. Raises TypeError, ValueError."""
    array = np.asarray(values)
    if array.size == 0:
        array = np.empty((0,) if columns is None else (0, columns), np.int64)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} must be whole numbers, not {array.dtype}")
    shape = (len(array),) if columns is None else (len(array), columns)
    if array.shape != shape:
        wanted = "(n,)" if columns is None else f"(n, {columns})"
        raise ValueError(f"{name} must have the shape {wanted}, not {array.shape}")
    return np.ascontiguousarray(array, np.int64)


class Editor:
    """A session of edits on one surface: seams and pins that move, and maps that follow.

    Edits are noted at once. `update` then maps the charts that they concern and no others, from the
    maps that they have, and judges each exactly. A call that raises leaves the maps as they were.
    The same calls give the same bits, but for updates that a limit of time ends. It is a context
    manager, which frees its memory at the end. One thread at a time may call, but `cancel` any.

    Parameters
    ----------
    vertices : (n, 3) array_like of floats, or trimesh.Trimesh
        Positions; they are copied. A mesh brings its faces, too.
    faces : (m, k) array_like of integers, or sequence of polygons; left out with a mesh
        Vertex numbers from 0, as for `unwrap`.
    corner_uvs : (m, k, 2) array_like of floats, optional
        UVs to begin with, as for `check_atlas`: charts keep them until an edit concerns them, and
        seams run where they differ. Without them the first update lays all charts side by side.
    seams : (s, 2) array_like of integers, optional
        Edges to cut, by their vertices.
    progress : bool or callable, optional
        As for `parameterize`, of the beginning.
    **options
        Those of `unwrap` that concern flattening, welding, holes, packing, `effort` of packing,
        `float32` and `threads`. Others have no effect, and are refused but at their defaults.

    Raises
    ------
    MeshError
        As `unwrap` does.
    TypeError, ValueError
        For arrays of other shapes or types, and options out of range.

    Examples
    --------
    >>> vertices = [[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 1], [2, 1, 0]]
    >>> faces = [[0, 1, 4, 3], [1, 2, 5, 4]]
    >>> with beltrami.Editor(vertices, faces) as editor:
    ...     first = editor.update()
    ...     editor.open_seams([[1, 4]])
    ...     changes = editor.update(steps=2)
    ...     editor.check().injective
    True
    """

    def __init__(
        self,
        vertices: Any,
        faces: Faces | None = None,
        *,
        corner_uvs: npt.ArrayLike | None = None,
        seams: npt.ArrayLike | None = None,
        progress: Progress = None,
        **options: Unpack[UnwrapOptions],
    ) -> None:
        if faces is None:
            if not _trimesh.is_mesh(vertices):
                raise TypeError("faces are missing: only a mesh brings its own")
            vertices, faces = vertices.vertices, vertices.faces
        points = _arrays.positions(vertices)
        polygons = _polygons.polygons(faces, len(points))
        uvs = None if corner_uvs is None else _polygons.corner_uvs(corner_uvs, polygons)
        cuts = None if seams is None else _integers("seams", seams, 2)
        surface = Surface(points, polygons, uvs, seams=cuts)
        self._faces = len(polygons)
        self._corners = polygons.corner_count
        self._dtype = np.dtype(np.float32 if options.get("float32") else np.float64)
        self._context = SessionContext()
        self._context.set_session_options(options)
        with hook_for(progress) as hook:
            self._context.begin(surface, hook)

    def __enter__(self) -> Editor:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        raised: BaseException | None,
        traceback: types.TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """End the session and free its memory; other calls raise InvalidStateError then."""
        self._context.end()

    # ---- Edits ----------------------------------------------------------------------------

    def open_seams(self, edges: npt.ArrayLike) -> None:
        """Open seams at edges; what meets no border and no other seam opens nothing yet.

        Parameters
        ----------
        edges : (k, 2) array_like of integers
            Their vertices.

        Raises
        ------
        InvalidArgumentError
            Where a pair is no edge, or inside a polygon: nothing is noted then.
        IndexOutOfRangeError, TypeError, ValueError
            For vertices that there are not, and other arrays.
        """
        self._context.edit("set_seams", _integers("edges", edges, 2), 1)

    def close_seams(self, edges: npt.ArrayLike) -> None:
        """Close seams at edges.

        Parameters
        ----------
        edges : (k, 2) array_like of integers
            Their vertices.

        Raises
        ------
        InvalidArgumentError
            Where a pair is no edge, or inside a polygon: nothing is noted then.
        IndexOutOfRangeError, TypeError, ValueError
            For vertices that there are not, and other arrays.
        """
        self._context.edit("set_seams", _integers("edges", edges, 2), 0)

    def set_pins(
        self,
        corners: npt.ArrayLike,
        uvs: npt.ArrayLike,
        kinds: Sequence[str] | None = None,
        directions: npt.ArrayLike | None = None,
    ) -> None:
        """Set pins in place of all before.

        Parameters
        ----------
        corners : (k,) array_like of integers
            Corners, counted from 0, face after face; none takes all pins off.
        uvs : (k, 2) array_like of floats
            Where they are to be; with the option `float32` numbers of that type.
        kinds : sequence of str, optional
            What is held of each: "point" (the default), "u", "v", or "line", along which it slides.
        directions : (k, 2) array_like of floats, optional
            Of lines, through their UVs; others are not read.

        Raises
        ------
        InvalidArgumentError, IndexOutOfRangeError, NonFiniteError
            With the corner.
        TypeError, ValueError
            For arrays of other shapes or types.
        """
        places = np.asarray(uvs, np.float64).reshape(-1, 2)
        numbers = _integers("corners", corners, None)
        if len(places) != len(numbers):
            raise ValueError(f"there are {len(numbers)} corners and {len(places)} UVs")
        held = None if kinds is None else _straight.held(kinds, directions, len(numbers))
        self._context.set_pins(numbers, np.ascontiguousarray(places))
        if held is not None:
            self._context.set_pin_kinds(*held)

    def select(self, faces: npt.ArrayLike | None) -> None:
        """Let some faces move alone; their charts are due.

        Parameters
        ----------
        faces : (k,) array_like of integers | None
            Numbers of faces; None lets all move.

        Raises
        ------
        IndexOutOfRangeError, TypeError, ValueError
            For faces that there are not, and other arrays.
        """
        self._context.edit("select", _integers("faces", [] if faces is None else faces, None))

    def lock(self, charts: npt.ArrayLike, locked: bool = True) -> None:
        """Lock charts, which then stay whatever happens, or unlock them.

        Parameters
        ----------
        charts : (k,) array_like of integers
            Numbers of charts.
        locked : bool, default True
            False unlocks them.

        Raises
        ------
        InvalidArgumentError, TypeError, ValueError
            For charts that there are not, and other arrays.
        """
        self._context.edit("lock", _integers("charts", charts, None), int(locked))

    def set_flags(
        self,
        charts: npt.ArrayLike,
        *,
        keep_frame: bool = False,
        keep_scale: bool = False,
        align: bool = False,
        stack: bool = False,
    ) -> None:
        """Give charts these flags in place of those that they have.

        Parameters
        ----------
        charts : (k,) array_like of integers
            Numbers of charts.
        keep_frame : bool, default False
            Packing does not turn them.
        keep_scale : bool, default False
            Pins leave their size, and packing those of all charts.
        align : bool, default False
            What is straight of their borders lies along the axes, from the next update on. Pins
            overrule it.
        stack : bool, default False
            Packing lays each on the first chart of its shape that has this flag. It is not judged
            there until one of the two changes.

        Raises
        ------
        InvalidArgumentError, TypeError, ValueError
            For charts that there are not, and other arrays.
        """
        flags = {"keep_frame": keep_frame, "keep_scale": keep_scale, "align": align, "stack": stack}
        self._context.set_flags(_integers("charts", charts, None), flags)

    def renew(self, charts: npt.ArrayLike, cold: bool = False) -> None:
        """Have the next update map charts anew, where they are.

        Parameters
        ----------
        charts : (k,) array_like of integers
            Numbers of charts.
        cold : bool, default False
            True starts from nothing instead of the map that is there.

        Raises
        ------
        InvalidArgumentError, TypeError, ValueError
            For charts that there are not, and other arrays.
        """
        self._context.edit("renew", _integers("charts", charts, None), int(cold))

    # ---- Maps -----------------------------------------------------------------------------

    def update(self, *, seconds: float = 0.0, steps: int = 0, progress: Progress = None) -> Changes:
        """Cut and map what the edits concern.

        Parameters
        ----------
        seconds : float, default 0.0
            Time after which no further step is begun, 0: any. The maps so far are injective, and
            the next update goes on with them.
        steps : int, default 0
            Newton steps that a chart takes at most from the map that it has, 0: to its minimum. 1
            or 2 are what a drag wants.
        progress : bool or callable, optional
            As for `parameterize`.

        Returns
        -------
        Changes
            The corners that moved.

        Raises
        ------
        PinError
            With the first corner that cannot be met together with those before it.
        InvalidStateError
            With a face, where parts that may not move cannot be joined.
        Cancelled, KeyboardInterrupt
            Where `cancel`, the progress or Ctrl-C ended it.
        """
        with hook_for(progress) as hook:
            status = self._context.update(seconds, steps, hook)
        return self._changes(status)

    def pack(self, charts: npt.ArrayLike | None = None, *, progress: Progress = None) -> Changes:
        """Pack charts among the others; locked ones and those with pins stay.

        Parameters
        ----------
        charts : (k,) array_like of integers | None
            Numbers of charts, which keep their sizes, and their places where there is no room
            elsewhere; None packs all, scaled as one.
        progress : bool or callable, optional
            As for `parameterize`.

        Returns
        -------
        Changes
            The corners that moved.

        Raises
        ------
        NoRoomError
            Where they do not fit.
        InvalidArgumentError
            Where a chart that stays lies on no page, with a face.
        InvalidStateError
            Before the first update.
        Cancelled, KeyboardInterrupt
            As of `update`.
        """
        numbers = _integers("charts", [] if charts is None else charts, None)
        if charts is not None and len(numbers) == 0:
            raise ValueError("there are no charts to pack: give None for all")
        with hook_for(progress) as hook:
            status = self._context.pack(numbers, hook)
        return self._changes(status)

    def _changes(self, status: str) -> Changes:
        if status == "BELTRAMI_NOT_INJECTIVE":
            warnings.warn("a chart is not injective", NotInjectiveWarning, stacklevel=3)
        return Changes(*self._context.changes(self._dtype), status)

    def check(self) -> AtlasCertificate:
        """Return the exact verdict on all charts together."""
        return self._context.check()

    def cancel(self) -> None:
        """Ask the call under way, or else the next one, to end. From any thread."""
        self._context.cancel()

    # ---- Undo -----------------------------------------------------------------------------

    def save(self) -> int:
        """Note everything under a number, which is returned."""
        return self._context.save()

    def restore(self, mark: int) -> Changes:
        """Go back to what was saved, to the bit; it stays saved.

        Parameters
        ----------
        mark : int
            What `save` returned.

        Returns
        -------
        Changes
            The corners that moved.

        Raises
        ------
        InvalidArgumentError
            Where nothing is saved under it.
        """
        self._context.restore(mark)
        return Changes(*self._context.changes(self._dtype), self._context.session_report().status)

    def forget(self, mark: int) -> None:
        """Drop what was saved.

        Parameters
        ----------
        mark : int
            What `save` returned.

        Raises
        ------
        InvalidArgumentError
            Where nothing is saved under it.
        """
        self._context.forget(mark)

    # ---- What there is --------------------------------------------------------------------

    @property
    def corner_uvs(self) -> Array:
        """A (k, 2) array of floats: the UVs of all corners, face after face."""
        return self._context.corner_uvs(self._corners, self._dtype)

    @property
    def chart_of_face(self) -> Array:
        """An (m,) array of int64: the number of the chart of each face, -1 where it has no area."""
        return self._context.face_charts(self._faces)

    @property
    def charts(self) -> tuple[SessionChart, ...]:
        """All charts, by their least faces."""
        return self._context.charts()

    @property
    def opened(self) -> Array:
        """A (k, 2) array of int64: edges cut beside the seams, for nothing else is a disk."""
        return self._context.opened()

    @property
    def report(self) -> SessionReport:
        """Counts, energy and the cost of the last call."""
        return self._context.session_report()
