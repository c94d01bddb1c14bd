# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: an artist has seams suggested for Suzanne, by mouse and keyboard."""

import importlib

import bmesh
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.extender_sidebar import SUGGEST_SEAMS, click_sidebar, open_sidebar
from tests.interface.session import area_of, override, point_at, screenshot, uv, xdotool

CUTS_ROW = 1  # of Adjust Last Operation, from the bottom
WHEEL_UP, WHEEL_DOWN = 4, 5

shown = []


def watch_previews():
    """Keep the preview that is shown in `shown`."""
    operators = importlib.import_module("spectral_unwrap.operators.suggest_seams")

    class Watched(operators.SeamPreview):
        def __init__(self, *arguments):
            super().__init__(*arguments)
            shown.append(self)

        def end(self, context):
            super().end(context)
            shown.remove(self)

    operators.SeamPreview = Watched


def seams():
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    return {tuple(sorted(vertex.index for vertex in edge.verts)) for edge in bm.edges if edge.seam}


def selected():
    return [face.select for face in bmesh.from_edit_mesh(bpy.context.edit_object.data).faces]


def history():
    return [operator.bl_idname for operator in bpy.context.window_manager.operators]


def view():
    return area_of("VIEW_3D").spaces.active.region_3d.view_distance


def open_suzanne():
    """Put a smooth Suzanne into edit mode, nothing selected, and open the sidebar."""
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_monkey_add()
        bpy.context.object.modifiers.new("Subdivision", "SUBSURF").levels = 1
        bpy.ops.object.modifier_apply(modifier="Subdivision")
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.view3d.view_selected()
        bpy.ops.mesh.select_all(action="DESELECT")
        bpy.ops.ed.undo_push(message="Suzanne")
    yield from open_sidebar()


def suggest_by_panel():
    yield from click_sidebar(SUGGEST_SEAMS)
    yield from drive.until(lambda: shown)
    point_at("VIEW_3D", 0.4, 0.3)
    yield from drive.until(lambda: shown[0].count in shown[0]._measured)
    yield


def suggest_by_menu():
    point_at("VIEW_3D")
    drive.point_at_header("VIEW_3D", drive.UV_MENU)
    xdotool("click", 1)
    yield
    yield from drive.click_below(drive.LAYOUT.header_to_suggest_seams, "suggest_seams_menu")
    yield from drive.until(lambda: shown)
    point_at("VIEW_3D", 0.4, 0.3)
    yield


def check_marked(before_seams, before_uv, after_seams, after_uv):
    """Undo and redo the last step, which must take seams and map together."""
    for keys, expected_seams, expected_uv in (
        ("ctrl+z", before_seams, before_uv),
        ("ctrl+shift+z", after_seams, after_uv),
    ):
        yield from drive.send("key", keys)
        assert seams() == expected_seams
        np.testing.assert_array_equal(uv(), expected_uv)


def adjust_last_operation(marked):
    """Ask for two cuts instead of four, which undoes the step and marks the first two."""
    yield from drive.open_adjust_last_operation()
    drive.point_at_row(CUTS_ROW)
    yield
    screenshot("suggest_seams_adjust")
    xdotool("click", "--repeat", 2, "--delay", 60, 1)
    yield
    xdotool("key", "ctrl+a", "type", "2")
    yield
    yield from drive.send("key", "Return")
    screenshot("suggest_seams_adjusted")
    assert set() < seams() < marked
    point_at("VIEW_3D", 0.4, 0.3)
    yield


def steps():
    yield from open_suzanne()
    watch_previews()
    before, done = uv(), history()
    screenshot("suggest_seams_panel")

    # A look at the preview, and away.
    yield from suggest_by_panel()
    total = shown[0].count
    assert total > 5
    screenshot("suggest_seams_preview")
    yield from drive.send("click", WHEEL_DOWN)
    yield from drive.send("key", "minus")
    assert shown[0].count == total - 2, shown[0].count
    yield from drive.send("key", "Up")
    assert shown[0].count == total - 1
    yield from drive.send("key", "Next", "key", "Next")
    fewer = shown[0].count
    assert fewer < total - 2
    distance = view()
    yield from drive.send("keydown", "ctrl", "click", WHEEL_UP, "keyup", "ctrl")
    assert view() < distance
    assert shown[0].count == fewer
    yield from drive.send("key", "ctrl+z", "key", "Tab", "key", "x")
    screenshot("suggest_seams_fewer")
    assert bpy.context.mode == "EDIT_MESH"
    # The wheel counts over the gizmos, too.
    sidebar = drive.region_of("VIEW_3D", "UI")
    drive.move_mouse(sidebar.x - 50, sidebar.y + sidebar.height - 60)
    yield from drive.send("click", WHEEL_DOWN)
    assert shown[0].count == fewer - 1
    yield from drive.send("click", WHEEL_UP)
    # Elsewhere Blender works, and nothing is applied: beside the mesh, over the UV editor.
    point_at("VIEW_3D", 0.08, 0.1)
    yield from drive.send("click", 1)
    point_at("IMAGE_EDITOR")
    yield from drive.send("click", WHEEL_UP)
    assert shown[0].count == fewer
    point_at("VIEW_3D", 0.4, 0.3)
    rotation = area_of("VIEW_3D").spaces.active.region_3d.view_rotation.copy()
    yield from drive.send("key", "KP_1")
    yield from drive.until(lambda: area_of("VIEW_3D").spaces.active.region_3d.view_rotation != rotation)
    assert shown
    assert seams() == set()
    # What moved the view may stand there.
    assert not any("spectral" in name for name in history())
    done = history()
    yield from drive.send("key", "Escape")
    assert not shown
    assert (seams(), history()) == (set(), done)
    np.testing.assert_array_equal(uv(), before)
    screenshot("suggest_seams_cancelled")

    # The same again, this time applied by a click. Live unwrapping must not make a step of its own of it.
    bpy.context.scene.spectral_unwrap_live = True
    yield from suggest_by_menu()
    assert shown[0].count == total
    for _ in range(total - 4):
        xdotool("click", WHEEL_DOWN)
    yield
    yield from drive.until(lambda: shown[0].count in shown[0]._measured)
    assert shown[0].count == 4
    yield
    screenshot("suggest_seams_four")
    point_at("VIEW_3D", 0.45, 0.5)
    yield from drive.send("click", 1)
    yield from drive.until(lambda: history() != done)
    yield
    assert history() == [*done, "UV_OT_spectral_suggest_seams"]
    marked, mapped = seams(), uv()
    assert marked
    assert not np.array_equal(mapped, before)
    assert not any(selected())
    assert bpy.context.window_manager.operators[-1].properties.cuts == 4
    yield from adjust_last_operation(marked)
    marked, mapped = seams(), uv()
    yield from check_marked(set(), before, marked, mapped)
    yield from drive.show_uvs()
    screenshot("suggest_seams_applied")

    # Right click cancels as Esc does.
    yield from suggest_by_panel()
    yield from drive.send("click", 3)
    assert not shown
    assert seams() == marked
    np.testing.assert_array_equal(uv(), mapped)


if __name__ == "__main__":
    drive.run(steps)
