# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the islands go: packed over all objects in edit mode, or kept in place."""

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


def _nothing():
    return scenes.new_object(np.zeros((0, 3)), [], name="Empty", uv_map=False)


@pytest.mark.parametrize(
    "make_active",
    [lambda: scenes.cube(name="Closed", uv_map=False), _nothing],
    ids=["closed, without a UV map", "without faces"],
)
def test_active_object_without_result_does_not_stop_the_others(make_active):
    active, grid = make_active(), scenes.grid(3, 2, uv_map=False)
    scenes.edit(active, grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    uv = scenes.read_uv(grid)
    assert uv.min() > -1e-5
    assert uv.max() == pytest.approx(1.0, abs=0.01)
    assert not active.data.uv_layers
    assert bpy.context.view_layer.objects.active == active


def test_shared_mesh_is_unwrapped_once(reports):
    grid = scenes.grid(3, 3)
    twin = bpy.data.objects.new("Twin", grid.data)
    bpy.context.collection.objects.link(twin)
    scenes.edit(grid, twin)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert "Unwrapped 1 island:" in reports()[0][1]


@pytest.mark.parametrize("rotation", ["SQUARE", "FREE", "NONE"])
def test_the_margin_of_scene_or_call_lies_between_islands_and_to_the_border(rotation):
    cube = scenes.cube(all_seams=True)
    scenes.edit(cube)
    scene = bpy.context.scene
    scene.spectral_margin, scene.spectral_texture_size = 16.0, 512
    for options, pixels in (({}, 16.0 / 512.0), ({"margin": 8.0}, 8.0 / 512.0), ({"texture_size": 256}, 16.0 / 256.0)):
        assert bpy.ops.uv.spectral_unwrap(rotation=rotation, **options) == {"FINISHED"}
        faces = scenes.read_uv(cube).reshape(-1, 4, 2)
        low, high = faces.min(axis=1), faces.max(axis=1)
        apart = np.maximum(low[:, None] - high, low - high[:, None]).max(axis=2)
        np.fill_diagonal(apart, np.inf)
        least = min(apart.min(), low.min(), 1.0 - high.max())
        assert pixels * (1.0 - 2e-3) < least < 1.5 * pixels
    assert scene.spectral_margin == 16.0


def test_adjust_last_operation_shows_the_margin_and_the_texture_that_it_counts_in():
    cube = scenes.cube(all_seams=True)
    cube.data.materials.append(bpy.data.materials.new("Wide"))
    cube.data.materials[0].spectral_texture_size = 2048
    scenes.edit(cube)
    bpy.context.scene.spectral_margin = 6.0
    # Without undo, operators are not registered for the panel.
    assert bpy.ops.uv.spectral_unwrap("EXEC_DEFAULT", True) == {"FINISHED"}
    shown = bpy.context.window_manager.operators[-1]
    assert (shown.margin, shown.texture_size) == (6.0, 2048.0)


def test_keep_in_place_fits_every_island_into_its_former_bounds():
    both = scenes.new_object(*_two_strips())
    scenes.edit(both)
    # The first strip stood upright, the second lay flat, each smaller than the packer would make it.
    uv = np.empty((16, 2))
    uv[:8] = scenes.corner_positions(both)[:8, 1::-1] * 0.05 + (0.3, 0.1)
    uv[8:] = scenes.corner_positions(both)[8:, :2] * 0.02 + (0.7, 0.8)
    scenes.write_uv(both, uv)
    before = scenes.read_uv(both)
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
    after = scenes.read_uv(both)
    for island in (slice(0, 8), slice(8, 16)):
        np.testing.assert_allclose(scenes.bounds(after[island]), scenes.bounds(before[island]), atol=1e-6)
    stretches = scenes.stretches(both, [0, 1])
    np.testing.assert_allclose(stretches, 0.05, rtol=1e-4)


def _two_strips():
    vertices = [(x, y + 5 * strip, 0) for strip in range(2) for y in range(2) for x in range(3)]
    faces = [(6 * s + x, 6 * s + x + 1, 6 * s + x + 4, 6 * s + x + 3) for s in range(2) for x in range(2)]
    return vertices, faces


@pytest.mark.parametrize("uv_map", [False, True])
def test_keep_in_place_without_former_bounds_says_so(reports, uv_map):
    cube = scenes.cube(all_seams=True, uv_map=uv_map)
    scenes.edit(cube)
    if uv_map:
        scenes.write_uv(cube, np.zeros((24, 2)))
    reports()
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
    assert (
        "Warning",
        "6 islands had no former bounds and were packed into the UV tile",
    ) in reports()
    faces = scenes.read_uv(cube).reshape(6, 4, 2)
    assert faces.min() >= 0.0
    assert faces.max() <= 1.0
    assert not any(scenes.overlap(faces[i], faces[j]) for i in range(6) for j in range(i))


def test_islands_that_the_artist_has_stacked_stay_so(reports):
    cube = scenes.cube(all_seams=True)
    scenes.edit(cube)
    square = np.array([(0.0, 0.0), (0.2, 0.0), (0.2, 0.2), (0.0, 0.2)])
    # Faces 0 and 3 lie on each other, 4 and 5 too, the latter mirrored.
    places = [(0.0, 0.0), (0.3, 0.0), (0.6, 0.0), (0.0, 0.0), (0.3, 0.3), (0.3, 0.3)]
    uv = np.array([square + place for place in places])
    uv[5] = uv[5, ::-1]
    scenes.write_uv(cube, uv.reshape(-1, 2).tolist())
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    (text,) = [text for _, text in reports() if text.startswith("Unwrapped")]
    assert "; 2 stacked on others; " in text
    faces = scenes.read_uv(cube).reshape(6, 4, 2)
    low = faces.min(axis=1)
    np.testing.assert_allclose(low[[0, 4]], low[[3, 5]], atol=1e-6)
    assert len(np.unique(low.round(5), axis=0)) == 4
    fill = int(text.split("; ")[2].split()[0]) if "filled" in text.split("; ")[2] else -1
    assert fill == int(100.0 * 4 * np.ptp(faces[0], axis=0).prod())
