# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands stand upright: mesh Z up, on their axis, the same at every unwrap."""

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


def _limb(direction, name="Limb"):
    """A tapering tube of length 6 along `direction`, with a seam at its back; its first ring is at the origin."""
    tube = scenes.cylinder(segments=16, rows=12, name=name)
    axis = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
    back = np.array((0.0, 1.0, 0.0)) - axis[1] * axis
    back /= np.linalg.norm(back)
    side = np.cross(axis, back)
    for vertex in tube.data.vertices:
        x, y, z = vertex.co
        vertex.co = 3.0 * z * axis + (1.0 - 0.2 * z) * (x * back + y * side)
    return tube


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
@pytest.mark.parametrize("make", [lambda: scenes.cube(all_seams=True), lambda: _limb((1, 0, -1)), _suzanne])
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
