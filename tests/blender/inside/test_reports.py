# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operator tells the user."""

import re

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


def test_solved_islands_are_counted_and_measured(reports):
    cube = scenes.cube(all_seams=True)
    scenes.edit(cube)
    reports()
    bpy.ops.uv.spectral_unwrap()
    ((level, text),) = reports()
    assert level == "Info"
    assert re.fullmatch(
        r"Unwrapped 6 islands: angle distortion 1\.000 average, 1\.000 worst; no flipped faces; \d+\.\d\d s", text
    )


def test_failed_islands_are_counted_with_reason_and_advice(reports):
    both = scenes.grid_and_cube()
    scenes.edit(both)
    reports()
    bpy.ops.uv.spectral_unwrap()
    (level, text), (second_level, second_text) = reports()
    assert (level, second_level) == ("Info", "Warning")
    assert text.startswith("Unwrapped 1 island: ")
    assert second_text.startswith("1 of 2 islands failed, UVs unchanged: ")
    assert "closed" in second_text.lower()
    assert "seam" in second_text


def test_only_failures_report_no_success(reports):
    cube = scenes.cube()
    scenes.edit(cube)
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"CANCELLED"}
    ((level, text),) = reports()
    assert level == "Warning"
    assert text.startswith("1 of 1 island failed")


def test_repairs_and_fallbacks_are_reported(reports):
    grid = scenes.grid(2, 1)
    scenes.edit(grid)
    scenes.edit_mesh(grid).faces[0].normal_flip()
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    (level, text), _ = reports()
    assert level == "Info"
    assert text.startswith("1 island needed a repair or fallback: 1 face wound the other way")


def test_a_margin_that_is_no_number_is_an_error_and_changes_nothing():
    grid, bare = scenes.grid(2, 2), scenes.grid(2, 2, name="Bare", uv_map=False)
    scenes.edit(grid, bare)
    before, state = scenes.read_uv(grid), scenes.state(grid)
    with pytest.raises(RuntimeError, match="The margin must be a number, not nan"):
        bpy.ops.uv.spectral_unwrap(margin=float("nan"))
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    assert scenes.state(grid) == state
    assert not bare.data.uv_layers


def test_nothing_selected(reports):
    grid = scenes.grid(1, 1)
    scenes.edit(grid, select=False)
    reports()
    bpy.ops.uv.spectral_unwrap()
    assert reports() == [("Warning", "No faces selected")]


def test_non_finite_coordinates_are_named(reports):
    grid = scenes.grid(2, 2)
    scenes.edit(grid)
    scenes.edit_mesh(grid).verts[4].co.x = float("inf")
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"CANCELLED"}
    ((level, text),) = reports()
    assert level == "Warning"
    assert "finite" in text
