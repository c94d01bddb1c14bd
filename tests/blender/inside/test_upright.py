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


def _rise(positions, uv):
    """The direction, as an angle from up in degrees, in which the height grows in the map."""
    u, v = np.linalg.lstsq(uv - uv.mean(axis=0), positions[:, 2] - positions[:, 2].mean(), rcond=None)[0]
    return np.degrees(np.arctan2(u, v))


def _islands(edited):
    """The corners of every connected part of the mesh, (C,) bool each: seams of the head do not part it."""
    faces = scenes.edit_mesh(edited).faces
    part = np.full(len(faces), -1)
    for start in range(len(faces)):
        stack = [faces[start]] if part[start] < 0 else []
        while stack:
            face = stack.pop()
            if part[face.index] < 0:
                part[face.index] = start
                stack += [other for edge in face.edges for other in edge.link_faces]
    of_corner = np.array([part[face.index] for face in faces for _ in face.loops])
    return [of_corner == number for number in np.unique(part)]


@pytest.mark.parametrize("direction", [(0, 0, 1), (0, 0, -1), (1, 0, -1), (-1, 0, -1), (0.2, -0.1, -1)])
def test_limb_stands(direction):
    limb = _limb(direction)
    scenes.edit(limb)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    uv, positions = scenes.read_uv(limb), scenes.corner_positions(limb)
    assert abs(_rise(positions, uv)) < 25.0
    # From one end to the other it goes up or down, not aside.
    along = positions @ direction
    ends = [uv[np.abs(along - extreme(along)) < 2.0].mean(axis=0) for extreme in (np.min, np.max)]
    across, upwards = ends[1] - ends[0]
    assert abs(across) < 0.1 * abs(upwards)
    assert np.sign(upwards) == np.sign(direction[2])


def test_head_stands_on_its_axis():
    head = _suzanne()
    scenes.edit(head)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    uv, positions = scenes.read_uv(head), scenes.corner_positions(head)
    islands = _islands(head)
    for island in islands:
        assert abs(_rise(positions[island], uv[island])) < 45.0
    face = max(islands, key=np.count_nonzero)
    assert abs(_rise(positions[face], uv[face])) < 0.1
    # The mirror image in x is that in the island's vertical middle line.
    where = {tuple(np.round(co, 4)): place for co, place in zip(positions[face], uv[face]) if abs(co[0]) > 1e-3}
    middle = uv[face][np.abs(positions[face][:, 0]) < 1e-5]
    inner = middle[np.abs(middle[:, 0] - np.median(middle[:, 0])) < 1e-3]
    assert len(inner) > len(middle) / 2
    off = [
        np.abs(place[0] + where[(-x, y, z)][0] - 2.0 * np.median(inner[:, 0]))
        for (x, y, z), place in where.items()
        if (-x, y, z) in where
    ]
    assert len(off) > 0.9 * len(where)
    assert max(off) < 1e-3


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


def test_in_place_an_island_stays_as_the_user_has_turned_it():
    limb = _limb((0, 0, 1))
    scenes.edit(limb)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    for quarters in range(4):
        uv = scenes.read_uv(limb)
        turned = 0.4 * (uv[:, ::-1] * (-1.0, 1.0)) + (0.7, 0.2)
        scenes.write_uv(limb, turned)
        assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
        np.testing.assert_allclose(scenes.read_uv(limb), turned, atol=1e-5)
        # A quarter turn counterclockwise each time.
        off = _rise(scenes.corner_positions(limb), turned) + 90.0 * (quarters + 1)
        assert abs(np.remainder(off + 180.0, 360.0) - 180.0) < 1.0


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


def test_pieces_of_a_cube_are_as_seen_from_the_front_and_from_above():
    cube = scenes.cube(all_seams=True)
    scenes.edit(cube)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    uv, positions = scenes.read_uv(cube).reshape(6, 4, 2), scenes.corner_positions(cube).reshape(6, 4, 3)
    for face in range(6):
        height = 2 if np.ptp(positions[face, :, 2]) > 0.5 else 1
        up = positions[face, :, height] > 0.5
        assert uv[face, up, 1].min() > uv[face, ~up, 1].max()
