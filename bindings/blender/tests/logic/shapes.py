# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small meshes as parts, for tests that need no Blender."""

from __future__ import annotations

import numpy as np
from uv_logic.parts import Part

CUBE = np.array([[x, y, z] for z in (0.0, 1) for y in (0.0, 1) for x in (0.0, 1)])
CUBE_FACES = np.array(
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
)


def edges_of(faces: np.ndarray) -> np.ndarray:
    """Return the edges of rows of vertex numbers, (e, 2), the lesser vertex first."""
    pairs = np.concatenate([faces[:, [k, (k + 1) % faces.shape[1]]] for k in range(faces.shape[1])])
    return np.unique(np.sort(pairs, axis=1), axis=0)


def part(vertices: np.ndarray, faces: np.ndarray, **given: object) -> Part:
    """Return a part with all faces chosen, without seams, pins and UVs, but for what is given."""
    edges, corners = edges_of(faces), faces.size
    values: dict[str, object] = {
        "name": "part",
        "positions": np.asarray(vertices, float),
        "corners": faces.ravel().astype(np.int32),
        "sizes": np.full(len(faces), faces.shape[1]),
        "edges": edges,
        "seams": np.zeros(len(edges), bool),
        "materials": np.zeros(len(faces), int),
        "chosen": np.ones(len(faces), bool),
        "uvs": np.zeros((corners, 2), np.float32),
        "pinned": np.zeros(corners, bool),
        "selected": np.zeros(len(edges), bool),
    }
    return Part(**{**values, **given})


def bumpy(side: int = 12) -> tuple[np.ndarray, np.ndarray]:
    """Return an open surface of quads, (n, 3) and (m, 4), with a hump in the middle."""
    x, y = np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side))
    z = 0.4 * np.exp(-12 * ((x - 0.5) ** 2 + (y - 0.5) ** 2))
    at = np.arange(side * side).reshape(side, side)
    faces = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=-1)
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), faces.reshape(-1, 4)


def cube() -> Part:
    """Return a cube without UVs."""
    return part(CUBE, CUBE_FACES)


def hump() -> Part:
    """Return a surface whose UVs are its shadow, in [0, 1]."""
    vertices, faces = bumpy()
    return part(vertices, faces, uvs=vertices[faces.ravel(), :2].astype(np.float32))
