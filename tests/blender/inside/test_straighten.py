# SPDX-License-Identifier: GPL-3.0-or-later
"""Straighten Borders: the option reaches the solver, and pins and stored shapes keep their islands."""

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


def bulging():
    """Edit a sheet of quads whose sides bulge by a hundredth of their length."""
    sheet = scenes.grid(8, 8)
    for vertex in sheet.data.vertices:
        x, y = (vertex.co[k] / 4.0 - 1.0 for k in range(2))
        vertex.co = (4.0 * x * (1.0 + 0.02 * (1.0 - y * y)), 4.0 * y * (1.0 + 0.02 * (1.0 - x * x)), 0.0)
    scenes.edit(sheet)
    return sheet


def off_rectangle(sheet):
    """Return how far the farthest border UV lies from the bounding box, as a fraction of its size."""
    uv = scenes.read_uv(sheet)
    low, high = uv.min(axis=0), uv.max(axis=0)
    bm = scenes.edit_mesh(sheet)
    border = np.array([loop.vert.is_boundary for face in bm.faces for loop in face.loops])
    return float(np.minimum(uv - low, high - uv).min(axis=1)[border].max() / (high - low).max())


def test_borders_become_straight():
    sheet = bulging()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert off_rectangle(sheet) > 2e-3
    assert bpy.ops.uv.spectral_unwrap(straighten=True) == {"FINISHED"}
    assert off_rectangle(sheet) < 1e-6


@pytest.mark.parametrize("held", ["pins", "shape"])
def test_pins_and_stored_shapes_keep_the_map(held):
    sheet = bulging()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    bm = scenes.edit_mesh(sheet)
    if held == "pins":
        layer = bm.loops.layers.uv.active
        for vertex in (bm.verts[0], bm.verts[-1]):
            for loop in vertex.link_loops:
                loop[layer].pin_uv = True
    else:
        bm.edges.ensure_lookup_table()
        for edge in bm.edges:
            edge.select_set(all(abs(vertex.co.y) < 1e-3 for vertex in edge.verts))
        assert bpy.ops.uv.spectral_shape(kind="STRAIGHT") == {"FINISHED"}
        bpy.ops.mesh.select_all(action="SELECT")
    maps = []
    for straighten in (False, True):
        assert bpy.ops.uv.spectral_unwrap(straighten=straighten) == {"FINISHED"}
        maps.append(scenes.read_uv(sheet))
    np.testing.assert_array_equal(*maps)


def pillow():
    """Edit a box of quads whose edges bulge outward, without a UV map."""
    bpy.ops.mesh.primitive_cube_add()
    box = bpy.context.object
    scenes.edit(box)
    bpy.ops.mesh.subdivide(number_cuts=7)
    for vertex in scenes.edit_mesh(box).verts:
        x, y, z = vertex.co
        vertex.co = (x * (1.0 + 0.02 * (1.0 - z * z)), y * (1.0 + 0.02 * (1.0 - z * z)), z)
    return box


def share_along_axes(box):
    """Return which share of the corners at seams begins an edge that is along an axis of the map."""
    bm = scenes.edit_mesh(box)
    layer = bm.loops.layers.uv.active
    steps = np.array(
        [loop.link_loop_next[layer].uv - loop[layer].uv for face in bm.faces for loop in face.loops if loop.edge.seam]
    )
    return np.mean(np.abs(steps).min(axis=1) < 1e-5 * np.abs(steps).max(axis=1))


def test_suggested_seams_of_hard_surfaces_get_straight_borders():
    shares = {}
    for style in ("ORGANIC", "HARD", "AUTO"):
        box = pillow()
        assert bpy.ops.uv.spectral_suggest_seams(style=style) == {"FINISHED"}
        shares[style] = share_along_axes(box)
        bpy.ops.object.mode_set(mode="OBJECT")
    assert shares["ORGANIC"] < 0.5
    assert shares["HARD"] == shares["AUTO"] > 0.9
    last = bpy.context.window_manager.operator_properties_last("uv.spectral_unwrap")
    assert not last.straighten, "settings of the window follow the artist, not scripts"
