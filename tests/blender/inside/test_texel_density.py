# SPDX-License-Identifier: GPL-3.0-or-later
"""Texel density: the scale of objects, factors kept with the mesh, and the operators on selected islands."""

import importlib

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes

names = importlib.import_module("spectral_unwrap.names")


def last_report(reports):
    *_, (level, text) = reports()
    assert level == "Info"
    return text


def two_grids(scale):
    """Two equal grids, the second scaled as an object."""
    grids = [scenes.grid(2, 2, name="Small"), scenes.grid(2, 2, name="Scaled", offset=(5.0, 0.0, 0.0))]
    grids[1].scale = scale
    bpy.context.view_layer.update()
    scenes.edit(*grids)
    return grids


def sizes(objects):
    return [np.ptp(scenes.read_uv(each), axis=0).max() for each in objects]


def test_an_uneven_scale_counts_on_average_and_is_told(reports):
    grids = two_grids((4.0, 1.0, 1.0))
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    small, scaled = sizes(grids)
    assert scaled / small == pytest.approx(2.0, rel=1e-4)
    assert [text for _, text in reports() if text.startswith("Scaled: scaled unevenly")]


def test_a_factor_stays_with_the_mesh_and_is_used(reports):
    cube = scenes.cube(all_seams=True)
    scenes.edit(cube)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    scenes.select_faces(cube, [0, 1])
    assert bpy.ops.uv.spectral_density(kind="FACTOR", factor=1.5) == {"FINISHED"}
    assert last_report(reports) == "2 islands: factor 1.5; Spectral Unwrap and Equalize use it"
    bpy.ops.object.mode_set(mode="OBJECT")
    stored = np.empty(6)
    cube.data.attributes[names.DENSITY_FACTOR_ATTRIBUTE].data.foreach_get("value", stored)
    assert stored.tolist() == [1.5, 1.5, 0.0, 0.0, 0.0, 0.0]
    bpy.ops.object.mode_set(mode="EDIT")
    before = scenes.read_uv(cube)
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.uv.spectral_density(kind="EQUAL") == {"FINISHED"}
    stretches = scenes.stretches(cube).reshape(6, -1).mean(axis=1)
    np.testing.assert_allclose(stretches / stretches[2], [1.5, 1.5, 1.0, 1.0, 1.0, 1.0], rtol=1e-4)
    assert not np.array_equal(before, scenes.read_uv(cube))
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    stretches = scenes.stretches(cube).reshape(6, -1).mean(axis=1)
    np.testing.assert_allclose(stretches / stretches[2], [1.5, 1.5, 1.0, 1.0, 1.0, 1.0], rtol=1e-4)


def test_pick_and_set_by_texture_and_unit_change_selected_islands_only(reports):
    cube = scenes.cube(all_seams=True, size=2.0)
    cube.scale = 0.5, 0.5, 0.5
    material = bpy.data.materials.new("Half")
    setattr(material, names.TEXTURE_SIZE_PROPERTY, 512)
    cube.data.materials.append(material)
    bpy.context.view_layer.update()
    scenes.edit(cube)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    bpy.context.scene.unit_settings.system = "METRIC"
    bpy.context.scene.unit_settings.length_unit = "CENTIMETERS"
    scenes.select_faces(cube, [3])
    before = scenes.read_uv(cube)
    assert bpy.ops.uv.spectral_density(density=2.56) == {"FINISHED"}
    assert "to 2.56 px/cm" in last_report(reports)
    after = scenes.read_uv(cube)
    changed = scenes.corners_of(cube, [3])
    np.testing.assert_array_equal(after[~changed], before[~changed])
    # A face is a meter in the world: half of a texture of 512 pixels are 2.56 pixels for a centimeter.
    assert np.ptp(after[changed], axis=0) == pytest.approx([0.5, 0.5], rel=1e-4)
    assert bpy.ops.uv.spectral_density(kind="PICK") == {"FINISHED"}
    assert last_report(reports) == "1 island: 2.56 px/cm"
    assert bpy.context.window_manager["spectral_result"].to_dict() == {
        "operator": "density",
        "density": pytest.approx(2.56, rel=1e-4),
    }
    last = bpy.context.window_manager.operator_properties_last("uv.spectral_density")
    assert last.density == pytest.approx(2.56, rel=1e-4)


def test_a_mesh_without_faces_gets_no_factor(reports):
    scenes.edit(scenes.new_object([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)], [], name="Points"), select=False)
    assert bpy.ops.uv.spectral_density(kind="FACTOR", factor=1.5) == {"CANCELLED"}
    assert [level for level, _ in reports()] == ["Warning"]
