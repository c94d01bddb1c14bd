# SPDX-License-Identifier: GPL-3.0-or-later
"""Called from the UV editor: there the UV selection counts, unless it is synchronized with the mesh selection."""

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


@pytest.fixture(params=["UV", "IMAGE_EDITOR"])
def uv_editor(request):
    """Context overrides for an area turned into a UV editor, or into an image editor that shows no UVs."""
    window = bpy.context.window_manager.windows[0]
    area = window.screen.areas[0]
    area.ui_type = request.param
    return {"window": window, "area": area}


def two_grids():
    """A mesh of two separate squares of 2 x 2 faces, in edit mode; all faces selected, UVs only of the second."""
    squares = [(x, y) for y in range(2) for x in range(2)]
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    vertices = [(x + 5 * part, y, 0) for part in range(2) for y in range(3) for x in range(3)]
    faces = [[9 * part + 3 * (y + b) + x + a for a, b in corners] for part in range(2) for x, y in squares]
    edited = scenes.new_object(vertices, faces)
    scenes.edit(edited)
    scenes.set_uv_flags(edited, scenes.corners_of(edited, range(4, 8)))
    return edited


@pytest.mark.parametrize("keep_in_place", [False, True])
def test_only_faces_with_a_selected_uv_are_unwrapped(uv_editor, keep_in_place):
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    edited = two_grids()
    before, state = scenes.read_uv(edited), scenes.state(edited)
    with bpy.context.temp_override(**uv_editor):
        assert bpy.ops.uv.spectral_unwrap(keep_in_place=keep_in_place) == {"FINISHED"}
    others = scenes.corners_of(edited, range(4))
    np.testing.assert_array_equal(scenes.read_uv(edited)[others], before[others])
    stretches = scenes.stretches(edited, range(4, 8))
    np.testing.assert_allclose(stretches, stretches.mean(), rtol=1e-5)
    assert scenes.state(edited) == state


def test_no_uv_selected_is_cancelled(uv_editor):
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    edited = two_grids()
    scenes.set_uv_flags(edited, np.zeros(32, dtype=bool))
    before = scenes.read_uv(edited)
    with bpy.context.temp_override(**uv_editor):
        assert bpy.ops.uv.spectral_unwrap() == {"CANCELLED"}
    np.testing.assert_array_equal(scenes.read_uv(edited), before)


def test_in_the_viewport_the_uv_selection_does_not_count():
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    edited = two_grids()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    stretches = scenes.stretches(edited)
    np.testing.assert_allclose(stretches, stretches.mean(), rtol=1e-5)
