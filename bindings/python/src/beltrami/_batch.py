"""Many meshes in one go, each flattened by a process of its own."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

from . import _jobs, _library
from ._cancel import CancelToken
from ._jobs import BatchRecord
from ._progress import Progress
from ._tables import EnergyChoice, FlattenChoice, InjectivityChoice, MethodChoice


def batch(
    paths: Iterable[str | os.PathLike[str]],
    out_dir: str | os.PathLike[str],
    scheduler: Any = None,
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
    suffix: str = ".obj",
    root: str | os.PathLike[str] | None = None,
    jobs: int | None = None,
    progress: Progress = None,
    cancel: CancelToken | None = None,
) -> list[BatchRecord]:
    """Flatten many mesh files, on all cores or on a Dask cluster; a second call resumes.

    Every mesh is a process of its own: one that fails, crashes or is killed becomes a record with
    its failure, and the others go on. ``out_dir/batch.jsonl`` gets a line for each when it ends. A
    mesh is left out where that log has a result for it, or its refusal. The file (by path, size and
    time), the options and the version of the library have to be the same. Whatever crashed, was
    cancelled, or could not be read or written is tried again. One call at a time may use a folder.

    Parameters
    ----------
    paths : iterable of path
        Meshes in OBJ, OFF, PLY or STL files.
    out_dir : path
        Folder for the results, which is made if need be: files with UVs, named as the meshes.
    scheduler : str or distributed.Client, optional
        Address of a Dask scheduler, such as "tcp://host:8786", or a client of one. The jobs run on
        its workers, which need this version of the package and the same paths. There is one on each
        of their threads: with `threads` above 1, have as many fewer of those. Left out, they run as
        processes on this machine.
    suffix : {".obj", ".ply"}
        Format of the results.
    root : path, optional
        Folder above the meshes: results keep their path below it. Left out, all results lie in
        `out_dir` itself.
    jobs : int, optional
        Processes at a time on this machine; left out, as many as there are cores for `threads`.
    progress : bool or callable, optional
        As for `parameterize`; called when a mesh is done, with the fraction that is done and the
        mesh's path. Returning False ends the batch.
    cancel : CancelToken, optional
        Ends the batch from any thread; on a cluster once the next job is done.

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
    list of BatchRecord
        One for each path, in their order; failures are those that are not `ok`.

    Raises
    ------
    TypeError, ValueError
        For options as `Flattener` does; where two results would have the same name, or one would
        replace a mesh; for a mesh that is not below `root`.
    OSError
        Where the folder or the log cannot be written, or the scheduler not be reached.
    ImportError
        With a scheduler, but without Dask.
    Cancelled, KeyboardInterrupt
        Jobs under way are ended (on a cluster, only those that have not begun); another call
        resumes.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> lines = "v 0 0 0", "v 1 0 0", "v 1 1 1", "v 0 1 0", "f 1 2 3", "f 1 3 4"
    >>> _ = (folder / "flap.obj").write_text(chr(10).join(lines))
    >>> records = beltrami.batch(folder.glob("*.obj"), folder / "flat", threads=1)
    >>> [(record.output, record.status, record.injective) for record in records]
    [('flap.obj', 'BELTRAMI_OK', True)]
    """
    given: dict[str, object] = {
        # options: items
        "method": method,
        "energy": energy,
        "coarse_faces": coarse_faces,
        "tolerance": tolerance,
        "max_iterations": max_iterations,
        "threads": threads,
        "unit_square": unit_square,
        "flatten": flatten,
        "injectivity": injectivity,
        "refine": refine,
        "refine_iterations": refine_iterations,
        "time_limit": time_limit,
        "float32": float32,
        "delaunay": delaunay,
        "memory_limit": memory_limit,
        # end of options
    }
    options = _library.Context().set_options(given)  # refuses what is out of range
    task = _jobs.Task("flatten", _library.arguments(options), options, threads)
    return _jobs.run_batch(
        task,
        paths,
        out_dir,
        scheduler,
        suffix=suffix,
        root=root,
        jobs=jobs,
        progress=progress,
        cancel=cancel,
    )
