"""The meshes of the benchmarks: read, refined, and opened along seams. Needs NumPy alone."""

from __future__ import annotations

import heapq
from pathlib import Path

import numpy as np

FOLDER = Path(__file__).resolve().parents[1] / "examples" / "data"


def read_obj(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices (n, 3) and faces (m, 3), scaled to area 1; other polygons are an error."""
    lines = [line.split() for line in path.read_text().splitlines()]
    vertices = np.array([words[1:4] for words in lines if words[:1] == ["v"]], float)
    corners = [[w.split("/")[0] for w in words[1:]] for words in lines if words[:1] == ["f"]]
    faces = np.array(corners, np.int64) - 1
    return vertices / np.sqrt(areas(vertices, faces).sum()), faces


def areas(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Return the areas of faces in space or in the plane, (m,)."""
    a, b, c = (points[faces[:, k]] for k in range(3))
    if points.shape[1] == 2:
        u, v = b - a, c - a
        return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def edges(faces: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return edges (e, 2), those of each face (m, 3), k from corner k, and their faces' number."""
    sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    most = int(faces.max(initial=0)) + 1
    keys = sides[:, 0].astype(np.int64) * most + sides[:, 1]
    found, of_side, count = np.unique(keys, return_inverse=True, return_counts=True)
    return np.column_stack(np.divmod(found, most)), of_side.reshape(-1, 3), count


def is_sphere(vertices: np.ndarray, faces: np.ndarray) -> bool:
    """Return whether a mesh is closed with the Euler number of a sphere: one, if in one piece."""
    ends, _, count = edges(faces)
    return bool((count == 2).all()) and len(vertices) - len(ends) + len(faces) == 2


def quarters(faces: np.ndarray, middles: np.ndarray) -> np.ndarray:
    """Return four faces for each, whose edges have these vertices, (m, 3), in their middles."""
    (a, b, c), (ab, bc, ca) = faces.T, middles.T
    return np.hstack([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]).T


def quarter(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the same surface, with a boundary or none, in four times the faces."""
    ends, of_face, _ = edges(faces)
    points = np.vstack([vertices, vertices[ends].mean(axis=1)])
    return points, quarters(faces, len(vertices) + of_face)


def subdivide(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a closed surface with four times the faces, by Loop's rules."""
    ends, of_face, _ = edges(faces)
    count = len(vertices)
    valence = np.bincount(ends.ravel(), minlength=count)[:, None]
    ring, wings = np.zeros_like(vertices), np.zeros((len(ends), 3))
    for here, there in (ends.T, ends.T[::-1]):
        np.add.at(ring, here, vertices[there])
    np.add.at(wings, of_face, vertices[np.roll(faces, -2, axis=1)])
    beta = (0.625 - (0.375 + 0.25 * np.cos(2 * np.pi / valence)) ** 2) / valence
    moved = (1 - valence * beta) * vertices + beta * ring
    middles = 0.375 * vertices[ends].sum(axis=1) + 0.125 * wings
    return np.vstack([moved, middles]), quarters(faces, count + of_face)


def split_longest(
    vertices: np.ndarray, faces: np.ndarray, target: int
) -> tuple[np.ndarray, np.ndarray]:
    """Split edges that are the longest of all their faces, up to `target` faces."""
    ends, of_face, count = edges(faces)
    length = np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1)
    rank = length.argsort(kind="stable").argsort(kind="stable")
    first = rank[of_face].argmax(axis=1)
    longest = np.take_along_axis(of_face, first[:, None], axis=1).ravel()
    chosen = np.flatnonzero(np.bincount(longest, minlength=len(ends)) == count)
    chosen = chosen[np.argsort(-rank[chosen])]
    more = np.cumsum(count[chosen]) - count[chosen]  # faces from the edges before each
    chosen = chosen[more < target - len(faces)]
    middle = np.full(len(ends), -1)
    middle[chosen] = len(vertices) + np.arange(len(chosen))
    hit = middle[longest] >= 0
    turned = np.take_along_axis(faces, (first[:, None] + np.arange(3)) % 3, axis=1)[hit]
    (a, b, c), m = turned.T, middle[longest[hit]]
    halves = np.hstack([[a, m, c], [m, b, c]]).T
    return (
        np.vstack([vertices, vertices[ends[chosen]].mean(axis=1)]),
        np.vstack([faces[~hit], halves]),
    )


def refine(
    vertices: np.ndarray, faces: np.ndarray, target: int, smooth: bool = True
) -> tuple[np.ndarray, np.ndarray]:
    """Refine to about `target` faces, first all, then at longest edges.

    Smoothly a closed surface becomes another one by Loop's rules; else any surface stays itself.
    """
    step = subdivide if smooth else quarter
    while 4 * len(faces) <= target + target // 20:
        vertices, faces = step(vertices, faces)
    while len(faces) < target - target // 200:
        vertices, faces = split_longest(vertices, faces, target)
    return vertices, faces


class Distances:
    """Distances along edges to a growing set of vertices, and the way there."""

    def __init__(self, vertices: np.ndarray, faces: np.ndarray):
        ends, _, _ = edges(faces)
        lengths = np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1)
        self._neighbours: list[list[tuple[int, float]]] = [[] for _ in vertices]
        for (a, b), length in zip(ends.tolist(), lengths.tolist()):
            self._neighbours[a].append((b, length))
            self._neighbours[b].append((a, length))
        self.distance = np.full(len(vertices), np.inf)
        self._next = np.full(len(vertices), -1)

    def add(self, vertices: list[int]) -> None:
        """Take vertices into the set; only what comes nearer to it is visited."""
        self.distance[vertices] = 0
        self._next[vertices] = -1
        queue = [(0.0, v) for v in vertices]
        heapq.heapify(queue)
        while queue:
            distance, v = heapq.heappop(queue)
            if distance > self.distance[v]:
                continue
            for w, length in self._neighbours[v]:
                if distance + length < self.distance[w]:
                    self.distance[w] = distance + length
                    self._next[w] = v
                    heapq.heappush(queue, (distance + length, w))

    def way(self, vertex: int) -> list[int]:
        """Return the vertices from one to the set, both ends included."""
        vertices = [vertex]
        while self._next[vertices[-1]] >= 0:
            vertices.append(int(self._next[vertices[-1]]))
        return vertices


def nested_seams(
    vertices: np.ndarray, faces: np.ndarray, points: list[int]
) -> list[set[tuple[int, int]]]:
    """Return trees of edges, each within the next, that join the given numbers of far points.

    Every point is the vertex farthest from those before it, along edges, and a shortest path joins
    it to the tree. `points` ascend; the edges are pairs (a, b) with a < b.
    """
    to_first = Distances(vertices, faces)
    to_first.add([0])
    start = int(to_first.distance.argmax())
    to_points, to_tree = Distances(vertices, faces), Distances(vertices, faces)
    to_points.add([start])
    to_tree.add([start])
    trees = []
    tree: set[tuple[int, int]] = set()
    for count in range(2, points[-1] + 1):
        farthest = int(to_points.distance.argmax())
        way = to_tree.way(farthest)
        tree |= {(min(pair), max(pair)) for pair in zip(way, way[1:])}
        to_points.add([farthest])
        to_tree.add(way)
        if count in points:
            trees.append(set(tree))
    return trees


def open_along(
    vertices: np.ndarray, faces: np.ndarray, seams: set[tuple[int, int]]
) -> tuple[np.ndarray, np.ndarray]:
    """Return a closed surface opened along edges: vertices are doubled there, and none moves."""
    across: dict[int, list[int]] = {}
    for a, b in sorted(seams):
        across.setdefault(a, []).append(b)
        across.setdefault(b, []).append(a)
    on_seam = np.zeros(len(vertices), bool)
    on_seam[list(across)] = True
    side: dict[tuple[int, int], tuple[int, int, int]] = {}  # (a, b): face, a's corner, third vertex
    for corner in range(3):
        for f in np.flatnonzero(on_seam[faces[:, corner]]).tolist():
            a, b, c = np.roll(faces[f], -corner).tolist()
            side[a, b] = (f, corner, c)
    opened, origin = faces.copy(), list(range(len(vertices)))
    for vertex, ends in across.items():
        for fan, neighbour in enumerate(ends):
            label = vertex if fan == 0 else len(origin)
            if fan > 0:
                origin.append(vertex)
            face, corner, third = side[vertex, neighbour]
            opened[face, corner] = label
            while third not in ends:
                face, corner, third = side[vertex, third]
                opened[face, corner] = label
    return vertices[origin], opened
