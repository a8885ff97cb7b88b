# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Packing among what stays, and what UVs are worth."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import shapes
from uv_logic import measuring, packing
from uv_logic.parts import joined, layout, regions


def halves(part):
    """Return the part with the UVs of its left half moved away: two charts."""
    left = np.repeat(part.positions[part.corners[::4], 0] < 0.5, 4)
    uvs = part.uvs * np.float32(0.5)
    uvs[left] += np.float32(0.5)
    return dataclasses.replace(part, uvs=uvs), left


def test_a_chart_is_what_shares_uv_vertices():
    hump = shapes.hump()
    part, left = halves(hump)
    flat = layout(joined([part]), part.uvs)
    assert len(np.unique(flat.chart_of_triangle)) == 2
    assert len(np.unique(flat.chart_of_triangle[left[flat.triangles[:, 0]]])) == 1


def test_charts_are_packed_and_keep_their_shapes():
    hump = shapes.hump()
    part, _ = halves(hump)
    surface = joined([part])
    before = measuring.measure(surface, part.uvs)
    packed = packing.pack(surface, part.uvs, joined([part], chosen=False), {"margin": 4.0})
    after = measuring.measure(surface, packed.uvs)
    assert after.sound
    assert after.charts == 2
    assert after.covered > 1.2 * before.covered
    assert after.energy == pytest.approx(before.energy, abs=1e-3)
    assert packed.report.margin >= 4


def test_what_is_not_chosen_is_no_place_to_pack():
    hump = shapes.hump()
    part, left = halves(hump)
    part = dataclasses.replace(part, chosen=~left[::4])
    surface = joined([part])
    packed = packing.pack(surface, surface.uvs, joined([part], chosen=False), {})
    uvs = part.uvs.copy()
    uvs[~left] = packed.uvs
    assert measuring.measure(
        joined([dataclasses.replace(part, chosen=np.ones(121, bool))]), uvs
    ).sound


def test_charts_with_pins_stay_where_they_are():
    part, left = halves(shapes.hump())
    pinned = np.zeros(len(left), bool)
    pinned[np.flatnonzero(left)[0]] = True
    part = dataclasses.replace(part, pinned=pinned)
    _, (uvs,) = packing.pack_parts([part], {"margin": 8.0})
    np.testing.assert_array_equal(uvs[left], part.uvs[left])
    assert (uvs[~left] != part.uvs[~left]).any()
    assert measuring.measure(joined([part]), uvs).sound
    _, (uvs,) = packing.pack_parts([part], {"margin": 8.0}, keep_pins=False)
    assert (uvs[left] != part.uvs[left]).any()
    with pytest.raises(ValueError, match="unpin some"):
        packing.pack_parts([dataclasses.replace(part, pinned=pinned | ~left)], {})


def test_charts_beyond_the_pages_are_no_obstacles():
    hump = shapes.hump()
    part = dataclasses.replace(hump, chosen=np.zeros(len(hump.sizes), bool))
    beyond = dataclasses.replace(part, uvs=part.uvs + np.float32(5))
    assert packing.obstacles(joined([part], chosen=False), 1)
    assert not packing.obstacles(joined([beyond], chosen=False), 1)
    without = dataclasses.replace(part, uvs=0 * part.uvs)
    assert not packing.obstacles(joined([without], chosen=False), 1)


def test_charts_across_tiles_are_obstacles_on_each():
    hump = shapes.hump()
    part = dataclasses.replace(hump, chosen=np.zeros(len(hump.sizes), bool))
    across = dataclasses.replace(part, uvs=part.uvs * np.float32(0.5) + np.array([0.77, 0], "f4"))
    surface = joined([across], chosen=False)
    area = [0.0, 0.0]
    for kept in packing.obstacles(surface, 2):
        assert kept.uvs[kept.uv_faces].min() >= 0
        assert kept.uvs[kept.uv_faces].max() <= 1
        page = int(kept.kept_pages[0])
        assert set(kept.kept_pages) == {page}
        a, b, c = (kept.uvs[kept.uv_faces[:, k]].astype(float) for k in range(3))
        area[page] += packing.doubled_areas(a, b, c).sum() / 2
    assert area[0] == pytest.approx(0.5 * 0.23, rel=1e-4)
    assert area[1] == pytest.approx(0.5 * 0.27, rel=1e-4)
    assert packing.pages_of(surface, {"texels_per_unit": 100.0}) == 2
    assert packing.pages_of(surface, {}) == 1


def test_nothing_is_packed_onto_charts_that_reach_beyond_the_page():
    hump = shapes.hump()
    part, left = halves(hump)
    uvs = part.uvs.copy()
    uvs[left] += np.float32(0.3)
    part = dataclasses.replace(part, chosen=~left[::4], uvs=uvs)
    surface = joined([part])
    packed = packing.pack(surface, surface.uvs, joined([part], chosen=False), {})
    uvs[~left] = packed.uvs
    whole = dataclasses.replace(part, chosen=np.ones(121, bool))
    assert measuring.measure(joined([whole]), uvs).sound
    assert packed.uvs.max() <= 1


def test_density_fills_tiles_of_udim():
    hump = shapes.hump()
    apart = dataclasses.replace(hump, positions=hump.positions + 2)
    surface = joined([hump, apart])
    options = {"texels_per_unit": 400.0, "resolution": 512}
    packed = packing.pack(surface, surface.uvs, joined([hump], chosen=False), options)
    assert packed.report.pages == 2
    assert 1 < packed.uvs[:, 0].max() <= 2
    assert packed.uvs[:, 1].max() <= 1


def test_without_uvs_there_is_nothing_to_pack():
    cube = shapes.cube()
    with pytest.raises(ValueError, match="unwrap first"):
        packing.pack(joined([cube]), cube.uvs, joined([cube], chosen=False), {})


def test_seams_part_regions():
    hump = shapes.hump()
    across = np.isin(hump.edges, np.arange(60, 72)).all(axis=1)
    surface = joined([dataclasses.replace(hump, seams=across)])
    assert len(np.unique(regions(surface, by_material=False))) == 2
    assert across.sum() == 11


def test_flips_and_overlaps_are_found_where_they_are():
    hump = shapes.hump()
    uvs = hump.uvs.copy()
    inner = hump.corners == 6 * 12 + 6
    uvs[inner] += np.float32(0.3)  # a vertex far beyond its neighbours
    found = measuring.measure(joined([hump]), uvs)
    assert found.flips > 0
    assert not found.sound
    faces = np.flatnonzero(found.flipped)
    assert np.isin(hump.corners.reshape(-1, 4)[faces], 6 * 12 + 6).any(axis=1).all()
    laid = dataclasses.replace(hump, positions=hump.positions + 3)
    two = measuring.measure(joined([hump, laid]), np.concatenate([hump.uvs, hump.uvs]))
    assert two.flips == 0
    assert two.overlaps > 0
    assert two.overlapping.any()


def test_mirrored_charts_may_count_as_sound():
    hump = shapes.hump()
    uvs = hump.uvs * np.array([-1, 1], np.float32)
    surface = joined([hump])
    assert measuring.measure(surface, uvs).flipped.all()
    mirrored = measuring.measure(surface, uvs, allow_mirrored=True)
    assert mirrored.sound
    assert not mirrored.flipped.any()


def test_energy_is_at_the_best_scale_and_two_for_what_keeps_lengths():
    vertices, faces = shapes.bumpy()
    vertices[:, 2] = 0
    part = shapes.part(vertices, faces)
    uvs = (7 * vertices[faces.ravel(), :2]).astype(np.float32)
    found = measuring.measure(joined([part]), uvs)
    assert found.energy == pytest.approx(2, abs=1e-6)
    assert np.abs(found.stretch).max() < 1e-5
    wide = measuring.measure(joined([part]), uvs * np.array([2, 0.5], np.float32))
    assert wide.energy == pytest.approx(4.25, abs=1e-4)
    assert wide.p99 == pytest.approx(4.25, abs=1e-4)


def test_uvs_without_area_have_no_energy():
    cube = shapes.cube()
    found = measuring.measure(joined([cube]), cube.uvs)
    assert found.energy == np.inf
    assert found.flips == 12
    assert found.flipped.all()


def test_colours_tell_larger_from_smaller():
    red, grey, blue = measuring.colours(np.array([-5.0, 0, 5]))
    assert red[0] > 2 * red[2]
    assert blue[2] > 2 * blue[0]
    assert grey[0] == grey[1] == grey[2]
    assert (np.array([red, grey, blue])[:, 3] == 1).all()
