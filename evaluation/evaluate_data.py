"""The data set of ./dev evaluate, by the recipe of the paper.

Disks are taken as they are. Closed meshes of genus 0 are opened along short seams, and give the
meshes without one triangle. Those on which CM ends at a mean energy of 2.5 or more are kept and
refined without a change of their surface: all edges halved as long as that fits, the longest ones
after that.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from meshes import (
    FOLDER,
    areas,
    edges,
    is_sphere,
    nested_seams,
    open_along,
    quarter,
    read_obj,
    refine,
)

LEAST_ENERGY = 2.5  # the paper's cut, on the base mesh
SMALLEST, LARGEST = 20_000, 4_000_000  # faces of the paper's data set
SEAMS = (2, 3)  # points that the seams of closed meshes join: more, and most are below the cut
BODIES = 5  # closed meshes made here, beside those of the examples
BODY = "body:"
BODY_FACES = 8_000
SUFFIXES = {".obj", ".off", ".ply", ".stl"}


@dataclass(frozen=True)
class Mesh:
    """A mesh that runs are of: plain values, from which it is made wherever it is needed."""

    name: str
    source: str  # path of a file, or "body:" with a number
    digest: str  # of the source
    seam: int = 0  # points that a closed mesh is opened through
    punctured: bool = False  # a closed mesh without one face
    faces: int = 0  # to refine to; 0 leaves it as it is

    def key(self) -> str:
        """Return what tells it from others, whatever the name of its file."""
        return f"{self.digest}/{self.seam}/{int(self.punctured)}/{self.faces}"

    def flat(self) -> dict[str, Any]:
        """Return its values, for a process that makes it."""
        return asdict(self)


@dataclass(frozen=True)
class Base:
    """A base mesh, before it is known whether it is kept."""

    mesh: Mesh
    faces: int  # that it has
    main: bool  # whether it is of the data set, or only punctured


def body(seed: int, faces: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a closed surface with limbs, star-shaped around the origin, the same at every call."""
    random = np.random.default_rng(seed)
    axes = np.vstack([np.eye(3), -np.eye(3)])
    upper = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2]])
    octahedron = np.vstack([upper, np.where(upper == 2, 5, upper)[:, ::-1]])
    vertices, corners = axes[[0, 1, 2, 3, 4, 5]], octahedron
    while 4 * len(corners) <= faces:
        vertices, corners = quarter(vertices, corners)
        vertices = vertices / np.linalg.norm(vertices, axis=1)[:, None]
    limbs = random.normal(size=(int(random.integers(6, 10)), 3))
    limbs /= np.linalg.norm(limbs, axis=1)[:, None]
    lengths = random.uniform(1.5, 3, len(limbs))
    widths = random.uniform(15, 30, len(limbs))
    bumps = (lengths * np.exp(widths * (vertices @ limbs.T - 1))).sum(axis=1)
    vertices = vertices * (1 + bumps)[:, None]
    # Limbs have long faces: what is split is the longest.
    return refine(vertices, corners, faces, smooth=False)


def load(source: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the triangles of a source, scaled to area 1; raises ValueError where it has others."""
    if source.startswith(BODY):
        return body(int(source[len(BODY) :]), BODY_FACES)
    path = Path(source)
    if path.suffix.lower() == ".obj":
        vertices, faces = read_obj(path)
    else:
        import trimesh

        read = trimesh.load(path, force="mesh", process=False)
        vertices, faces = np.asarray(read.vertices, float), np.asarray(read.faces, np.int64)
    if faces.ndim != 2 or faces.shape[1] != 3 or not len(faces):
        raise ValueError("it has no triangles, or other polygons as well")
    return vertices, faces


def digest_of(source: str) -> str:
    """Return a hash of the contents of a source."""
    if source.startswith(BODY):
        known = b"".join(array.tobytes() for array in load(source))
    else:
        known = Path(source).read_bytes()
    return hashlib.sha256(known).hexdigest()[:16]


def boundary_edges(faces: np.ndarray) -> int:
    """Count the edges of one face; raises ValueError where one has more than two."""
    _, _, count = edges(faces)
    if (count > 2).any():
        raise ValueError("an edge has more than two triangles")
    return int((count == 1).sum())


def bases_of(source: str) -> Iterator[Base]:
    """Yield the base meshes that a source gives; raises ValueError where it gives none."""
    vertices, faces = load(source)
    name = source.replace(":", " ") if source.startswith(BODY) else Path(source).stem
    mesh = Mesh(name, source, digest_of(source))
    if is_sphere(vertices, faces):
        values = {**mesh.flat(), "punctured": True}
        yield Base(Mesh(**{**values, "name": f"{name} punctured"}), len(faces) - 1, main=False)
        for seam in SEAMS:
            values = {**mesh.flat(), "name": f"{name} cut {seam}", "seam": seam}
            yield Base(Mesh(**values), len(faces), main=True)
        return
    border = boundary_edges(faces)
    if border == 0 or len(np.unique(faces)) - (3 * len(faces) + border) // 2 + len(faces) != 1:
        raise ValueError("it is neither a disk nor closed with genus 0")
    yield Base(mesh, len(faces), main=border > 3)  # one face short of closed is punctured


def sources_of(folders: Sequence[Path]) -> list[str]:
    """Return the files in folders, or what comes with the project where none is given."""
    if not folders:
        shipped = sorted(str(path) for path in FOLDER.glob("*.obj"))
        return shipped + [f"{BODY}{seed}" for seed in range(1, BODIES + 1)]
    paths = (path for folder in folders for path in sorted(folder.iterdir()))
    return [str(path.resolve()) for path in paths if path.suffix.lower() in SUFFIXES]


def read_bases(sources: Iterable[str]) -> tuple[list[Base], dict[str, str]]:
    """Return the base meshes of sources, and why others give none, by name."""
    found: list[Base] = []
    refused: dict[str, str] = {}
    for source in sources:
        try:
            found += bases_of(source)
        except Exception as error:  # of trimesh, on broken files
            refused[Path(source).name] = str(error)
    return found, refused


def make(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices (n, 3) and faces (m, 3) of a mesh, of area 1."""
    vertices, faces = load(mesh.source)
    if mesh.punctured and boundary_edges(faces) == 0:
        faces = faces[1:]
    if mesh.seam:
        seams = nested_seams(vertices, faces, [mesh.seam])[0]
        vertices, faces = open_along(vertices, faces, seams)
    if mesh.faces:
        vertices, faces = refine(vertices, faces, mesh.faces, smooth=False)
    return vertices / np.sqrt(areas(vertices, faces).sum()), faces


def sizes(count: int, smallest: int = SMALLEST, largest: int = LARGEST) -> list[int]:
    """Return numbers of faces, each the same multiple of the one before."""
    if count == 1:
        return [smallest]
    return [round(smallest * (largest / smallest) ** (k / (count - 1))) for k in range(count)]


def ladder(bases: Sequence[Base], count: int) -> list[Mesh]:
    """Return base meshes refined to sizes spread evenly (on a logarithmic scale), ascending.

    All bases take turns, in an order that changes with every round: none is always the largest. A
    base that has more faces than a size leaves it to others; a size is skipped where all have.
    """
    random = np.random.default_rng(1)
    used = [0] * len(bases)
    meshes = []
    for size in sizes(count):
        free = [k for k, base in enumerate(bases) if base.faces <= size * 1.05]
        if not free:
            continue
        tie = random.permutation(len(bases))
        chosen = min(free, key=lambda k: (used[k], tie[k]))
        used[chosen] += 1
        values = {**bases[chosen].mesh.flat(), "faces": size}
        meshes.append(Mesh(**values))
    return meshes
