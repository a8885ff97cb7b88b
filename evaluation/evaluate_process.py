"""Does a run of ./dev evaluate in processes of its own. Dask takes this module to its workers.

So it needs the standard library alone; everything else is found where the task says.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

PREPARING = 600.0  # seconds that a mesh may take to be made
STOPPED = "STOPPED"  # at the end of the budget: no result, and not recorded
ENDED = {"status": STOPPED, "error": "the budget ended"}


def execute(task: dict[str, Any]) -> dict[str, Any]:
    """Run a task; return the figures, or a status that says how it failed.

    ``task`` has the interpreters (``python``, and ``own`` of our package), the path ``worker`` of
    evaluate_worker.py, ``mesh`` (values) and ``made`` (the file that it is kept in), ``program``,
    ``options``, ``limit`` (CPU seconds), ``wall`` (seconds until the budget ends), and ``uv``, the
    file for the UVs where ``keep``.
    """
    start = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="evaluate-") as folder:
        found = _in_folder(task, Path(folder), start + task["wall"])
    found["wall"] = round(time.monotonic() - start, 3)
    return found


def _in_folder(task: dict[str, Any], folder: Path, deadline: float) -> dict[str, Any]:
    made, out = Path(task["made"]), folder / "out.json"
    if not made.exists():
        made.parent.mkdir(parents=True, exist_ok=True)
        mesh = folder / "mesh.json"
        mesh.write_text(json.dumps(task["mesh"]))
        command = [task["own"], "-B", task["worker"], "prepare", str(mesh), str(made)]
        failure = _call(command, min(deadline, time.monotonic() + PREPARING))
        if failure:
            return failure
    values = folder / "run.json"
    keep, uv = task["keep"], task["uv"]
    if keep:
        Path(uv).parent.mkdir(parents=True, exist_ok=True)
    given = {key: task[key] for key in ("program", "options", "limit", "keep")}
    values.write_text(json.dumps({**given, "uv": uv if keep else str(folder / "uv.npz")}))
    command = [task["python"], "-B", task["worker"], "run", str(made), str(values), str(out)]
    failure = _call(command, deadline)
    if not failure and task["python"] != task["own"]:
        uv = json.loads(values.read_text())["uv"]
        command = [task["own"], "-B", task["worker"], "judge", str(made), uv, str(values), str(out)]
        failure = _call(command, deadline)
    if failure:
        return failure
    found: dict[str, Any] = json.loads(out.read_text())
    return found


def _call(command: list[str], deadline: float) -> dict[str, Any]:
    """Run a command on one thread; return nothing, or how it failed."""
    left = deadline - time.monotonic()
    if left <= 0:
        return dict(ENDED)
    one = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
    try:
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            env={**os.environ, **one},
            timeout=left,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return dict(ENDED)
    if done.returncode == 0:
        return {}
    if -done.returncode == signal.SIGXCPU:
        return {"status": "TIMEOUT", "error": "more CPU seconds than a run may take"}
    name = f"exit code {done.returncode}"
    if done.returncode < 0:
        name = signal.Signals(-done.returncode).name
    return {"status": "CRASHED", "error": f"{name}: {done.stderr.strip()[-300:]}"}
