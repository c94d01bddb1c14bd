# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: every panel and menu opens in both editors, with its tooltips, in German; and the
buttons for whole tiles work.
"""

import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface import extender_sidebar as sidebar
from tests.interface.session import override, point_at, screenshot, uv, xdotool

WHEEL_DOWN = 5
# Pixels between places to point at: every group of buttons with tooltips that change has one.
_STEP = 60
# The tab in the UV editor, where only a click opens it, from the sidebar's top left corner.
_TAB = (215, 180)


def open_all_panels():
    """Let all panels be open when they are shown first."""
    panels = drive.part_of_addon("ui.panels")
    panels.unregister()
    for panel in bpy.types.Panel.__subclasses__():
        if panel.__name__.startswith(drive.part_of_addon("names").PANEL_PREFIXES):
            panel.bl_options = set()
    panels.register()


def edit_suzanne():
    """Suzanne with seams, unwrapped, and with every kind of entry in the list of shapes."""
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_monkey_add()
        bpy.context.object.active_material = bpy.data.materials.new("Stone")
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.uv.spectral_suggest_seams("EXEC_DEFAULT", True)
        bpy.ops.uv.spectral_shape("EXEC_DEFAULT", True, kind="SYMMETRIC")
        bpy.ops.mesh.select_all(action="DESELECT")
        bpy.ops.mesh.select_mode(type="VERT")
    yield


def look_through(kind):
    """Scroll through the sidebar of an editor, and wait for tooltips."""
    region, page, last = drive.region_of(kind, "UI"), 0, None
    while last != (lower := region.view2d.region_to_view(0, 0)[1]):
        last = lower
        screenshot(f"panels_{kind.lower()}_{page}")
        for place in range(_STEP // 2, region.height, _STEP):
            x = (0.3, 0.55, 0.8)[place // _STEP % 3]
            drive.move_mouse(region.x + x * (region.width - 25), region.y + region.height - place)
            yield
            yield
        screenshot(f"panels_{kind.lower()}_{page}_tooltip")
        page += 1
        # Beside lists and fields, which the wheel would scroll instead.
        drive.move_mouse(region.x + 4, region.y + 0.5 * region.height)
        yield
        yield from drive.send("click", "--repeat", 12, WHEEL_DOWN)
    assert page > 1, "all panels fit"


def open_sidebar(kind):
    drive.area_of(kind).spaces.active.show_region_ui = True
    yield
    yield
    region = drive.region_of(kind, "UI")
    if hasattr(region, "active_panel_category"):
        region.active_panel_category = "Spectral"
        yield
    else:
        x, y = sidebar.TAB if kind == "VIEW_3D" else _TAB
        drive.move_mouse(region.x + x, region.y + region.height - y)
        yield
        xdotool("click", 1)
    yield


def open_menus(kind):
    """Open every menu with entries of the add-on that this editor has."""
    menus = drive.part_of_addon("ui.menus")
    prefix = "VIEW3D" if kind == "VIEW_3D" else "IMAGE"
    for name in (menus.UV_MT_spectral.bl_idname, *(menu for menu, _, _ in menus._entries() if menu.startswith(prefix))):
        point_at(kind, 0.4, 0.7)
        yield
        with override(kind):
            bpy.ops.wm.call_menu(name=name)
        yield
        yield
        screenshot(f"menu_{kind.lower()}_{name}")
        xdotool("key", "Escape")
        yield


def move_by_tiles():
    """Press the buttons for whole tiles as the panel draws them."""
    compatibility, panels = drive.part_of_addon("compatibility"), drive.part_of_addon("ui.panels")
    with override("IMAGE_EDITOR"):
        bpy.context.scene.tool_settings.use_uv_select_sync = False
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.uv.select_all(action="SELECT")
    for axis, tiles, icon in panels._TILE_MOVES:
        drawn = Drawn()
        compatibility.draw_tile_move(drawn, axis, tiles, icon)
        before = uv()
        with override("IMAGE_EDITOR"):
            category, operator = drawn.name.split(".")
            getattr(getattr(bpy.ops, category), operator)("EXEC_DEFAULT", True, **vars(drawn.properties))
        yield
        step = [tiles * (axis == each) for each in "XY"]
        np.testing.assert_allclose(uv(), before + step, atol=1e-5)


def pack_on_pixels():
    """Pack a plane with Blender's Round to Pixels on: its borders get to those of pixels."""
    drive.area_of("IMAGE_EDITOR").spaces.active.uv_editor.pixel_round_mode = "CORNER"
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_plane_add()
        bpy.ops.mesh.select_all(action="SELECT")
    with override("IMAGE_EDITOR"):
        bpy.ops.uv.select_all(action="SELECT")
        bpy.ops.uv.spectral_pack("EXEC_DEFAULT", True, steps=0)
    yield
    corners = 1024.0 * uv()[-4:]
    np.testing.assert_allclose(corners, np.round(corners), atol=1e-3)


class Properties:
    """What is set."""


class Drawn:
    """Keeps the operator that is drawn, and what is set in it."""

    def operator(self, name, **_options):
        self.name, self.properties = name, Properties()
        return self.properties


def steps():
    open_all_panels()
    yield from edit_suzanne()
    yield from drive.show_uvs()
    for kind in ("VIEW_3D", "IMAGE_EDITOR"):
        yield from open_sidebar(kind)
    view = bpy.context.preferences.view
    view.language = "de_DE"
    view.use_translate_interface = view.use_translate_tooltips = True
    yield
    for kind in ("VIEW_3D", "IMAGE_EDITOR"):
        yield from look_through(kind)
        yield from open_menus(kind)
    yield from move_by_tiles()
    yield from pack_on_pixels()


if __name__ == "__main__":
    drive.run(steps)
