"""What is refused comes with what to write instead, and that works as it stands."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import grid, write_obj

import beltrami

VERTICES, FACES = grid(3)


def refusal(*arguments, call=beltrami.parameterize, error=(TypeError, ValueError)):
    """Return the message of the exception that the call raises."""
    with pytest.raises(error) as caught:
        call(*arguments)
    return str(caught.value)


def after(words, message):
    """Return the expression that follows these words in a message."""
    assert words in message
    return message.partition(words)[2]


# ---- Shapes and types ---------------------------------------------------------------------


@pytest.mark.parametrize(
    ("vertices", "meant"),
    [
        (VERTICES.T, "vertices.T"),
        (VERTICES.ravel(), "vertices.reshape(-1, 3)"),
        (VERTICES[:, :2], "np.column_stack([vertices, np.zeros(len(vertices))])"),
        (np.column_stack([VERTICES, np.zeros(16)]), "vertices[:, :3]"),
        (VERTICES[None], "vertices[0]"),
        (
            np.rec.fromarrays(VERTICES.T, names="x,y,z"),
            "np.column_stack([vertices['x'], vertices['y'], vertices['z']])",
        ),
        (VERTICES.astype(object), "np.array(vertices, float)"),
    ],
    ids=["columns", "flat", "in a plane", "padded", "batch of one", "fields", "objects"],
)
def test_vertices_of_another_shape_or_type(vertices, meant):
    assert refusal(vertices, FACES).endswith(f"give {meant}")
    corrected = eval(meant, {"vertices": vertices, "np": np})
    assert beltrami.parameterize(corrected, FACES).injective


def arrays_in_an_array(rows):
    """Return an array of objects, each of which is a row."""
    outer = np.empty(len(rows), object)
    outer[:] = list(rows)
    return outer


QUADS = np.array([[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6]])
COUNTED = np.column_stack([np.full(len(FACES), 3), FACES])


@pytest.mark.parametrize(
    ("faces", "meant"),
    [
        (FACES.T, "faces.T"),
        (FACES.ravel()[:-3], "faces.reshape(-1, 3)"),
        (COUNTED, "faces.reshape(-1, 4)[:, 1:]"),
        (COUNTED.ravel(), "faces.reshape(-1, 4)[:, 1:]"),
        (QUADS, "np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])"),
        (FACES.astype(float), "faces.astype(np.int64)"),
        (FACES.astype(object), "np.array(faces, np.int64)"),
        (arrays_in_an_array(FACES), "np.stack(faces)"),
        (FACES + 1, "faces - 1"),
    ],
    ids=[
        *("columns", "flat", "counted", "counted and flat", "quads", "floats", "objects"),
        *("an array of arrays", "from 1"),
    ],
)
def test_faces_of_another_shape_or_type(faces, meant):
    assert meant in refusal(VERTICES, faces)
    corrected = eval(meant, {"faces": faces, "np": np})
    assert beltrami.parameterize(VERTICES, corrected).injective


def test_more_corners_than_vertices_are_no_polygon():
    message = refusal(VERTICES, FACES.T, call=beltrami.unwrap, error=ValueError)
    assert message.endswith("no polygon has 18 corners where there are 16 vertices: give faces.T")
    assert refusal(VERTICES, FACES.T, call=beltrami.Editor, error=ValueError) == message
    ring = np.arange(16).reshape(1, -1)
    assert beltrami.unwrap(VERTICES, np.repeat(ring, 3, axis=0)).report.faces == 3


def test_polygons_are_no_triangles():
    message = refusal(VERTICES, [[0, 1, 5], [1, 2, 6, 5]])
    assert message == "faces has rows of different lengths: cut polygons into triangles"


def test_uvs_with_a_third_number_that_says_nothing():
    uv = VERTICES * [1, 1, 0]
    assert refusal(uv, FACES, call=beltrami.check_injective).endswith(": give uv[:, :2]")
    assert beltrami.check_injective(uv[:, :2], FACES)
    assert refusal(VERTICES, FACES, call=beltrami.check_injective).endswith("not (16, 3)")


def test_arguments_that_change_places():
    assert refusal(FACES, VERTICES).endswith("are the arguments in their order?")


@pytest.mark.parametrize("index", [16, 2**40])
def test_an_index_that_is_too_large_is_shown_by_the_checks_too(index):
    faces = FACES.copy()
    faces[3, 1] = index
    words = f"face 3 names vertex {index}, but there are 16"
    assert refusal(VERTICES, faces) == f"{words} vertices: indices count from 0"
    uv = VERTICES[:, :2]
    assert refusal(uv, faces, call=beltrami.check_injective).startswith(f"{words} UVs")
    assert refusal(VERTICES, faces, uv, call=beltrami.distortion).startswith(f"{words} UVs")


# ---- Meshes of other packages -------------------------------------------------------------


class Tensor:
    """What Open3D has in its meshes of tensors."""

    def __init__(self, array):
        self.numpy = lambda: array


def pymeshlab_mesh():
    return SimpleNamespace(vertex_matrix=lambda: VERTICES, face_matrix=lambda: FACES)


MESHES = {
    "Open3D": SimpleNamespace(vertices=VERTICES, triangles=FACES),
    "Open3D, tensors": SimpleNamespace(
        vertex=SimpleNamespace(positions=Tensor(VERTICES)),
        triangle=SimpleNamespace(indices=Tensor(FACES)),
    ),
    "PyVista": SimpleNamespace(points=VERTICES, regular_faces=FACES, faces=COUNTED.ravel()),
    "meshio": SimpleNamespace(points=VERTICES, cells_dict={"triangle": FACES}, cells=[]),
    "vedo": SimpleNamespace(vertices=VERTICES, cells=FACES.tolist()),
    "PyMeshLab": pymeshlab_mesh(),
    "a dict": {"vertices": VERTICES, "faces": FACES},
    "like a trimesh": SimpleNamespace(vertices=VERTICES, faces=FACES),
}


@pytest.mark.parametrize("name", MESHES)
def test_meshes_of_other_packages_are_named_with_their_arrays(name):
    mesh = MESHES[name]
    message = refusal(mesh)
    kind = "dict" if isinstance(mesh, dict) else "types.SimpleNamespace"
    assert message.startswith(f"vertices is a {kind}: give its arrays, ")
    vertices, _, faces = after("arrays, ", message).partition(" and ")
    found = beltrami.parameterize(eval(vertices, {"mesh": mesh}), eval(faces, {"mesh": mesh}))
    assert found.uv.tobytes() == beltrami.parameterize(VERTICES, FACES).uv.tobytes()
    assert refusal(mesh, FACES) == message
    assert refusal([mesh, mesh]).startswith("vertices is a list: give one mesh at a time; the fir")


def test_a_pair_of_arrays_is_no_mesh():
    mesh = (VERTICES, FACES)
    assert refusal(mesh).startswith("vertices is a tuple: give its vertices and faces one by one")
    assert beltrami.parameterize(*mesh).injective


def test_a_result_is_not_its_uvs():
    result = beltrami.parameterize(VERTICES, FACES)
    message = refusal(result, FACES, call=beltrami.check_injective)
    assert message.endswith(
        "uv is a beltrami.Parameterization: give its arrays, result.uv and result.faces"
    )
    assert beltrami.check_injective(result.uv, result.faces)


def test_a_batch_takes_files():
    def batch(paths):
        beltrami.batch(paths, "out")

    assert "give files" in refusal([(VERTICES, FACES)], call=batch)
    assert "glob.glob" in refusal("scans/*.ply", call=batch)


# ---- trimesh and files --------------------------------------------------------------------


def tube(sides=8):
    """Return a tube cut open along a seam whose vertices coincide, and its faces."""
    angle = 2 * np.pi * (np.arange(sides + 1) % sides) / sides
    ring = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(sides + 1)])
    right = np.arange(sides) + 1
    above = right + sides + 1
    lower = np.column_stack([right - 1, right, above - 1])
    faces = np.concatenate([lower, np.column_stack([right, above, above - 1])])
    return np.concatenate([ring, ring + np.array([0, 0, 2])]), faces


@pytest.mark.parametrize("kind", [str, Path, lambda path: str(path).encode()])
def test_a_path_is_no_mesh_but_the_message_has_two_ways_to_flatten_it(tmp_path, monkeypatch, kind):
    trimesh = pytest.importorskip("trimesh")
    monkeypatch.chdir(tmp_path)
    write_obj(tmp_path / "tube.obj", *tube())
    path = kind("tube.obj")
    message = refusal(path)
    assert refusal(path, FACES) == refusal(path, call=beltrami.Flattener().set_mesh) == message
    assert message.startswith("vertices is a path: give the mesh in it, ")
    load, _, batch = after("mesh in it, ", message).partition(", or have the file flattened, ")
    result = beltrami.parameterize(eval(load, {"trimesh": trimesh}))
    assert result.uv.tobytes() == beltrami.parameterize(*tube()).uv.tobytes()
    assert eval(batch, {"beltrami": beltrami})[0].ok


def test_what_has_faces_is_given_without_them():
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.Trimesh(VERTICES, FACES, process=False)
    words = "its own faces: leave faces out"
    for path in ("x.obj", Path("x.obj")):
        assert refusal(path, FACES, call=beltrami.unwrap) == f"the file of a path has {words}"
    for thing in (mesh, trimesh.Scene([mesh])):
        message = refusal(thing, FACES, call=beltrami.unwrap)
        assert message == f"a {type(thing).__name__} brings {words}"


def test_a_path_of_stl_has_its_vertices_merged(tmp_path, monkeypatch):
    trimesh = pytest.importorskip("trimesh")
    monkeypatch.chdir(tmp_path)
    trimesh.Trimesh(*grid(3), process=False).export("hump.stl")
    load = after("mesh in it, ", refusal("hump.stl")).partition(", or")[0]
    assert beltrami.parameterize(eval(load, {"trimesh": trimesh})).injective


def test_a_cut_that_trimesh_has_closed_is_said_to_be():
    trimesh = pytest.importorskip("trimesh")
    assert beltrami.parameterize(trimesh.Trimesh(*tube(), process=False)).injective
    message = refusal(trimesh.Trimesh(*tube()), error=beltrami.NotADiskError)
    assert message.endswith("load or make the mesh with process=False")
    closed = trimesh.creation.box()
    assert "process" not in refusal(closed.vertices, closed.faces, error=beltrami.NotADiskError)


def test_a_scene_is_told_apart_from_its_meshes():
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.Trimesh(VERTICES, FACES, process=False)
    scene = trimesh.Scene([mesh])
    message = refusal(scene)
    assert message == "vertices is a trimesh.Scene: give the mesh in it, scene.dump()[0]"
    result = beltrami.parameterize(eval(after("in it, ", message), {"scene": scene}))
    assert result.uv.tobytes() == beltrami.parameterize(VERTICES, FACES).uv.tobytes()
    message = refusal(trimesh.Scene([mesh, mesh.copy()]))
    assert message.endswith("give one of its 2 meshes after the other, for mesh in scene.dump()")
