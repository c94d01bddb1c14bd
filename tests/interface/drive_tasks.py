# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: five tasks of an artist, and how many clicks each takes."""

import bmesh
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface import extender_sidebar as sidebar
from tests.interface.drive_constraints import COLUMNS, ROWS, bent_sheet
from tests.interface.drive_suggest_seams import seams, shown, watch_previews
from tests.interface.session import override, point_at, screenshot, uv, xdotool

WHEEL_DOWN = 5


class Hand:
    """Clicks of the mouse, counted."""

    def __init__(self):
        self.clicks = 0

    def on(self, place):
        """Click a place in the sidebar."""
        self.clicks += 1
        yield from sidebar.click_sidebar(place)

    def on_mesh(self):
        """Click the middle of the viewport, where the mesh is."""
        self.clicks += 1
        point_at("VIEW_3D", 0.38, 0.5)
        yield
        xdotool("click", 1)
        yield


def edit(made):
    """Put a new object alone into edit mode, its faces selected, in the middle of what the sidebar leaves free."""
    with override("VIEW_3D"):
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        for other in [each for each in bpy.data.objects if each.type == "MESH"]:
            bpy.data.objects.remove(other)
        made()
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_mode(type="FACE")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="Task")
    view = drive.area_of("VIEW_3D").spaces.active.region_3d
    view.view_distance *= 1.7
    view.view_location.x += 0.5
    yield
    yield


def prop():
    bpy.ops.mesh.primitive_cube_add(calc_uvs=False)
    bpy.ops.object.modifier_add(type="BEVEL")
    bpy.ops.object.modifier_apply(modifier="Bevel")


def character():
    bpy.ops.mesh.primitive_monkey_add()


def sheet():
    bpy.context.view_layer.objects.active = bent_sheet()


def apply_seams(hand, wheel=0):
    """Suggest seams, take fewer by the wheel, and click the mesh."""
    yield from hand.on(sidebar.SUGGEST_SEAMS)
    yield from drive.until(lambda: shown)
    yield from drive.until(lambda: shown[0].count in shown[0]._measured)
    count = shown[0].count
    for _ in range(wheel):
        point_at("VIEW_3D", 0.38, 0.5)
        xdotool("click", WHEEL_DOWN)
        yield
    assert shown[0].count == count - wheel
    yield from hand.on_mesh()
    yield from drive.until(lambda: not shown)
    assert seams()
    yield


def is_mapped():
    """Return whether all UVs are finite and fill the tile from border to border."""
    return np.isfinite(uv()).all() and np.ptp(uv(), axis=0).max() > 0.95


def steps():
    watch_previews()
    yield from edit(prop)
    yield from sidebar.open_sidebar()
    hand = Hand()
    yield from apply_seams(hand)
    assert is_mapped() and hand.clicks == 2, hand.clicks
    screenshot("task_prop")

    yield from edit(character)
    hand = Hand()
    yield from apply_seams(hand, wheel=2)
    assert is_mapped() and hand.clicks == 2, hand.clicks
    screenshot("task_character")

    yield from edit(sheet)
    with override("VIEW_3D"):
        bpy.ops.uv.spectral_unwrap("EXEC_DEFAULT", True)
        bpy.ops.mesh.select_mode(type="EDGE")
        bpy.ops.mesh.select_all(action="DESELECT")
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    for edge in bm.edges:
        edge.select_set(all(vertex.index % (ROWS + 1) == 3 for vertex in edge.verts))
    bmesh.update_edit_mesh(bpy.context.edit_object.data)
    before, hand = uv(), Hand()
    yield from hand.on(sidebar.STRAIGHT)
    yield from drive.until(lambda: not np.array_equal(uv(), before))
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    layer, row = bm.loops.layers.uv.active, [vertex for vertex in bm.verts if vertex.index % (ROWS + 1) == 3]
    points = np.array([loop[layer].uv[:] for vertex in row for loop in vertex.link_loops])
    assert len(row) == COLUMNS + 1 and np.ptp(points, axis=0).min() < 1e-5 and hand.clicks == 1, np.ptp(points, axis=0)
    screenshot("task_straight")

    # A region in the middle is crumpled by hand.
    region = [ROWS * column + place for column in range(4, 8) for place in range(2, 5)]
    with override("VIEW_3D"):
        bpy.ops.mesh.select_mode(type="FACE")
        bpy.ops.mesh.select_all(action="DESELECT")
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    bm.faces.ensure_lookup_table()
    layer = bm.loops.layers.uv.active
    for index in region:
        bm.faces[index].select_set(True)
    inner = [vertex for vertex in bm.verts if all(face.select for face in vertex.link_faces)]
    good = uv()
    for vertex in inner:
        for loop in vertex.link_loops:
            loop[layer].uv.x += 0.08
    bmesh.update_edit_mesh(bpy.context.edit_object.data)
    crumpled, hand = uv(), Hand()
    yield from hand.on(sidebar.UNWRAP)
    yield from drive.until(lambda: not np.array_equal(uv(), crumpled))
    moved = (crumpled != good).any(axis=1)
    np.testing.assert_array_equal(uv()[~moved], good[~moved])
    assert np.abs(uv() - good).max() < 0.25 * np.abs(crumpled - good).max() and hand.clicks == 1
    screenshot("task_region")

    # Once: 2k and 8 pixels.
    yield from edit(prop)
    with override("VIEW_3D"):
        bpy.ops.uv.spectral_suggest_seams("EXEC_DEFAULT", True)
    yield from sidebar.click_sidebar(sidebar.TEXTURE_2K)
    yield from sidebar.click_sidebar(sidebar.MARGIN, times=2)
    xdotool("key", "ctrl+a", "type", "8")
    yield
    xdotool("key", "Return")
    yield
    scene = bpy.context.scene
    assert (scene.spectral_texture_size, scene.spectral_margin) == (2048, 8.0)
    bpy.context.window_manager.operator_properties_last("uv.spectral_pack").seconds = 2.0
    hand, done = Hand(), len(bpy.context.window_manager.operators)
    yield from hand.on(sidebar.PACK)
    # It ends by itself.
    yield from drive.until(lambda: len(bpy.context.window_manager.operators) > done)
    yield
    packed = bpy.context.window_manager.operators[-1]
    assert (packed.bl_idname, packed.properties.margin, hand.clicks) == ("UV_OT_spectral_pack", 8.0, 1)
    assert uv().min() >= 8.0 / 2048.0 - 1e-6 and uv().max() <= 1.0 - 8.0 / 2048.0 + 1e-6
    screenshot("task_pack")


if __name__ == "__main__":
    drive.run(steps)
