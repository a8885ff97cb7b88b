"""The cuts that ./dev bench seams opens closed meshes along."""

from __future__ import annotations

import numpy as np
import pytest
from meshes import edges, is_sphere, nested_seams, open_along, refine

import beltrami

POINTS = [3, 5, 10, 20]


@pytest.fixture(scope="module")
def ellipsoid() -> tuple[np.ndarray, np.ndarray]:
    """Return a closed mesh of about 1,000 faces."""
    axes = np.array([[1.0, 0, 0], [0, 2, 0], [0, 0, 4]])
    upper = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2]])
    faces = np.vstack([upper, np.where(upper == 2, 5, upper)[:, ::-1]])
    return refine(np.vstack([axes, -axes]), faces, 1000)


def test_a_refined_mesh_is_closed_and_has_about_the_faces_asked_for(ellipsoid):
    vertices, faces = ellipsoid
    assert is_sphere(vertices, faces)
    assert abs(len(faces) - 1000) <= 5


def test_a_cut_with_more_points_contains_those_with_fewer(ellipsoid):
    seams = nested_seams(*ellipsoid, POINTS)
    assert len(seams) == len(POINTS)
    for smaller, larger in zip(seams, seams[1:]):
        assert smaller < larger


@pytest.mark.parametrize("index", range(len(POINTS)))
def test_a_mesh_opened_along_a_cut_is_a_disk_of_the_same_faces(ellipsoid, index):
    vertices, faces = ellipsoid
    seams = nested_seams(vertices, faces, POINTS)[index]
    opened, corners = open_along(vertices, faces, seams)
    assert np.array_equal(opened[corners], vertices[faces])
    assert (edges(corners)[2] == 1).sum() == 2 * len(seams)
    assert beltrami.parameterize(opened, corners, method="tutte").injective
