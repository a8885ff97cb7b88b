"""Meshes, scenes and files of trimesh: the same out, with UVs."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from conftest import BUST

import beltrami

trimesh = pytest.importorskip("trimesh")


def box():
    mesh = trimesh.creation.box()
    mesh.metadata["author"] = "someone"
    mesh.vertex_attributes["weight"] = np.arange(8.0)
    mesh.face_attributes["part"] = np.arange(12)
    return mesh


def test_a_mesh_comes_back_with_uvs_and_all_that_it_had():
    mesh = box()
    before = (mesh.vertices.tobytes(), mesh.faces.tobytes(), repr(mesh.visual))
    atlas = beltrami.unwrap(mesh)
    assert atlas.injective
    assert atlas.uvs.tobytes() == beltrami.unwrap(mesh.vertices, mesh.faces).uvs.tobytes()
    out = atlas.mesh
    assert (out.vertices == mesh.vertices[atlas.origins]).all()
    assert (out.faces == atlas.uv_faces).all()
    assert (out.visual.uv == atlas.uvs).all()
    assert (out.vertex_normals == mesh.vertex_normals[atlas.origins]).all()
    assert (out.vertex_attributes["weight"] == atlas.origins).all()
    assert (out.face_attributes["part"] == np.arange(12)).all()
    assert out.metadata["author"] == "someone"
    assert (mesh.vertices.tobytes(), mesh.faces.tobytes(), repr(mesh.visual)) == before


def test_materials_and_colours_stay():
    mesh = box()
    mesh.visual = trimesh.visual.TextureVisuals(
        uv=np.zeros((8, 2)), material=trimesh.visual.material.SimpleMaterial(diffuse=[255, 0, 0])
    )
    out = beltrami.unwrap(mesh).mesh
    assert out.visual.material.diffuse.tolist() == [255, 0, 0, 255]
    assert out.visual.material is not mesh.visual.material
    mesh = box()
    mesh.visual.vertex_colors = np.arange(32, dtype=np.uint8).reshape(8, 4)
    atlas = beltrami.unwrap(mesh)
    colours = atlas.mesh.visual.vertex_attributes["color"]
    assert (colours == mesh.visual.vertex_colors[atlas.origins]).all()
    again = beltrami.unwrap(atlas.mesh)
    assert (again.mesh.visual.vertex_attributes["color"] == colours[again.origins]).all()
    mesh = box()
    mesh.visual.face_colors = np.arange(48, dtype=np.uint8).reshape(12, 4)
    out = beltrami.unwrap(mesh).mesh
    assert (out.face_attributes["color"] == mesh.visual.face_colors).all()


def test_islands_are_those_of_the_mesh():
    sides = beltrami.unwrap(box(), hard_angle=45)
    assert len(sides.charts) == 6
    again = beltrami.unwrap(sides.mesh, cut="islands")
    assert len(again.charts) == 6
    assert len(beltrami.unwrap(sides.mesh, cut="minimal").charts) == 1
    with pytest.raises(ValueError, match="give them as corner_uvs"):
        beltrami.unwrap(box(), cut="islands")


def scene():
    """Return two meshes, one of them placed twice, and some points."""
    scene = trimesh.Scene(metadata={"title": "things"})
    scene.add_geometry(box(), geom_name="box", node_name="left")
    shift = trimesh.transformations.translation_matrix([3, 0, 0])
    scene.graph.update("right", geometry="box", matrix=shift)
    scene.add_geometry(trimesh.creation.icosphere(1), geom_name="ball", transform=2 * shift)
    scene.add_geometry(trimesh.PointCloud(np.eye(3)), geom_name="points")
    return scene


def test_a_scene_comes_back_as_a_scene(tmp_path):
    given = scene()
    seen = []
    result = beltrami.unwrap(given, threads=2, progress=lambda *now: seen.append(now))
    assert result.injective
    assert result.atlases.keys() == {"box", "ball"}
    assert result.atlases["box"].options["threads"] == 2
    assert [fraction for fraction, _ in seen] == sorted(fraction for fraction, _ in seen)
    assert seen[-1][0] == pytest.approx(1)
    out = result.scene
    assert out.geometry.keys() == given.geometry.keys()
    assert set(out.graph.nodes_geometry) == set(given.graph.nodes_geometry)
    assert (out.graph["right"][0] == given.graph["right"][0]).all()
    assert out.metadata["title"] == "things"
    for name, atlas in result.atlases.items():
        assert out.geometry[name] is atlas.mesh
        assert atlas.uvs.tobytes() == beltrami.unwrap(given.geometry[name]).uvs.tobytes()
    assert not hasattr(given.geometry["ball"].visual, "uv")
    out.export(tmp_path / "scene.glb")
    again = beltrami.unwrap(tmp_path / "scene.glb")
    assert again.atlases.keys() == {"box", "ball"}


def test_what_is_wrong_in_a_scene_names_the_mesh():
    given = scene()
    given.geometry["ball"].vertices[5] = np.nan
    with pytest.raises(beltrami.NonFiniteError, match=r"^ball: vertex 5") as caught:
        beltrami.unwrap(given)
    assert caught.value.element == 5
    with pytest.raises(TypeError, match="with each mesh"):
        beltrami.unwrap(scene(), face_labels=np.zeros(12))
    with pytest.raises(beltrami.Cancelled):
        beltrami.unwrap(scene(), progress=lambda *_: False)


@pytest.mark.parametrize("kind", [str, lambda path: path])
def test_a_path_is_that_of_a_file_that_trimesh_loads(kind, tmp_path):
    path = tmp_path / "box.stl"
    box().export(path)
    atlas = beltrami.unwrap(kind(path), cut="minimal")
    assert atlas.report.vertices == 36  # as the file has them
    assert atlas.report.welded_vertices == 28
    assert len(atlas.charts) == 1
    assert atlas.mesh.visual.uv.shape == (len(atlas.uvs), 2)
    trimesh.PointCloud(np.eye(3)).export(tmp_path / "points.ply")
    with pytest.raises(TypeError, match=r"points\.ply holds a PointCloud, and no mesh"):
        beltrami.unwrap(kind(tmp_path / "points.ply"))


@pytest.mark.parametrize("kind", [str, lambda path: path])
def test_a_path_without_a_file_says_so(kind, tmp_path):
    missing = kind(tmp_path / "nowhere.obj")
    with pytest.raises(FileNotFoundError, match=r"nowhere\.obj") as caught:
        beltrami.unwrap(missing)
    assert str(caught.value.filename) == str(missing)
    with pytest.raises(IsADirectoryError):
        beltrami.unwrap(kind(tmp_path))


def test_a_file_without_trimesh_says_what_to_install(tmp_path, monkeypatch):
    path = tmp_path / "square.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")
    monkeypatch.setitem(sys.modules, "trimesh", None)
    with pytest.raises(ModuleNotFoundError, match="pip install trimesh"):
        beltrami.unwrap(path)


@pytest.mark.parametrize("suffix", ["obj", "ply", "stl", "off", "glb"])
def test_every_file_comes_back_as_a_mesh(suffix, tmp_path):
    path = tmp_path / f"box.{suffix}"
    box().export(path)
    mesh = beltrami.unwrap(path).mesh
    assert mesh.area == pytest.approx(6)
    assert mesh.visual.uv.shape == (len(mesh.vertices), 2)
    mesh.export(tmp_path / "out.obj")


def test_a_scene_comes_back_as_a_mesh_at_its_places(tmp_path):
    given = scene()
    result = beltrami.unwrap(given, share_page=True)
    mesh = result.mesh
    assert mesh.bounds == pytest.approx(given.bounds)
    assert len(mesh.faces) == 2 * 12 + 80
    assert mesh.visual.uv.shape == (len(mesh.vertices), 2)
    assert mesh.volume == pytest.approx(2 + given.geometry["ball"].volume * 8, rel=1e-6)
    one = trimesh.Scene(box())
    one.apply_translation([5, 0, 0])
    alone = beltrami.unwrap(one).mesh
    assert alone.bounds[0] == pytest.approx([4.5, -0.5, -0.5])
    assert (alone.face_attributes["part"] == np.arange(12)).all()


@pytest.mark.parametrize("things", [[], [trimesh.PointCloud(np.eye(3))]], ids=["empty", "points"])
def test_a_scene_without_a_mesh_is_refused(things):
    with pytest.raises(beltrami.MeshError, match="the scene has no mesh") as caught:
        beltrami.unwrap(trimesh.Scene(things))
    assert caught.value.status == "BELTRAMI_E_EMPTY"


def test_meshes_of_a_scene_share_a_page():
    given = scene()
    seen = []
    apart = beltrami.unwrap(given, fill_weight=0.0)
    result = beltrami.unwrap(
        given, share_page=True, resolution=512, progress=lambda *now: seen.append(now)
    )
    assert result.injective
    assert [fraction for fraction, _ in seen] == sorted(fraction for fraction, _ in seen)
    assert seen[-1][0] == pytest.approx(1)
    atlases = list(result.atlases.values())
    assert atlases[0].packing == atlases[1].packing
    assert (atlases[0].packing.pages, atlases[0].packing.resolution) == (1, 512)
    assert atlases[0].packing.margin >= 2
    assert atlases[0].options["pack"] == "pages"
    covered = 0.0
    for name, atlas in result.atlases.items():
        before = apart.atlases[name]
        assert (atlas.uv_faces == before.uv_faces).all()
        assert atlas.energy == pytest.approx(before.energy)
        assert result.scene.geometry[name] is atlas.mesh
        assert (atlas.mesh.visual.uv == atlas.uvs).all()
        assert (atlas.page_of_uv == 0).all()
        low, high = atlas.uvs.min(axis=0), atlas.uvs.max(axis=0)
        boxes = np.array([chart.box for chart in atlas.charts])
        assert (low == boxes[:, :2].min(axis=0)).all()
        assert (high == boxes[:, 2:].max(axis=0)).all()
        a, b, c = np.moveaxis(atlas.uvs[atlas.uv_triangles], 1, 0)
        covered += 0.5 * np.abs(np.linalg.det(np.stack([b - a, c - a], axis=1))).sum()
    assert covered == pytest.approx(result.atlases["box"].utilisation)
    corners = [atlas.corner_uvs for atlas in atlases]
    meshes = [given.geometry[name] for name in result.atlases]
    vertices = np.concatenate([mesh.vertices + 9 * k for k, mesh in enumerate(meshes)])
    faces = np.concatenate([meshes[0].faces, meshes[1].faces + len(meshes[0].vertices)])
    assert beltrami.check_atlas(vertices, faces, np.concatenate(corners)).injective
    assert beltrami.unwrap(box(), share_page=True).injective
    with pytest.raises(TypeError, match="share_page is for the meshes of a scene"):
        beltrami.unwrap(box().vertices, box().faces, share_page=True)


def test_meshes_share_a_page_at_the_sizes_that_the_scene_shows():
    given = trimesh.Scene([box()])
    given.add_geometry(box(), transform=np.diag([5.0, 5, 5, 1]))
    mesh = beltrami.unwrap(given, share_page=True).mesh
    a, b, c = np.moveaxis(mesh.visual.uv[mesh.faces], 1, 0)
    areas = 0.5 * np.abs(np.linalg.det(np.stack([b - a, c - a], axis=1)))
    assert areas / mesh.area_faces == pytest.approx((areas / mesh.area_faces)[0], rel=0.15)


def test_pages_are_shared_by_as_many_as_there_have_to_be():
    result = beltrami.unwrap(
        scene(), share_page=True, resolution=128, texels_per_unit=50, hard_angle=10
    )
    pages = {page for atlas in result.atlases.values() for page in atlas.page_of_uv}
    assert len(pages) == result.atlases["box"].packing.pages > 1
    assert len(result.atlases["box"].page_utilisations) == len(pages)
    for atlas in result.atlases.values():
        chart = atlas.chart_of_face[atlas.face_of_triangle]
        of_charts = np.array([chart.page for chart in atlas.charts])
        assert (atlas.page_of_uv[atlas.uv_triangles] == of_charts[chart][:, None]).all()


@pytest.mark.parametrize(
    "options", [{"pack": "none"}, {"fill_weight": 1.0}, {"stack": "copies"}, {"share_copies": True}]
)
def test_options_of_one_atlas_do_not_go_with_a_shared_page(options):
    with pytest.raises(ValueError, match=f"does not go with {next(iter(options))}="):
        beltrami.unwrap(scene(), share_page=True, **options)


def test_a_disk_stays_the_disk_that_it_is():
    atlas = beltrami.unwrap(BUST, cut="minimal")
    assert len(atlas.charts) == 1
    assert atlas.seam_length == 0
    assert atlas.mesh.visual.uv.shape == (len(atlas.mesh.vertices), 2)


def test_things_that_are_no_mesh_are_refused_in_words():
    with pytest.raises(TypeError, match="only a mesh, a scene or a path"):
        beltrami.unwrap(np.eye(3))
    with pytest.raises(TypeError, match="give its arrays, mesh"):
        beltrami.unwrap({"vertices": np.eye(3), "faces": [[0, 1, 2]]})
