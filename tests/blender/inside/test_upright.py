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


def test_islands_turn_only_where_that_is_asked_for():
    plank = scenes.grid(2, 6)
    scenes.edit(plank)
    ratios, widths = [], []
    for turn_to_pack in (False, True, False):
        assert bpy.ops.uv.spectral_unwrap(turn_to_pack=turn_to_pack) == {"FINISHED"}
        width, height = np.ptp(scenes.read_uv(plank), axis=0)
        ratios.append(height / width)
        widths.append(scenes.stretches(plank, range(12)).mean())
    np.testing.assert_allclose(ratios[::2], 3.0, rtol=1e-4)
    # Across the corners of the tile there is more room.
    assert ratios[1] < 2.0 and widths[1] > 1.04 * widths[0]
    assert widths[2] == widths[0]
