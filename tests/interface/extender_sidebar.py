# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's list of extenders, for the drivers that run inside Blender."""

import sys

import bmesh
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.session import override, point_at, xdotool

COLUMNS, ROWS = 6, 5
# Places in the viewport's sidebar, in pixels from its top left corner.
TAB = drive.LAYOUT.sidebar_tab
if drive.LAYOUT.is_wide:
    SUGGEST_SEAMS, SEAMS, STRAIGHT = (134, 46), (80, 303), (90, 532)
    UNWRAP, PACK, TEXTURE_2K, MARGIN = (58, 72), (215, 72), (134, 208), (134, 229)
    NEW_TEXTURES = (241 if bpy.app.version >= (5, 0) else 233, 187)
    CUT_HERE, NEVER_HERE, BY_ANGLE = (73, 355), (180, 355), (195, 402)
    ADD, ADJUST = (200, 576), (144, 691)
    ICON, NAME, STRENGTH, USE, REMOVE = 38, 80, 165, 210, 236
else:
    SUGGEST_SEAMS, SEAMS, STRAIGHT = (103, 46), (63, 303), (68, 532)
    UNWRAP, PACK, TEXTURE_2K, MARGIN = (45, 72), (161, 72), (103, 208), (103, 229)
    NEW_TEXTURES = (171, 187)
    CUT_HERE, NEVER_HERE, BY_ANGLE = (54, 355), (130, 355), (147, 402)
    ADD, ADJUST = (147, 576), (102, 691)
    ICON, NAME, STRENGTH, USE, REMOVE = 28, 62, 119, 152, 175
FIRST_ROW, NEXT_ROW = 608, 21
SHOW_MAP = (37, 384)


def open_grid():
    """Put a grid with a map into edit mode, seen from above, in vertex mode without a selection; open the sidebar."""
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
    view.view_location.x += 0.9 if drive.LAYOUT.is_wide else 0.6
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    yield from open_sidebar()


def open_sidebar():
    """Open the viewport's sidebar by its key, and the add-on's tab."""
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


def type_amount(index, amount):
    """Double-click the amount of an extender in the list, in percent, and type another."""
    yield from click_sidebar(row(index, STRENGTH), times=2)
    xdotool("key", "ctrl+a", "type", amount)
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


def half_of(index, factor=1.0):
    """The strength that 50 % of an extender stands for, at which it begins, as in the list; or a multiple of that."""
    layer = bpy.context.edit_object.data.spectral_shapes[index].layer
    return round(factor * drive.part_of_addon("edit_mesh.shapes").of_layer(layer).half, 3)


def listed():
    return [(e.name, round(e.strength, 3), e.use) for e in bpy.context.edit_object.data.spectral_shapes]


def pairs():
    extenders = sys.modules["spectral_unwrap.edit_mesh.extenders"]
    return extenders.ends(bpy.context.edit_object.data)


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


def check_undo_and_redo(before, after):
    """Undo and redo the last step, which must change the list exactly from `after` to `before` and back."""
    assert listed() == after, listed()
    yield from press("ctrl+z")
    assert listed() == before, listed()
    yield from press("ctrl+shift+z")
    assert listed() == after, listed()
