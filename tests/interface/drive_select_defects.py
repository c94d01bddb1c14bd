# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: an artist looks for the faces of a map that cover others."""

import bmesh
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.session import override, point_at, screenshot, uv

STEPS, TURNS = 60, 1.25


def open_ramp():
    """Put a ramp that climbs around an axis more than once into edit mode and unwrap it; no face is selected."""
    angle = np.linspace(0.0, 2.0 * np.pi * TURNS, STEPS + 1)
    radii = np.linspace(1.0, 2.0, 4)
    mesh = bpy.data.meshes.new("Ramp")
    vertices = [(float(r * np.cos(a)), float(r * np.sin(a)), float(0.15 * a)) for a in angle for r in radii]
    mesh.from_pydata(vertices, [], [(a, a + 1, a + 5, a + 4) for i in range(STEPS) for a in range(4 * i, 4 * i + 3)])
    ramp = bpy.data.objects.new("Ramp", mesh)
    bpy.context.collection.objects.link(ramp)
    bpy.context.view_layer.objects.active = ramp
    ramp.select_set(True)
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    with override("VIEW_3D"):
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.view3d.view_selected()
        assert bpy.ops.uv.spectral_unwrap("EXEC_DEFAULT", True) == {"FINISHED"}
        bpy.ops.mesh.select_mode(type="FACE")
        bpy.ops.mesh.select_all("EXEC_DEFAULT", True, action="DESELECT")
    yield


def selected():
    return [face.index for face in bmesh.from_edit_mesh(bpy.context.edit_object.data).faces if face.select]


def steps():
    yield from open_ramp()
    yield from drive.show_uvs()
    before = uv()
    point_at("VIEW_3D")
    yield from drive.search("Flipped and")
    yield
    assert bpy.context.window_manager.operators[-1].bl_idname == "UV_OT_spectral_select"
    # Both ends, one of which lies over the other.
    faces = 3 * STEPS
    reach = round(faces * (TURNS - 1.0) / TURNS)
    ends = set(range(reach)) | set(range(faces - reach, faces))
    assert set(selected()) <= ends, selected()
    assert len(selected()) > 0.8 * len(ends), selected()
    yield from drive.show_uvs()
    point_at("VIEW_3D")
    yield
    screenshot("select_defects")
    yield from drive.send("key", "ctrl+z")
    assert selected() == []
    np.testing.assert_array_equal(uv(), before)


drive.run(steps)
