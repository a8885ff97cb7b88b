"""The interface of xatlas: what code that was written for it gets."""

from __future__ import annotations

import doctest
import importlib.util
import sys
import warnings

import numpy as np
import pytest
from conftest import grid, read_obj

import beltrami
import beltrami.xatlas as ours

POSITIONS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def sphere(rows=12):
    """Return a closed mesh: two humps, one of them turned over, along their border."""
    vertices, faces = grid(rows)
    angle = np.pi * vertices[:, :2]
    below = vertices * [1, 1, -1]
    inner = np.abs(angle).max(axis=1) < np.pi - 1e-9
    number = np.arange(len(vertices))
    number[inner] = len(vertices) + np.arange(inner.sum())
    return np.concatenate([vertices, below[inner]]), np.concatenate([faces, number[faces][:, ::-1]])


MESHES = {
    "hump": grid(12),
    "sphere": sphere(),
    "tetrahedron": (POSITIONS, FACES),
    "unused vertex and faces without area": (
        np.vstack([[[9.0, 9, 9]], POSITIONS]),
        np.vstack([FACES + 1, [[1, 1, 2], [1, 2, 2]]]),
    ),
    "two parts": (np.vstack([POSITIONS, POSITIONS + 3]), np.vstack([FACES, FACES + 4])),
}


def require_xatlas():
    """Return the real one, or skip the test."""
    return pytest.importorskip("xatlas")


def check_result(result, positions, faces):
    """Check what xatlas promises of a mesh."""
    vmapping, indices, uvs = result
    assert (vmapping.dtype, indices.dtype, uvs.dtype) == (np.uint32, np.uint32, np.float32)
    assert vmapping.shape == (len(uvs),)
    assert uvs.shape == (len(vmapping), 2)
    assert (vmapping[indices] == faces).all()
    assert uvs.min() >= 0
    assert uvs.max() <= 1
    assert set(indices.ravel()) == set(range(len(vmapping)))
    assert vmapping.max() < len(positions)


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("module", ["beltrami.xatlas", "xatlas"])
def test_both_keep_the_same_promises(module, name):
    parametrize = (ours if module == "beltrami.xatlas" else require_xatlas()).parametrize
    positions, faces = MESHES[name]
    check_result(parametrize(positions, faces), positions, faces)
    check_result(parametrize(positions.astype(np.float32), faces.astype(np.uint32)), *MESHES[name])


@pytest.mark.parametrize("name", MESHES)
def test_what_is_handed_out_is_injective(name):
    positions, faces = MESHES[name]
    vmapping, indices, uvs = ours.parametrize(positions, faces)
    found = beltrami.check_atlas(positions, faces, uvs[indices])
    assert found.injective
    assert positions[vmapping].shape == (len(uvs), 3)


def test_the_interface_is_that_of_xatlas():
    xatlas = require_xatlas()
    for name in ("ChartOptions", "PackOptions"):
        theirs, mine = getattr(xatlas, name)(), getattr(ours, name)()
        known = [word for word in dir(theirs) if not word.startswith("_")]
        assert sorted(known) == sorted(mine.__slots__)
        for word in known:
            assert getattr(mine, word) == pytest.approx(getattr(theirs, word))
            assert type(getattr(mine, word)) is type(getattr(theirs, word))
    for name in ("Atlas", "Chart"):
        words = {word for word in dir(getattr(xatlas, name)) if not word.startswith("_")}
        mine = set(dir(getattr(ours, name))) | set(
            getattr(getattr(ours, name), "__dataclass_fields__", ())
        )
        assert words <= mine
    assert {kind.name: int(kind) for kind in ours.ChartType} == {
        name: int(kind) for name, kind in xatlas.ChartType.__members__.items()
    }
    assert str(ours.ChartType.LSCM) == str(xatlas.ChartType.LSCM)
    public = {word for word in dir(xatlas) if not word.startswith("_")}
    assert public <= set(ours.__all__)


def test_a_wrong_name_of_an_option_is_refused():
    with pytest.raises(AttributeError):
        ours.PackOptions().pading = 2
    with pytest.raises(TypeError, match="colour"):
        ours.parametrize(POSITIONS, FACES, colour=1)
    with pytest.raises(TypeError, match="margin is no option here"):
        ours.parametrize(POSITIONS, FACES, margin=1)


def three_meshes():
    """Return an atlas of meshes of several sizes, and the meshes."""
    atlas = ours.Atlas()
    meshes = [MESHES["hump"], (POSITIONS, FACES), MESHES["unused vertex and faces without area"]]
    for positions, faces in meshes:
        atlas.add_mesh(positions, faces)
    return atlas, meshes


def test_several_meshes_share_one_page_at_one_scale():
    atlas, meshes = three_meshes()
    assert (len(atlas), atlas.atlas_count, atlas.chart_count, atlas.width) == (0, 0, 0, 0)
    atlas.generate()
    assert (len(atlas), atlas.mesh_count, atlas.atlas_count) == (3, 3, 1)
    assert (atlas.width, atlas.height) == (1024, 1024)
    assert atlas.chart_count == sum(atlas.get_mesh_chart_count(i) for i in range(3))
    assert atlas.utilization == atlas.get_utilization(0)
    corners, densities = [], []
    for result, (positions, faces) in zip(atlas, meshes):
        check_result(result, positions, faces)
        _, indices, uvs = result
        corners.append(uvs[indices].astype(float))
        a, b, c = np.moveaxis(positions[faces], 1, 0)
        area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
        u, v, w = np.moveaxis(corners[-1], 1, 0)
        flat = 0.5 * np.abs(np.linalg.det(np.stack([v - u, w - u], axis=1))).sum()
        densities.append(1024 * (flat / area) ** 0.5)
    assert densities == pytest.approx(3 * [atlas.texels_per_unit], rel=0.05)
    count = [len(positions) for positions, _ in meshes]
    starts = np.cumsum([0, *count[:-1]])
    joined = np.concatenate([faces + start for (_, faces), start in zip(meshes, starts)])
    apart = np.concatenate([mesh[0] + [9 * k, 0, 0] for k, mesh in enumerate(meshes)])
    assert beltrami.check_atlas(apart, joined, np.concatenate(corners)).injective


def test_charts_are_those_of_the_faces():
    atlas, meshes = three_meshes()
    options = ours.PackOptions()
    atlas.generate(pack_options=options, hard_angle=60)
    assert atlas.get_mesh_chart_count(1) == 4
    charts = [atlas.get_mesh_chart(1, k) for k in range(4)]
    assert sorted(np.concatenate([chart.faces for chart in charts])) == [0, 1, 2, 3]
    assert charts[0].faces.dtype == np.uint32
    assert {chart.type for chart in charts} == {ours.ChartType.LSCM}
    assert {(chart.atlas_index, chart.material) for chart in charts} == {(0, 0)}
    first = 0
    for index, (_, faces) in enumerate(meshes):
        page, number = atlas.get_mesh_vertex_assignment(index)
        _, indices, _ = atlas[index]
        for k in range(atlas.get_mesh_chart_count(index)):
            mine = indices[atlas.get_mesh_chart(index, k).faces]
            assert (number[mine] == first + k).all()
            assert (page[mine] == 0).all()
        first += atlas.get_mesh_chart_count(index)
        if index == 2:
            assert (number[indices[len(faces) - 2 :]] == 2**32 - 1).all()
    assert first == atlas.chart_count
    with pytest.raises(IndexError, match="out of bounds"):
        atlas.get_mesh_chart(0, 99)


@pytest.mark.parametrize("count", [1, 2])
def test_options_of_pages_are_heard(count):
    def made(**values):
        atlas, options = ours.Atlas(), ours.PackOptions()
        for _ in range(count):
            atlas.add_mesh(*MESHES["sphere"])
        for name, value in values.items():
            setattr(options, name, value)
        atlas.generate(ours.ChartOptions(), options, hard_angle=20)
        return atlas

    assert made(resolution=256).width == 256
    dense = made(resolution=128, texels_per_unit=40.0)
    assert dense.texels_per_unit == pytest.approx(40)
    assert dense.width == 128
    assert dense.atlas_count == len([dense.get_utilization(k) for k in range(dense.atlas_count)])
    assert dense.atlas_count > 1
    sized = made(texels_per_unit=50.0)
    assert sized.texels_per_unit == pytest.approx(50)
    assert sized.atlas_count == 1
    assert sized.utilization > 0.4
    assert made(resolution=256, padding=8).utilization < made(resolution=256).utilization
    with pytest.raises(beltrami.NoRoomError):
        made(resolution=32, texels_per_unit=5000.0)


def test_two_charts_keep_their_distance():
    positions = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    for padding, bilinear, least in [(0, True, 2), (0, False, 1), (8, True, 18)]:
        atlas, options = ours.Atlas(), ours.PackOptions()
        options.padding, options.bilinear, options.resolution = padding, bilinear, 256
        atlas.add_mesh(np.vstack([positions, positions + 5]), [[0, 1, 2], [3, 4, 5]])
        atlas.generate(pack_options=options)
        _, indices, uvs = atlas[0]
        sides = 256 * uvs[indices].astype(float)
        ends = np.linspace(0, 1, 400)[:, None]
        outlines = [
            np.concatenate([a + ends * (b - a) for a, b in zip(side, np.roll(side, -1, axis=0))])
            for side in sides
        ]
        gap = np.linalg.norm(outlines[0][:, None] - outlines[1][None], axis=2).min()
        assert least - 0.01 <= gap < least + 2


def test_an_image_shows_the_charts():
    atlas, options = ours.Atlas(), ours.PackOptions()
    atlas.add_mesh(POSITIONS, FACES)
    with pytest.raises(IndexError):
        _ = atlas.chart_image
    atlas.generate()
    with pytest.raises(RuntimeError, match="create_image"):
        _ = atlas.chart_image
    options.create_image, options.resolution = True, 128
    atlas.generate(pack_options=options, hard_angle=60)
    image = atlas.chart_image
    assert (image.shape, image.dtype) == ((128, 128, 3), np.uint8)
    covered = image.any(axis=2)
    assert covered.mean() == pytest.approx(atlas.utilization, abs=0.02)
    assert len(np.unique(image[covered], axis=0)) == 4
    _, indices, uvs = atlas[0]
    x, y = (128 * uvs[indices].mean(axis=1)).astype(int).T
    assert covered[y, x].all()  # the first row is that of v = 0
    with pytest.raises(IndexError):
        atlas.get_chart_image(1)


def test_the_charts_of_uvs_may_be_kept():
    vertices, faces = grid(6)
    right = vertices[faces].mean(axis=1)[:, 0] > 0
    halves = faces + len(vertices) * right[:, None]
    positions = np.concatenate([vertices, vertices])
    uvs = positions[:, :2] + np.repeat([[0.0, 0], [5, 0]], len(vertices), axis=0)  # two islands
    atlas, options = ours.Atlas(), ours.ChartOptions()
    atlas.add_mesh(positions, halves, uvs=uvs)
    atlas.generate()
    assert atlas.chart_count == 1  # of vertices at the same places
    options.use_input_mesh_uvs = True
    atlas.generate(options)
    assert atlas.chart_count == 2


def test_meshes_of_uvs_are_packed_as_they_are():
    uvs = np.array([[0.0, 0], [2, 0], [0, 1], [5, 5], [9, 9], [6, 5], [5, 6]], np.float32)
    faces = [[0, 1, 2], [3, 5, 6]]
    atlas = ours.Atlas()
    atlas.add_uv_mesh(uvs, faces)
    atlas.add_uv_mesh(uvs[:4] + np.float32(0), [[0, 1, 2], [1, 3, 2]], np.array([[7], [8]]))
    atlas.generate()
    assert (len(atlas), atlas.atlas_count, atlas.chart_count) == (2, 1, 4)
    vmapping, indices, packed = atlas[0]
    assert vmapping.tolist() == [0, 1, 2, 3, 5, 6]
    assert (vmapping[indices] == faces).all()
    sides = np.linalg.norm(packed[indices] - packed[np.roll(indices, 1, axis=1)], axis=2)
    before = np.linalg.norm(uvs[faces] - uvs[np.roll(faces, 1, axis=1)], axis=2)
    scales = 1024 * sides / before
    assert scales == pytest.approx(np.full((2, 3), atlas.texels_per_unit), rel=1e-3)
    vmapping, indices, _ = atlas[1]
    assert len(vmapping) == 6
    assert [atlas.get_mesh_chart(1, k).material for k in range(2)] == [7, 8]
    assert atlas.get_mesh_vertex_assignment(1)[1][indices[1]].tolist() == [3, 3, 3]
    with pytest.raises(RuntimeError, match="not both"):
        atlas.add_mesh(POSITIONS, FACES)
    with pytest.raises(ValueError, match="one for each of 2 faces"):
        atlas.add_uv_mesh(uvs, faces, [1])


def test_folded_uvs_come_with_a_warning():
    atlas = ours.Atlas()
    atlas.add_uv_mesh([[0.0, 0], [1, 0], [0, 1], [0.1, 0.1]], [[0, 1, 2], [2, 1, 3]])
    with pytest.warns(beltrami.NotInjectiveWarning, match="1 flipped"):
        atlas.generate()
    assert len(atlas) == 1


def test_arrays_of_other_shapes_are_refused_as_by_xatlas():
    modules = [ours]
    if importlib.util.find_spec("xatlas"):
        modules.append(importlib.import_module("xatlas"))
    bad = [
        ((np.ones(1), FACES), "Nx3"),
        ((np.ones((1, 1)), FACES), "Nx3"),
        ((POSITIONS, np.ones(1, int)), "Nx3"),
        ((POSITIONS, np.ones((1, 1), int)), "Nx3"),
        ((POSITIONS, FACES, np.ones(1)), "Nx3"),
        ((POSITIONS, FACES, np.ones((1, 3))), "first dimension"),
        ((POSITIONS, FACES, POSITIONS, np.ones((4, 1))), "Nx2"),
        ((POSITIONS, FACES, POSITIONS, np.ones((1, 2))), "first dimension"),
    ]
    for module in modules:
        for arguments, words in bad:
            with pytest.raises(ValueError, match=words):
                module.Atlas().add_mesh(*arguments)
        with pytest.raises(RuntimeError, match="out of range"):
            module.Atlas().add_mesh(POSITIONS, FACES + 1)
        with pytest.raises(IndexError, match="out of bounds"):
            module.Atlas().get_mesh(0)
    with pytest.raises(beltrami.IndexOutOfRangeError) as caught:
        ours.parametrize(POSITIONS, [[0, 1, 2], [0, 1, -1]])
    assert (caught.value.element, caught.value.element_kind) == (1, "face")
    with pytest.raises(beltrami.MeshError):
        ours.parametrize(POSITIONS * np.nan, FACES)


def test_nothing_to_do_is_done(capsys):
    atlas = ours.Atlas()
    atlas.generate()
    assert (len(atlas), atlas.atlas_count) == (0, 0)
    atlas.add_mesh(POSITIONS, FACES)
    atlas.generate(verbose=True)
    assert "Charts: 1\nSize: 1024x1024\n" in capsys.readouterr().out


def test_results_are_copies():
    atlas = ours.Atlas()
    atlas.add_mesh(POSITIONS, FACES)
    atlas.generate()
    first = atlas[0][2]
    kept = first.copy()
    first[:, 1] = 1 - first[:, 1]
    assert (atlas[0][2] == kept).all()


def test_a_file_holds_what_was_given(tmp_path):
    positions, faces = grid(3)
    vmapping, indices, uvs = ours.parametrize(positions, faces)
    path = tmp_path / "hump.obj"
    ours.export(str(path), positions[vmapping], indices, uvs)
    vertices, read_uvs, read_faces = read_obj(path)
    assert (vertices.astype(np.float32) == positions[vmapping].astype(np.float32)).all()
    assert (read_uvs.astype(np.float32) == uvs).all()
    assert (read_faces == indices).all()
    for extra, corner in [({}, "1"), ({"uvs": uvs}, "1/1"), ({"normals": vertices}, "1//1")]:
        ours.export(path, vertices, [[0, 1, 2]], **extra)
        assert path.read_text().splitlines()[-1].split()[1] == corner
    ours.export(path, vertices, indices, uvs, vertices)
    assert "f 1/1/1 " in path.read_text()
    ours.export(path, vertices)
    assert "f" not in path.read_text()
    with pytest.raises(OSError, match="missing"):
        ours.export(tmp_path / "missing" / "hump.obj", vertices)


def test_trimesh_unwraps_with_it(monkeypatch):
    trimesh = pytest.importorskip("trimesh")
    monkeypatch.setitem(sys.modules, "xatlas", ours)
    monkeypatch.setattr(trimesh.tol, "strict", True)
    mesh = trimesh.Trimesh(*MESHES["sphere"], process=False)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        unwrapped = mesh.unwrap()
    assert (unwrapped.triangles == mesh.triangles).all()
    found = beltrami.check_atlas(
        mesh.vertices, mesh.faces, unwrapped.visual.uv[np.asarray(unwrapped.faces)]
    )
    assert found.injective


def test_its_snippets_run_as_they_stand():
    results = doctest.testmod(ours)
    assert results.attempted >= 15
    assert results.failed == 0
