# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: overlay and legend beside panels, other sizes of the interface and files."""

from pathlib import Path

import addon_utils
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.session import override, picture, point_at, screenshot

# Of a color's brightness, 0 to 1: what counts as another pixel.
OTHER = 0.02


def shown():
    return bpy.context.window_manager.spectral_map_overlay


def remembered():
    """Return what the add-on remembers of the overlay."""
    return drive.part_of_addon("session").of(drive.part_of_addon("overlay.map_overlay").Overlay)


def is_drawn():
    """Return whether the overlay has read everything to draw."""
    return bool(remembered().meshes)


def open_suzanne():
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_monkey_add()
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.uv.spectral_suggest_seams("EXEC_DEFAULT", True)
        bpy.ops.view3d.view_selected()
    yield


def is_of_viewport(pixels):
    """Cut the viewport's main region out of the pixels of the screen."""
    region = drive.region_of("VIEW_3D")
    return pixels[region.y : region.y + region.height, region.x : region.x + region.width]


def legend_pixels(name):
    """Return the box in which the legend is drawn in the viewport, and which pixels within change with it.

    Blender alone changes others between two pictures, such as those along the outlines of objects.
    """
    legend = drive.part_of_addon("overlay.legend")
    fill_box, boxes = legend.fill_box, []

    def noted(box, colors):
        if bpy.context.area.type == "VIEW_3D":
            boxes.append(box)
        fill_box(box, colors)

    shown().legend = False
    yield
    yield
    without = is_of_viewport(picture(f"{name}_without"))
    legend.fill_box = noted
    shown().legend = True
    yield
    yield
    changed = np.abs(is_of_viewport(picture(name)) - without).max(axis=-1) > OTHER
    legend.fill_box = fill_box
    # The background is filled before what lies on it.
    left, bottom, right, top = (round(end) for end in boxes[0])
    return changed[bottom:top, left:right]


def check_size(changed, name, scale=1.0):
    """Check that the whole legend is visible: a box of its width, filled from side to side at every height."""
    height, width = changed.shape
    assert width >= 240 * scale - 2, (name, width)
    assert height >= 90 * scale, (name, height)
    assert changed.mean() > 0.9, (name, "covered", changed.mean())


def check_beside_adjust(name):
    """Check that the legend that was drawn last is beside Adjust Last Operation, without the mouse over the editor."""
    legend = drive.part_of_addon("overlay.legend")
    draw, fill_box, boxes = legend.draw, legend.fill_box, []

    def noted(*arguments):
        if bpy.context.area.type == "VIEW_3D":
            boxes.clear()
        draw(*arguments)

    def noted_box(box, colors):
        if bpy.context.area.type == "VIEW_3D":
            boxes.append(box)
        fill_box(box, colors)

    legend.draw, legend.fill_box = noted, noted_box
    drive.region_of("VIEW_3D").tag_redraw()
    yield
    yield
    yield from drive.open_adjust_last_operation()
    # It unfolds.
    yield
    screenshot(name)
    panel, region = drive.region_of("VIEW_3D", "HUD"), drive.region_of("VIEW_3D")
    right, top = panel.x + panel.width - region.x, panel.y + panel.height - region.y
    assert panel.height > 100
    left, bottom, _, _ = boxes[0]
    assert left >= right or bottom >= top, (boxes[0], right, top)
    legend.draw, legend.fill_box = draw, fill_box


def look_at_panels():
    """The legend is whole beside Adjust Last Operation, the sidebar, and at any size of the interface."""
    overlay = drive.part_of_addon("overlay.map_overlay")
    shown().show = True
    # Colors that stay the same between two pictures.
    shown().use_range = True
    yield from drive.until(lambda: all(found.islands_known for _, found, _ in overlay.views(bpy.context)))
    space = drive.area_of("VIEW_3D").spaces.active
    check_size((yield from legend_pixels("legend_alone")), "alone")
    with override("VIEW_3D"):
        assert bpy.ops.uv.spectral_unwrap("EXEC_DEFAULT", True) == {"FINISHED"}
    # So large that the panel reaches the legend.
    bpy.context.preferences.view.ui_scale = 1.4
    yield
    yield from check_beside_adjust("legend_as_adjust_opens")
    bpy.context.preferences.view.ui_scale = 1.0
    yield
    point_at("VIEW_3D", 0.5, 0.9)
    yield from drive.until(lambda: all(found.islands_known for _, found, _ in overlay.views(bpy.context)))
    check_size((yield from legend_pixels("legend_beside_adjust")), "beside Adjust Last Operation")
    space.show_region_ui = True
    yield
    yield
    check_size((yield from legend_pixels("legend_beside_both")), "beside the sidebar, too")
    for scale, has_sidebar in ((1.5, True), (2.0, False)):
        bpy.context.preferences.view.ui_scale = scale
        space.show_region_ui = has_sidebar
        yield
        yield
        # There is no room for its full size, but for one that can be read.
        check_size((yield from legend_pixels(f"legend_at_{scale}")), scale, 0.6)
    bpy.context.preferences.view.ui_scale = 1.0
    space.show_region_ui = False
    yield
    yield


def look_at_two():
    """The legend has the numbers of two meshes together, in object mode; it follows the frames."""
    overlay, legend = drive.part_of_addon("overlay.map_overlay"), drive.part_of_addon("overlay.legend")
    with override("VIEW_3D"):
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.object.duplicate()
        bpy.context.object.location.x = 3.0
        for each in bpy.data.objects:
            each.select_set(each.type == "MESH")
    lines, draw = [], legend.draw

    def noted(*arguments):
        lines[:] = arguments[-1]
        draw(*arguments)

    legend.draw = noted
    shown().legend = True
    faces = 2 * len(bpy.context.object.data.polygons)
    yield from drive.until(lambda: len(lines) > 1, 20.0)
    screenshot("legend_of_two")
    assert lines[0] == f"Shown: {faces} faces", lines
    legend.draw = draw
    # Without an update of its own, as when the artist plays the animation.
    bpy.context.object.modifiers.new("Wave", "WAVE").height = 1.0
    yield
    yield
    bpy.context.scene.frame_set(40)
    yield
    yield
    screenshot("legend_at_a_later_frame")
    for each, _, view in overlay.views(bpy.context):
        mesh = each.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        places = np.array([vertex.co for vertex in mesh.vertices], dtype=np.float32)
        np.testing.assert_array_equal(view.mesh.vertices, places)
    yield


def status_bar(name):
    """Return the pixels of the status bar, at the lower end of the window."""
    return picture(name)[:20]


def leave_while_inspecting():
    """Nothing of Inspect Map stays when the add-on is disabled, nor when the workspace is left meanwhile."""
    point_at("VIEW_3D", 0.5, 0.5)
    yield
    yield
    before = status_bar("status_before")
    first = drive.window().workspace
    with override("VIEW_3D"):
        bpy.ops.uv.spectral_inspect("INVOKE_DEFAULT")
    yield
    yield
    keys = status_bar("status_inspecting")
    assert np.abs(keys - before).max() > 0.1, "no keys are shown"
    drive.window().workspace = bpy.data.workspaces["Layout"]
    yield
    yield
    point_at("VIEW_3D", 0.5, 0.55)
    yield
    yield from drive.send("key", "Escape")
    drive.window().workspace = first
    yield
    point_at("VIEW_3D", 0.5, 0.5)
    yield
    yield
    # The workspace has a mode of its own, whose keys are others.
    assert np.abs(status_bar("status_of_left_workspace") - keys).max() > 0.1, "the text stays in the other workspace"
    with override("VIEW_3D"):
        bpy.ops.uv.spectral_inspect("INVOKE_DEFAULT")
    yield
    yield
    colored = is_of_viewport(picture("overlay_before_disabling"))
    addon_utils.disable("spectral_unwrap")
    yield
    yield
    assert np.abs(status_bar("status_after_disabling") - keys).max() > 0.1, "the text stays without the add-on"
    assert np.abs(is_of_viewport(picture("overlay_after_disabling")) - colored).mean() > 0.01, "the colors stay"
    addon_utils.enable("spectral_unwrap")
    yield from drive.until(lambda: is_drawn() == shown().show, 20.0)
    assert remembered().pointed_at is None


def check_switch(name):
    """Check that the switch of the overlay shows whether it is drawn; return that."""
    screenshot(name)
    assert is_drawn() == shown().show, (name, shown().show)
    return shown().show


def open_others():
    """The switch shows what is drawn in a new file, and in one saved with the overlay on."""
    shown().show = True
    yield
    path = str(Path(bpy.app.tempdir, "shown.blend"))
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile()
    yield
    yield
    check_switch("switch_in_a_new_file")
    shown().show = False
    for load_ui in (True, False):
        bpy.ops.wm.open_mainfile(filepath=path, load_ui=load_ui)
        yield
        yield
        check_switch(f"switch_opened_{load_ui}")
        shown().show = not shown().show
        yield
        check_switch(f"switch_turned_{load_ui}")


drive.run(open_suzanne, look_at_panels, look_at_two, leave_while_inspecting, open_others)
