# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: an artist adds extenders in the sidebar, changes, undoes, saves and reopens.

blender --factory-startup --python drive_extenders.py -- <folder for the screenshots> <file for the verdict>
"""

import sys
from pathlib import Path

import bmesh
import bpy

sys.path.append(str(Path(__file__).resolve().parent))

import driving as drive  # noqa: E402 - found only now
from session import VERDICT, override, point_at, screenshot, uv, xdotool  # noqa: E402

COLUMNS, ROWS = 6, 5
# Places in the viewport's sidebar, in pixels from its top left corner.
TAB = (215, 170)
ADD, ADD_TO_ACTIVE = (112, 137), (103, 158)
SELECT, REMOVE, REMOVE_BROKEN = (58, 292), (147, 292), (103, 316)
FIRST_ROW, NEXT_ROW = 190, 21
ICON, NAME, STRENGTH, USE = 25, 50, 140, 172


def open_grid():
    """Put a grid with a map into edit mode, seen from above, vertices to be selected, none is; open the sidebar."""
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=COLUMNS, y_subdivisions=ROWS)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.view3d.view_axis(type="TOP")
        bpy.ops.view3d.view_selected()
        bpy.ops.mesh.select_all(action="DESELECT")
        bpy.ops.ed.undo_push(message="Grid")
    view = drive.area_of("VIEW_3D").spaces.active.region_3d
    # Room for the sidebar on the right.
    view.view_distance *= 1.7
    view.view_location.x += 0.6
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    yield
    point_at("VIEW_3D", 0.3, 0.3)
    xdotool("key", "n")
    # The sidebar slides in.
    for _ in range(3):
        yield
    yield from click_sidebar(TAB)


def point_at_sidebar(place):
    region = drive.region_of("VIEW_3D", "UI")
    drive.move_mouse(region.x + place[0], region.y + region.height - place[1])


def click_sidebar(place, times=1):
    point_at_sidebar(place)
    yield
    xdotool("click", "--repeat", times, "--delay", 60, 1)
    yield


def row(index, column):
    return column, FIRST_ROW + NEXT_ROW * index


def type_strength(index, strength):
    """Double-click the strength of an extender in the list and type another."""
    yield from click_sidebar(row(index, STRENGTH), times=2)
    xdotool("key", "ctrl+a", "type", strength)
    yield
    xdotool("key", "Return")
    yield


def click_vertices(*indices):
    """Click one vertex, the others with Shift."""
    for place, index in enumerate(indices):
        drive.point_at_vertices(index)
        yield
        xdotool(*(("keydown", "shift") if place else ()), "click", 1, *(("keyup", "shift") if place else ()))
        yield


def press(*keys):
    """Press keys over the viewport, away from the mesh."""
    point_at("VIEW_3D", 0.3, 0.2)
    yield
    for key in keys:
        xdotool("key", key)
        yield


def listed():
    return [(e.name, round(e.strength, 3), e.use) for e in bpy.context.edit_object.data.spectral_extenders]


def pairs():
    extenders = sys.modules["spectral_unwrap.extenders"]
    mesh = bpy.context.edit_object.data
    return extenders.ends(bmesh.from_edit_mesh(mesh), mesh)


def check_undo_and_redo(before, after):
    """Undo and redo the last step, which must change the list exactly from `after` to `before` and back."""
    assert listed() == after, listed()
    yield from press("ctrl+z")
    assert listed() == before, listed()
    yield from press("ctrl+shift+z")
    assert listed() == after, listed()


def add_by_clicking():
    one = [("Extender", 1.0, True)]
    yield from click_vertices(6, 0)
    yield from click_sidebar(ADD)
    assert pairs() == [(6, 0)]
    yield from check_undo_and_redo([], one)

    three = one + [("Extender.001", 1.0, True), ("Extender.002", 1.0, True)]
    yield from click_vertices(35, 41, 24)
    yield from click_sidebar(ADD_TO_ACTIVE)
    screenshot("extenders_added")
    assert sorted(pairs()) == [(6, 0), (35, 24), (41, 24)]
    yield from check_undo_and_redo(one, three)


def adjust_last_operation():
    """The operator's own panel undoes the step and repeats it with other settings."""
    before = listed()
    yield from click_vertices(3, 38)
    yield from click_sidebar(ADD)
    yield from drive.open_adjust_last_operation()
    region = drive.region_of("VIEW_3D", "HUD")
    drive.move_mouse(region.x + int(0.7 * region.width), region.y + 20)
    yield
    xdotool("click", "--repeat", 2, "--delay", 60, 1)
    yield
    xdotool("key", "ctrl+a", "type", "--", "-2.5")
    yield
    xdotool("key", "Return")
    yield
    yield
    screenshot("extenders_adjusted")
    after = [*before, ("Extender.003", -2.5, True)]
    assert listed() == after, listed()
    yield from check_undo_and_redo(before, after)
    yield from press("ctrl+z")


def change_in_the_list():
    start = listed()
    yield from type_strength(0, "0.4")
    changed = [("Extender", 0.4, True), *start[1:]]
    yield from check_undo_and_redo(start, changed)
    yield from click_sidebar(row(1, USE))
    off = [changed[0], ("Extender.001", 1.0, False), changed[2]]
    screenshot("extenders_one_off")
    yield from check_undo_and_redo(changed, off)

    yield from click_sidebar(row(0, NAME), times=2)
    xdotool("key", "ctrl+a", "type", "Brim")
    xdotool("key", "Return")
    yield
    yield
    named = [("Brim", 0.4, True), *off[1:]]
    yield from check_undo_and_redo(off, named)

    yield from click_sidebar(row(0, ICON))
    assert bpy.context.edit_object.data.spectral_extenders_active == 0
    yield from click_sidebar(SELECT)
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    assert [vertex.index for vertex in bm.verts if vertex.select] == [0, 6]
    yield from click_sidebar(REMOVE)
    yield from check_undo_and_redo(named, named[1:])
    yield from press("ctrl+z")
    assert listed() == named, listed()


def break_one():
    start = pairs()
    yield from click_vertices(41)
    yield from press("x")
    # The Delete menu's entry with this letter: Vertices.
    xdotool("key", "v")
    yield
    yield
    screenshot("extenders_broken")
    assert sum(-1 in pair for pair in pairs()) == 1, pairs()
    before = listed()
    yield from click_sidebar(REMOVE_BROKEN)
    yield from check_undo_and_redo(before, [item for item in before if item[0] != "Extender.002"])
    yield from press("ctrl+z", "ctrl+z")
    assert pairs() == start, pairs()
    screenshot("extenders_whole_again")


def move_a_vertex():
    yield from click_vertices(0)
    xdotool("key", "g")
    yield
    xdotool("mousemove_relative", "--", -40, 60)
    yield
    yield
    screenshot("extenders_moving")
    xdotool("key", "Escape")
    yield


def move_a_uv():
    """A running transform holds pointers to the UVs, which drawing must not move in memory."""
    before = uv()
    point_at("IMAGE_EDITOR", 0.3, 0.3)
    xdotool("key", "g")
    yield
    for _ in range(3):
        xdotool("mousemove_relative", "--", -10, 20)
        yield
    screenshot("extenders_moving_uv")
    xdotool("click", 1)
    yield
    moved = (uv() != before).any(axis=1)
    assert moved.any()
    assert not moved.all()
    yield from drive.check_undo_and_redo(before, uv())


def undo_and_redo_all():
    """Undo to the start and redo to the end, selections too."""
    end = listed()
    point_at("VIEW_3D", 0.3, 0.2)
    for key, wanted in (("ctrl+z", []), ("ctrl+shift+z", end)):
        for _ in range(40):
            xdotool("key", key)
            yield
            if listed() == wanted:
                break
        assert listed() == wanted, listed()


def leave_edit_mode_and_come_back():
    before = listed(), pairs()
    yield from press("Tab")
    assert bpy.context.mode == "OBJECT"
    yield from press("ctrl+z")
    assert (listed(), pairs()) == before
    yield from type_strength(0, "3")
    yield from check_undo_and_redo(before[0], [("Brim", 3.0, True), *before[0][1:]])
    yield from press("ctrl+z")


def save_and_reopen():
    before = listed(), pairs()
    path = str(VERDICT.with_name("extenders.blend"))
    bpy.ops.wm.save_as_mainfile(filepath=path)
    yield
    bpy.ops.wm.read_homefile(use_empty=True)
    yield
    bpy.ops.wm.open_mainfile(filepath=path)
    yield
    yield
    assert (listed(), pairs()) == before
    screenshot("extenders_reopened")
    yield from type_strength(0, "3")
    yield from check_undo_and_redo(before[0], [("Brim", 3.0, True), *before[0][1:]])


def steps():
    yield from drive.open_uv_editing()
    yield from open_grid()
    yield from add_by_clicking()
    yield from adjust_last_operation()
    yield from change_in_the_list()
    yield from break_one()
    yield from move_a_vertex()
    yield from move_a_uv()
    yield from undo_and_redo_all()
    yield from leave_edit_mode_and_come_back()
    yield from save_and_reopen()


drive.run(steps())
