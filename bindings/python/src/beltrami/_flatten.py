"""Flattening: `parameterize` for one mesh, `Flattener` for many."""

from __future__ import annotations

import contextlib
import threading
import warnings
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _hints, _trimesh
from ._arrays import Array
from ._cancel import CancelToken
from ._cancel import check as check_token
from ._errors import InvalidStateError, NotADiskError, NotInjectiveWarning
from ._library import Context
from ._progress import Progress, hook_for
from ._results import Parameterization
from ._tables import EnergyChoice, FlattenChoice, InjectivityChoice, MethodChoice, Options

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Flattener:
    """Flattens meshes one after the other, with the same options; a run can be cancelled.

    One thread at a time may use a flattener; another one that tries gets `InvalidStateError`. Only
    `cancel` may be called from any thread. Flatteners share nothing. The GIL is released while the
    library works, so several of them run at the same time in as many threads.

    Options
    -------
    method : {"beltrami", "cm", "tutte", "gif", "bff", "uv-prolongation"}, default "beltrami"
        How the map is computed: beltrami (fast and low in distortion), cm (composite majorization
        on the full mesh, the slow reference) or tutte (into a circle, highly distorted). Baselines
        to compare with are gif and bff on the surface's own metric, and uv-prolongation of the
        coarse UVs; bff and uv-prolongation may flip.
    energy : str, default "symmetric-dirichlet"
        One of "symmetric-dirichlet", "symmetric-arap", "exponential-dirichlet". The distortion that
        is minimised; exponential-dirichlet lowers it where it is highest, at a mean that is a
        little higher.
    coarse_faces : int, default 0
        Faces of the simplified mesh that composite majorization runs on. 0 chooses 1% of the faces,
        at least 10,000; or 1,000 to 5,000 where meshes from 4,000 faces on go through levels. A
        number from 0 to 700,000,000.
    tolerance : float, default 0.0001
        Relative decrease of the energy in one iteration below which composite majorization stops. A
        number from 0 to 1.
    max_iterations : int, default 500
        Iterations after which composite majorization stops even if it has not converged. A number
        from 1 to 1,000,000.
    threads : int, default 1
        Threads to use, the calling one included; the result does not depend on it. A number from 1
        to 1,024.
    unit_square : bool, default False
        True scales and shifts the UVs into the unit square, where those of pages are in any case;
        False keeps them in the mesh's unit of length.
    flatten : {"metric", "dirichlet", "gif", "flim", "bff"}, default "metric"
        How the method beltrami flattens the fine mesh. metric: a Poisson solve with a free
        boundary, and a polish. dirichlet: harmonic, boundary from the coarse map, faster, energy a
        little higher. gif: a harmonic subspace of a few boundary vertices with a scaffold. flim:
        the same, local injectivity only. bff: conformal, may flip.
    injectivity : {"auto", "global", "local"}, default "auto"
        What the optimisation sees to: global (no flips, no boundary crossings), local (no flips:
        parts may overlap, at a slightly lower energy) or auto. That is global, but for the method
        cm, which is left as the literature has it.
    refine : bool, default False
        True goes on with composite majorization on the fine mesh from the result, to a little less
        energy in much more time.
    refine_iterations : int, default 0
        Iterations after which the refinement stops; 0 leaves it to the tolerance. A number from 0
        to 1,000,000.
    time_limit : float, default 0.0
        Seconds since the start of the run after which iterations stop with the best map so far; 0
        sets no limit. A number from 0 to 1,000,000,000.
    float32 : bool, default False
        True delivers UVs that single precision holds exactly, rounded so that the map stays
        injective.
    delaunay : bool, default False
        True flips edges to the intrinsic Delaunay triangulation of the prolonged metric before the
        fine mesh is flattened: what is injective then are its own triangles on the same vertices.
    memory_limit : int, default 0
        Bytes of memory that a run is to stay within by its estimate; 0 sets no limit. A run that
        needs more ends before it starts. Steps that only hard meshes need are left out where they
        would exceed it, or end the run if there is no map without them. A number from 0 to 1e+14.

    Raises
    ------
    TypeError, ValueError
        For an option that has another type, or is out of range (`InvalidArgumentError`).

    Examples
    --------
    >>> flattener = beltrami.Flattener(energy="symmetric-arap")
    >>> for height in (0, 1):
    ...     vertices = [[0, 0, 0], [1, 0, 0], [1, 1, height], [0, 1, 0]]
    ...     result = flattener.parameterize(vertices, [[0, 1, 2], [0, 2, 3]])
    ...     print(result.injective, round(result.energy.symmetric_arap, 6))
    True 0.0
    True 0.0
    """

    def __init__(
        self,
        *,
        # options: parameters
        method: MethodChoice = "beltrami",
        energy: EnergyChoice = "symmetric-dirichlet",
        coarse_faces: int = 0,
        tolerance: float = 0.0001,
        max_iterations: int = 500,
        threads: int = 1,
        unit_square: bool = False,
        flatten: FlattenChoice = "metric",
        injectivity: InjectivityChoice = "auto",
        refine: bool = False,
        refine_iterations: int = 0,
        time_limit: float = 0.0,
        float32: bool = False,
        delaunay: bool = False,
        memory_limit: int = 0,
        # end of options
    ) -> None:
        self._context = Context()
        self._busy = threading.Lock()
        self._mesh: Any = None  # a trimesh.Trimesh, where one was given
        self._faces: Array | None = None
        self._vertices_dtype = np.dtype(np.float64)
        self._vertex_count = 0
        self._options = Options()
        self.set_options(
            # options: keywords
            method=method,
            energy=energy,
            coarse_faces=coarse_faces,
            tolerance=tolerance,
            max_iterations=max_iterations,
            threads=threads,
            unit_square=unit_square,
            flatten=flatten,
            injectivity=injectivity,
            refine=refine,
            refine_iterations=refine_iterations,
            time_limit=time_limit,
            float32=float32,
            delaunay=delaunay,
            memory_limit=memory_limit,
            # end of options
        )

    @property
    def options(self) -> Options:
        """The options for later runs, by keyword (a copy)."""
        return self._options.copy()

    def set_options(self, **options: Unpack[Options]) -> None:
        """Change options for later runs.

        Parameters
        ----------
        **options
            As for `Flattener`; those that are not given stay as they are.

        Raises
        ------
        TypeError, ValueError, InvalidStateError
            Options before the one that is refused are changed.
        """
        with self._alone():
            for name, value in options.items():
                self._options.update(self._context.set_options({name: value}))  # type: ignore[typeddict-item]

    def set_mesh(self, vertices: Any, faces: npt.ArrayLike | None = None) -> None:
        """Take a mesh over, for `run`.

        The library has a copy, so the positions are free to change afterwards. Faces that were read
        in place, and a ``trimesh.Trimesh``, are handed out again with the results: leave those as
        they are.

        Parameters
        ----------
        vertices : (n, 3) array_like of floats, or trimesh.Trimesh
            Positions in any unit of length; float32 and float64 are read in place.
        faces : (m, 3) array_like of integers
            Counter-clockwise vertex numbers from 0; left out with a ``trimesh.Trimesh``.

        Raises
        ------
        MeshError
            `NotADiskError`, `IndexOutOfRangeError`, `NonFiniteError` and others, with the element.
            The flattener keeps the mesh that it had.
        TypeError, ValueError
            For arrays of other shapes or types.
        OutOfMemoryError, InvalidStateError
            As their names say.
        """
        mesh = None
        if faces is None:
            if not _trimesh.is_mesh(vertices):
                instead = _hints.for_thing(vertices)
                missing = "faces are missing: only a trimesh.Trimesh brings its own"
                raise TypeError(missing if instead is None else f"vertices is {instead}")
            mesh, vertices, faces = vertices, vertices.vertices, vertices.faces
        points, triangles = _arrays.positions(vertices), _arrays.indices(faces)
        with self._alone():
            try:
                self._context.set_mesh(points, triangles)
            except NotADiskError as error:
                if mesh is not None:
                    _trimesh.explain(error, mesh)
                raise
            self._mesh, self._faces = mesh, triangles
            self._vertices_dtype, self._vertex_count = points.dtype, len(points)

    def estimate_memory(self) -> int:
        """Estimate the memory of the next `run`, with the mesh and the options that are set.

        Returns
        -------
        int
            Bytes that the library will hold at its peak, its copy of the mesh included, arrays of
            Python not. It is the least `memory_limit` that the run can do with: below, it raises
            `OutOfMemoryError` before it starts. Without a limit the default mode may take four
            times as much on hard meshes, where Newton steps end a blocked polish.

        Raises
        ------
        InvalidStateError
            Without a mesh.
        """
        with self._alone():
            return self._context.estimate_memory()

    def run(self, progress: Progress = None) -> Parameterization:
        """Flatten the mesh that was set.

        Parameters
        ----------
        progress : bool or callable, optional
            As for `parameterize`.

        Returns
        -------
        Parameterization
            As `parameterize` does.

        Raises
        ------
        InvalidStateError
            Without a mesh.
        Cancelled, KeyboardInterrupt, SolverError, OutOfMemoryError, InternalError
            As `parameterize` does.
        """
        return self._run(progress, callers=2)

    def parameterize(
        self, vertices: Any, faces: npt.ArrayLike | None = None, *, progress: Progress = None
    ) -> Parameterization:
        """Flatten a mesh: `set_mesh` and `run` in one.

        Parameters
        ----------
        vertices, faces
            As for `set_mesh`.
        progress : bool or callable, optional
            As for the function `parameterize`.

        Returns
        -------
        Parameterization
            As the function does.

        Raises
        ------
        BeltramiError, TypeError, ValueError
            What `set_mesh` and `run` raise.
        """
        return self._parameterize(vertices, faces, progress, callers=2)

    def cancel(self) -> None:
        """End the run under way, which then raises `Cancelled`; from any thread.

        It is heard within some milliseconds, but inside an ordering or a factorization of a large
        matrix. Without a run under way, it is the next one that ends; `set_mesh` drops the request.
        """
        self._context.cancel()

    @contextlib.contextmanager
    def _alone(self) -> Iterator[None]:
        if not self._busy.acquire(blocking=False):
            raise InvalidStateError("this flattener is in use: only cancel() is possible")
        try:
            yield
        finally:
            self._busy.release()

    def _parameterize(
        self, vertices: Any, faces: npt.ArrayLike | None, progress: Progress, callers: int
    ) -> Parameterization:
        self.set_mesh(vertices, faces)
        return self._run(progress, callers + 1)

    def _run(self, progress: Progress, callers: int) -> Parameterization:
        """Run; `callers` says how many calls up a warning is to point at."""
        with self._alone():
            with hook_for(progress) as hook:
                status = self._context.run(hook)
            result = self._fetch(status)
        if not result.injective:
            warnings.warn(_reservation(result), NotInjectiveWarning, stacklevel=callers + 1)
        return result

    def _fetch(self, status: str) -> Parameterization:
        assert self._faces is not None
        single = self._vertices_dtype == np.float32 or self._options["float32"]
        dtype = np.dtype(np.float32 if single else np.float64)
        uv = self._context.uvs(self._vertex_count, dtype)
        faces = self._context.faces(self._faces) if self._options["delaunay"] else self._faces
        return Parameterization(
            uv=uv,
            faces=faces,
            status=status,
            certificate=self._context.certificate(dtype),
            energy=self._context.energy(),
            stages=self._context.stages(),
            report=self._context.report(),
            options=self.options,
            mesh=None if self._mesh is None else _trimesh.with_uv(self._mesh, uv, faces),
        )


def parameterize(
    vertices: Any,
    faces: npt.ArrayLike | None = None,
    *,
    # options: parameters
    method: MethodChoice = "beltrami",
    energy: EnergyChoice = "symmetric-dirichlet",
    coarse_faces: int = 0,
    tolerance: float = 0.0001,
    max_iterations: int = 500,
    threads: int = 1,
    unit_square: bool = False,
    flatten: FlattenChoice = "metric",
    injectivity: InjectivityChoice = "auto",
    refine: bool = False,
    refine_iterations: int = 0,
    time_limit: float = 0.0,
    float32: bool = False,
    delaunay: bool = False,
    memory_limit: int = 0,
    # end of options
    progress: Progress = None,
    cancel: CancelToken | None = None,
) -> Parameterization:
    """Flatten a disk-like triangle mesh to UVs: injective, with low distortion.

    Vertices and faces are never duplicated, dropped or reordered: there is one UV per vertex. The
    same input gives the same bits, at any number of threads.

    Parameters
    ----------
    vertices : (n, 3) array_like of floats, or trimesh.Trimesh
        Positions in any unit of length. float32 and float64 with consecutive coordinates, and any
        positive distance from row to row, are read in place; all else is converted.
    faces : (m, 3) array_like of integers
        Counter-clockwise vertex numbers from 0; int32, int64, uint32 and uint64 are read in place.
        Left out with a ``trimesh.Trimesh``. The faces must form one disk: one component, one
        boundary loop, no handles, manifold and consistently oriented.
    progress : bool or callable, optional
        True draws a bar: tqdm's, in terminals and notebooks, where it is installed, else a plain
        line on stderr if that is a terminal. A callable is told ``(fraction, stage)`` in this
        thread, with a fraction in [0, 1] that never decreases. It cancels by returning False or by
        raising, and what it raises is passed on.
    cancel : CancelToken, optional
        Ends the call from any thread.

    Options
    -------
    method : {"beltrami", "cm", "tutte", "gif", "bff", "uv-prolongation"}, default "beltrami"
        How the map is computed: beltrami (fast and low in distortion), cm (composite majorization
        on the full mesh, the slow reference) or tutte (into a circle, highly distorted). Baselines
        to compare with are gif and bff on the surface's own metric, and uv-prolongation of the
        coarse UVs; bff and uv-prolongation may flip.
    energy : str, default "symmetric-dirichlet"
        One of "symmetric-dirichlet", "symmetric-arap", "exponential-dirichlet". The distortion that
        is minimised; exponential-dirichlet lowers it where it is highest, at a mean that is a
        little higher.
    coarse_faces : int, default 0
        Faces of the simplified mesh that composite majorization runs on. 0 chooses 1% of the faces,
        at least 10,000; or 1,000 to 5,000 where meshes from 4,000 faces on go through levels. A
        number from 0 to 700,000,000.
    tolerance : float, default 0.0001
        Relative decrease of the energy in one iteration below which composite majorization stops. A
        number from 0 to 1.
    max_iterations : int, default 500
        Iterations after which composite majorization stops even if it has not converged. A number
        from 1 to 1,000,000.
    threads : int, default 1
        Threads to use, the calling one included; the result does not depend on it. A number from 1
        to 1,024.
    unit_square : bool, default False
        True scales and shifts the UVs into the unit square, where those of pages are in any case;
        False keeps them in the mesh's unit of length.
    flatten : {"metric", "dirichlet", "gif", "flim", "bff"}, default "metric"
        How the method beltrami flattens the fine mesh. metric: a Poisson solve with a free
        boundary, and a polish. dirichlet: harmonic, boundary from the coarse map, faster, energy a
        little higher. gif: a harmonic subspace of a few boundary vertices with a scaffold. flim:
        the same, local injectivity only. bff: conformal, may flip.
    injectivity : {"auto", "global", "local"}, default "auto"
        What the optimisation sees to: global (no flips, no boundary crossings), local (no flips:
        parts may overlap, at a slightly lower energy) or auto. That is global, but for the method
        cm, which is left as the literature has it.
    refine : bool, default False
        True goes on with composite majorization on the fine mesh from the result, to a little less
        energy in much more time.
    refine_iterations : int, default 0
        Iterations after which the refinement stops; 0 leaves it to the tolerance. A number from 0
        to 1,000,000.
    time_limit : float, default 0.0
        Seconds since the start of the run after which iterations stop with the best map so far; 0
        sets no limit. A number from 0 to 1,000,000,000.
    float32 : bool, default False
        True delivers UVs that single precision holds exactly, rounded so that the map stays
        injective.
    delaunay : bool, default False
        True flips edges to the intrinsic Delaunay triangulation of the prolonged metric before the
        fine mesh is flattened: what is injective then are its own triangles on the same vertices.
    memory_limit : int, default 0
        Bytes of memory that a run is to stay within by its estimate; 0 sets no limit. A run that
        needs more ends before it starts. Steps that only hard meshes need are left out where they
        would exceed it, or end the run if there is no map without them. A number from 0 to 1e+14.

    Returns
    -------
    Parameterization
        `uv` is an (n, 2) array: float32 where `vertices` are float32, or with the option `float32`;
        else float64. A map that is not injective is returned, too, with a `NotInjectiveWarning`;
        its `injective` is False, and its `certificate` says why.

    Raises
    ------
    MeshError
        `NotADiskError`, `IndexOutOfRangeError`, `NonFiniteError` and others, with the face or
        vertex in `element`.
    TypeError, ValueError
        For arrays of other shapes or types, and for options out of range.
    Cancelled
        By `cancel`, or because `progress` returned False.
    KeyboardInterrupt
        On Ctrl-C, in the main thread.
    SolverError, OutOfMemoryError, InternalError
        As their names say.

    Examples
    --------
    >>> vertices = [[0.0, 0, 0], [1, 0, 0], [1, 1, 1], [0, 1, 0]]
    >>> result = beltrami.parameterize(vertices, [[0, 1, 2], [0, 2, 3]], threads=2)
    >>> result.uv.shape, result.injective, round(result.energy.symmetric_dirichlet, 3)
    ((4, 2), True, 2.0)
    """
    flattener = Flattener(
        # options: keywords
        method=method,
        energy=energy,
        coarse_faces=coarse_faces,
        tolerance=tolerance,
        max_iterations=max_iterations,
        threads=threads,
        unit_square=unit_square,
        flatten=flatten,
        injectivity=injectivity,
        refine=refine,
        refine_iterations=refine_iterations,
        time_limit=time_limit,
        float32=float32,
        delaunay=delaunay,
        memory_limit=memory_limit,
        # end of options
    )
    check_token(cancel)
    flattener._context.token = cancel
    return flattener._parameterize(vertices, faces, progress, callers=2)


def _reservation(result: Parameterization) -> str:
    found = result.certificate
    return (
        f"the map is not injective: {found.negative} flipped faces, {found.degenerate} without "
        f"area, {found.boundary_crossings} boundary crossings"
    )
