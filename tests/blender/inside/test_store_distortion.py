# SPDX-License-Identifier: GPL-3.0-or-later
"""Store as Attribute: values on faces, colors on their corners."""

import importlib

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes

names = importlib.import_module("spectral_unwrap.names")
map_view = importlib.import_module("spectral_unwrap.core.measure.map_view")
texels = importlib.import_module("spectral_unwrap.core.measure.texels")
read_map = importlib.import_module("spectral_unwrap.edit_mesh.read_map")


def unwrapped():
    edited = scenes.bumpy_grid()
    scenes.edit(edited)
    bpy.ops.uv.unwrap(method="CONFORMAL")
    return edited


def stored(edited, name, field, size):
    """An attribute of the mesh out of edit mode."""
    bpy.ops.object.mode_set(mode="OBJECT")
    attribute = edited.data.attributes[name]
    values = np.empty(size * len(attribute.data))
    attribute.data.foreach_get(field, values)
    return attribute, values.reshape(-1, size)


@pytest.mark.parametrize("mode", ["EDIT", "OBJECT"])
@pytest.mark.parametrize("kind", sorted(names.ATTRIBUTES))
def test_values_are_those_that_are_shown(kind, mode):
    edited = unwrapped()
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.mesh.spectral_store_distortion(kind=kind) == {"FINISHED"}
    attribute, values = stored(edited, names.ATTRIBUTES[kind], "value", 1)
    assert (attribute.domain, attribute.data_type) == ("FACE", "FLOAT")
    expected = map_view.MapView(read_map.read_own_map(bpy.context, edited)).values(kind, texels.Texels(1024))
    np.testing.assert_allclose(values[:, 0], expected, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("mode", ["EDIT", "OBJECT"])
def test_colors_are_those_of_the_legend(mode):
    edited = unwrapped()
    bpy.ops.object.mode_set(mode=mode)
    # The range of the overlay, as for a map of small differences.
    overlay = bpy.context.window_manager.spectral_map_overlay
    overlay.use_range, overlay.range[1] = True, 10.0
    assert bpy.ops.mesh.spectral_store_distortion(kind="ANGLE", as_colors=True) == {"FINISHED"}
    attribute, colors = stored(edited, names.ATTRIBUTES["ANGLE"] + names.COLORS_SUFFIX, "color", 4)
    assert (attribute.domain, attribute.data_type) == ("CORNER", "FLOAT_COLOR")
    qc = map_view.MapView(read_map.read_own_map(bpy.context, edited)).qc
    best, worst = (colors.reshape(-1, 4, 4)[face] for face in (qc.argmin(), qc.argmax()))
    assert (best == best[0]).all()
    # From blue to red.
    assert best[0, 2] > best[0, 0]
    assert worst[0, 0] > worst[0, 2]
    assert (colors[:, 3] == 1.0).all()


def test_hidden_faces_and_a_second_time():
    edited = unwrapped()
    scenes.edit_mesh(edited).faces[3].hide_set(True)
    for _ in range(2):
        assert bpy.ops.mesh.spectral_store_distortion(kind="ANGLE") == {"FINISHED"}
    _, values = stored(edited, names.ATTRIBUTES["ANGLE"], "value", 1)
    assert values[3, 0] > 1.0
    assert sum(each.name.startswith("spectral_angle") for each in edited.data.attributes) == 1
