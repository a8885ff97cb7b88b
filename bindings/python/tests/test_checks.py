"""Checks and measures of UVs from anywhere."""

from __future__ import annotations

import contextlib

import numpy as np
import pytest
from conftest import grid

import beltrami
from beltrami import _interrupt

SQUARE = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])


def test_an_injective_map_is_true():
    certificate = beltrami.check_injective(SQUARE, FACES)
    assert certificate
    assert certificate.injective
    assert (certificate.positive, certificate.first_crossing) == (2, None)


def test_a_flipped_face_is_counted_and_named():
    uv = SQUARE.copy()
    uv[3] = [1, 0.5]
    certificate = beltrami.check_injective(uv, FACES)
    assert not certificate
    assert not certificate.injective
    assert (certificate.positive, certificate.negative) == (1, 1)
    assert certificate.first_bad_face == 1


def test_a_crossing_boundary_is_counted_and_named():
    strip = np.array([[0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4], [2, 6, 5], [6, 7, 5]])
    angles = np.array([0, 1, 2, 0, 1, 2, 3, 3]) * 2.3
    radii = np.array([2, 2, 2, 1, 1, 1, 2, 1])
    uv = np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=1)
    crossing = beltrami.check_boundary(uv, strip)
    assert crossing.boundary_crossings > 0
    assert len(crossing.first_crossing) == 2
    assert not crossing


def test_parts_prove_no_more_than_they_look_at():
    triangles = beltrami.check_triangles(SQUARE, FACES)
    boundary = beltrami.check_boundary(SQUARE, FACES)
    assert triangles
    assert boundary
    assert not triangles.injective
    assert not boundary.injective


def test_triangles_need_be_no_disk():
    twice = np.concatenate([FACES, FACES])
    assert beltrami.check_triangles(SQUARE, twice).positive == 4
    with pytest.raises(beltrami.NotADiskError):
        beltrami.check_injective(SQUARE, twice)


def test_uvs_are_judged_as_stored():
    uv = np.array([[0, 0], [1, 0], [1, 1e-9], [0, 1]], float) + 1
    assert beltrami.check_injective(uv, FACES)
    assert beltrami.check_injective(uv.astype(np.float32), FACES).degenerate == 1


def test_uvs_that_are_not_finite_are_named():
    uv = SQUARE.copy()
    uv[2, 1] = np.nan
    for call in (
        lambda: beltrami.check_injective(uv, FACES),
        lambda: beltrami.distortion(np.zeros((4, 3)), FACES, uv),
    ):
        with pytest.raises(beltrami.NonFiniteError, match=r"^vertex 2: A coordinate") as caught:
            call()
        assert (caught.value.element, caught.value.element_kind) == (2, "vertex")


def test_positions_that_are_not_finite_are_named():
    vertices = np.column_stack([SQUARE, np.zeros(4)])
    vertices[3, 0] = np.inf
    with pytest.raises(beltrami.NonFiniteError) as caught:
        beltrami.distortion(vertices, FACES, SQUARE)
    assert (caught.value.element, caught.value.element_kind) == (3, "vertex")


def singular_values(vertices, faces, uv):
    """Return s1 and s2 of every face as NumPy's decomposition has them, (m, 2)."""
    found = []
    for face in faces:
        a, b, c = vertices[face]
        x = (b - a) / np.linalg.norm(b - a)
        normal = np.cross(b - a, c - a)
        y = np.cross(normal / np.linalg.norm(normal), x)
        flat = np.array([[(b - a) @ x, (c - a) @ x], [(b - a) @ y, (c - a) @ y]])
        image = np.array([uv[face[1]] - uv[face[0]], uv[face[2]] - uv[face[0]]]).T
        jacobian = image @ np.linalg.inv(flat)
        s1, s2 = np.linalg.svd(jacobian, compute_uv=False)
        found.append([s1, np.copysign(s2, np.linalg.det(jacobian))])
    return np.array(found)


def test_distortion_is_that_of_the_singular_values():
    vertices, faces = grid(7)
    uv = vertices[:, :2] * [1.5, 0.7] + 0.02 * np.random.default_rng(1).normal(size=(64, 2))
    found = beltrami.distortion(vertices, faces, uv)
    s1, s2 = singular_values(vertices, faces, uv).T
    assert np.allclose(found.singular_values, np.stack([s1, s2], 1), rtol=1e-9)
    assert np.allclose(found.symmetric_dirichlet, (s1**2 + s2**2 + s1**-2 + s2**-2) / 2)
    assert np.allclose(found.symmetric_arap, (s1 - 1) ** 2 + (1 / s2 - 1) ** 2)
    assert np.allclose(found.area, s1 * s2)
    assert np.allclose(found.conformal, s1 / s2)
    edges = vertices[faces[:, 1:]] - vertices[faces[:, :1]]
    areas = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    mean = np.average(found.symmetric_dirichlet, weights=areas)
    assert found.energy.symmetric_dirichlet == pytest.approx(mean)
    assert found.energy.max == found.symmetric_dirichlet.max()
    assert found.energy.worst_face == found.symmetric_dirichlet.argmax()


def test_distortion_of_flipped_and_empty_faces():
    vertices = np.column_stack([SQUARE, np.zeros(4)])
    vertices[3] = vertices[0]  # the second face has no area in space
    uv = SQUARE[:, ::-1].copy()  # both are flipped
    found = beltrami.distortion(vertices, FACES, uv)
    assert found.flipped.tolist() == [True, False]
    assert np.isinf(found.symmetric_dirichlet[0])
    assert np.isnan(found.singular_values[1]).all()
    assert found.energy.left_out == 2


def test_distortion_of_a_result_is_its_own(bust):
    vertices, faces = bust
    result = beltrami.parameterize(vertices, faces)
    found = beltrami.distortion(vertices, faces, result.uv)
    assert found.energy.symmetric_dirichlet == pytest.approx(result.energy.symmetric_dirichlet)
    assert found.energy.worst_face == result.energy.worst_face
    assert not found.flipped.any()


def test_a_distortion_equals_itself():
    vertices = np.column_stack([SQUARE, np.zeros(4)])
    found, other = (beltrami.distortion(vertices, FACES, SQUARE) for _ in range(2))
    assert found == found
    assert len({found, other}) == 2


def test_lengths_must_agree():
    with pytest.raises(ValueError, match="5 vertices, but 4 UVs"):
        beltrami.distortion(np.zeros((5, 3)), FACES, SQUARE)


def test_ctrl_c_ends_checks_measures_and_the_loading_of_a_mesh(monkeypatch):
    @contextlib.contextmanager
    def cancelled_at_once(cancel):
        cancel()
        yield _interrupt.Interrupt()

    monkeypatch.setattr(_interrupt, "watched", cancelled_at_once)
    vertices, faces = grid(80)
    uv = np.ascontiguousarray(vertices[:, :2])
    for call in (
        lambda: beltrami.check_injective(uv, faces),
        lambda: beltrami.check_triangles(uv, faces),
        lambda: beltrami.check_boundary(uv, faces),
        lambda: beltrami.distortion(vertices, faces, uv),
        lambda: beltrami.Flattener().set_mesh(vertices, faces),
    ):
        with pytest.raises(beltrami.Cancelled):
            call()
