"""What notebooks show of an atlas."""

from __future__ import annotations

import base64
import dataclasses
import html.parser
import io
import re
import sys

import numpy as np
import pytest
from conftest import grid

import beltrami
from beltrami import _html, _layouts

CUBE = np.array([[x, y, z] for x in (0.0, 1) for y in (0.0, 1) for z in (0.0, 1)])
SIDES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def picture(shown):
    """Return the picture in a snippet, (height, width, 4)."""
    image = pytest.importorskip("PIL.Image")
    data = base64.b64decode(re.search(r'src="data:image/png;base64,([^"]+)"', shown)[1])
    return np.asarray(image.open(io.BytesIO(data)))


def cells(shown):
    """Return the table in a snippet, by the words of its first column."""
    found = re.findall(r"<td[^>]*>([^<]*)</td>", shown)
    return dict(zip(found[::2], found[1::2]))


class Balanced(html.parser.HTMLParser):
    """Whether every element that is opened is closed."""

    def __init__(self, text):
        super().__init__()
        self.open = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        if tag != "img":
            self.open.append(tag)

    def handle_endtag(self, tag):
        if tag != "img":
            assert self.open.pop() == tag


def test_an_atlas_shows_its_layout_and_figures():
    atlas = beltrami.unwrap(CUBE, SIDES, hard_angle=60, resolution=256)
    shown = atlas._repr_html_()
    assert not Balanced(shown).open
    assert "http" not in shown
    table = cells(shown)
    assert table["injective"] == "yes, proven"
    assert table["charts"] == "6"
    assert table["pages"] == "1 of 256 x 256 texels"
    assert table["energy, mean"].startswith("2 ")
    image = picture(shown)
    assert image.shape == (320, 320, 4)
    coloured = np.abs(image[:, :, :3].astype(int) - _html._PAGE).max(axis=2) > 20
    assert coloured.mean() == pytest.approx(atlas.utilisation, abs=0.02)
    isometric = np.abs(image[:, :, :3] - _html._COLOURS[0]).max(axis=2) < 3
    assert isometric.mean() > 0.9 * atlas.utilisation


def test_charts_are_drawn_where_they_lie():
    atlas = beltrami.unwrap(*grid(4), resolution=256)
    image = picture(atlas._repr_html_())
    middle = atlas.uvs[atlas.uv_triangles].mean(axis=1)
    x, y = (320 * middle).astype(int).T
    page = np.abs(image[319 - y, x, :3].astype(int) - _html._PAGE).max(axis=1) <= 3
    assert not page.any()


def test_energies_are_those_of_the_report():
    vertices, faces = grid(20)
    for pack in ("pages", "none"):
        atlas = beltrami.unwrap(vertices, faces, pack=pack)
        found = _layouts.layout(atlas)
        mean = found.energies @ found.areas / found.areas.sum()
        assert mean == pytest.approx(atlas.energy, rel=1e-6)
        assert _layouts.most(found.energies, found.areas) == pytest.approx(atlas.report.p99)
        if atlas.packing is not None:
            texels = atlas.packing.resolution / atlas.packing.texels_per_unit
            assert found.unit == pytest.approx(texels, rel=1e-4)


def test_what_has_no_page_is_drawn_as_it_lies():
    atlas = beltrami.unwrap(*grid(6), pack="none")
    shown = atlas._repr_html_()
    assert "pages" not in cells(shown)
    image = picture(shown)
    assert max(image.shape[:2]) >= 320
    assert (image[:, :, 3] == 0).any()


def test_the_first_pages_are_shown():
    atlas = beltrami.unwrap(CUBE, SIDES, hard_angle=60, resolution=64, texels_per_unit=60)
    assert atlas.packing.pages == 6
    shown = atlas._repr_html_()
    assert cells(shown)["pages"].startswith("6 of")
    assert picture(shown).shape[1] > 4 * picture(shown).shape[0]


def test_faces_without_area_and_folds_are_shown():
    faces = [*SIDES, [0, 0, 1, 1]]
    assert "yes, proven" in beltrami.unwrap(CUBE, faces)._repr_html_()
    atlas = beltrami.unwrap(*grid(8))
    uvs = atlas.uvs.copy()
    uvs[atlas.uv_faces[40, 0]] = uvs[atlas.uv_faces[100, 0]]
    found = beltrami.check_atlas(atlas.vertices, grid(8)[1], uvs[atlas.uv_faces])
    shown = dataclasses.replace(atlas, uvs=uvs, certificate=found)._repr_html_()
    assert cells(shown)["injective"].startswith(f"no: {found.negative} flipped")
    red = np.abs(picture(shown)[:, :, :3].astype(int) - _html._BAD).max(axis=2) < 3
    assert red.any()


def test_a_scene_shows_its_meshes():
    trimesh = pytest.importorskip("trimesh")
    scene = trimesh.Scene()
    for number in range(10):
        scene.add_geometry(trimesh.creation.box(), geom_name=f"<box {number}>")
    shown = beltrami.unwrap(scene, effort="quick")._repr_html_()
    assert not Balanced(shown).open
    assert shown.count("<img") == 8
    assert "&lt;box 0&gt;" in shown
    assert "and 2 more" in shown


def test_numpy_is_enough(monkeypatch):
    for name in ("matplotlib", "PIL"):
        monkeypatch.setitem(sys.modules, name, None)
    assert "base64" in beltrami.unwrap(CUBE, SIDES)._repr_html_()
