# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: an artist reads a map below the mouse, and previews suggested seams."""

import bmesh
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface import session
from tests.interface.session import override, point_at, screenshot, xdotool


def open_suzanne():
    """Suzanne with suggested seams, unwrapped; nothing is selected."""
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_monkey_add()
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide(smoothness=1.0)
        bpy.ops.uv.spectral_suggest_seams("EXEC_DEFAULT", True)
        bpy.ops.mesh.select_mode("EXEC_DEFAULT", True, type="FACE")
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_selected()
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    yield from drive.show_uvs()


def remembered():
    """Return what the add-on remembers of the overlay."""
    return drive.part_of_addon("session").of(drive.part_of_addon("overlay.map_overlay").Overlay)


def selected():
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    return {face.index for face in bm.faces if face.select}


def look_at_suggestions():
    """Suggest seams with the overlay on, take fewer, and leave everything as it was."""
    job_operator, overlay = drive.part_of_addon("operators.job_operator"), drive.part_of_addon("overlay.map_overlay")

    def shown():
        ((_, _, view),) = overlay.views(bpy.context)
        return view

    before, settings = session.uv(), bpy.context.window_manager.spectral_map_overlay
    settings.show = True
    own = shown().qc
    with override("VIEW_3D"):
        bpy.ops.mesh.mark_seam(clear=True)
        bpy.ops.uv.spectral_suggest_seams("INVOKE_DEFAULT")
    yield from drive.until(lambda: job_operator.running() is not None and job_operator.running().choice is not None)
    choice = job_operator.running().choice
    total = choice.count
    yield from drive.until(lambda: choice._overlaid == total)
    yield
    screenshot("preview_of_all_seams")
    all_cuts = shown().qc
    assert all_cuts.mean() < own.mean()
    point_at("VIEW_3D", 0.5, 0.5)
    xdotool("key", "Next")
    yield from drive.until(lambda: choice._overlaid == choice.count < total)
    yield
    screenshot("preview_of_fewer_seams")
    assert not np.array_equal(shown().qc, all_cuts)
    xdotool("key", "Escape")
    yield from drive.until(lambda: job_operator.running() is None)
    yield
    np.testing.assert_array_equal(shown().qc, own)
    np.testing.assert_array_equal(session.uv(), before)
    settings.show = False


def steps():
    yield from open_suzanne()
    before, map_overlay = session.uv(), drive.part_of_addon("overlay.map_overlay")
    # The numbers of the face below the mouse, in both editors; a click selects its island.
    with override("VIEW_3D"):
        bpy.ops.mesh.select_all(action="DESELECT")
    point_at("VIEW_3D", 0.5, 0.5)
    yield from drive.search("Inspect Map")
    yield from drive.until(lambda: map_overlay.is_on())
    point_at("VIEW_3D", 0.5, 0.52)
    yield from drive.until(lambda: remembered().pointed_at is not None)
    yield from drive.until(lambda: all(found.islands_known for _, found, _ in map_overlay.views(bpy.context)))
    yield
    screenshot("inspect_viewport")
    ((_, _, view),) = map_overlay.views(bpy.context)
    face = remembered().pointed_at[1]
    bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
    bm.faces.ensure_lookup_table()
    assert bm.faces[face].normal.y < 0.0, "the nearest face looks to the front"
    xdotool("click", 1)
    yield from drive.until(selected)
    assert selected() == set(np.flatnonzero(view.island_of_face == view.island_of_face[face]))
    # The same in the UV editor.
    corner = view.mesh.face_offsets[0]
    middle = view.mesh.uv[corner : view.mesh.face_offsets[1]].mean(axis=0)
    region = drive.region_of("IMAGE_EDITOR")
    key = drive.part_of_addon("session.identity").key(bpy.context.edit_object)
    x, y = region.view2d.view_to_region(*map(float, middle), clip=False)
    drive.move_mouse(region.x + x, region.y + y)
    yield from drive.until(lambda: remembered().pointed_at == (key, 0))
    yield
    screenshot("inspect_uv_editor")
    yield from drive.send("key", "Escape")
    assert remembered().pointed_at is None
    np.testing.assert_array_equal(session.uv(), before)
    with override("VIEW_3D"):
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.uv.smart_project()
    yield from look_at_suggestions()


drive.run(steps)
