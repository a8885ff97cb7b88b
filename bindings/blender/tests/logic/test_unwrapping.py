# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""New UVs of what is chosen: seams, pins, what stays, several objects."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import shapes
from uv_logic import measuring, unwrapping
from uv_logic.parts import Part, RefusedError, joined
from uv_logic.unwrapping import Request

import beltrami

SEAMS = [(0, 2), (2, 3), (1, 3), (4, 6), (6, 7), (5, 7), (2, 6)]  # of a cube that becomes a cross


def with_seams(part: Part, pairs: list[tuple[int, int]]) -> Part:
    wanted = {tuple(sorted(pair)) for pair in pairs}
    seams = np.array([tuple(edge) in wanted for edge in part.edges.tolist()])
    assert seams.sum() == len(pairs)
    return dataclasses.replace(part, seams=seams)


def test_marked_seams_are_the_only_ones():
    cube = shapes.cube()
    marked = with_seams(cube, SEAMS)
    found = unwrapping.unwrap([marked], Request(tell_seams=True))
    assert found.measures.charts == 1
    assert found.measures.sound
    assert found.measures.energy == pytest.approx(2, abs=1e-4)
    assert {tuple(pair) for pair in found.seams[0].tolist()} == set(SEAMS)
    assert found.reached is None


def test_uvs_lie_on_the_page_with_the_margin():
    cube = shapes.cube()
    found = unwrapping.unwrap([cube], Request(options={"hard_angle": 60.0, "margin": 16.0}))
    uvs = found.uvs[0]
    assert found.measures.charts == 6
    assert uvs.min() >= 8 / 1024 - 1e-6
    assert uvs.max() <= 1 - 8 / 1024 + 1e-6


def test_faces_that_are_not_chosen_stay_and_nothing_is_laid_on_them():
    hump = shapes.hump()
    others = hump.positions[hump.corners[::4], 0] < 0.5
    uvs = hump.uvs * np.float32(0.5)  # they cover a quarter of the page
    part = dataclasses.replace(hump, chosen=~others, uvs=uvs)
    found = unwrapping.unwrap([part], Request())
    stays = np.repeat(others, part.sizes)
    np.testing.assert_array_equal(found.uvs[0][stays], uvs[stays])
    assert (found.uvs[0][~stays] != uvs[~stays]).any()
    whole = dataclasses.replace(part, chosen=np.ones(len(others), bool))
    assert measuring.measure(joined([whole]), found.uvs[0]).sound
    assert found.uvs[0].min() >= 0
    assert found.uvs[0].max() <= 1


def test_charts_beside_others_get_their_density():
    hump = shapes.hump()
    others = hump.positions[hump.corners[::4], 0] < 0.2
    part = dataclasses.replace(hump, chosen=~others, uvs=hump.uvs * np.float32(0.25))
    found = unwrapping.unwrap([part], Request())
    stays = np.repeat(others, part.sizes)
    moved = found.uvs[0][~stays]
    height = np.ptp(moved, axis=0)
    assert 0.2 < height.max() < 0.4


def test_without_room_at_the_density_of_others_charts_are_smaller():
    hump = shapes.hump()
    others = hump.positions[hump.corners[::4], 0] < 0.45
    uvs = hump.uvs.copy()
    part = dataclasses.replace(hump, chosen=~others, uvs=uvs)
    found = unwrapping.unwrap([part], Request())
    assert found.density < 1
    assert found.measures.sound
    whole = dataclasses.replace(part, chosen=np.ones(len(others), bool))
    assert measuring.measure(joined([whole]), found.uvs[0]).sound
    full = dataclasses.replace(hump, positions=hump.positions + 3)
    full = dataclasses.replace(full, chosen=np.zeros(len(others), bool))
    with pytest.raises(beltrami.NoRoomError, match="leave no room"):
        unwrapping.unwrap([part, full], Request())


def test_pins_stay_to_the_bit_and_their_chart_follows():
    hump = shapes.hump()
    corner = np.flatnonzero(np.isin(hump.corners, [0, 11]))
    pinned = np.zeros(len(hump.corners), bool)
    pinned[corner] = True
    uvs = hump.uvs * np.float32(0.3) + np.float32(0.6)
    part = dataclasses.replace(hump, pinned=pinned, uvs=uvs)
    found = unwrapping.unwrap([part], Request())
    np.testing.assert_array_equal(found.uvs[0][pinned], uvs[pinned])
    assert found.measures.sound
    assert found.measures.energy < 2.3
    assert np.ptp(found.uvs[0], axis=0).max() < 0.5  # not packed anew onto the whole page


def test_one_pin_keeps_the_size_of_its_chart():
    hump = shapes.hump()
    pinned = np.zeros(len(hump.corners), bool)
    pinned[0] = True
    uvs = hump.uvs * np.float32(0.3) + np.float32(0.2)
    part = dataclasses.replace(hump, positions=hump.positions * 50, pinned=pinned, uvs=uvs)
    found = unwrapping.unwrap([part], Request())
    np.testing.assert_array_equal(found.uvs[0][0], uvs[0])
    area = measuring.measure(joined([part]), found.uvs[0]).covered
    assert area == pytest.approx(0.09, rel=0.05)


def test_what_is_not_pinned_is_packed_around_what_is():
    hump = shapes.hump()
    pinned = np.zeros(len(hump.corners), bool)
    pinned[np.flatnonzero(np.isin(hump.corners, [0, 11]))] = True
    held = dataclasses.replace(hump, pinned=pinned, uvs=hump.uvs * np.float32(0.5))
    free = shapes.part(shapes.CUBE + 3, shapes.CUBE_FACES)
    found = unwrapping.unwrap([held, free], Request())
    np.testing.assert_array_equal(found.uvs[0][pinned], held.uvs[pinned])
    assert found.measures.sound
    assert found.measures.charts == 2
    assert found.uvs[1].min() >= 0
    assert found.uvs[1].max() <= 1


def test_pins_that_no_map_meets_are_refused_with_a_sentence():
    hump = shapes.hump()
    pinned = np.zeros(len(hump.corners), bool)
    pinned[:4] = True  # all corners of a face
    uvs = hump.uvs.copy()
    uvs[:4] = uvs[3::-1]  # turned over
    part = dataclasses.replace(hump, pinned=pinned, uvs=uvs)
    with pytest.raises(beltrami.PinError):
        unwrapping.unwrap([part], Request())
    assert unwrapping.unwrap([part], Request(keep_pins=False)).measures.sound


def test_several_objects_share_a_page_at_one_density():
    cube = shapes.cube()
    large = dataclasses.replace(cube, positions=2 * cube.positions)
    found = unwrapping.unwrap([cube, large], Request())
    assert found.measures.sound
    areas = [
        measuring.measure(joined([part]), uvs).covered
        for part, uvs in zip((cube, large), found.uvs)
    ]
    assert areas[1] / areas[0] == pytest.approx(4, rel=0.01)


def test_objects_at_one_place_are_not_joined():
    cube = shapes.cube()
    found = unwrapping.unwrap([cube, cube], Request(cut="auto"))
    assert found.measures.charts >= 2
    assert found.measures.sound


def test_materials_may_part_charts():
    hump = shapes.hump()
    materials = (hump.positions[hump.corners[::4], 1] < 0.5).astype(int)
    part = dataclasses.replace(hump, materials=materials)
    assert unwrapping.unwrap([part], Request()).measures.charts == 1
    assert unwrapping.unwrap([part], Request(materials="cut")).measures.charts == 2


def test_islands_keep_the_charts_of_the_uvs():
    hump = shapes.hump()
    moved = np.repeat(hump.positions[hump.corners[::4], 1] < 0.5, 4)
    uvs = hump.uvs.copy()
    uvs[moved] += np.float32(3)
    part = dataclasses.replace(hump, uvs=uvs)
    found = unwrapping.unwrap([part], Request(cut="islands"))
    assert found.measures.charts == 2
    assert found.measures.sound


def test_seams_that_were_found_can_be_marked_and_used():
    vertices, faces = shapes.bumpy(16)
    vertices[:, 2] *= 4
    part = shapes.part(vertices, faces)
    found = unwrapping.unwrap(
        [part], Request("auto", options={"target_energy": 2.02}, tell_seams=True)
    )
    assert found.reached
    assert found.measures.energy <= 2.0201
    assert len(found.seams[0]) > 0
    marked = with_seams(part, [tuple(pair) for pair in found.seams[0].tolist()])
    again = unwrapping.unwrap([marked], Request())
    assert again.measures.charts == found.measures.charts
    assert again.measures.energy == pytest.approx(found.measures.energy, abs=1e-3)


def test_polygons_of_several_sizes_are_taken():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0.5, 1]])
    faces = np.array([[0, 1, 2, 3]])
    part = shapes.part(vertices, faces)
    part = dataclasses.replace(
        part,
        corners=np.array([0, 1, 2, 3, 1, 4, 2]),
        sizes=np.array([4, 3]),
        materials=np.zeros(2, int),
        chosen=np.ones(2, bool),
        uvs=np.zeros((7, 2), np.float32),
        pinned=np.zeros(7, bool),
    )
    found = unwrapping.unwrap([part], Request())
    assert found.measures.charts == 1
    assert found.measures.energy == pytest.approx(2, abs=1e-5)


def test_a_vertex_that_is_nowhere_is_named():
    hump = shapes.hump()
    positions = hump.positions.copy()
    positions[7, 1] = np.nan
    with pytest.raises(RefusedError, match="vertex 7 of part"):
        unwrapping.unwrap([dataclasses.replace(hump, positions=positions)], Request())


def test_nothing_chosen_and_stacks_beside_others_are_refused():
    hump = shapes.hump()
    nothing = dataclasses.replace(hump, chosen=np.zeros(len(hump.sizes), bool))
    with pytest.raises(RefusedError, match="select some faces"):
        unwrapping.unwrap([nothing], Request())
    some = dataclasses.replace(hump, chosen=np.arange(len(hump.sizes)) < 50)
    with pytest.raises(RefusedError, match="select all faces"):
        unwrapping.unwrap([some], Request(cut="auto", options={"stack": "copies"}))


def test_copies_among_objects_are_stacked():
    cube = shapes.cube()
    apart = dataclasses.replace(cube, positions=cube.positions + 5)
    found = unwrapping.unwrap([cube, apart], Request(cut="auto", options={"stack": "copies"}))
    assert np.ptp(found.uvs[0], axis=0).max() > 0.5
    order = np.lexsort(found.uvs[0].T), np.lexsort(found.uvs[1].T)
    np.testing.assert_array_equal(found.uvs[0][order[0]], found.uvs[1][order[1]])


def test_progress_rises_to_the_end_and_cancels():
    hump = shapes.hump()
    told: list[float] = []

    def listen(fraction: float, stage: str) -> bool:
        told.append(fraction)
        return True

    part = dataclasses.replace(hump, chosen=np.arange(len(hump.sizes)) < 60)
    unwrapping.unwrap([part], Request(), listen)
    assert told == sorted(told)
    assert told[-1] > 0.9
    with pytest.raises(beltrami.Cancelled):
        unwrapping.unwrap([part], Request(), lambda fraction, stage: False)
