# SPDX-License-Identifier: GPL-3.0-or-later
"""Compare Methods: what it measures, and that the artist's UVs stay as they are."""

import importlib

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes

texts = importlib.import_module("spectral_unwrap.core.texts")
map_view = importlib.import_module("spectral_unwrap.core.map_view")
read_map = importlib.import_module("spectral_unwrap.edit_mesh.read_map")
comparison = importlib.import_module("spectral_unwrap.unwrapping.comparison")
last_result = importlib.import_module("spectral_unwrap.unwrapping.last_result")


def methods():
    return {each.method: each for each in comparison.last()}


def kept(edited):
    """All that comparing must not change."""
    uv = scenes.read_uv(edited).tolist() if edited.data.uv_layers else None
    return scenes.state(edited), uv


def measured(edited):
    """The quasi-conformal distortion of the map as it is now."""
    return map_view.MapView(read_map.read_map(bpy.context, edited)).qc


def compared():
    """The two bumpy grids of different sizes in edit mode, compared."""
    objects = (scenes.bumpy_grid(), scenes.bumpy_grid(8, 3, name="Second"))
    scenes.edit(*objects)
    before = [kept(each) for each in objects]
    assert bpy.ops.uv.spectral_compare() == {"FINISHED"}
    return objects, before


def test_everything_stays_as_it_is():
    objects, before = compared()
    assert [kept(each) for each in objects] == before
    assert not any(last_result.is_remembered(each.data) for each in objects)


def test_the_numbers_are_those_of_the_methods():
    compared()
    bpy.ops.mesh.select_all(action="SELECT")
    found = methods()
    assert {"SPECTRAL", "CONFORMAL", "ANGLE_BASED"} <= set(found)
    assert ("MINIMUM_STRETCH" in found) == (bpy.app.version >= (4, 3, 0))
    bpy.ops.uv.spectral_unwrap()
    shown = bpy.context.objects_in_mode_unique_data[0]
    assert found["SPECTRAL"].views[0].qc == pytest.approx(measured(shown), abs=1e-4)
    bpy.ops.uv.unwrap(method="ANGLE_BASED", fill_holes=False)
    assert found["ANGLE_BASED"].views[0].qc == pytest.approx(measured(shown), abs=1e-4)
    assert found["SPECTRAL"].numbers.faces == 6 * 4 + 8 * 3
    assert all(each.seconds > 0.0 for each in found.values())
    best = comparison.best(list(found.values()))
    assert best.numbers.mean_qc == min(each.numbers.mean_qc for each in found.values())


def test_without_a_uv_map_there_is_none_afterwards():
    edited = scenes.bumpy_grid(uv_map=False)
    scenes.edit(edited)
    assert bpy.ops.uv.spectral_compare() == {"FINISHED"}
    assert not edited.data.uv_layers
    assert methods()["SPECTRAL"].numbers.mean_qc < 1.5


def test_only_selected_faces_count_and_pins_hold():
    edited = scenes.bumpy_grid()
    scenes.edit(edited, select=False)
    scenes.select_faces(edited, range(6))
    scenes.pin(edited, [0, 1])
    before = kept(edited)
    assert bpy.ops.uv.spectral_compare() == {"FINISHED"}
    assert kept(edited) == before
    for each in methods().values():
        assert each.numbers.faces == 6
        np.testing.assert_allclose(each.views[0].arrays.uv[:2], scenes.read_uv(edited)[:2], atol=1e-6)


def test_a_method_that_fails_is_not_measured_by_the_map_before():
    bpy.ops.mesh.primitive_cube_add()
    closed = bpy.context.object
    scenes.edit(closed)
    before = kept(closed)
    bpy.ops.uv.spectral_compare()
    assert kept(closed) == before
    ours = methods()["SPECTRAL"]
    assert ours.numbers is None or ours.numbers.mapped == 0
    assert texts.comparison_row("Ours", ours.numbers, 0.0)[1] == "failed"
    assert comparison.best(comparison.last()) != ours


def test_faces_that_a_method_leaves_out_are_counted():
    edited = scenes.grid_and_cube()
    scenes.edit(edited)
    assert bpy.ops.uv.spectral_compare() == {"FINISHED"}
    ours = methods()["SPECTRAL"].numbers
    assert ours.faces - ours.mapped == 6
    assert texts.comparison_row("Ours", ours, 0.0)[0] == "Ours (6 left out)"


@pytest.mark.parametrize(("method", "margin"), [("ANGLE_BASED", 0.02), ("CONFORMAL", 0.1)])
def test_blenders_own_unwrap_keeps_its_settings(method, margin):
    edited = scenes.bumpy_grid()
    scenes.edit(edited)
    # What an unwrap is called with is what the next one begins with.
    bpy.ops.uv.unwrap(method=method, margin=margin)
    bpy.ops.uv.unwrap()
    before, known = scenes.read_uv(edited), [len(bpy.data.scenes), len(bpy.data.objects), len(bpy.data.meshes)]
    assert bpy.ops.uv.spectral_compare() == {"FINISHED"}
    bpy.ops.uv.unwrap()
    np.testing.assert_array_equal(scenes.read_uv(edited), before)
    assert [len(bpy.data.scenes), len(bpy.data.objects), len(bpy.data.meshes)] == known
    bpy.ops.uv.unwrap(method="CONFORMAL" if method == "ANGLE_BASED" else "ANGLE_BASED", margin=margin)
    assert not np.array_equal(scenes.read_uv(edited), before)


def test_nothing_selected():
    scenes.edit(scenes.bumpy_grid(), select=False)
    assert bpy.ops.uv.spectral_compare() == {"CANCELLED"}
