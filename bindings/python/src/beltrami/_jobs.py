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
from collections.abc import Generator, Iterable
from concurrent import futures
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

from . import _library, _program
from ._cancel import CancelToken, ending
from ._cancel import check as check_token
from ._errors import Cancelled
from ._progress import Progress, hook_for

LOG = "batch.jsonl"
# Exit codes of the program after which another try would end the same (docs/report.md): injective,
# unusable mesh, not injective. But what is wrong with a file, or with a full disk, may be mended.
_UNUSABLE = 2
_FINAL = (0, _UNUSABLE, 3)
_FILE_ERROR = "FILE_ERROR"
_REQUEST_TO_CANCEL = -6  # BELTRAMI_E_CANCELLED


@dataclass(frozen=True)
class BatchRecord:
    """What became of one mesh of a `batch` or an `unwrap_batch`; a line of its log.

    Attributes
    ----------
    input, output : str
        Path of the mesh, and name of the file with UVs in the folder of results.
    status : str
        A status of the library such as "BELTRAMI_OK" or "BELTRAMI_E_CLOSED". "FILE_ERROR" is for a
        file that could not be read or written. "PROCESS_DIED" says that the process was killed or
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
class Task:
    """What is to be done with every mesh."""

    command: str  # of the program
    arguments: list[str]
    options: dict[str, object]  # what the result depends on, and the threads
    threads: int
    suffixes: tuple[str, ...] = (".obj", ".ply")  # of results


@dataclass(frozen=True)
class Job:
    """One mesh to work on: plain values, for it goes to other machines."""

    input: str
    output: str  # path
    name: str  # of the output in the folder of results
    command: str
    arguments: list[str]
    identity: dict[str, Any] | None  # of what the result depends on; None without an input


def run_batch(
    task: Task,
    paths: Iterable[str | os.PathLike[str]],
    out_dir: str | os.PathLike[str],
    scheduler: Any,
    *,
    suffix: str | None,
    root: str | os.PathLike[str] | None,
    jobs: int | None,
    progress: Progress,
    cancel: CancelToken | None,
) -> list[BatchRecord]:
    """Do a task with many files; arguments, result and errors are those of `batch`."""
    if isinstance(paths, (str, os.PathLike)):
        raise TypeError(f"paths is {paths!r}: give a list of paths, such as glob.glob('*.ply')")
    if suffix not in (*task.suffixes, None):
        raise ValueError(f"suffix is {suffix!r}: give {' or '.join(map(repr, task.suffixes))}")
    check_token(cancel)
    folder = Path(out_dir)
    work = [_job(path, folder, suffix, root, task) for path in paths]
    _require_distinct(work)
    folder.mkdir(parents=True, exist_ok=True)
    known = _read_log(folder / LOG)
    done = {job.name: known[job.name] for job in work if _is_done(job, known.get(job.name))}
    left = list({job.name: job for job in work if job.name not in done}.values())
    if jobs is None:
        jobs = cores() // task.threads
    run = _on_processes(left, jobs, cancel) if scheduler is None else _on_dask(left, scheduler)
    fresh: dict[str, dict[str, Any]] = {}
    with hook_for(progress) as hook, _open_log(folder / LOG) as log:
        try:
            for job, line in run:
                check_token(cancel)  # before what it ended is taken for a failure
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
    suffix: str | None,
    root: str | os.PathLike[str] | None,
    task: Task,
) -> Job:
    if not isinstance(path, (str, os.PathLike)):
        kind = type(path).__name__
        raise TypeError(f"paths has a {kind}: give files, and meshes to parameterize or unwrap")
    path = Path(path).absolute()
    below = path.relative_to(Path(root).absolute()) if root is not None else Path(path.name)
    if suffix is None:
        suffix = path.suffix.lower() if path.suffix.lower() in task.suffixes else task.suffixes[0]
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
            "options": {key: value for key, value in task.options.items() if key != "threads"},
            "version": _library.version(),
        }
    output = str((folder / name).absolute())
    return Job(str(path), output, name.as_posix(), task.command, task.arguments, identity)


def cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _require_distinct(work: list[Job]) -> None:
    meshes = {os.path.realpath(job.input) for job in work}
    inputs: dict[str, str] = {}
    for job in work:
        if os.path.realpath(job.output) in meshes:
            raise ValueError(
                f"{job.output} is a mesh of the batch: name another folder for results"
            )
        other = inputs.setdefault(job.name, job.input)
        if other != job.input:
            raise ValueError(
                f"{other} and {job.input} would both become {job.name}: name a root, so that "
                "results keep their folders"
            )


def run_job(job: Job) -> dict[str, Any]:
    """Do a job in a process of its own; return the line for the log. Dask calls it."""
    return _run_job(job, _Processes())


def _run_job(job: Job, processes: _Processes) -> dict[str, Any]:
    try:
        return _work(job, processes)
    except OSError as error:
        return _line(job, _UNUSABLE, str(error), None)


def _work(job: Job, processes: _Processes) -> dict[str, Any]:
    Path(job.output).parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="beltrami-") as scratch:
        report_path = Path(scratch) / "report.json"
        command = [str(_program.path()), job.command, job.input, job.output, "--quiet"]
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


def _on_processes(
    work: list[Job], count: int, cancel: CancelToken | None
) -> Generator[tuple[Job, dict[str, Any]], None, None]:
    """Yield jobs with their lines as they end; closing it ends those under way."""
    processes = _Processes()
    pool = futures.ThreadPoolExecutor(max_workers=max(1, count))
    try:
        with ending(cancel, processes.end):
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
