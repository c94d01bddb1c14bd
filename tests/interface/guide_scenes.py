# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: scenes that no test by mouse has, for `tests.benchmarks.guide_pictures`."""

import bmesh
import bpy
from mathutils import Vector

from tests.interface import driving as drive
from tests.interface.extender_sidebar import open_sidebar
from tests.interface.session import override, screenshot


def add(name, *edited, farther=1.35):
    """Put objects into edit mode, everything selected, and look at them, beside the sidebar."""
    with override("VIEW_3D"):
        for each in edited:
            each.select_set(True)
        bpy.context.view_layer.objects.active = edited[0]
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message=name)
    view = drive.area_of("VIEW_3D").spaces.active.region_3d
    # Room for the sidebar on the right.
    view.view_distance *= farther
    middle = sum((each.location for each in edited), edited[0].location * 0.0) / len(edited)
    view.view_location = middle + view.view_rotation @ Vector((0.08 * view.view_distance, 0.0, 0.0))
    yield


def show(kind):
    overlay = bpy.context.window_manager.spectral_map_overlay
    overlay.kind, overlay.show = kind, True
    yield from drive.show_uvs()
    for _ in range(4):
        yield


def new_scene():
    with override("VIEW_3D"):
        bpy.ops.object.mode_set(mode="OBJECT")
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    yield


def suzanne():
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_monkey_add()
        head = bpy.context.object
        head.rotation_euler.z = 0.5
        head.modifiers.new("Subdivision", "SUBSURF").levels = 1
        bpy.ops.object.modifier_apply(modifier="Subdivision")
    return head


def suggest_and_unwrap():
    with override("VIEW_3D"):
        assert bpy.ops.uv.spectral_suggest_seams("EXEC_DEFAULT") == {"FINISHED"}
        bpy.ops.mesh.select_all(action="DESELECT")


def cube_of_two_stacks():
    """A cube whose faces lie on four squares: two stacks of two, and two squares that are too close."""
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_cube_add()
        yield from add("Cube", bpy.context.object, farther=2.0)
    corners = [(0.05, 0.05), (0.4, 0.05), (0.4, 0.55), (0.05, 0.05), (0.4, 0.05), (0.705, 0.05)]
    mesh = bpy.context.edit_object.data
    bm = bmesh.from_edit_mesh(mesh)
    layer = bm.loops.layers.uv.verify()
    for face, (u, v) in zip(bm.faces, corners):
        for loop, (x, y) in zip(face.loops, ((0, 0), (0.3, 0), (0.3, 0.3), (0, 0.3))):
            loop[layer].uv = u + x, v + y
    bmesh.update_edit_mesh(mesh)


def steps():
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    yield from add("Suzanne", suzanne())
    yield from open_sidebar()
    suggest_and_unwrap()
    yield from show("ANGLE")
    screenshot("guide_map_overlay")
    yield from new_scene()
    yield from cube_of_two_stacks()
    bpy.context.scene.spectral_margin = 16.0
    yield from show("STACKS")
    screenshot("guide_stacks")


drive.run(steps)
