"""From where to look at a model: the direction that shows most of it, as the program chooses it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._arrays import Array

# Faces that are looked at to choose; of larger meshes every k-th one.
_SAMPLES = 40_000
# Squares of the grid in which the nearest sample hides the others: some samples for each.
_GRID = 48
# Mean normal against area: a sphere has 0, a plane 1. Above, the model is looked at like a map.
_FLATNESS = 0.6
# What all the bending of a surface weighs against all its area: so a face wins over the back of a
# head.
_BENDING = 0.5


def face_normals(space: Array, triangles: Array) -> Array:
    """Return normals of faces, (m, 3), twice as long as their areas."""
    a, b, c = (space[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def normals(space: Array, triangles: Array) -> Array:
    """Return unit normals of vertices, (n, 3); 0 where no face is."""
    sums = np.zeros((len(space), 3))
    of_faces = face_normals(space, triangles)
    for k in range(3):
        for axis in range(3):
            sums[:, axis] += np.bincount(triangles[:, k], of_faces[:, axis], len(space))
    return _unit(sums)


def frame(
    space: Array,
    triangles: Array,
    boundary: Array,
    view: npt.ArrayLike | None,
    up: npt.ArrayLike | None,
) -> Array:
    """Return what is right, up and toward the viewer, as the rows of a rotation (3, 3).

    Parameters
    ----------
    space : (n, 3) array of float64
        Positions.
    triangles : (m, 3) array of integers
        Vertex numbers.
    boundary : (k, 3) array of float64
        Positions on the boundary.
    view, up : (3,) array_like of floats, or None
        Toward the viewer, and up; None chooses.
    """
    upward = _guess_up(space, triangles, boundary) if up is None else _direction("up", up)
    if view is not None:
        return _frame_of(_direction("view", view), upward)
    of_faces = 0.5 * face_normals(space, triangles)
    area = np.linalg.norm(of_faces, axis=1)
    mean = of_faces.sum(axis=0)
    if np.linalg.norm(mean) > _FLATNESS * area.sum():
        straight = _frame_of(mean, upward)
        tilted = straight[2] + 0.35 * straight[0] - 0.35 * straight[1]
        return _frame_of(tilted, straight[1])
    side = _unit(np.cross(upward, np.roll(upward, 1))[None])[0]
    front = np.cross(side, upward)
    chosen = _Samples(space, triangles, of_faces, area)
    candidates = [
        _frame_of(
            np.cos(height) * (np.cos(turn) * front + np.sin(turn) * side) + np.sin(height) * upward,
            upward,
        )
        for height in (0.1, 0.4)
        for turn in np.arange(16) * (np.pi / 8)
    ]
    return max(candidates, key=chosen.score)


class _Samples:
    """Some of the faces as points with normals, and what each of them weighs."""

    def __init__(self, space: Array, triangles: Array, of_faces: Array, area: Array) -> None:
        turn = np.zeros(len(triangles))
        of_vertices, of_face = normals(space, triangles), _unit(of_faces)
        for k in range(3):
            turn += 1 - (of_vertices[triangles[:, k]] * of_face).sum(axis=1)
        bending = area * turn
        weights = area / max(area.sum(), 1e-300) + _BENDING * bending / max(bending.sum(), 1e-300)
        some = slice(None, None, -(-len(triangles) // _SAMPLES))
        self._weights = weights[some] / max(weights[some].sum(), 1e-300)
        self._areas = area[some] / max(area[some].sum(), 1e-300)
        self._normals = of_face[some]
        centers = space[triangles[some]].mean(axis=1)
        self._points = centers - centers.mean(axis=0)
        self._radius = max(float(np.linalg.norm(self._points, axis=1).max()), 1e-300)

    def score(self, rotation: Array) -> float:
        """Return what a view shows of the front, less half of what it shows of the back."""
        seen = self._points @ rotation.T
        facing = self._normals @ rotation[2]
        x, y = ((seen[:, :2] / self._radius + 1) * (0.499 * _GRID)).astype(np.int64).T
        square = y * _GRID + x
        nearest = np.full(_GRID * _GRID, -np.inf)
        np.maximum.at(nearest, square, seen[:, 2])
        # Two squares of slack: a sloping surface differs in depth within its square.
        visible = seen[:, 2] >= nearest[square] - 4 * self._radius / _GRID
        front = visible & (facing > 0)
        back = visible & (facing < 0)
        return float(self._weights[front] @ facing[front] + 0.5 * self._areas[back] @ facing[back])


def _guess_up(space: Array, triangles: Array, boundary: Array) -> Array:
    """Models stand on y or, less often, lie with z up. A boundary below the rest tells."""
    if len(boundary) == 0:
        return np.array([0.0, 1.0, 0.0])
    used = space[triangles].reshape(-1, 3)
    center = used.mean(axis=0)
    radius = np.linalg.norm(used - center, axis=1).max()
    rise = center - boundary.mean(axis=0)
    axis = int(np.abs(rise).argmax())
    upward = np.zeros(3)
    if abs(rise[axis]) < 0.35 * radius:
        upward[1] = 1
    else:
        upward[axis] = np.sign(rise[axis])
    return upward


def _direction(name: str, values: npt.ArrayLike) -> Array:
    direction = np.asarray(values, float)
    if direction.shape != (3,) or not np.linalg.norm(direction) > 0:
        raise ValueError(f"{name} must be a direction, three numbers that are not all 0")
    return direction


def _frame_of(toward: Array, up: Array) -> Array:
    back = _unit(toward[None])[0]
    right = np.cross(up, back)
    if np.linalg.norm(right) < 1e-3:  # looking along `up`: any other axis will do
        right = np.cross([0.0, 1.0, 0.0] if abs(back[1]) < 0.9 else [0.0, 0.0, -1.0], back)
    right = _unit(right[None])[0]
    return np.array([right, np.cross(back, right), back])


def _unit(rows: Array) -> Array:
    length = np.linalg.norm(rows, axis=1, keepdims=True)
    unit: Array = rows / np.where(length > 0, length, 1)
    return unit
