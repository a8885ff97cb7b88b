"""The page for browsers that `Atlas.html` writes."""

from __future__ import annotations

import base64
import json
import re
import subprocess
import zlib

import numpy as np
import pytest
from conftest import grid
from test_html import CUBE, SIDES

import beltrami
from beltrami import _program


def contents(path):
    """Return what the page holds: JSON, and its arrays by name."""
    text = path.read_text(encoding="utf-8")
    said = json.loads(re.search(r'<script [^>]*id="report">(.*?)</script>', text, re.DOTALL)[1])
    packed = re.search(r'<script [^>]*id="arrays">(.*?)</script>', text, re.DOTALL)[1]
    planes = np.frombuffer(zlib.decompress(base64.b64decode(packed)), np.uint8)
    words = np.ascontiguousarray(planes.reshape(4, -1).T).view("<u4").ravel()
    vertices, triangles = said["mesh"]["vertices"], said["mesh"]["triangles"]
    ends = np.cumsum([3 * vertices, 2 * vertices, triangles, 3 * triangles, triangles])
    assert len(words) == ends[-1]
    positions, uvs, energies, faces, charts = np.split(words, ends[:-1])
    return said, {
        "positions": positions.view(np.float32).reshape(-1, 3),
        "uvs": uvs.view(np.float32).reshape(-1, 2),
        "energies": energies.view(np.float32),
        "faces": np.cumsum(faces, dtype=np.uint32).reshape(-1, 3),
        "charts": charts,
    }


def test_the_page_holds_the_atlas(tmp_path):
    atlas = beltrami.unwrap(CUBE, SIDES, hard_angle=60, resolution=256)
    atlas.html(tmp_path / "cube <1>.html")
    said, arrays = contents(tmp_path / "cube <1>.html")
    np.testing.assert_array_equal(arrays["faces"], atlas.uv_triangles)
    np.testing.assert_array_equal(arrays["uvs"], atlas.uvs.astype(np.float32))
    np.testing.assert_array_equal(arrays["positions"] + 0.5, CUBE[atlas.origins])
    np.testing.assert_array_equal(arrays["charts"], np.repeat(np.arange(6), 2))
    np.testing.assert_allclose(arrays["energies"], 2, rtol=1e-6)
    report = said["report"]
    assert report["injective"]["result"] is True
    assert report["charts"] == 6
    assert report["input"]["path"] == "cube <1>"
    assert report["packing"]["pages"] == 1
    assert report["energy"]["symmetric_dirichlet"] == atlas.energy
    frame = np.array(said["mesh"]["frame"]).reshape(3, 3)
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)


def test_a_scene_with_one_mesh_has_its_page(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    box = trimesh.creation.box()
    scene = beltrami.unwrap(trimesh.Scene([box]))
    scene.html(tmp_path / "box.html")
    _, arrays = contents(tmp_path / "box.html")
    (atlas,) = scene.atlases.values()
    np.testing.assert_array_equal(arrays["faces"], atlas.uv_triangles)
    two = beltrami.unwrap(trimesh.Scene([box, box.copy()]))
    with pytest.raises(ValueError, match="the scene has 2"):
        two.html(tmp_path / "two.html")
    assert not (tmp_path / "two.html").exists()


def test_pages_lie_side_by_side(tmp_path):
    atlas = beltrami.unwrap(CUBE, SIDES, hard_angle=60, resolution=64, texels_per_unit=40)
    atlas.html(tmp_path / "a.html")
    _, arrays = contents(tmp_path / "a.html")
    assert atlas.packing.pages > 1
    np.testing.assert_array_equal(np.floor(arrays["uvs"][:, 0]).max(), atlas.packing.pages - 1)


def test_the_program_writes_the_same_page(tmp_path):
    vertices, faces = grid(4)
    atlas = beltrami.unwrap(vertices, faces)
    atlas.html(tmp_path / "ours.html")
    with (tmp_path / "in.obj").open("w", encoding="utf-8") as file:
        file.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices.tolist())
        file.writelines(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces.tolist())
    names = ["in.obj", "out.obj", "--html", "theirs.html", "--quiet"]
    subprocess.run([_program.path(), "unwrap", *names], cwd=tmp_path, check=True)
    ours, theirs = contents(tmp_path / "ours.html"), contents(tmp_path / "theirs.html")
    for key in ("charts", "utilisation", "energy", "seam_over_root_area"):
        for name in ours[0]["report"][key] if key == "energy" else [None]:
            one, other = (page[0]["report"][key] for page in (ours, theirs))
            assert (one[name] if name else one) == (other[name] if name else other)
    for name in ("uvs", "positions", "energies"):
        corners = [
            page[1][name][page[1]["faces"]] if name != "energies" else page[1][name]
            for page in (ours, theirs)
        ]
        np.testing.assert_allclose(*corners, rtol=1e-5, atol=1e-6)


def test_a_path_that_cannot_be_written_is_told(tmp_path):
    atlas = beltrami.unwrap(CUBE, SIDES)
    with pytest.raises(OSError, match="none"):
        atlas.html(tmp_path / "none" / "a.html")
