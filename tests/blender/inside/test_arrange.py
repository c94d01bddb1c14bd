# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands in a row, and whole tiles farther: by Blender's operators where it has them, else by ours."""

import importlib

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes
from tests.blender.inside.test_pack import FACES, edit_cubes

compatibility = importlib.import_module("spectral_unwrap.compatibility")


def test_blenders_own_operator_goes_before():
    assert hasattr(bpy.types, "UV_OT_spectral_arrange") != compatibility.HAS_ARRANGE_ISLANDS
    assert (bpy.app.version >= (5, 0, 0)) == compatibility.HAS_ARRANGE_ISLANDS


@pytest.fixture
def registered():
    """Register the operator where Blender has one of its own, too."""
    operator = importlib.import_module("spectral_unwrap.operators.arrange").UV_OT_spectral_arrange
    if compatibility.HAS_ARRANGE_ISLANDS:
        bpy.utils.register_class(operator)
    yield
    if compatibility.HAS_ARRANGE_ISLANDS:
        bpy.utils.unregister_class(operator)


@pytest.mark.usefixtures("registered")
def test_islands_of_several_objects_stand_in_a_column(reports):
    cubes = edit_cubes(2)
    bpy.ops.mesh.select_all(action="DESELECT")
    state = scenes.state(cubes[0])
    options = {"axis": "Y", "order": "SMALL_TO_LARGE", "margin": 8.0, "texture_size": 512}
    assert bpy.ops.uv.spectral_arrange(**options) == {"FINISHED"}
    assert reports() == [("Info", f"Arranged {2 * FACES} islands")]
    assert scenes.state(cubes[0]) == state
    islands = np.concatenate([scenes.read_uv(cube).reshape(FACES, 4, 2) for cube in cubes])
    low, high = islands.min(axis=1), islands.max(axis=1)
    order = np.argsort(low[:, 1])
    assert (np.diff((high - low).prod(axis=1)[order]) > -1e-6).all()
    np.testing.assert_allclose((low[order[1:]] - high[order[:-1]])[:, 1] * 512, 8.0, atol=1e-3)


@pytest.mark.usefixtures("registered")
def test_without_a_map_nothing_is_arranged(reports):
    scenes.edit(scenes.new_object(np.eye(3), [(0, 1, 2)], uv_map=False))
    assert bpy.ops.uv.spectral_arrange() == {"CANCELLED"}
    assert [level for level, _ in reports()] == ["Warning"]
