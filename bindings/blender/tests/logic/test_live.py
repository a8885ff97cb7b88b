# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that follow seams and pins; Blender is not needed."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import shapes
from uv_logic import measuring
from uv_logic.live import Live
from uv_logic.parts import Part, RefusedError, joined


def settle(live: Live, part: Part) -> Part:
    """Return the part with the UVs that it comes to."""
    for _ in range(50):
        uvs = live.follow(part)
        if uvs is None:
            return part
        part = dataclasses.replace(part, uvs=uvs)
    raise AssertionError("it never comes to rest")


def seam(part: Part, marked: bool) -> Part:
    """Return the part with a seam from its border to its middle, or without."""
    on = np.isclose(part.positions[:, 0], part.positions[6, 0]) & (part.positions[:, 1] < 0.5)
    seams = on[part.edges].all(axis=1)
    return dataclasses.replace(part, seams=seams & marked)


def pinned(part: Part, corners: list[int], by: tuple[float, float] = (0, 0)) -> Part:
    """Return the part with some corners pinned, the last of them moved with those at its vertex."""
    flags, uvs = np.zeros(len(part.corners), bool), part.uvs.copy()
    for corner in corners:
        flags |= part.corners == part.corners[corner]
    uvs[part.corners == part.corners[corners[-1]]] += np.array(by, np.float32)
    return dataclasses.replace(part, pinned=flags, uvs=uvs)


def test_what_does_not_change_is_left_alone():
    live, hump = Live(1), shapes.hump()
    assert live.follow(hump) is None
    assert live.follow(hump) is None
    live.close()


def test_islands_follow_seams_that_are_marked_and_cleared():
    live, hump = Live(1), shapes.hump()
    live.follow(hump)
    opened = settle(live, seam(hump, True))
    found = measuring.measure(joined([opened]), opened.uvs)
    assert found.sound
    before = measuring.measure(joined([hump]), hump.uvs)
    assert found.energy < before.energy
    closed = settle(live, seam(opened, False))
    again = measuring.measure(joined([closed]), closed.uvs)
    assert again.sound
    assert found.energy < again.energy < before.energy
    live.close()


def test_islands_follow_pins_that_move():
    live, hump = Live(1), shapes.hump()
    first = settle(live, pinned(hump, [0, 40, -1]))
    dragged = pinned(first, [0, 40, -1], (0.05, 0.03))
    after = settle(live, dragged)
    np.testing.assert_array_equal(after.uvs[dragged.pinned], dragged.uvs[dragged.pinned])
    assert (after.uvs != dragged.uvs).any()
    assert measuring.measure(joined([after]), after.uvs).sound
    live.close()


def test_pins_that_no_map_meets_are_told_and_a_way_back_is_open():
    live, hump = Live(1), shapes.hump()
    first = settle(live, pinned(hump, [0, 1, 2, 3]))
    corners = [0, 1, 2, 3]
    flipped = first.uvs.copy()
    at = [np.flatnonzero(first.corners == first.corners[k]) for k in corners]
    for one, other in ((0, 1), (3, 2)):
        flipped[at[one]], flipped[at[other]] = first.uvs[other], first.uvs[one]
    with pytest.raises(RefusedError):
        live.follow(dataclasses.replace(first, uvs=flipped))
    assert live.follow(dataclasses.replace(first, pinned=np.zeros_like(first.pinned))) is None
    live.close()


def test_other_shapes_and_uvs_of_others_begin_anew():
    live, hump = Live(1), shapes.hump()
    first = settle(live, seam(hump, True))
    moved = dataclasses.replace(first, positions=first.positions * np.array([1.0, 2.0, 1.0]))
    assert measuring.measure(joined([moved]), settle(live, moved).uvs).sound
    other = dataclasses.replace(first, uvs=hump.uvs)  # as after an undo: the seam is not in the UVs
    assert measuring.measure(joined([other]), settle(live, other).uvs).sound
    live.close()


def test_a_mesh_without_uvs_gets_some():
    live, cube = Live(1), shapes.cube()
    marked = dataclasses.replace(cube, seams=np.ones(len(cube.edges), bool))
    after = settle(live, marked)
    assert measuring.measure(joined([after]), after.uvs).charts == 6
    live.close()
