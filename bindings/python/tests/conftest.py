"""Meshes and places that the tests share."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[3]
BUST = ROOT / "examples" / "data" / "nefertiti_disk.obj"


def grid(rows: int, height: float = 0.6) -> tuple[np.ndarray, np.ndarray]:
    """Return a square with a hump: (rows + 1)^2 vertices, 2 rows^2 faces."""
    x, y = np.meshgrid(np.linspace(-1, 1, rows + 1), np.linspace(-1, 1, rows + 1))
    z = height * np.exp(-3 * (x**2 + y**2))
    corner = (np.arange(rows)[:, None] * (rows + 1) + np.arange(rows)).ravel()
    right, above = corner + 1, corner + rows + 1
    faces = np.concatenate(
        [np.stack([corner, right, above], 1), np.stack([right, above + 1, above], 1)]
    )
    return np.stack([x.ravel(), y.ravel(), z.ravel()], 1), faces


def read_obj(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the vertices, the UVs and the faces of a file that has one UV a vertex, or none."""
    rows: dict[str, list[list[str]]] = {"v": [], "vt": [], "f": []}
    for line in path.read_text().splitlines():
        words = line.split()
        if words and words[0] in rows:
            rows[words[0]].append(words[1:])
    faces = [[int(corner.split("/")[0]) - 1 for corner in face] for face in rows["f"]]
    return np.array(rows["v"], float), np.array(rows["vt"], float), np.array(faces)


def write_obj(path: Path, vertices: np.ndarray, faces: np.ndarray) -> Path:
    """Write a mesh so that every bit of it comes back; return the path."""
    lines = ["v {!r} {!r} {!r}".format(*map(float, vertex)) for vertex in vertices]
    lines += ["f {} {} {}".format(*(np.asarray(face) + 1)) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.fixture(autouse=True)
def ctrl_c_is_not_ignored() -> Iterator[None]:
    """Have Ctrl-C raise KeyboardInterrupt, though a shell has started this job with it ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def hump() -> tuple[np.ndarray, np.ndarray]:
    """Return a mesh that takes some milliseconds; one byte counts its 169 vertices."""
    return grid(12)


@pytest.fixture(scope="session")
def bust() -> tuple[np.ndarray, np.ndarray]:
    """Return the scanned bust: 70,000 faces."""
    vertices, _, faces = read_obj(BUST)
    return vertices, faces
