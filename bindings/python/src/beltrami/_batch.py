"""Many meshes in one go: each is a job that runs the program `beltrami` as a process of its own.

So a job that crashes or is killed takes nothing with it, and what a job needs of memory is given
back. The log has one JSON object a line, written when a job ends.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import tempfile
import threading
from collections.abc import Generator, Iterable, Mapping
from concurrent import futures
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

from . import _library, _program
from ._errors import Cancelled
from ._progress import Progress, hook_for
from ._tables import EnergyChoice, FlattenChoice, InjectivityChoice, MethodChoice

LOG = "batch.jsonl"
# Exit codes of the program after which another try would end the same (docs/report.md): injective,
# unusable mesh, not injective. But what is wrong with a file, or with a full disk, may be mended.
_UNUSABLE = 2
_FINAL = (0, _UNUSABLE, 3)
_FILE_ERROR = "FILE_ERROR"
_REQUEST_TO_CANCEL = -6  # BELTRAMI_E_CANCELLED


@dataclass(frozen=True)
class BatchRecord:
    """What became of one mesh of a `batch`; a line of its log.

    Attributes
    ----------
    input, output : str
        Path of the mesh, and name of the file with UVs in the folder of results.
    status : str
        A status of the library such as "BELTRAMI_OK" or "BELTRAMI_E_CLOSED"; "FILE_ERROR" for a
        file that could not be read or written; "PROCESS_DIED" where the process was killed or
        crashed, or the worker it ran on.
    message : str | None
        Of a failure: one sentence.
    injective : bool | None
        The exact verdict on the UVs in the file; None where there is no result.
    report : dict | None
        The report of the program (docs/report.md), where it came to write one.
    resumed : bool
        Whether an earlier call did the work. Not in the log.
    """

    input: str
    output: str
    status: str
    message: str | None
    injective: bool | None
    report: dict[str, Any] | None = field(repr=False)
    resumed: bool = False

    @property
    def ok(self) -> bool:
        """Whether there is a result."""
        return self.injective is not None


@dataclass(frozen=True)
class Job:
    """One mesh to flatten: plain values, for it goes to other machines."""

    input: str
    output: str  # path
    name: str  # of the output in the folder of results
    arguments: list[str]
    identity: dict[str, Any] | None  # of what the result depends on; None without an input


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
) -> list[BatchRecord]:
    """Flatten many mesh files, on all cores or on a Dask cluster; a second call resumes.

    Every mesh is a process of its own: one that fails, crashes or is killed becomes a record with
    its failure, and the others go on. ``out_dir/batch.jsonl`` gets a line for each when it ends. A
    mesh is left out where that log has a result for it, or its refusal, and neither the file (by
    path, size and time), nor the options, nor the version of the library are others since; whatever
    crashed, was cancelled, or could not be read or written is tried again. One call at a time may
    use a folder.

    Parameters
    ----------
    paths : iterable of path
        Meshes in OBJ, OFF, PLY or STL files.
    out_dir : path
        Folder for the results, which is made if need be: files with UVs, named as the meshes.
    scheduler : str or distributed.Client, optional
        Address of a Dask scheduler, such as "tcp://host:8786", or a client of one: the jobs run on
        its workers, which need this version of the package and the same paths, one on each of
        their threads: with `threads` above 1, have as many fewer of those. Left out, they run as
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

    Options
    -------
    method : {"beltrami", "cm", "tutte", "gif", "bff", "uv-prolongation"}, default "beltrami"
        How the map is computed: beltrami (fast and low in distortion), cm (composite majorization
        on the full mesh, the slow reference), tutte (into a circle, highly distorted), or a
        baseline to compare with: gif and bff on the surface's own metric, uv-prolongation of the
        coarse UVs (bff and uv-prolongation may flip).
    energy : {"symmetric-dirichlet", "symmetric-arap"}, default "symmetric-dirichlet"
        The distortion that is minimised.
    coarse_faces : int, default 0
        Faces of the simplified mesh that composite majorization runs on; 0 chooses 1% of the faces,
        at least 10,000. A number from 0 to 700,000,000.
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
        True scales and shifts the UVs into the unit square; False keeps them in the mesh's unit of
        length.
    flatten : {"metric", "dirichlet", "gif", "flim", "bff"}, default "metric"
        How the method beltrami flattens the fine mesh: metric (Poisson solve with a free boundary
        and a polish), dirichlet (harmonic, boundary from the coarse map: faster, energy a little
        higher), gif (harmonic subspace of a few boundary vertices with a scaffold), flim (the same,
        local injectivity only) or bff (conformal, may flip).
    injectivity : {"auto", "global", "local"}, default "auto"
        What the optimisation sees to: global (no flips, no boundary crossings), local (no flips:
        parts may overlap, at a slightly lower energy) or auto (global, but for the method cm, which
        is left as the literature has it).
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
        Bytes of memory that a run is to stay within by its estimate: one that needs more ends
        before it starts, and steps that only hard meshes need are left out where they would exceed
        it; 0 sets no limit. A number from 0 to 1e+14.

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
    if isinstance(paths, (str, os.PathLike)):
        raise TypeError(f"paths is {paths!r}: give a list of paths, such as glob.glob('*.ply')")
    if suffix not in (".obj", ".ply"):
        raise ValueError(f"suffix is {suffix!r}: give '.obj' or '.ply'")
    folder = Path(out_dir)
    work = [_job(path, folder, suffix, root, options) for path in paths]
    _require_distinct(work)
    folder.mkdir(parents=True, exist_ok=True)
    known = _read_log(folder / LOG)
    done = {job.name: known[job.name] for job in work if _is_done(job, known.get(job.name))}
    left = list({job.name: job for job in work if job.name not in done}.values())
    if jobs is None:
        jobs = _cores() // threads
    run = _on_processes(left, jobs) if scheduler is None else _on_dask(left, scheduler)
    fresh: dict[str, dict[str, Any]] = {}
    with hook_for(progress) as hook, _open_log(folder / LOG) as log:
        try:
            for job, line in run:
                fresh[job.name] = line
                log.write(json.dumps(line).encode() + b"\n")
                log.flush()
                if hook((len(done) + len(fresh)) / (len(done) + len(left)), job.input):
                    raise Cancelled(
                        "the batch was cancelled", _REQUEST_TO_CANCEL, "BELTRAMI_E_CANCELLED"
                    )
        finally:
            run.close()  # ends the jobs under way
    return [
        _record(done[job.name], True) if job.name in done else _record(fresh[job.name], False)
        for job in work
    ]


# ---- Jobs ---------------------------------------------------------------------------------


def _job(
    path: str | os.PathLike[str],
    folder: Path,
    suffix: str,
    root: str | os.PathLike[str] | None,
    options: Mapping[str, object],
) -> Job:
    if not isinstance(path, (str, os.PathLike)):
        kind = type(path).__name__
        raise TypeError(f"paths has a {kind}: give files, and meshes to parameterize")
    path = Path(path).absolute()
    below = path.relative_to(Path(root).absolute()) if root is not None else Path(path.name)
    name = below.with_suffix(suffix)
    try:
        status = path.stat()
    except OSError:
        identity = None
    else:
        identity = {
            "size": status.st_size,
            "mtime_ns": status.st_mtime_ns,
            # The result does not depend on the number of threads.
            "options": {key: value for key, value in options.items() if key != "threads"},
            "version": _library.version(),
        }
    arguments = _library.arguments(options)
    return Job(str(path), str((folder / name).absolute()), name.as_posix(), arguments, identity)


def _cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _require_distinct(work: list[Job]) -> None:
    meshes = {os.path.realpath(job.input) for job in work}
    inputs: dict[str, str] = {}
    for job in work:
        if os.path.realpath(job.output) in meshes:
            raise ValueError(f"{job.output} is a mesh to flatten: name another folder for results")
        other = inputs.setdefault(job.name, job.input)
        if other != job.input:
            raise ValueError(
                f"{other} and {job.input} would both become {job.name}: name a root, so that "
                "results keep their folders"
            )


def run_job(job: Job) -> dict[str, Any]:
    """Flatten one mesh in a process of its own; return the line for the log. Dask calls it."""
    return _run_job(job, _Processes())


def _run_job(job: Job, processes: _Processes) -> dict[str, Any]:
    try:
        return _flatten(job, processes)
    except OSError as error:
        return _line(job, _UNUSABLE, str(error), None)


def _flatten(job: Job, processes: _Processes) -> dict[str, Any]:
    Path(job.output).parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="beltrami-") as scratch:
        report_path = Path(scratch) / "report.json"
        command = [str(_program.path()), "flatten", job.input, job.output, "--quiet"]
        command += ["--report", str(report_path), *job.arguments]
        code, stderr = processes.run(command)
        report = None
        if report_path.exists():
            report = json.loads(report_path.read_text(encoding="utf-8"))
    return _line(job, code, stderr, report)


def _line(job: Job, code: int, stderr: str, report: dict[str, Any] | None) -> dict[str, Any]:
    verdict = None
    status, message = "PROCESS_DIED", f"the process ended with {_name_of(code)}"
    if report is not None:
        status, message = report["status"], report["message"]
        verdict = (report["injective"] or {}).get("result") if code in (0, 3) else None
    elif code == _UNUSABLE:
        status, message = _FILE_ERROR, stderr.strip()
    return {
        "input": job.input,
        "output": job.name,
        "status": status,
        "message": message,
        "injective": verdict,
        "exit_code": code,
        "identity": job.identity,
        "report": report,
    }


def _name_of(code: int) -> str:
    try:
        return signal.Signals(-code).name if code < 0 else f"exit code {code}"
    except ValueError:
        return f"signal {-code}"


class _Processes:
    """The processes under way, so that they can be ended."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._running: set[subprocess.Popen[str]] = set()
        self._ended = False

    def run(self, command: list[str]) -> tuple[int, str]:
        """Run a command; return its exit code (below 0: a signal's number) and its stderr."""
        with self._lock:
            if self._ended:
                return -signal.SIGTERM, ""
            process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                text=True,
                errors="replace",
            )
            self._running.add(process)
        try:
            _, stderr = process.communicate()
        finally:
            with self._lock:
                self._running.discard(process)
        return process.returncode, stderr

    def end(self) -> None:
        """End the processes, and let none begin."""
        with self._lock:
            self._ended = True
            for process in self._running:
                process.terminate()


def _on_processes(work: list[Job], count: int) -> Generator[tuple[Job, dict[str, Any]], None, None]:
    """Yield jobs with their lines as they end; closing it ends those under way."""
    processes = _Processes()
    pool = futures.ThreadPoolExecutor(max_workers=max(1, count))
    try:
        running = {pool.submit(_run_job, job, processes): job for job in work}
        for future in futures.as_completed(running):
            yield running[future], future.result()
    finally:
        processes.end()
        pool.shutdown(cancel_futures=True)


def _on_dask(work: list[Job], scheduler: Any) -> Generator[tuple[Job, dict[str, Any]], None, None]:
    """Do the same on the workers of a Dask cluster."""
    if not work:
        return
    from distributed import Client, as_completed

    client = scheduler if isinstance(scheduler, Client) else Client(scheduler)
    waiting, ended = list(reversed(work)), as_completed()
    running: dict[Any, Job] = {}
    try:
        while waiting or running:
            # No more than can run: a worker that dies would have those blamed that wait for it.
            while waiting and len(running) < max(1, sum(client.nthreads().values())):
                job = waiting.pop()
                future = client.submit(run_job, job, pure=False)
                running[future] = job
                ended.add(future)
            future = next(ended)
            job = running.pop(future)
            yield job, _line_from_dask(job, future)
    finally:
        client.cancel(list(running))
        if client is not scheduler:
            client.close()


def _line_from_dask(job: Job, future: Any) -> dict[str, Any]:
    if future.status == "finished":
        line: dict[str, Any] = future.result()
        return line
    # Its worker died, more often than the scheduler tries again; or lacks this package.
    line = _line(job, -signal.SIGKILL, "", None)
    return {**line, "message": f"the worker failed: {future.exception()!r}"}


# ---- The log ------------------------------------------------------------------------------


def _read_log(path: Path) -> dict[str, dict[str, Any]]:
    """Return the last line for each output. Lines that were cut off by a kill are left out."""
    lines: dict[str, dict[str, Any]] = {}
    if not path.exists():
        return lines
    for text in path.read_bytes().splitlines():
        try:
            line = json.loads(text)
            lines[line["output"]] = line
        except (ValueError, TypeError, KeyError):
            continue
    return lines


def _open_log(path: Path) -> IO[bytes]:
    log = path.open("ab")
    if log.tell() > 0:
        with path.open("rb") as tail:
            tail.seek(-1, os.SEEK_END)
            if tail.read() != b"\n":  # a kill cut the last line off
                log.write(b"\n")
    return log


def _is_done(job: Job, line: dict[str, Any] | None) -> bool:
    if line is None or job.identity is None or line.get("identity") != job.identity:
        return False
    if line.get("input") != job.input or line.get("status") == _FILE_ERROR:
        return False
    has_result = line.get("injective") is not None
    return line.get("exit_code") in _FINAL and (not has_result or Path(job.output).exists())


def _record(line: dict[str, Any], resumed: bool) -> BatchRecord:
    return BatchRecord(
        input=line["input"],
        output=line["output"],
        status=line["status"],
        message=line["message"],
        injective=line["injective"],
        report=line["report"],
        resumed=resumed,
    )
