"""Any arrays in, typed errors out."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from conftest import grid

import beltrami
from beltrami import _arrays


def strided(array):
    wide = np.zeros((len(array), array.shape[1] + 2), array.dtype)
    wide[:, : array.shape[1]] = array
    return wide[:, : array.shape[1]]


def unaligned(array):
    buffer = np.zeros(array.nbytes + 1, np.uint8)
    view = buffer[1:].view(array.dtype).reshape(array.shape)
    view[:] = array
    return view


class HasArray:
    """What brings an array of its own, as tensors and frames do."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return self.array


LAYOUTS = {
    "packed": np.ascontiguousarray,
    "strided": strided,
    "every second row": lambda a: np.repeat(a, 2, axis=0)[::2],
    "unaligned": unaligned,
    "read-only": lambda a: np.frombuffer(a.tobytes(), a.dtype).reshape(a.shape),
    "column by column": np.asfortranarray,
    "backwards": lambda a: np.ascontiguousarray(a[::-1])[::-1],
    "mirrored": lambda a: np.ascontiguousarray(a[:, ::-1])[:, ::-1],
    "big-endian": lambda a: a.astype(a.dtype.newbyteorder(">")),
    "a list": lambda a: a.tolist(),
    "another object": HasArray,
}
IN_PLACE = ["packed", "strided", "every second row", "unaligned", "read-only"]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_any_layout_and_type_gives_the_same_uvs(hump, layout):
    put = LAYOUTS[layout]
    vertices, faces = hump
    vertices = vertices.astype(np.float32).astype(float)
    expected = beltrami.parameterize(vertices, faces).uv
    for dtype in (np.int32, np.int64, np.uint32, np.uint64, np.int16, np.uint8):
        result = beltrami.parameterize(put(vertices), put(faces.astype(dtype)))
        assert result.uv.tobytes() == expected.tobytes()
    single = beltrami.parameterize(put(vertices.astype(np.float32)), put(faces))
    assert np.allclose(single.uv, expected, atol=1e-6)


@pytest.mark.parametrize("layout", IN_PLACE)
def test_good_layouts_are_read_in_place(hump, layout):
    put = LAYOUTS[layout]
    vertices, faces = hump
    for dtype in (np.float32, np.float64):
        given = put(vertices.astype(dtype))
        assert np.shares_memory(given, _arrays.positions(given))
        given = put(vertices[:, :2].astype(dtype))
        assert np.shares_memory(given, _arrays.coordinates(given))
    for dtype in (np.int32, np.int64, np.uint32, np.uint64):
        given = put(faces.astype(dtype))
        assert np.shares_memory(given, _arrays.indices(given))


def test_a_lone_triangle_may_have_any_strides():
    result = beltrami.parameterize(np.eye(3), np.array([[0, 1, 2]])[::-1])
    assert result.injective
    assert result.energy.symmetric_dirichlet == pytest.approx(2)


@pytest.mark.parametrize(
    ("vertices", "faces", "error"),
    [
        (np.zeros((3, 2)), [[0, 1, 2]], ValueError),
        (np.zeros(9), [[0, 1, 2]], ValueError),
        (np.zeros((3, 3)), [0, 1, 2], ValueError),
        (np.zeros((3, 3)), [[0, 1, 2, 2]], ValueError),
        (np.zeros((3, 3)), [[0.0, 1.0, 2.0]], TypeError),
        (np.zeros((3, 3)), [[False, True, True]], TypeError),
        (np.zeros((3, 3), complex), [[0, 1, 2]], TypeError),
        ([["a", "b", "c"]], [[0, 0, 0]], TypeError),
        ([], [], beltrami.MeshError),
        (np.zeros((0, 3)), np.zeros((0, 3), int), beltrami.MeshError),
        (np.zeros((3, 3)), None, TypeError),
    ],
)
def test_arrays_of_other_shapes_and_types_are_refused(vertices, faces, error):
    with pytest.raises(error):
        beltrami.parameterize(vertices, faces)


@pytest.mark.parametrize("dtype", [np.int32, np.int64])
def test_a_negative_index_is_out_of_range_and_the_message_shows_it(hump, dtype):
    vertices, faces = hump
    faces = faces.astype(dtype)
    faces[5, 1] = -1
    for call in (
        lambda: beltrami.parameterize(vertices, faces),
        lambda: beltrami.check_injective(vertices[:, :2], faces),
        lambda: beltrami.distortion(vertices, faces, vertices[:, :2]),
    ):
        with pytest.raises(
            beltrami.IndexOutOfRangeError, match="face 5 names vertex -1:"
        ) as caught:
            call()
        error = caught.value
        assert (error.element, error.element_kind) == (5, "face")
        assert (error.status, error.code) == ("BELTRAMI_E_INDEX_OUT_OF_RANGE", -21)


def two_squares():
    vertices, faces = grid(1)
    return np.concatenate([vertices, vertices + 5]), np.concatenate([faces, faces + 4])


def three_pages():
    return np.concatenate([np.eye(3), -np.eye(2, 3)]), [[0, 1, 2], [1, 0, 3], [0, 1, 4]]


TETRAHEDRON = (np.eye(4, 3), [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]])


@pytest.mark.parametrize(
    ("mesh", "error", "status", "element"),
    [
        (TETRAHEDRON, beltrami.NotADiskError, "CLOSED", (None, None)),
        (two_squares(), beltrami.NotADiskError, "COMPONENTS", (2, "face")),
        (three_pages(), beltrami.NotADiskError, "NON_MANIFOLD_EDGE", (2, "face")),
        ((np.eye(3), [[0, 1, 1]]), beltrami.NotADiskError, "REPEATED_VERTEX", (0, "face")),
        (
            (np.eye(3), [[0, 1, 3]]),
            beltrami.IndexOutOfRangeError,
            "INDEX_OUT_OF_RANGE",
            (0, "face"),
        ),
        (
            (np.diag([1, np.nan, 1]), [[0, 1, 2]]),
            beltrami.NonFiniteError,
            "NON_FINITE",
            (1, "vertex"),
        ),
        ((np.zeros((3, 3)), [[0, 1, 2]]), beltrami.MeshError, "ZERO_AREA", (None, None)),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_mesh_that_cannot_be_flattened_is_refused_with_the_element(mesh, error, status, element):
    with pytest.raises(error) as caught:
        beltrami.parameterize(*mesh)
    found = caught.value
    assert found.status == f"BELTRAMI_E_{status}"
    assert (found.element, found.element_kind) == element
    assert isinstance(found, beltrami.BeltramiError)
    assert isinstance(found, ValueError)


def test_errors_can_be_pickled():
    with pytest.raises(beltrami.NonFiniteError) as caught:
        beltrami.parameterize(np.diag([1, np.inf, 1]), [[0, 1, 2]])
    copied = pickle.loads(pickle.dumps(caught.value))
    assert type(copied) is beltrami.NonFiniteError
    assert str(copied) == str(caught.value)
    assert vars(copied) == vars(caught.value)


@pytest.mark.parametrize(
    ("options", "error", "match"),
    [
        ({"energy": "other"}, ValueError, "energy is 'other': give 'symmetric-dirichlet' or"),
        ({"energy": 1}, TypeError, "energy is 1: give"),
        ({"threads": 0}, beltrami.InvalidArgumentError, "threads"),
        ({"threads": 1.5}, TypeError, r"threads is 1\.5: give a whole number"),
        ({"tolerance": "1"}, TypeError, "tolerance is '1': give a number"),
        ({"tolerance": float("nan")}, ValueError, "tolerance"),
        ({"threads": 10**30}, beltrami.InvalidArgumentError, "out of range for the option threads"),
        ({"tolerance": 10**400}, beltrami.InvalidArgumentError, "option tolerance"),
        ({"refine": 1}, TypeError, "refine is 1: give True or False"),
        ({"delaunay": "on"}, TypeError, "delaunay is 'on': give True or False"),
    ],
)
def test_options_are_checked(hump, options, error, match):
    with pytest.raises(error, match=match):
        beltrami.parameterize(*hump, **options)
    with pytest.raises(error, match=match):
        beltrami.Flattener().set_options(**options)


def test_an_unknown_option_is_named():
    with pytest.raises(TypeError, match="there is no option 'colour': choose from method, energy"):
        beltrami.Flattener().set_options(colour="red")
    with pytest.raises(TypeError, match="colour"):
        beltrami.parameterize([], [], colour="red")


def test_numbers_of_numpy_are_numbers(hump):
    options = {"threads": np.int8(2), "tolerance": np.float32(0.5), "refine": np.bool_(False)}
    assert beltrami.parameterize(*hump, **options).injective
