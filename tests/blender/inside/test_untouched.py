# SPDX-License-Identifier: GPL-3.0-or-later
"""What an unwrap must leave exactly as it was."""

import bpy
import numpy as np
import pytest

from tests.blender.inside import digest, scenes


def test_nothing_visible_is_cancelled_and_unchanged():
    grid = scenes.grid(2, 2)
    scenes.edit(grid)
    bpy.ops.mesh.hide()
    before, state = scenes.read_uv(grid), scenes.state(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"CANCELLED"}
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    assert scenes.state(grid) == state


@pytest.mark.parametrize("use_sync", [False, True])
@pytest.mark.parametrize("all_solved", [False, True])
@pytest.mark.parametrize("keep_in_place", [False, True])
def test_everything_but_the_uvs_survives(use_sync, all_solved, keep_in_place):
    both = scenes.grid_and_cube()
    other = scenes.grid(2, 2, name="Without selection", offset=(0.0, 5.0, 0.0))
    both.data.uv_layers.new(name="Second").active = False
    both.vertex_groups.new(name="Group").add([0, 3, 7], 0.25, "REPLACE")
    both.shape_key_add(name="Basis")
    both.shape_key_add(name="Key").data[2].co.z = 4.0
    both.active_shape_key_index = 1
    bpy.context.scene.tool_settings.use_uv_select_sync = use_sync
    scenes.edit(both, other)
    scenes.select_faces(other, [])
    # The closed cube, faces 6 to 11, fails.
    scenes.select_faces(both, range(5 if all_solved else 12))
    bm = scenes.edit_mesh(both)
    bm.faces.active = bm.faces[3]
    bm.edges[4].seam = True
    bm.edges[5].smooth = False
    bm.faces[5].hide_set(True)
    bm.select_history.clear()
    bm.select_history.add(bm.faces[2])
    bm.select_history.add(bm.faces[4])
    flags = np.random.default_rng(1).random((2, 48)) < 0.5
    scenes.set_uv_flags(both, flags[0])
    scenes.set_uv_flags(other, flags[1])
    states, other_uv = [scenes.state(both), scenes.state(other)], scenes.read_uv(other)
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=keep_in_place) == {"FINISHED"}
    for edited, before in zip((both, other), states):
        after = scenes.state(edited)
        assert {name: after[name] for name in after if after[name] != before[name]} == {}
    np.testing.assert_array_equal(scenes.read_uv(other), other_uv)


@pytest.mark.parametrize("keep_in_place", [False, True])
def test_layers_of_all_kinds_and_elements_that_a_script_holds_survive(keep_in_place):
    grid = scenes.bumpy_grid(4, 3)
    grid.data.uv_layers.new(name="Second").active = False
    grid.shape_key_add(name="Basis")
    grid.shape_key_add(name="Key").data[5].co.z = 4.0
    scenes.edit(grid)
    bm = scenes.edit_mesh(grid)
    random = np.random.default_rng(2)
    for kind in ("verts", "edges", "faces", "loops"):
        layers = getattr(bm, kind).layers
        for of_type, layer_name in ((layers.float, "Number"), (layers.string, "Name"), (layers.float_color, "Color")):
            of_type.new(layer_name)
        # Only now, as a new layer moves the others in memory.
        number, name, color = layers.float["Number"], layers.string["Name"], layers.float_color["Color"]
        loops = (loop for face in bm.faces for loop in face.loops)
        for element in loops if kind == "loops" else getattr(bm, kind):
            element[number], element[name], element[color] = random.random(), b"kept", random.random(4).tolist()
    other = bm.loops.layers.uv["Second"]
    for face in bm.faces:
        for loop in face.loops:
            loop[other].uv, loop[other].pin_uv = random.random(2).tolist(), random.random() < 0.5
    bpy.context.tool_settings.mesh_select_mode = (True, True, False)
    for elements in (bm.verts, bm.edges, bm.faces):
        elements.ensure_lookup_table()
    held = [bm.verts[3], bm.edges[4], bm.faces[5]]
    before = digest.digest()
    uv = scenes.read_uv(grid)
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=keep_in_place) == {"FINISHED"}
    assert digest.changes(before, digest.digest()) == []
    assert [element.is_valid and element.index for element in held] == [3, 4, 5]
    assert not np.array_equal(scenes.read_uv(grid), uv)


def test_shape_keys_survive_topology_edits_in_the_same_edit_session():
    # Reading the edit mesh into a temporary one must not renumber the original's shape key vertices.
    keys = []
    for unwrap in (False, True):
        grid = scenes.grid(3, 3)
        grid.shape_key_add(name="Basis")
        for index, point in enumerate(grid.shape_key_add(name="Key").data):
            point.co.z = float(index)
        grid.active_shape_key_index = 0
        scenes.edit(grid)
        scenes.select_faces(grid, [0, 4])
        bpy.ops.mesh.delete(type="FACE")
        bpy.ops.mesh.select_all(action="SELECT")
        if unwrap:
            assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
        for vertex in scenes.edit_mesh(grid).verts:
            vertex.co.x += 0.5 * vertex.index
        bpy.ops.object.mode_set(mode="OBJECT")
        keys.append([[tuple(point.co) for point in key.data] for key in grid.data.shape_keys.key_blocks])
    assert keys[0] == keys[1]


def test_operators_need_edit_mode():
    grid = scenes.grid(2, 2)
    bpy.context.view_layer.objects.active = grid
    for name in ("unwrap", "suggest_seams", "select", "shape", "extender", "shape_remove"):
        assert not getattr(bpy.ops.uv, f"spectral_{name}").poll(), name
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap.poll()
