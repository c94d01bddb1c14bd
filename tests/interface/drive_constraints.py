# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: edges are straightened from the search, drawn in both editors, and undone."""

import bmesh
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.drive_seam_hints import has_color
from tests.interface.extender_sidebar import open_sidebar
from tests.interface.session import override, picture, point_at, uv

COLUMNS, ROWS = 12, 7


def bent_sheet():
    """Return a new object, a bent sheet of quads, linked to the scene."""
    s, t = np.meshgrid(np.linspace(0, 2, COLUMNS + 1), np.linspace(0, 1, ROWS + 1), indexing="ij")
    points = np.c_[s.ravel() - 1, 0.3 * np.sin(3 * s + 2 * t).ravel(), (t * (1 + 0.3 * s)).ravel()]
    first = (np.arange(COLUMNS)[:, None] * (ROWS + 1) + np.arange(ROWS)).ravel()
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(points.tolist(), [], np.c_[first, first + ROWS + 1, first + ROWS + 2, first + 1].tolist())
    sheet = bpy.data.objects.new("Sheet", mesh)
    bpy.context.collection.objects.link(sheet)
    return sheet


def open_sheet():
    """Put a bent sheet with a map into edit mode, one of its rows selected, and open the sidebar."""
    sheet = bent_sheet()
    bpy.context.view_layer.objects.active = sheet
    with override("VIEW_3D"):
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.uv.spectral_unwrap()
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_selected()
        bpy.ops.mesh.select_mode(type="EDGE")
        bpy.ops.mesh.select_all(action="DESELECT")
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    bm = bmesh.from_edit_mesh(sheet.data)
    for edge in bm.edges:
        edge.select_set(all(vertex.index % (ROWS + 1) == 3 for vertex in edge.verts))
    bmesh.update_edit_mesh(sheet.data)
    bpy.ops.ed.undo_push(message="Sheet")
    yield from open_sidebar()


def steps():
    yield from open_sheet()
    yield from drive.show_uvs()
    before = uv()
    point_at("VIEW_3D", 0.3, 0.3)
    yield
    yield from drive.search("Straight")
    yield from drive.until(lambda: not np.array_equal(uv(), before))
    after = uv()
    yield from drive.check_undo_and_redo(before, after)
    with override("VIEW_3D"):
        bpy.ops.mesh.select_all(action="SELECT")
    yield
    yield
    pixels = picture("constraints")
    middle = pixels.shape[1] // 2
    for half in (pixels[:, :middle], pixels[:, middle:]):
        assert has_color(half, 0.35, 0.95, 0.45), "no green lines"


if __name__ == "__main__":
    drive.run(steps)
