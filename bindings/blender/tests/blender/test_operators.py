# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators, as scripts call them."""

from __future__ import annotations

import bmesh
import conftest
import numpy as np
import pytest
from conftest import edit, leave, uvs_of, verdict
from mathutils import Vector


def faces_of(thing, name, dtype=bool):
    values = np.zeros(len(thing.data.polygons), dtype)
    thing.data.polygons.foreach_get(name, values)
    return values


def seams_of(thing):
    values = np.zeros(len(thing.data.edges), bool)
    thing.data.edges.foreach_get("use_seam", values)
    return values


def select_faces(thing, wanted):
    """Select some faces of an object that is edited."""
    bpy = conftest.bpy
    bpy.context.tool_settings.mesh_select_mode = (False, False, True)
    edited = bmesh.from_edit_mesh(thing.data)
    for face, chosen in zip(edited.faces, wanted):
        face.select_set(bool(chosen))
    bmesh.update_edit_mesh(thing.data)


def corners(thing, faces):
    return np.repeat(faces, faces_of(thing, "loop_total", np.int32))


def pin(thing, pinned):
    """Pin some corners of an object that is not edited."""
    layer = thing.data.uv_layers.active
    if hasattr(layer, "pin_ensure"):  # from Blender 5.0 on
        layer.pin_ensure()
    thing.data.uv_layers.active.pin.foreach_set("value", pinned)


def right_half(thing):
    leave()
    centres = np.array([polygon.center.x for polygon in thing.data.polygons])
    edit(thing)
    return centres > 0


def test_unwrap_is_sound_and_on_the_page(scene, monkey):
    before = np.array([vertex.co[:] for vertex in monkey.data.vertices])
    assert scene.ops.uv.beltrami_unwrap() == {"FINISHED"}
    assert scene.context.mode == "EDIT_MESH"
    found = verdict(monkey)
    assert found.injective
    uvs = uvs_of(monkey)
    assert uvs.min() >= 0
    assert uvs.max() <= 1
    after = np.array([vertex.co[:] for vertex in monkey.data.vertices])
    np.testing.assert_array_equal(before, after)


def test_unwrap_is_the_same_twice_and_in_object_mode(scene, monkey):
    scene.ops.uv.beltrami_unwrap()
    first = uvs_of(monkey)
    edit(monkey)
    scene.ops.uv.beltrami_unwrap()
    np.testing.assert_array_equal(first, uvs_of(monkey))
    scene.ops.uv.beltrami_unwrap()
    assert scene.context.mode == "OBJECT"
    np.testing.assert_array_equal(first, uvs_of(monkey))


def test_a_mesh_without_uvs_gets_some(scene, monkey):
    leave()
    while monkey.data.uv_layers:
        monkey.data.uv_layers.remove(monkey.data.uv_layers[0])
    edit(monkey)
    scene.ops.uv.beltrami_unwrap()
    leave()
    assert len(monkey.data.uv_layers) == 1
    assert verdict(monkey).injective


def test_only_selected_faces_move_and_nothing_lies_on_the_others(scene, monkey):
    scene.ops.uv.beltrami_unwrap()
    first = uvs_of(monkey)
    wanted = right_half(monkey)
    select_faces(monkey, wanted)
    scene.ops.uv.beltrami_unwrap(margin=8)
    second = uvs_of(monkey)
    moved = corners(monkey, wanted)
    np.testing.assert_array_equal(first[~moved], second[~moved])
    assert (first[moved] != second[moved]).any()
    assert verdict(monkey).injective


def test_hidden_faces_stay(scene, monkey):
    scene.ops.uv.beltrami_unwrap()
    first = uvs_of(monkey)
    wanted = right_half(monkey)
    select_faces(monkey, ~wanted)
    scene.ops.mesh.hide(unselected=False)
    scene.ops.mesh.select_all(action="SELECT")
    scene.ops.uv.beltrami_unwrap(margin=8)
    second = uvs_of(monkey)
    moved = corners(monkey, wanted)
    np.testing.assert_array_equal(first[~moved], second[~moved])
    assert (first[moved] != second[moved]).any()


def test_marked_seams_part_islands(scene):
    scene.ops.mesh.primitive_cube_add()
    cube = scene.context.object
    for edge in cube.data.edges:
        edge.use_seam = True
    edit(cube)
    scene.ops.uv.beltrami_unwrap()
    assert verdict(cube).injective
    rows = np.unique(uvs_of(cube), axis=0)
    assert len(rows) == 24


def test_sharp_edges_and_materials_part_islands_where_asked(scene):
    scene.ops.mesh.primitive_cube_add()
    cube = scene.context.object
    for edge in cube.data.edges:
        edge.use_edge_sharp = True
    edit(cube)
    scene.ops.uv.beltrami_unwrap(sharp_seams=True)
    assert len(np.unique(uvs_of(cube), axis=0)) == 24
    edit(cube)
    scene.ops.uv.beltrami_unwrap()
    assert len(np.unique(uvs_of(cube), axis=0)) < 24
    for k in range(6):
        cube.data.materials.append(scene.data.materials.new(str(k)))
        cube.data.polygons[k].material_index = k
    edit(cube)
    scene.ops.uv.beltrami_unwrap(materials="cut")
    assert len(np.unique(uvs_of(cube), axis=0)) == 24


def test_pinned_uvs_stay(scene, monkey):
    scene.ops.uv.beltrami_unwrap()
    leave()
    mesh = monkey.data
    middle = [vertex.index for vertex in mesh.vertices if vertex.co.z > 0.9]
    pinned = np.array([loop.vertex_index in middle for loop in mesh.loops])
    assert 0 < pinned.sum() < len(pinned)
    first = uvs_of(monkey)
    # Pins that the old map meets, moved and scaled together.
    moved = first * np.float32(0.5) + np.float32(0.25)
    monkey.data.uv_layers.active.uv.foreach_set("vector", moved.ravel())
    pin(monkey, pinned)
    edit(monkey)
    scene.ops.uv.beltrami_unwrap()
    second = uvs_of(monkey)
    np.testing.assert_array_equal(second[pinned], moved[pinned])
    assert verdict(monkey).injective
    edit(monkey)
    scene.ops.uv.beltrami_pack()
    np.testing.assert_array_equal(uvs_of(monkey)[pinned], moved[pinned])
    edit(monkey)
    scene.ops.uv.beltrami_unwrap(keep_pins=False)
    assert (uvs_of(monkey)[pinned] != moved[pinned]).any()


def test_pins_that_no_map_meets_are_refused_and_nothing_changes(scene, monkey):
    scene.ops.uv.beltrami_unwrap()
    leave()
    face = monkey.data.polygons[100]
    own = list(face.loop_indices)
    uvs = uvs_of(monkey)
    uvs[own] = uvs[own[::-1]]
    monkey.data.uv_layers.active.uv.foreach_set("vector", uvs.ravel())
    pinned = np.zeros(len(uvs), bool)
    pinned[own] = True
    pin(monkey, pinned)
    edit(monkey)
    with pytest.raises(RuntimeError, match="unpin some"):
        scene.ops.uv.beltrami_unwrap()
    np.testing.assert_array_equal(uvs_of(monkey), uvs)


def test_several_objects_share_the_page(scene):
    scene.ops.mesh.primitive_monkey_add()
    one = scene.context.object
    scene.ops.mesh.primitive_torus_add(location=(3, 0, 0))
    two = scene.context.object
    scene.ops.object.duplicate(linked=True)
    three = scene.context.object
    edit(one, two, three)
    scene.ops.uv.beltrami_auto(effort="quick")
    assert verdict(one, two).injective
    np.testing.assert_array_equal(uvs_of(two), uvs_of(three))


def test_objects_larger_in_the_scene_get_more_of_the_page(scene):
    scene.ops.mesh.primitive_plane_add()
    one = scene.context.object
    scene.ops.mesh.primitive_plane_add(location=(5, 0, 0))
    two = scene.context.object
    two.scale = (3, 3, 3)
    edit(one, two)
    scene.ops.uv.beltrami_unwrap()
    sides = [np.linalg.norm(uvs[1] - uvs[0]) for uvs in (uvs_of(one), uvs_of(two))]
    assert sides[1] / sides[0] == pytest.approx(3, rel=1e-3)
    edit(one, two)
    scene.ops.uv.beltrami_unwrap(scaled=False)
    sides = [np.linalg.norm(uvs[1] - uvs[0]) for uvs in (uvs_of(one), uvs_of(two))]
    assert sides[1] / sides[0] == pytest.approx(1, rel=1e-3)


def test_auto_unwrap_finds_seams_and_marks_them_where_asked(scene, monkey):
    scene.ops.uv.beltrami_auto(target_energy=2.1, effort="quick", keep_seams=False)
    assert verdict(monkey).injective
    before = seams_of(monkey)
    edit(monkey)
    scene.ops.uv.beltrami_auto(target_energy=2.1, effort="quick", keep_seams=False, mark_seams=True)
    leave()
    after = seams_of(monkey)
    assert (after & before == before).all()
    assert after.sum() > before.sum()


def test_less_distortion_takes_more_islands_or_seams(scene, monkey):
    counts = []
    for target in (2.02, 2.5):
        leave()
        for edge in monkey.data.edges:
            edge.use_seam = False
        edit(monkey)
        scene.ops.uv.beltrami_auto(target_energy=target, mark_seams=True, effort="quick")
        leave()
        counts.append(int(seams_of(monkey).sum()))
    assert counts[0] > counts[1]


def grid(scene):
    """Add a sheet of 8 by 8 quads with a hump, unwrapped, and edit it."""
    scene.ops.mesh.primitive_grid_add(x_subdivisions=8, y_subdivisions=8)
    thing = scene.context.object
    for vertex in thing.data.vertices:
        vertex.co.z = 0.5 * np.exp(-6 * (vertex.co.x**2 + vertex.co.y**2))
    edit(thing)
    scene.ops.uv.beltrami_unwrap()
    return thing


def test_straighten_makes_grids_of_selected_quads(scene, installed):
    thing = grid(scene)
    assert scene.ops.uv.beltrami_straighten() == {"FINISHED"}
    assert verdict(thing).injective
    for quad in uvs_of(thing).reshape(-1, 4, 2):
        assert [np.unique(quad[:, axis]).size for axis in (0, 1)] == [2, 2]


def test_straighten_takes_the_islands_of_selected_edges(scene, installed):
    thing = grid(scene)
    with pytest.raises(RuntimeError, match="No edge is selected"):
        scene.ops.mesh.select_all(action="DESELECT")
        scene.ops.uv.beltrami_straighten(straight="axes")
    scene.context.tool_settings.mesh_select_mode = (False, True, False)
    edited = bmesh.from_edit_mesh(thing.data)
    low = {vertex.index for vertex in edited.verts if vertex.co.y < -0.999}
    for edge in edited.edges:
        edge.select_set({vertex.index for vertex in edge.verts} <= low)
    bmesh.update_edit_mesh(thing.data)
    scene.ops.uv.beltrami_straighten(straight="v")
    assert verdict(thing).injective
    leave()
    on_side = np.array([loop.vertex_index in low for loop in thing.data.loops])
    assert np.unique(uvs_of(thing)[on_side][:, 1]).size == 1


def rest(scene, installed):
    """Let live unwrapping come to rest."""
    scene.context.view_layer.update()
    for _ in range(30):
        installed.following.step(scene.context)


def test_islands_follow_seams_and_pins_while_live_unwrapping_is_on(scene, installed):
    thing = grid(scene)
    manager = scene.context.window_manager
    manager.beltrami_live = True
    assert scene.app.timers.is_registered(installed.following._tick)
    rest(scene, installed)
    before = uvs_of(thing)
    edit(thing)
    edited = bmesh.from_edit_mesh(thing.data)
    for edge in edited.edges:
        edge.seam = all(abs(v.co.x) < 1e-6 and v.co.y < 0.1 for v in edge.verts)
    marked = sum(edge.seam for edge in edited.edges)
    bmesh.update_edit_mesh(thing.data)
    rest(scene, installed)
    opened = uvs_of(thing)
    assert marked > 0
    assert (opened != before).any()
    assert verdict(thing).injective

    edit(thing)
    edited = bmesh.from_edit_mesh(thing.data)
    layer = edited.loops.layers.uv.verify()
    edited.faces.ensure_lookup_table()
    corner = edited.faces[0].loops[0]
    place = corner[layer].uv.copy() + Vector((-0.05, -0.05))
    for loop in corner.vert.link_loops:
        loop[layer].uv = place
        loop[layer].pin_uv = True
    bmesh.update_edit_mesh(thing.data)
    rest(scene, installed)
    assert verdict(thing).injective
    np.testing.assert_array_equal(uvs_of(thing)[0], np.array(place, np.float32))
    assert (uvs_of(thing) != opened).all(axis=1).mean() > 0.9  # one pin takes all along

    edit(thing)
    manager.beltrami_live = False
    assert not scene.app.timers.is_registered(installed.following._tick)


def test_pack_keeps_shapes_and_what_is_not_selected(scene, monkey):
    scene.ops.uv.beltrami_auto(effort="quick")
    first = uvs_of(monkey)
    edit(monkey)
    scene.ops.uv.beltrami_pack(margin=16)
    assert verdict(monkey).injective
    second = uvs_of(monkey)
    assert (first != second).any()
    assert second.min() >= 8 / 1024 - 1e-6
    wanted = right_half(monkey)
    select_faces(monkey, wanted)
    scene.ops.uv.beltrami_pack(margin=2)
    third = uvs_of(monkey)
    moved = corners(monkey, wanted)
    np.testing.assert_array_equal(second[~moved], third[~moved])


def test_check_selects_what_is_flipped_and_what_overlaps(scene, monkey):
    scene.ops.uv.beltrami_unwrap()
    uvs = uvs_of(monkey)
    own = list(monkey.data.polygons[100].loop_indices)
    uvs[own] = uvs[own[::-1]]
    monkey.data.uv_layers.active.uv.foreach_set("vector", uvs.ravel())
    edit(monkey)
    assert scene.ops.uv.beltrami_check() == {"FINISHED"}
    leave()
    selected = faces_of(monkey, "select")
    assert selected[100]
    assert selected.sum() < 40


def test_check_leaves_the_selection_where_all_is_well(scene, monkey):
    scene.ops.uv.beltrami_unwrap()
    scene.ops.uv.beltrami_check(colours=True)
    leave()
    assert faces_of(monkey, "select").all()
    attribute = monkey.data.color_attributes["UV Stretch"]
    values = np.zeros(4 * len(monkey.data.loops), np.float32)
    attribute.data.foreach_get("color_srgb", values)
    assert values.reshape(-1, 4)[:, 3].min() == 1
    assert len(np.unique(values.reshape(-1, 4), axis=0)) > 50
    scene.ops.uv.beltrami_check(colours=True)  # in object mode, too
    again = np.zeros_like(values)
    monkey.data.color_attributes["UV Stretch"].data.foreach_get("color_srgb", again)
    np.testing.assert_allclose(values, again, atol=2 / 255)


def test_without_faces_there_is_a_sentence(scene, monkey):
    scene.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="select the faces"):
        scene.ops.uv.beltrami_unwrap()
    leave()
    scene.ops.object.select_all(action="DESELECT")
    assert not scene.ops.uv.beltrami_unwrap.poll()


def test_uvs_without_area_cannot_be_packed_and_that_is_said(scene, monkey):
    leave()
    zeros = np.zeros(2 * len(monkey.data.loops), np.float32)
    monkey.data.uv_layers.active.uv.foreach_set("vector", zeros)
    edit(monkey)
    with pytest.raises(RuntimeError, match="unwrap first"):
        scene.ops.uv.beltrami_pack()


def test_stacks_beside_faces_that_stay_are_refused_with_a_sentence(scene, monkey):
    scene.ops.uv.beltrami_unwrap()
    select_faces(monkey, right_half(monkey))
    with pytest.raises(RuntimeError, match="select all faces"):
        scene.ops.uv.beltrami_auto(stack="copies")


def test_shape_keys_and_other_layers_stay(scene, monkey):
    leave()
    monkey.data.uv_layers.new(name="second")
    monkey.data.uv_layers.active_index = 1
    monkey.shape_key_add(name="Basis")
    key = monkey.shape_key_add(name="moved")
    key.data[0].co.x += 1
    layer = monkey.data.uv_layers[0]
    before = np.zeros(2 * len(monkey.data.loops), np.float32)
    layer.uv.foreach_get("vector", before)
    edit(monkey)
    scene.ops.uv.beltrami_unwrap()
    leave()
    after = np.zeros_like(before)
    monkey.data.uv_layers[0].uv.foreach_get("vector", after)
    np.testing.assert_array_equal(before, after)
    assert monkey.data.shape_keys.key_blocks["moved"].data[0].co.x == key.data[0].co.x
    assert verdict(monkey).injective
    for kind in (scene.data.meshes, scene.data.shape_keys):  # of the copy that was read
        assert len(kind) == 1


def test_many_faces(scene):
    scene.ops.mesh.primitive_uv_sphere_add(segments=150, ring_count=75)
    sphere = scene.context.object
    edit(sphere)
    scene.ops.uv.beltrami_auto(effort="quick")
    assert verdict(sphere).injective


def test_a_selection_of_uvs_chooses_faces(scene, installed, monkey):
    bridge = installed.bridge
    scene.context.scene.tool_settings.use_uv_select_sync = False
    wanted = right_half(monkey)
    bridge.select(monkey, wanted, in_uvs=True)
    read = bridge.read(monkey, bridge.Reading(by_uvs=True))
    np.testing.assert_array_equal(read.chosen, wanted)
    assert bridge.read(monkey, bridge.Reading()).chosen.all()
    assert bridge.read(monkey, bridge.Reading(by_uvs=True, everything=True)).chosen.all()
