"""Runs of programs on meshes in processes with limits, and a file of those that need not run again.

A row of the file is a line of JSON: a mesh by name and by the hash of its positions and triangles,
a program with its version, and the figures or the error. It serves again where hash, program and
version are the same; an error at a limit only under limits that are no wider.
"""

from __future__ import annotations

import hashlib
import json
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from atlas_figures import Figures, components, measure, weld
from meshes import edges

import beltrami

WORKER = Path(__file__).with_name("atlas_programs.py")
# A process may wait for others, or sleep for ever: it gets this many times its CPU seconds.
PATIENCE = 10


@dataclass
class Mesh:
    """Triangles with area, vertices at one place welded."""

    name: str
    vertices: np.ndarray
    faces: np.ndarray

    def digest(self) -> str:
        """Return the hash of the contents."""
        parts = np.ascontiguousarray(self.vertices, "<f8"), np.ascontiguousarray(self.faces, "<i8")
        return hashlib.sha256(b"".join(part.tobytes() for part in parts)).hexdigest()

    def closed(self) -> bool:
        """Return whether no edge has one triangle only."""
        return bool((edges(self.faces)[2] > 1).all())

    def parts(self) -> int:
        """Count the parts that edges hold together."""
        edge = edges(self.faces)[1].ravel()
        order = np.argsort(edge, kind="stable")
        same = edge[order][1:] == edge[order][:-1]
        pairs = np.column_stack([order[1:][same], order[:-1][same]]) // 3
        return components(len(self.faces), pairs)


@dataclass(frozen=True)
class Program:
    """What unwraps: a rival, or ours with keywords."""

    name: str
    version: str = ""  # of a rival; "" where it is not installed
    keywords: Mapping[str, object] | None = None  # None: a rival

    def target(self) -> float | None:
        """Return the energy that it is asked for."""
        target = (self.keywords or {}).get("target_energy")
        return float(target) if isinstance(target, (int, float)) else None


@dataclass(frozen=True)
class Limits:
    """What a process may take."""

    seconds: float  # of CPU time
    gigabytes: float


@dataclass
class Row:
    """What came of one program on one mesh."""

    mesh: str
    digest: str
    faces: int
    program: str
    version: str
    figures: Figures | None = None
    cpu_seconds: float = 0.0  # of the call alone
    error: str = ""
    limits: Limits | None = None  # that the error came at

    def flat(self) -> dict[str, object]:
        """Return what is written of it."""
        head = {key: getattr(self, key) for key in ("mesh", "digest", "faces", "program")}
        if self.version:
            head["version"] = self.version
        if self.figures is None:
            return {**head, "error": self.error, **asdict(self)["limits"]}
        return {**head, **asdict(self.figures), "cpu_seconds": self.cpu_seconds}


def row_from(written: Mapping[str, Any]) -> Row:
    """Return a row that was written."""
    values = dict(written)
    head = {key: values.pop(key) for key in ("mesh", "digest", "faces", "program", "version")}
    if "error" in values:
        error = values.pop("error")
        return Row(**head, error=error, limits=Limits(**values))
    seconds = values.pop("cpu_seconds")
    return Row(**head, figures=Figures(**values), cpu_seconds=seconds)


class Cache:
    """The rows of rivals in a file, each added as soon as it is known."""

    def __init__(self, path: Path | None):
        self._path = path
        lines = path.read_text().splitlines() if path is not None and path.exists() else []
        self._rows = [row_from(json.loads(line)) for line in lines]

    def find(self, digest: str, program: Program, limits: Limits) -> Row | None:
        """Return the last row that serves; of a rival that is not installed, of any version."""
        for row in reversed(self._rows):
            same = (row.digest, row.program) == (digest, program.name)
            if same and program.version in ("", row.version) and serves(row, limits):
                return row
        return None

    def add(self, row: Row) -> None:
        """Keep a row."""
        self._rows.append(row)
        if self._path is not None:
            with self._path.open("a") as file:
                file.write(json.dumps(row.flat()) + "\n")

    def knows(self, program: str) -> bool:
        """Return whether there is a row of a program."""
        return any(row.program == program for row in self._rows)


def serves(row: Row, limits: Limits) -> bool:
    """Return whether a row would be the same under these limits."""
    if row.limits is None:
        return row.cpu_seconds <= limits.seconds
    return limits.seconds <= row.limits.seconds and limits.gigabytes <= row.limits.gigabytes


def load(path: Path) -> Mesh:
    """Read the triangles of a file."""
    import trimesh

    mesh = trimesh.load(path, force="mesh", process=False)
    vertices, faces = np.asarray(mesh.vertices, float), np.asarray(mesh.faces, np.int64)
    if not np.isfinite(vertices).all():
        raise ValueError("a coordinate is not finite")
    vertices, faces = weld(vertices, faces)
    if not len(faces):
        raise ValueError("no triangle has area")
    return Mesh(path.name, vertices, faces)


def versions(python: Path) -> dict[str, str]:
    """Return the versions of the rivals that load in an environment."""
    found = subprocess.run(
        [python, "-B", WORKER, "--versions"], capture_output=True, text=True, check=True
    )
    return dict(json.loads(found.stdout.splitlines()[-1]))


def end_of(status: int) -> str:
    """Say how a process ended that left no result."""
    if -status == signal.SIGXCPU:
        return "stopped at the time limit"
    if status < 0:
        return f"crashed: {signal.Signals(-status).name}"
    return f"ended with status {status}"


def run(python: Path, program: Program, mesh: Mesh, limits: Limits) -> Row:
    """Run a program on a mesh, and measure what it made."""
    row = Row(mesh.name, mesh.digest(), len(mesh.faces), program.name, program.version)
    ours = program.keywords is not None
    with tempfile.TemporaryDirectory() as folder:
        given, made = Path(folder, "mesh.npz"), Path(folder, "made.npz")
        np.savez(given, vertices=mesh.vertices, faces=mesh.faces)
        command = [
            sys.executable if ours else python,
            "-B",
            WORKER,
            "ours" if ours else row.program,
        ]
        command += [given, made, json.dumps(dict(program.keywords or {})), str(limits.seconds)]
        command += [str(int(limits.gigabytes * 2**30))]
        try:
            wait = PATIENCE * (limits.seconds + 60)
            status = subprocess.run(command, capture_output=True, timeout=wait).returncode
            row.error = "" if made.exists() else end_of(status)
        except subprocess.TimeoutExpired:
            row.error = "hung"
        if not row.error:
            with np.load(made) as result:
                if "error" in result:
                    row.error = str(result["error"])
                else:
                    row.cpu_seconds = round(float(result["seconds"]), 4)
                    uvs, page = result["uvs"], tuple(result["page"].tolist())
                    row.figures = measure(mesh.vertices, mesh.faces, uvs, page)
    if row.error:
        row.limits = limits
    return row


def own_version() -> str:
    """Return our version."""
    return beltrami.build_info().split(",")[0]
