"""Charts on the pages of a texture."""

from __future__ import annotations

import numpy as np
import pytest

import beltrami

TETRAHEDRON = (
    np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
    np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]),
)


def confetti(count: int, size: float = 1.0) -> beltrami.UvMesh:
    """Return so many triangles, each a chart, whose vertices in space are `size` times larger."""
    corner = np.array([[0, 0], [1, 0.2], [0, 1]])
    uvs = (corner + 2 * np.arange(count)[:, None, None] * [1, 0]).reshape(-1, 2)
    vertices = size * np.pad(uvs, ((0, 0), (0, 1)))
    return beltrami.UvMesh(uvs, np.arange(3 * count).reshape(-1, 3), vertices)


def areas(uvs: np.ndarray, faces: np.ndarray) -> np.ndarray:
    a, b, c = (uvs[faces[:, k]] for k in range(3))
    p, q = b - a, c - a
    return 0.5 * (p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0])


def test_an_atlas_lies_on_a_page() -> None:
    atlas = beltrami.unwrap(*TETRAHEDRON, hard_angle=10.0)
    assert atlas.injective
    assert atlas.packing is not None
    assert atlas.packing.pages == atlas.report.pages == 1
    assert atlas.packing.margin >= 2
    assert atlas.uvs.min() >= 0
    assert atlas.uvs.max() <= 1
    assert atlas.utilisation == pytest.approx(areas(atlas.uvs, atlas.uv_triangles).sum())
    assert atlas.page_utilisations.tolist() == [atlas.utilisation]
    assert atlas.energy == pytest.approx(2)  # at the scale of the surface
    apart = beltrami.unwrap(*TETRAHEDRON, hard_angle=10.0, pack="none")
    assert apart.packing is None
    assert areas(apart.uvs, apart.uv_triangles).sum() == pytest.approx(apart.report.area)


def test_pages_are_told_for_uv_vertices() -> None:
    atlas = beltrami.unwrap(*TETRAHEDRON, hard_angle=10.0, texels_per_unit=700.0)
    assert atlas.packing is not None
    assert atlas.packing.pages > 1
    of_faces = np.array([chart.page for chart in atlas.charts])[atlas.chart_of_face]
    assert (atlas.page_of_uv[atlas.uv_faces] == of_faces[:, None]).all()
    tiles = np.floor(atlas.udim_uvs).astype(int)
    assert (tiles[:, 0] + 10 * tiles[:, 1] == atlas.page_of_uv).all()
    assert beltrami.check_atlas(
        atlas.vertices, TETRAHEDRON[1], atlas.udim_uvs[atlas.uv_faces]
    ).injective


def test_splits_charts_at_a_price() -> None:
    x, y = np.meshgrid(np.arange(25.0), np.arange(2.0))
    vertices = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    low = np.arange(24)
    quads = np.column_stack([low, low + 1, low + 26, low + 25])
    whole = beltrami.unwrap(vertices, quads, fill_weight=0.0)
    assert whole.packing is not None
    assert whole.packing.splits == 0
    assert whole.packing.unsplit_utilisation == whole.utilisation
    atlas = beltrami.unwrap(vertices, quads, fill_weight=20.0)
    assert atlas.injective
    assert atlas.packing is not None
    assert atlas.packing.splits == len(atlas.charts) - 1 > 0
    assert atlas.packing.unsplit_utilisation == pytest.approx(whole.utilisation)
    gained = atlas.utilisation - whole.utilisation
    assert 20 * gained >= atlas.packing.split_length > 0
    given = beltrami.unwrap(vertices, quads, cut="given", seams=atlas.seams)
    assert (given.chart_of_face == atlas.chart_of_face).all()
    with pytest.raises(beltrami.InvalidArgumentError, match="fill-weight=20 has no effect"):
        beltrami.unwrap(vertices, quads, fill_weight=20.0, pack="none")


def test_packs_meshes_onto_common_pages() -> None:
    small, large = confetti(3), confetti(4, 2.0)
    packing = beltrami.pack([small, large], resolution=256)
    assert packing.injective
    assert packing.report.charts == 7
    assert packing.report.margin >= 2
    first, second = (areas(uvs, faces) for uvs, faces in zip(packing.uvs, packing.uv_faces))
    assert (first > 0).all()
    assert second == pytest.approx(4 * first[0])
    assert first.sum() + second.sum() == pytest.approx(packing.utilisation)
    assert packing.chart_of_face[1].tolist() == [3, 4, 5, 6]


def test_the_same_bits_on_any_number_of_threads() -> None:
    one, two = (beltrami.pack(confetti(20), threads=threads) for threads in (1, 2))
    assert one.uvs[0].tobytes() == two.uvs[0].tobytes()


def test_charts_stay_where_they_are() -> None:
    mesh = confetti(5)
    before = beltrami.pack(mesh, texels_per_unit=100.0)
    kept = np.zeros(5, int)
    kept[2] = -1
    after = beltrami.pack(
        beltrami.UvMesh(before.uvs[0], mesh.uv_faces, mesh.vertices, kept_pages=kept)
    )
    moved = np.arange(15) // 3 == 2
    assert (after.uvs[0][~moved] == before.uvs[0][~moved]).all()
    assert after.report.texels_per_unit == pytest.approx(100)
    assert after.report.margin >= 2
    kept[0] = 1
    mesh = beltrami.UvMesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    with pytest.raises(ValueError, match="different pages"):
        beltrami.pack(beltrami.UvMesh(mesh.uvs, mesh.uv_faces, kept_pages=[0, 1]))


def test_labels_have_pages_of_their_own() -> None:
    mesh = confetti(3)
    labelled = beltrami.UvMesh(mesh.uvs, mesh.uv_faces, page_labels=[8, 3, 8])
    packing = beltrami.pack(labelled)
    assert packing.page_of_chart.tolist() == [1, 0, 1]
    assert packing.udim_uvs[0].max() > 1
    with pytest.raises(ValueError, match="page_labels has the shape"):
        beltrami.pack(beltrami.UvMesh(mesh.uvs, mesh.uv_faces, page_labels=[8]))
    tetrahedron = (np.eye(4, 3), [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    labels = np.array([1, 0, 0, 1])
    atlas = beltrami.unwrap(*tetrahedron, face_labels=labels, label_pages=True)
    assert (atlas.page_of_uv[atlas.uv_triangles] == labels[:, None]).all()
    with pytest.raises(ValueError, match="no face labels"):
        beltrami.unwrap(*tetrahedron, label_pages=True)


def test_single_precision_in_and_out() -> None:
    mesh = confetti(5)
    uvs = np.asarray(mesh.uvs, np.float32)
    packing = beltrami.pack(beltrami.UvMesh(uvs, mesh.uv_faces))
    assert packing.uvs[0].dtype == np.float32
    assert packing.injective
    assert packing.report.margin >= 2


def test_masks_show_what_charts_cover() -> None:
    packing = beltrami.pack(confetti(4), resolution=64, masks=True)
    (mask,) = packing.masks
    assert mask.shape == (64, 64)
    counts = np.bincount(mask.ravel(), minlength=3)
    assert counts[2] > 64 * 64 * packing.utilisation
    assert counts[1] > 0


def test_says_what_came_flipped() -> None:
    mesh = confetti(3)
    faces = np.array(mesh.uv_faces)
    faces[1] = faces[1, ::-1]
    with pytest.warns(beltrami.NotInjectiveWarning, match="1 flipped"):
        packing = beltrami.pack(beltrami.UvMesh(mesh.uvs, faces))
    assert packing.status == "BELTRAMI_NOT_INJECTIVE"
    assert packing.certificate.first_bad_face == 1


def test_says_that_there_is_no_room() -> None:
    with pytest.raises(beltrami.NoRoomError):
        beltrami.pack(confetti(3), texels_per_unit=1e5)
    with pytest.raises(beltrami.NoRoomError):
        beltrami.unwrap(*TETRAHEDRON, texels_per_unit=1e5)


def test_refuses_what_is_no_mesh() -> None:
    with pytest.raises(TypeError, match="UvMesh"):
        beltrami.pack([TETRAHEDRON])  # type: ignore[list-item]
    with pytest.raises(IndexError):
        beltrami.pack(beltrami.UvMesh([[0, 0], [1, 0], [0, 1]], [[0, 1, 3]]))
