# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectral Relax: what moves, what stays to the last bit, and what it reports."""

import bmesh
import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes

N = 6


def hill(name="Hill", offset=0.0):
    """A hill of N x N quads whose map is its view from above, (C, 2), in edit mode."""
    x, y = np.meshgrid(np.arange(N + 1), np.arange(N + 1))
    height = 3.0 * np.exp(-((x - 3.0) ** 2 + (y - 3.4) ** 2) / 3.0)
    vertices = np.stack([x + offset, y, height], axis=-1).reshape(-1, 3)
    return scenes.new_object(vertices, scenes._quads(N, N, N + 1), name=name)


def flatten(edited):
    """Map by the view from above, as single precision has it."""
    uv = (scenes.corner_positions(edited)[:, :2] / (2.0 * N)).astype(np.float32)
    scenes.write_uv(edited, uv.tolist())
    return scenes.read_uv(edited)


def edit_hill():
    edited = hill()
    scenes.edit(edited)
    return edited, flatten(edited)


def deviation(edited):
    return np.log(scenes.stretches(edited)).std()


def test_whole_islands_of_many_objects_get_even(reports):
    first, second = hill(), hill("Second", offset=10.0)
    scenes.edit(first, second)
    for edited in (first, second):
        # In the middle of the tile.
        scenes.write_uv(edited, (flatten(edited) + 0.25).tolist())
    before, state = deviation(first), scenes.state(first)
    assert bpy.ops.uv.spectral_relax(sizes=1.0) == {"FINISHED"}
    assert deviation(first) < 0.8 * before
    assert deviation(second) < 0.8 * before
    assert scenes.state(first) == state
    ((level, text),) = reports()
    assert level == "Info"
    assert "lower" in text and "no flipped faces" in text


def test_islands_that_come_to_lie_on_others_are_counted(reports):
    first, second = hill(), hill("Second", offset=10.0)
    scenes.edit(first, second)
    # Side by side, without overlap, but the island that bulges has no room.
    before = flatten(first)
    scenes.write_uv(second, (before + (0.5, 0.0)).tolist())
    assert bpy.ops.uv.spectral_relax() == {"FINISHED"}
    n = int(scenes.overlapping_faces(first, second).sum())
    assert n > 0
    assert reports()[-1] == ("Warning", f"{n} faces overlap other islands now; Spectral Pack separates them")
    # What has covered others before is not said again.
    assert bpy.ops.uv.spectral_relax(steps=1) == {"FINISHED"}
    assert not any("overlap other" in text for _, text in reports())


def test_faces_that_leave_their_tile_are_counted(reports):
    edited, before = edit_hill()
    # In the lower left corner of the first tile of the second row.
    before = before + (0.0, 1.0)
    scenes.write_uv(edited, before.tolist())
    assert bpy.ops.uv.spectral_relax() == {"FINISHED"}
    bounds = scenes.read_uv(edited).reshape(-1, 4, 2).min(axis=1) - (0.0, 1.0)
    n = int((bounds < -1e-5).any(axis=1).sum())
    assert n > 0
    assert reports()[-1] == ("Warning", f"{n} faces lie beyond their UV tile now; Spectral Pack brings them back")
    # What lay beyond before is not said again.
    assert bpy.ops.uv.spectral_relax(steps=1) == {"FINISHED"}
    assert not any("UV tile" in text for _, text in reports())


def test_hidden_faces_and_pins_stay():
    edited, before = edit_hill()
    bm = scenes.edit_mesh(edited)
    layer = bm.loops.layers.uv.active
    hidden, pinned = bm.faces[8], bm.faces[22].loops[0].vert
    for loop in pinned.link_loops:
        loop[layer].pin_uv = True
    stay = np.array([v in set(hidden.verts) | {pinned} for f in bm.faces for v in (loop.vert for loop in f.loops)])
    hidden.hide_set(True)
    bmesh.update_edit_mesh(edited.data)
    assert bpy.ops.uv.spectral_relax() == {"FINISHED"}
    moved = (scenes.read_uv(edited) != before).any(axis=1)
    assert not moved[stay].any()
    assert moved[~stay].all()


def test_held_border():
    edited, before = edit_hill()
    assert bpy.ops.uv.spectral_relax(border="HELD") == {"FINISHED"}
    moved = (scenes.read_uv(edited) != before).any(axis=1)
    bm = scenes.edit_mesh(edited)
    on_border = np.array([loop.vert.is_boundary for face in bm.faces for loop in face.loops])
    np.testing.assert_array_equal(moved, ~on_border)


@pytest.mark.parametrize("sync", [False, True])
def test_selection_of_the_uv_editor(uv_editor, sync):
    bpy.context.scene.tool_settings.use_uv_select_sync = sync
    edited, before = edit_hill()
    half = scenes.corners_of(edited, range(N * N // 2))
    if sync:
        scenes.select_faces(edited, range(N * N // 2))
    else:
        scenes.set_uv_flags(edited, half)
    with bpy.context.temp_override(**uv_editor):
        assert bpy.ops.uv.spectral_relax() == {"FINISHED"}
    moved = (scenes.read_uv(edited) != before).any(axis=1)
    middle = np.isclose(before[:, 1], 0.25)
    assert not moved[~half | middle].any()
    assert moved[half & ~middle].all()


def test_folds_go_where_asked(reports):
    edited, before = edit_hill()
    # The middle lies beside the island.
    folded = before.copy()
    folded[np.isclose(before, 0.25).all(axis=1)] = (0.9, 0.3)
    scenes.write_uv(edited, folded.tolist())
    assert bpy.ops.uv.spectral_relax(fold_free=True) == {"FINISHED"}
    assert any("no flipped faces" in text for _, text in reports())


def test_nothing_that_can_move_is_said(reports):
    edited, before = edit_hill()
    scenes.select_faces(edited, [14])
    assert bpy.ops.uv.spectral_relax() == {"CANCELLED"}
    np.testing.assert_array_equal(scenes.read_uv(edited), before)
    assert reports()[0][0] == "Warning"
