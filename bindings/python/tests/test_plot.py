"""Pictures: what shows where."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import grid

import beltrami
from beltrami import _raster, _view, plot

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
pyplot = pytest.importorskip("matplotlib.pyplot")


@pytest.fixture(autouse=True)
def _close_figures():
    yield
    pyplot.close("all")


def picture(ax):
    """Return the picture in the axes, (height, width, 4)."""
    return np.asarray(ax.images[0].get_array())


def share(image, colour):
    """Return the share of the visible pixels that have about this colour."""
    visible = image[:, :, 3] > 0.5
    near = np.abs(image[:, :, :3] - colour).max(axis=2) < 0.06
    return (near & visible).sum() / visible.sum()


def test_a_layout_shows_the_triangles_where_they_are():
    uv = np.array([[0, 0], [2, 0], [0, 1]], float)
    ax = plot.layout(uv, [[0, 1, 2]], resolution=200)
    image = picture(ax)
    assert image.shape[1] == 200
    assert image.shape[0] == pytest.approx(102, abs=4)
    left, right, low, high = ax.images[0].get_extent()
    covered = (image[:, :, 3] > 0.5).mean() * (right - left) * (high - low)
    assert covered == pytest.approx(1, rel=0.03)
    assert image[10, 10, 3] == 1  # lower left
    assert image[-10, -10, 3] == 0
    assert ax.get_aspect() == 1
    assert not ax.axison


def test_flipped_faces_are_red_and_on_top(hump):
    vertices, faces = hump
    uv = vertices[:, :2].copy()
    assert share(picture(plot.layout(uv, faces, resolution=300)), plot._BAD) == 0
    uv[84] += [0.4, 0]  # the middle vertex, beyond its ring
    assert share(picture(plot.layout(uv, faces, resolution=300)), plot._BAD) > 0.003
    heat = plot.heat_map(vertices, faces, uv, resolution=300)
    assert share(picture(heat), plot._BAD) > 0.003


def test_an_atlas_shows_its_charts_in_colours_of_their_own():
    vertices, faces = grid(4)
    right = vertices[faces].mean(axis=1)[:, 0] > 0
    unwrapped = beltrami.unwrap(vertices, faces, face_labels=right)
    image = picture(plot.atlas(unwrapped, resolution=300))
    shares = [share(image, colour) for colour in plot._CHARTS[:2]]
    assert min(shares) > 0.3
    assert share(image, plot._BAD) == 0
    lines = plot.atlas(unwrapped, edges=False, resolution=99).collections[0]
    assert len(lines.get_segments()) == 24
    heat = plot.heat_map(*unwrapped.split(triangles=True), resolution=200)
    assert share(picture(heat), plot._BAD) == 0
    quads = beltrami.unwrap(np.eye(4, 3), [[0, 1, 2], [0, 2, 3, 1]])
    assert share(picture(plot.atlas(quads, edges=False, resolution=300)), plot._CHARTS[0]) > 0.3


def test_a_heat_map_takes_an_atlas_at_its_own_scale():
    vertices, faces = grid(20)
    packed = beltrami.unwrap(vertices, faces)
    alone = beltrami.unwrap(vertices, faces, pack="none")
    ends = []
    for unwrapped in (packed, alone):
        ax = plot.heat_map(unwrapped, resolution=200)
        image = picture(ax)
        assert share(image, plot._BAD) == 0
        ends.append(ax.figure.axes[1].get_ylim())
        width = np.ptp(ax.images[0].get_extent()[:2])
        assert 1.5 < width < 5  # of a square of side 2, in its unit of length
    assert ends[0] == pytest.approx(ends[1], rel=0.05)
    assert ends[0][1] < 4
    _, axes = pyplot.subplots(1, 2)
    assert plot.heat_map(packed, ax=axes[0], measure="area", resolution=99) is axes[0]
    with pytest.raises(TypeError, match="give ax by its name"):
        plot.heat_map(packed, axes[1])
    with pytest.raises(TypeError, match="faces and uv are missing"):
        plot.heat_map(vertices)


def test_pages_lie_side_by_side():
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    cube = np.array([[x, y, z] for x in (0.0, 1) for y in (0.0, 1) for z in (0.0, 1)])
    unwrapped = beltrami.unwrap(cube, sides, hard_angle=60, resolution=64, texels_per_unit=60)
    left, right, low, high = plot.atlas(unwrapped, resolution=300).images[0].get_extent()
    assert right - left > 5 * (high - low)
    ax = plot.heat_map(unwrapped, resolution=300)
    left, right, low, high = ax.images[0].get_extent()
    assert right - left > 5 * (high - low)


def test_a_scene_shows_its_meshes_on_their_pages():
    trimesh = pytest.importorskip("trimesh")
    scene = trimesh.Scene([trimesh.creation.box(), trimesh.creation.box([2, 1, 1])])

    def width(**options):
        left, right, _, _ = plot.atlas(beltrami.unwrap(scene, **options)).images[0].get_extent()
        return right - left

    assert width(share_page=True) < 1.1
    assert 1.5 < width() < 2.1
    apart = beltrami.unwrap(scene, pack="none")
    with pytest.raises(ValueError, match="lie on each other"):
        plot.atlas(apart)
    one = beltrami.unwrap(trimesh.Scene([trimesh.creation.box()]), pack="none")
    alone = plot.atlas(next(iter(one.atlases.values())), resolution=200)
    assert (picture(plot.atlas(one, resolution=200)) == picture(alone)).all()


def test_edges_are_drawn_where_faces_are_large():
    vertices, faces = grid(20)
    uv = vertices[:, :2]
    assert len(plot.layout(uv, faces, resolution=400).collections) == 2  # edges, and boundary
    assert len(plot.layout(uv, faces, resolution=50).collections) == 1
    assert len(plot.layout(uv, faces, resolution=400, edges=False).collections) == 1


def test_the_boundary_is_drawn_once(hump):
    vertices, faces = hump
    lines = plot.layout(vertices[:, :2], faces, edges=False, resolution=99).collections[0]
    assert len(lines.get_segments()) == 48


@pytest.mark.parametrize(
    ("measure", "start", "word"),
    [
        ("symmetric-dirichlet", 2, "isometric"),
        ("symmetric-arap", 0, "isometric"),
        ("area", None, "area"),
        ("conformal", 1, "angles"),
    ],
)
def test_a_heat_map_has_a_bar_that_says_what_it_means(hump, measure, start, word):
    vertices, faces = hump
    uv = beltrami.parameterize(vertices, faces).uv
    ax = plot.heat_map(vertices, faces, uv, measure=measure, resolution=99)
    bar = ax.figure.axes[1]
    assert word in bar.get_ylabel()
    low, high = bar.get_ylim()
    ticks = bar.get_yticks()
    assert len(ticks) == 5
    assert (ticks[0], ticks[-1]) == pytest.approx((low, high))
    assert low == pytest.approx(1 / high if start is None else start)


def test_colours_follow_the_distortion(hump):
    vertices, faces = hump
    uv = vertices[:, :2].copy()
    uv[:, 0] *= np.where(uv[:, 0] > 0, 2, 1)  # the right half is stretched
    flat = vertices * [1, 1, 0]
    ax = plot.heat_map(flat, faces, uv, limit=4.0, cmap="gray", resolution=300)
    image = picture(ax)
    middle = image.shape[0] // 2
    assert image[middle, image.shape[1] // 6, 0] < 0.1
    expected = np.log((2**2 + 1 + 2**-2 + 1) / 2 / 2) / np.log(4 / 2)
    assert image[middle, 5 * image.shape[1] // 6, 0] == pytest.approx(expected, abs=0.02)


def test_an_unknown_measure_is_named(hump):
    with pytest.raises(ValueError, match="measure is 'other': give 'symmetric-dirichlet' or"):
        plot.heat_map(*hump, hump[0][:, :2], measure="other")


def test_a_checkered_square_has_its_squares():
    vertices, faces = grid(4, height=0)
    ax = plot.checkered(
        vertices, faces, vertices[:, :2], cells=8, view=(0, 0, 1), up=(0, 1, 0), resolution=400
    )
    image = picture(ax)
    shares = [share(image, colour * image[200, 200, :3].max() / 0.95) for colour in plot._CHECKER]
    assert min(shares) > 0.35
    row = image[225, :, 2] - image[225, :, 0] > 0.15  # blue
    assert np.count_nonzero(np.diff(row[10:-10].astype(int))) in (7, 8)


def test_the_inner_side_has_other_colours():
    vertices, faces = grid(4, height=0)
    ax = plot.checkered(vertices, faces, vertices[:, :2], view=(0, 0, -1), resolution=300)
    visible = picture(ax)[picture(ax)[:, :, 3] > 0.9]
    assert (visible[:, 0] >= visible[:, 2] - 0.05).mean() > 0.95  # nothing blue


def test_the_nearest_face_shows_and_the_boundary_on_it():
    near, faces = grid(1, height=0)
    vertices = np.concatenate([near, near * 3 - [0, 0, 2]])
    both = np.concatenate([faces, faces + 4])
    uv = np.zeros((8, 2))
    uv[:4] = near[:, :2]
    ax = plot.checkered(vertices, both, uv, view=(0, 0, 1), up=(0, 1, 0), resolution=300)
    image = picture(ax)
    line = np.abs(image[:, :, :3] - plot._LINE).max(axis=2) < 0.1
    assert line[150, 95:105].any()  # of the small square, over the large one
    assert not line[150, 120:180].any()


def test_the_view_that_is_chosen_shows_the_front():
    vertices, faces = grid(30, height=0.2)
    towards = _view.frame(vertices, faces, vertices[:4], None, None)[2]
    assert towards[2] > 0.8
    rows = _view.frame(vertices, faces, vertices[:4], (1, 2, 3), (0, 0, 1))
    assert np.allclose(rows @ rows.T, np.eye(3))
    assert np.linalg.det(rows) == pytest.approx(1)
    assert np.allclose(rows[2], np.array([1, 2, 3]) / 14**0.5)
    with pytest.raises(ValueError, match="view must be a direction"):
        _view.frame(vertices, faces, vertices[:4], (0, 0, 0), None)


def test_a_mesh_of_many_views_is_looked_at_from_the_side_that_shows_more(bust):
    towards = _view.frame(*bust, bust[0][:10], None, (0, 1, 0))[2]
    assert abs(towards[1]) < 0.5


def test_axes_that_are_given_are_used(hump):
    vertices, faces = hump
    _, axes = pyplot.subplots(1, 3)
    uv = vertices[:, :2]
    assert plot.layout(uv, faces, axes[0], resolution=99) is axes[0]
    assert plot.heat_map(vertices, faces, uv, axes[1], resolution=99) is axes[1]
    assert plot.checkered(vertices, faces, uv, axes[2], resolution=99) is axes[2]


def drawings(vertices, faces, uv):
    """Return what draws each kind of picture."""
    return [
        lambda: plot.layout(uv, faces),
        lambda: plot.heat_map(vertices, faces, uv),
        lambda: plot.checkered(vertices, faces, uv),
    ]


def test_nothing_to_draw_is_refused():
    for draw in drawings(np.zeros((0, 3)), np.zeros((0, 3), int), np.zeros((0, 2))):
        with pytest.raises(beltrami.MeshError, match="no faces"):
            draw()


@pytest.mark.parametrize("shift", [-1, 1])
def test_faces_without_their_vertices_are_refused(hump, shift):
    vertices, faces = hump
    for draw in drawings(vertices, faces + shift, vertices[:, :2]):
        with pytest.raises(beltrami.IndexOutOfRangeError):
            draw()


def test_numbers_that_are_not_finite_are_refused(hump):
    vertices, faces = hump
    odd = vertices.copy()
    odd[7] = np.inf
    odd_uv = drawings(vertices, faces, odd[:, :2])
    odd_vertices = drawings(odd, faces, vertices[:, :2])[1:]
    for draw in odd_uv + odd_vertices:
        with pytest.raises(beltrami.NonFiniteError) as caught:
            draw()
        assert caught.value.element == 7


@pytest.mark.parametrize(
    "options", [{"limit": 2.0}, {"measure": "area", "limit": 0.5}, {"resolution": 0}], ids=str
)
def test_numbers_that_make_no_picture_are_refused(hump, options):
    name = "resolution" if "resolution" in options else "limit"
    with pytest.raises(ValueError, match=f"{name} is .*: give a number"):
        plot.heat_map(*hump, hump[0][:, :2], **options)
    with pytest.raises(ValueError, match="cells is 0: give a number from 1"):
        plot.checkered(*hump, hump[0][:, :2], cells=0)


def test_a_layout_without_area_is_drawn():
    plot.layout(np.zeros((3, 2)), [[0, 1, 2]])
    plot.layout([[0, 0], [1, 0], [2, 0]], [[0, 1, 2]])
    plot.checkered(np.eye(3), [[0, 1, 2]], np.zeros((3, 2)))


# ---- Rasters ------------------------------------------------------------------------------


def brute_force(points, depth, faces, width, height):
    """Return the nearest face at each pixel, one pixel and face after the other."""
    found = np.full((height, width), -1)
    for y in range(height):
        for x in range(width):
            best = -np.inf
            for number, face in enumerate(faces):
                matrix = np.vstack([points[face].T, np.ones(3)])
                if abs(np.linalg.det(matrix)) < 1e-12:
                    continue
                weights = np.linalg.solve(matrix, [x + 0.5, y + 0.5, 1])
                z = weights @ depth[face]
                if (weights >= 0).all() and z >= best:
                    best, found[y, x] = z, number
    return found


def test_a_raster_shows_the_nearest_face_at_every_pixel(monkeypatch):
    monkeypatch.setattr(_raster, "_SPANS", 50)  # several blocks
    random = np.random.default_rng(5)
    points = random.uniform(-3, 23, (60, 2))
    depth = random.uniform(0, 1, 60)
    faces = random.integers(0, 60, (40, 3))
    raster = _raster.rasterize(points, depth, faces, 20, 16)
    assert (raster.face == brute_force(points, depth, faces, 20, 16)).all()
    pixels, face, weights = _raster.barycentric(points, faces, raster)
    at = np.einsum("ik,ikj->ij", weights, points[faces[face]])
    assert np.allclose(at, np.stack([pixels % 20, pixels // 20], 1) + 0.5)
    z = np.einsum("ik,ik->i", weights, depth[faces[face]])
    assert np.allclose(z, raster.depth.ravel()[pixels])
