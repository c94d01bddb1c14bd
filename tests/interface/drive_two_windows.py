# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with two windows that show two scenes, each with a mesh in edit mode: both keep their overlay,
and live unwrapping follows in both.
"""

import bmesh
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.session import screenshot


def windows():
    return bpy.context.window_manager.windows


def viewport_of(window):
    """Return the context of the first 3D viewport of a window."""
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=window, area=area, region=region)


def edit_tube(window, name):
    """Put a tube that is cut along one edge into edit mode in the scene of a window, and unwrap it."""
    with viewport_of(window):
        bpy.ops.mesh.primitive_cylinder_add(vertices=16, end_fill_type="NOTHING")
        edited = bpy.context.object
        edited.name = name
        bpy.ops.object.mode_set(mode="EDIT")
        mark(edited, [0])
        bpy.ops.mesh.select_all(action="SELECT")
        assert bpy.ops.uv.spectral_unwrap("EXEC_DEFAULT") == {"FINISHED"}
        bpy.ops.view3d.view_selected()
    return edited


def mark(edited, numbers):
    """Mark lengthwise edges as seams, by their number, as an operator does: with an update."""
    bm = bmesh.from_edit_mesh(edited.data)
    lengthwise = [edge for edge in bm.edges if abs(edge.verts[0].co.z - edge.verts[1].co.z) > 0.1]
    for number in numbers:
        lengthwise[number].seam = True
    bmesh.update_edit_mesh(edited.data)


def mark_by_operator(edited, number):
    """Mark a lengthwise edge as an artist does."""
    bm = bmesh.from_edit_mesh(edited.data)
    lengthwise = [edge for edge in bm.edges if abs(edge.verts[0].co.z - edge.verts[1].co.z) > 0.1]
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.context.tool_settings.mesh_select_mode = (False, True, False)
    lengthwise[number].select_set(True)
    bmesh.update_edit_mesh(edited.data)
    bpy.ops.mesh.mark_seam(clear=False)


def uv_of(edited):
    bm = bmesh.from_edit_mesh(edited.data)
    layer = bm.loops.layers.uv.active
    return np.array([tuple(loop[layer].uv) for face in bm.faces for loop in face.loops])


def steps():
    other = bpy.data.scenes.new("Other")
    bpy.ops.wm.window_new_main()
    yield
    windows()[1].scene = other
    yield
    tubes = [edit_tube(window, f"Tube {number}") for number, window in enumerate(windows())]
    yield

    shown_mesh, read_map = drive.part_of_addon("overlay.shown_mesh"), drive.part_of_addon("edit_mesh.read_map")
    reads, original = [], read_map.read_map
    shown_mesh.read_map.read_map = lambda *arguments: reads.append(arguments[1].name) or original(*arguments)
    bpy.context.window_manager.spectral_map_overlay.show = True
    overlay = drive.part_of_addon("session").of(drive.part_of_addon("overlay.map_overlay").Overlay)
    yield from drive.until(lambda: len(overlay.meshes) == 2)
    yield from drive.until(lambda: all(shown.islands_known for shown in overlay.meshes.values()))
    for _ in range(3):
        yield
    before = len(reads)
    for _ in range(5):
        drive.part_of_addon("editors").redraw(bpy.context)
        yield
    assert len(reads) == before, reads[before:]
    screenshot("two_windows")

    for scene in bpy.data.scenes:
        scene.spectral_unwrap_live = True
    yield
    for edge, work in enumerate(("short", "long"), 8):
        if work == "long":
            # So that nothing ends before the timer looks again.
            drive.part_of_addon("live.following")._SHORT = 0.0
        former = [uv_of(edited) for edited in tubes]
        # Before the timer looks; while the first is solved, the second has changed, too.
        for edited, window in zip(tubes, windows()):
            with viewport_of(window):
                mark_by_operator(edited, edge)
        for edited, before in zip(tubes, former):
            yield from drive.until(lambda edited=edited, before=before: (uv_of(edited) != before).any(), 20.0)
    screenshot("two_windows_followed")


drive.run(steps)
