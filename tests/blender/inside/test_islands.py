# SPDX-License-Identifier: GPL-3.0-or-later
"""What becomes of the selected faces: developable, cut, n-gon and real islands."""

import bpy
import numpy as np

from tests.blender.inside import scenes


def test_existing_uv_splits_do_not_cut():
    split, joined = scenes.grid(4, 4, name="Split"), scenes.grid(4, 4, name="Joined", uv_map=False)
    results = []
    for grid in (split, joined):
        scenes.edit(grid)
        assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
        results.append(scenes.read_uv(grid))
        bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_allclose(results[0], results[1], atol=1e-6)


def test_uv_map_is_made_where_there_is_none():
    grid = scenes.grid(2, 2, uv_map=False)
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert [layer.name for layer in grid.data.uv_layers] == ["UVMap"]
    bpy.ops.object.mode_set(mode="OBJECT")
    uv = np.array([corner.uv for corner in grid.data.uv_layers.active.data])
    assert np.ptp(uv, axis=0).min() > 0.4


def test_only_the_active_uv_map_is_written():
    grid = scenes.grid(2, 2)
    grid.data.uv_layers.new(name="Second")
    grid.data.uv_layers.active_index = 1
    scenes.edit(grid)
    first, second = scenes.read_uv(grid, "UVMap"), scenes.read_uv(grid, "Second")
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    np.testing.assert_array_equal(scenes.read_uv(grid, "UVMap"), first)
    assert not np.array_equal(scenes.read_uv(grid, "Second"), second)


def test_suzanne_has_less_distortion_than_blenders_conformal():
    bpy.ops.mesh.primitive_monkey_add()
    suzanne = bpy.context.object
    scenes.edit(suzanne)
    mean = {}
    for name, unwrap in {"spectral": bpy.ops.uv.spectral_unwrap, "conformal": bpy.ops.uv.unwrap}.items():
        assert unwrap(method=name.upper()) == {"FINISHED"}
        uv = scenes.read_uv(suzanne)
        assert np.isfinite(uv).all()
        assert uv.min() > -1e-5
        assert uv.max() < 1.0 + 1e-5
        qc, area = scenes.quasi_conformal(suzanne)
        mean[name] = np.average(qc, weights=area)
    assert mean["spectral"] <= mean["conformal"]
