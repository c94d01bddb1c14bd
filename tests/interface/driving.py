# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist does with mouse and keyboard, for the drivers that run inside Blender."""

import importlib
import itertools
import time
from dataclasses import dataclass

import addon_utils
import bmesh
import bpy
import numpy as np
from bpy_extras import view3d_utils

from tests.interface import session
from tests.interface.session import area_of, override, xdotool

# Places in pixels, at Blender's default size of the interface. The menu that U opens has its first entry below the
# mouse when it is opened for the first time.
UV_MENU = 555  # in the viewport's header


@dataclass(frozen=True)
class Layout:
    """Where a version of Blender shows the controls to click.

    Attributes:
        first_to_mark_seam: in the menu of U, from its first entry.
        header_to_unwrap, header_to_suggest_seams: from the header to entries of its menu.
        row: height of the rows of Adjust Last Operation.
        bottom_row: its last row, above the lower end.
        sidebar_tab: from the sidebar's top left corner.
        is_wide: whether the sidebar is as wide as from 4.0 on.
    """

    first_to_mark_seam: int
    header_to_unwrap: int
    header_to_suggest_seams: int
    row: int
    bottom_row: int
    sidebar_tab: tuple
    is_wide: bool


LAYOUTS = {
    (5, 0): Layout(279, 25, 379, 23, 18, (278, 248), True),
    (4, 3): Layout(98, 25, 200, 23, 18, (278, 174), True),
    (4, 0): Layout(238, 25, 339, 23, 18, (215, 170), False),
    (3, 4): Layout(247, 27, 351, 22, 20, (215, 170), False),
}
LAYOUT = next(layout for version, layout in LAYOUTS.items() if bpy.app.version >= version)
# From 5.0 the UV selection belongs to the mesh.
UV_SELECTION_ON_MESH = hasattr(bmesh.types.BMLoop, "uv_select_vert")
# Rows of Adjust Last Operation, counted from 0 at the bottom.
ROWS = {"rotation": 1, "texture_size": 2, "margin": 3, "keep_in_place": 4}


def window():
    return bpy.context.window_manager.windows[0]


def region_of(kind, region_kind="WINDOW"):
    return next(region for region in area_of(kind).regions if region.type == region_kind)


def move_mouse(x, y):
    """Move the mouse to a place in the window, in Blender's coordinates."""
    xdotool("mousemove", int(x), int(window().height - y))


def point_at_header(kind, x):
    """Move the mouse `x` pixels from the left end of an editor's header."""
    region = region_of(kind, "HEADER")
    move_mouse(region.x + x, region.y + region.height // 2)


def point_at_vertices(*indices):
    """Move the mouse to the middle of some vertices of the edited mesh in the viewport."""
    area, region = area_of("VIEW_3D"), region_of("VIEW_3D")
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    bm.verts.ensure_lookup_table()
    middle = bpy.context.edit_object.matrix_world @ (
        sum((bm.verts[i].co for i in indices[1:]), bm.verts[indices[0]].co.copy()) / len(indices)
    )
    place = view3d_utils.location_3d_to_region_2d(region, area.spaces.active.region_3d, middle)
    move_mouse(region.x + place.x, region.y + place.y)


def point_at_setting(name):
    """Move the mouse to the field of a setting in Adjust Last Operation in the viewport."""
    point_at_row(ROWS[name])


def point_at_row(row):
    """Move the mouse to a row of Adjust Last Operation, counted from 0 at the bottom."""
    region = region_of("VIEW_3D", "HUD")
    move_mouse(region.x + int(0.7 * region.width), region.y + LAYOUT.bottom_row + LAYOUT.row * row)


def open_adjust_last_operation():
    """Click the heading of Adjust Last Operation, which stands alone while the panel is closed."""
    region = region_of("VIEW_3D", "HUD")
    move_mouse(region.x + int(0.7 * region.width), region.y + 20)
    yield
    yield from send("click", 1)


def click_below(pixels, picture=None):
    """Click this far below the mouse; `picture` names a screenshot taken before the click."""
    xdotool("mousemove_relative", "--", 0, pixels)
    yield
    if picture:
        session.screenshot(picture)
    xdotool("click", 1)
    yield


def send(*words):
    """Give xdotool its words, and let Blender act on them."""
    xdotool(*words)
    yield
    yield


def search(words):
    """Start an operator by its name, from Blender's search over all menus."""
    yield from send("key", "F3")
    yield from send("type", words)
    xdotool("key", "Return")
    yield


def last_operator():
    """Return the last operator, which must be the add-on's."""
    operator = bpy.context.window_manager.operators[-1]
    assert operator.bl_idname == "UV_OT_spectral_unwrap", operator.bl_idname
    return operator


def check_undo_and_redo(before, after):
    """Press the keys of undo and redo, which must change the UVs exactly from `after` to `before` and back."""
    for keys, expected in (("ctrl+z", before), ("ctrl+shift+z", after)):
        xdotool("key", keys)
        yield from until(lambda expected=expected: np.array_equal(session.uv(), expected))


def until(condition, seconds=240.0):
    """Let Blender run until `condition()` holds; fail after a time that means a hang, even on a busy machine."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        yield


def open_uv_editing():
    """Show the UV Editing workspace of a file without meshes."""
    bpy.context.preferences.view.show_splash = False
    # Without a window manager nobody gives Blender the focus; without it, reports are not shown.
    xdotool("search", "--onlyvisible", "--class", "blender", "windowfocus")
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    window().workspace = bpy.data.workspaces["UV Editing"]
    yield


def show_uvs():
    with override("IMAGE_EDITOR"):
        bpy.ops.image.view_all(fit_view=True)
    yield


def part_of_addon(name):
    return importlib.import_module(f"spectral_unwrap.{name}")


def run(*parts):
    """Enable the add-on, show the UV editor, drive Blender through what these functions yield, and quit."""
    assert addon_utils.enable("spectral_unwrap", default_set=True)
    session.run(itertools.chain(open_uv_editing(), *(part() for part in parts)))
