# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operator tells the user."""

import re

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes

# What works on a map; with options for what would ask for more.
ON_A_MAP = [
    *(("uv.spectral_pack", {}), ("uv.spectral_relax", {}), ("uv.spectral_density", {"kind": "PICK"})),
    *(("uv.spectral_density", {"kind": "NUMBER"}), ("uv.spectral_density", {"kind": "EQUAL"})),
    *(("uv.spectral_select", {"kind": "DEFECTS"}), ("uv.spectral_shape", {"kind": "UPRIGHT"})),
    *(("uv.spectral_new_textures", {}), ("mesh.spectral_store_distortion", {})),
]


@pytest.mark.parametrize(("operator", "options"), ON_A_MAP, ids=str)
def test_without_a_uv_map_what_works_on_one_says_so(operator, options, reports):
    scenes.edit(scenes.grid(2, 2, uv_map=False))
    category, name = operator.split(".")
    reports()
    assert getattr(getattr(bpy.ops, category), name)(**options) == {"CANCELLED"}
    assert reports() == [("Warning", "There is no UV map; unwrap first")]


def test_solved_islands_are_counted_and_measured(reports):
    cube = scenes.cube(all_seams=True)
    scenes.edit(cube)
    reports()
    bpy.ops.uv.spectral_unwrap()
    ((level, text),) = reports()
    assert level == "Info"
    assert re.fullmatch(
        r"Unwrapped 6 islands: angles off by 0\.0 % on average, 0\.0 % at worst; no flipped faces; "
        r"\d+ % of the tile filled; \d+\.\d\d s",
        text,
    )


def test_numbers_of_the_last_result_can_be_read_by_scripts():
    both = scenes.grid_and_cube()
    scenes.edit(both)
    manager = bpy.context.window_manager
    bpy.ops.uv.spectral_unwrap()
    found = manager["spectral_result"].to_dict()
    assert (found["operator"], found["solved"], found["failed"]) == ("unwrap", 1, 1)
    assert (found["flipped"], found["overlapping"]) == (0, 0)
    assert found["mean_qc"] == pytest.approx(1.0, abs=0.1)
    assert 0.0 < found["fill"] <= 1.0
    bpy.ops.uv.spectral_relax(steps=3)
    found = manager["spectral_result"].to_dict()
    assert (found["operator"], found["steps"] <= 3) == ("relax", True)
    bpy.ops.uv.spectral_pack(steps=4)
    found = manager["spectral_result"].to_dict()
    assert (found["operator"], found["packed"] > 0, found["steps"]) == ("pack", True, 4)
    assert found["fill"] > 0.1


@pytest.mark.parametrize("unwrap", [False, True])
def test_numbers_of_suggested_seams_are_not_those_of_another_operator(unwrap):
    scenes.edit(scenes.cube(size=2.0))
    manager = bpy.context.window_manager
    manager["spectral_result"] = {"operator": "pack", "fill": 0.5}
    bpy.ops.uv.spectral_suggest_seams(style="HARD", unwrap=unwrap)
    found = manager["spectral_result"].to_dict()
    # A cross of a cube whose edges are 2 long.
    assert (found["operator"], found["length"]) == ("suggest_seams", 14.0)
    assert found["cuts"] > 0 and found["seconds"] > 0.0
    assert found.get("solved") == (1 if unwrap else None)
    assert ("fill" in found) == unwrap


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
    with pytest.raises(RuntimeError, match="Margin must be a number, not nan"):
        bpy.ops.uv.spectral_unwrap(margin=float("nan"))
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    assert scenes.state(grid) == state
    assert not bare.data.uv_layers


def test_nothing_selected_means_all_that_is_visible(reports):
    grid = scenes.grid(2, 2)
    scenes.edit(grid)
    scenes.select_faces(grid, [0])
    bpy.ops.mesh.hide()
    bpy.ops.mesh.select_all(action="DESELECT")
    before = scenes.read_uv(grid)
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    (level, text), (_, result) = reports()
    assert (level, text) == ("Info", "Nothing was selected, so all visible faces were used")
    assert result.startswith("Unwrapped 1 island")
    changed = (scenes.read_uv(grid) != before).any(axis=1)
    assert not changed[:4].any()
    assert changed[4:].any()
    assert not any(face.select for face in scenes.edit_mesh(grid).faces)


def test_a_selection_in_any_mesh_is_the_only_one_that_counts(reports):
    selected, other = scenes.grid(2, 2), scenes.grid(2, 2, name="Other")
    scenes.edit(selected, other, select=False)
    before = [scenes.read_uv(each) for each in (selected, other)]
    scenes.select_faces(selected, [0])
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert not any("Nothing was selected" in text for _, text in reports())
    assert not np.array_equal(scenes.read_uv(selected)[:4], before[0][:4])
    np.testing.assert_array_equal(scenes.read_uv(selected)[4:], before[0][4:])
    np.testing.assert_array_equal(scenes.read_uv(other), before[1])
    # Without it both are unwrapped, and stay unselected.
    bpy.ops.mesh.select_all(action="DESELECT")
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert not np.array_equal(scenes.read_uv(other), before[1])
    assert not any(face.select for each in (selected, other) for face in scenes.edit_mesh(each).faces)


def test_unwrapping_after_suggested_seams_needs_no_selection():
    scenes.edit(scenes.cube(), select=False)
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}


def test_faces_that_are_bent_far_more_than_the_rest_are_a_warning_and_the_last_line(reports):
    spike = scenes.grid(8, 8)
    scenes.edit(spike)
    bm = scenes.edit_mesh(spike)
    bm.verts.ensure_lookup_table()
    bm.verts[40].co.z = 3.0
    reports()
    bpy.ops.uv.spectral_unwrap()
    *_, (level, text) = reports()
    assert level == "Warning"
    count, rest = text.split(" ", 1)
    assert rest.startswith("faces are stretched to more than twice their width, up to ")
    # One click selects them, that many and no others.
    assert bpy.ops.uv.spectral_select(kind="STRETCHED") == {"FINISHED"}
    assert sum(face.select for face in bm.faces) == int(count) > 0
    assert not all(face.select for face in bm.faces)


def test_where_nothing_is_stretched_there_is_nothing_to_select(reports):
    grid = scenes.grid(3, 3)
    scenes.edit(grid)
    bpy.ops.uv.spectral_unwrap()
    scenes.select_faces(grid, [4])
    reports()
    assert bpy.ops.uv.spectral_select(kind="STRETCHED") == {"FINISHED"}
    assert reports() == [("Info", "No such faces, selection unchanged")]
    assert [face.index for face in scenes.edit_mesh(grid).faces if face.select] == [4]


def test_the_notice_on_scale_is_the_last_line(reports):
    grid = scenes.grid(2, 2)
    grid.scale = 1.0, 2.0, 1.0
    scenes.edit(grid)
    reports()
    bpy.ops.uv.spectral_unwrap()
    *_, (level, text) = reports()
    assert (level, "non-uniform scale" in text) == ("Info", True)
