"""Meshes as marching cubes and surface nets leave them: figures, crumbs, gyroids and nets.

They have any size. All are made of random waves of a seed, so that anybody has the same ones.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
from atlas_figures import weld
from atlas_runs import Mesh

# Samples along a side where the number of faces is found out, and within what of the number asked
# for a mesh is taken.
FIRST_SIDE, NEAR, TRIES = 48, 0.05, 6
# Of a figure.
LIMBS = ((0, 0, 1), (0, 0, -1), (0.7, 0.2, 0.6), (-0.7, 0.1, 0.6), (0.4, 0, -1.4), (-0.4, 0, -1.4))
CRUMBS_PER_FACE = 1 / 235  # of a figure with crumbs

Field = Callable[[np.ndarray], np.ndarray]  # from points (n, 3) within [-2, 2] to values


def waves(points: np.ndarray, seed: int, count: int, least: float, most: float) -> np.ndarray:
    """Return a sum of `count` waves with frequencies in a range, of mean square one."""
    random = np.random.default_rng(seed)
    total = np.zeros(len(points))
    for _ in range(count):
        direction = random.normal(size=3)
        direction *= random.uniform(least, most) / np.linalg.norm(direction)
        total += np.sin(points @ direction + random.uniform(0, 2 * np.pi))
    return total * np.sqrt(2 / count)


def figure(points: np.ndarray) -> np.ndarray:
    """Be negative inside a body with head, arms and legs, and folds."""
    body = np.exp(-4 * ((points * [1, 1.4, 0.8]) ** 2).sum(1))
    for limb in LIMBS:
        along = np.clip(points @ np.array(limb) / np.dot(limb, limb), 0, 1)
        away = points - along[:, None] * np.array(limb)
        body += 0.8 * np.exp(-40 * (away**2).sum(1))
    return 0.35 + 0.02 * waves(points, 1, 12, 6, 14) - body


def gyroid(points: np.ndarray) -> np.ndarray:
    """Be negative in the walls of a gyroid in a ball."""
    x, y, z = (5 * points).T
    surface = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    return np.maximum(np.abs(surface) - 0.35, np.linalg.norm(points, axis=1) - 1.6)


def foam(points: np.ndarray) -> np.ndarray:
    """Be negative in many parts that touch."""
    return 0.9 + 0.3 * np.linalg.norm(points, axis=1) - np.abs(waves(points, 2, 24, 4, 12))


def samples(field: Field, side: int) -> np.ndarray:
    """Return a cube of values of the field, which is asked for one layer after the other."""
    axis = np.linspace(-2, 2, side)
    values = np.empty((side, side, side))
    for layer, x in zip(values, axis, strict=True):
        points = np.stack(np.meshgrid([x], axis, axis, indexing="ij"), -1)
        layer[:] = field(points.reshape(-1, 3)).reshape(side, side)
    return values


def marching_cubes(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices and triangles of the level zero."""
    from skimage.measure import marching_cubes as extract

    vertices, faces, _, _ = extract(values, 0)
    return vertices, faces


def surface_net(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a vertex per cell that the surface crosses, and two triangles per edge that does.

    Cells that it crosses twice leave edges of four triangles (Gibson 1998 joins them, too).
    """
    inside = values < 0
    cells = tuple(side - 1 for side in values.shape)
    sums, counts = np.zeros((*cells, 3)), np.zeros(cells)
    quads = []
    for axis in range(3):
        first, last = np.moveaxis(inside, axis, 0)[:-1], np.moveaxis(inside, axis, 0)[1:]
        crossed = np.moveaxis(first != last, 0, axis)
        down = np.moveaxis(last, 0, axis)
        places = np.argwhere(crossed)
        others = [other for other in range(3) if other != axis]
        inner = np.all([(places[:, o] > 0) & (places[:, o] < cells[o]) for o in others], axis=0)
        places = places[inner]
        low = values[tuple(places.T)]
        step = np.eye(3, dtype=int)
        high = values[tuple((places + step[axis]).T)]
        points = places + (low / (low - high))[:, None] * step[axis]
        corners = []
        for a, b in ((1, 1), (0, 1), (0, 0), (1, 0)):
            cell = places - a * step[others[0]] - b * step[others[1]]
            np.add.at(sums, tuple(cell.T), points)
            np.add.at(counts, tuple(cell.T), 1)
            corners.append(np.ravel_multi_index(tuple(cell.T), cells))
        quad = np.stack(corners, 1)
        turned = down[tuple(places.T)] ^ (axis == 1)
        quad[turned] = quad[turned][:, ::-1]
        quads.append(quad)
    quad = np.concatenate(quads)
    used, faces = np.unique(
        np.concatenate([quad[:, [0, 1, 2]], quad[:, [0, 2, 3]]]), return_inverse=True
    )
    vertices = sums.reshape(-1, 3)[used] / counts.ravel()[used][:, None]
    return vertices, faces.reshape(-1, 3)


def sized(name: str, field: Field, extract: Callable, target: int) -> Mesh:
    """Return the mesh with about `target` triangles."""
    side, made = FIRST_SIDE, None
    for _ in range(TRIES):
        vertices, faces = extract(samples(field, side))
        made = Mesh(f"{name}@{target}", *weld(np.asarray(vertices, float), faces))
        share = target / len(made.faces)
        if abs(share - 1) < NEAR:
            break
        side = max(8, round(side * share**0.5))
    assert made is not None
    return made


def with_crumbs(mesh: Mesh) -> Mesh:
    """Return a figure with small closed parts around it."""
    random = np.random.default_rng(3)
    low, high = mesh.vertices.min(0), mesh.vertices.max(0)
    corners = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    sides = orient(np.array(list(itertools.product((0, 1), (2, 3), (4, 5)))), corners)
    vertices, faces = [mesh.vertices], [mesh.faces]
    count = len(mesh.vertices)
    for _ in range(round(CRUMBS_PER_FACE * len(mesh.faces))):
        size = 0.004 * np.linalg.norm(high - low) * random.uniform(0.2, 1, (6, 1))
        vertices.append(random.uniform(low, high) + size * corners)
        faces.append(count + sides)
        count += len(corners)
    name = mesh.name.replace("figure", "crumbs")
    return Mesh(name, np.concatenate(vertices), np.concatenate(faces))


def orient(faces: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """Turn the triangles of a body around the origin outwards."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c) < 0
    turned = faces.copy()
    turned[inwards] = turned[inwards][:, [0, 2, 1]]
    return turned


def generated(target: int) -> list[Mesh]:
    """Return one mesh of each kind with about so many triangles."""
    body = sized("figure", figure, marching_cubes, target)
    return [
        body,
        with_crumbs(body),
        sized("gyroid", gyroid, marching_cubes, target),
        sized("net", foam, surface_net, target),
    ]
