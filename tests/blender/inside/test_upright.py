# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands stand upright: mesh Z up, on their axis, the same at every unwrap."""

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


def _suzanne():
    """The monkey's head, with a seam down its back; the eyes are islands of their own."""
    bpy.ops.mesh.primitive_monkey_add()
    head = bpy.context.object
    vertices = head.data.vertices
    for edge in head.data.edges:
        ends = [vertices[index].co for index in edge.vertices]
        edge.use_seam = all(abs(co.x) < 1e-5 for co in ends) and sum(co.y for co in ends) > 0.0
    return head


@pytest.mark.parametrize("keep_in_place", [False, True])
@pytest.mark.parametrize("make", [lambda: scenes.cube(all_seams=True), _suzanne])
def test_unwrapping_again_changes_nothing(make, keep_in_place):
    edited = make()
    scenes.edit(edited)
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=keep_in_place) == {"FINISHED"}
    first = scenes.read_uv(edited)
    for _ in range(2):
        assert bpy.ops.uv.spectral_unwrap(keep_in_place=keep_in_place) == {"FINISHED"}
        np.testing.assert_allclose(scenes.read_uv(edited), first, atol=1e-6)


def test_unwrapped_islands_turn_as_the_scene_or_the_call_says():
    planks = scenes.grid(1, 6), scenes.grid(6, 1)
    scenes.edit(*planks)

    def stand(**options):
        assert bpy.ops.uv.spectral_unwrap(**options) == {"FINISHED"}
        return [bool(np.less(*np.ptp(scenes.read_uv(plank), axis=0))) for plank in planks]

    # Side by side they fill more of the tile.
    assert bpy.context.scene.spectral_rotation == "SQUARE"
    one, other = stand()
    assert one == other
    assert stand(rotation="NONE") == [True, False]
    bpy.context.scene.spectral_rotation = "NONE"
    assert stand() == [True, False]
    one, other = stand(rotation="QUARTERS")
    assert one == other
