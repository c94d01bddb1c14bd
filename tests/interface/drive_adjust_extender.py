# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: an artist makes two extenders and drags their strength while the map follows.

blender --factory-startup --python drive_adjust_extender.py -- <folder for the screenshots> <file for the verdict>
"""

import addon_utils
import bmesh
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.extender_sidebar import (
    ADD,
    ADJUST,
    click_sidebar,
    click_vertices,
    listed,
    open_grid,
    pairs,
    press,
    type_strength,
)
from tests.interface.session import VERDICT, override, point_at, screenshot, uv, xdotool


def raise_a_hill():
    """Make the grid a surface on which forces matter, and unwrap it."""
    mesh = bpy.context.edit_object.data
    for vertex in bmesh.from_edit_mesh(mesh).verts:
        x, y, _ = vertex.co
        vertex.co.z = 1.2 * np.exp(-6.0 * ((x - 0.2) ** 2 + (y + 0.1) ** 2))
    bmesh.update_edit_mesh(mesh)
    with override("VIEW_3D"):
        bpy.ops.mesh.select_all(action="SELECT")
        assert bpy.ops.uv.spectral_unwrap("EXEC_DEFAULT", True) == {"FINISHED"}
        bpy.ops.mesh.select_all("EXEC_DEFAULT", True, action="DESELECT")
    yield from drive.show_uvs()


def make_two():
    for pair in ((0, 6), (35, 24)):
        yield from click_vertices(*pair)
        yield from click_sidebar(ADD)
    assert pairs() == [(0, 6), (35, 24)], pairs()


def drag(pixels):
    """Press the button and move the mouse."""
    yield from click_sidebar(ADJUST)
    for _ in range(5):
        xdotool("mousemove_relative", "--", pixels // 5, 0)
        yield


def check_map_undo_and_redo(before, after):
    point_at("VIEW_3D", 0.3, 0.3)
    yield
    yield from drive.check_undo_and_redo(before, after)


def drag_and_confirm():
    before, start = uv(), listed()
    yield from drag(300)
    assert np.abs(uv() - before).max() > 0.005
    screenshot("extender_dragged")
    # The list shows the strength that is dragged.
    assert listed()[0] == start[0]
    assert listed()[1][1] > 2.0, listed()
    xdotool("click", 1)
    yield
    yield
    after = uv()
    assert listed()[0] == start[0]
    name, strength, use = listed()[1]
    assert strength > 2.0, strength
    yield from check_map_undo_and_redo(before, after)
    assert listed() == [start[0], (name, strength, use)]


def drag_and_give_up():
    before, start = uv(), listed()
    yield from drag(-100)
    assert not np.array_equal(uv(), before)
    xdotool("key", "Escape")
    yield
    yield
    np.testing.assert_array_equal(uv(), before)
    assert listed() == start


def drag_and_disable():
    """Disable the add-on in the middle of a drag, as a script may, and enable it again; the mouse stays in the drag."""
    before, start = uv(), listed()
    yield from drag(200)
    assert not np.array_equal(uv(), before)
    addon_utils.disable("spectral_unwrap")
    np.testing.assert_array_equal(uv(), before)
    yield
    yield
    screenshot("extender_disabled")
    addon_utils.enable("spectral_unwrap", default_set=True)
    yield
    yield
    assert listed() == start
    np.testing.assert_array_equal(uv(), before)
    # Without another update of the mesh, the arrows are there again.
    tracking = sys.modules["spectral_unwrap.extenders.tracking"]
    assert tracking.track(bpy.context.edit_object.data) is not None
    screenshot("extender_enabled_again")


def add_and_type_live():
    """With live unwrapping on, the map follows extenders that are added or changed in the list, and undo knows it."""
    bpy.context.scene.spectral_unwrap_live = True
    before, start = uv(), listed()
    yield from click_vertices(3, 38)
    yield from click_sidebar(ADD)
    yield
    added = uv()
    assert len(listed()) == len(start) + 1
    assert np.abs(added - before).max() > 1e-4, "the map does not follow the extender"
    screenshot("extender_added_live")
    yield from check_map_undo_and_redo(before, added)
    yield from type_strength(len(start), "9")
    for _ in range(3):
        yield
    typed = uv()
    assert np.abs(typed - added).max() > 1e-4, "the map does not follow the strength"
    screenshot("extender_typed_live")
    yield from press("ctrl+z", "ctrl+z")
    yield
    np.testing.assert_array_equal(uv(), added)
    yield from press("ctrl+z")
    yield
    np.testing.assert_array_equal(uv(), before)
    assert listed() == start
    bpy.context.scene.spectral_unwrap_live = False


def type_a_number():
    start = listed()
    yield from click_sidebar(ADJUST)
    xdotool("key", "7", "period", "5")
    yield
    yield
    screenshot("extender_typed")
    xdotool("key", "Return")
    yield
    yield
    assert listed() == [start[0], (start[1][0], 7.5, True)], listed()


def save_and_reopen():
    before = listed(), pairs(), uv()
    path = str(VERDICT.with_name("adjusted.blend"))
    bpy.ops.wm.save_as_mainfile(filepath=path)
    yield
    bpy.ops.wm.open_mainfile(filepath=path)
    yield
    yield
    assert (listed(), pairs()) == before[:2]
    np.testing.assert_array_equal(uv(), before[2])
    screenshot("extender_reopened")


def steps():
    yield from drive.open_uv_editing()
    yield from open_grid()
    yield from raise_a_hill()
    yield from make_two()
    yield from drag_and_confirm()
    yield from drag_and_give_up()
    yield from type_a_number()
    yield from add_and_type_live()
    yield from drag_and_disable()
    yield from save_and_reopen()


drive.run(steps())
