# SPDX-License-Identifier: GPL-3.0-or-later
"""Adjust Push/Pull dragged by the mouse: map, list and arrows follow, and are restored unless it is confirmed."""

import bpy  # isort: skip - makes addon_utils importable
import addon_utils
import numpy as np
import pytest

from tests.blender.inside import jobs, scenes
from tests.blender.inside.test_control import add_extender, hill


class Dragged:
    """Drives the operator without a window."""

    def __init__(self, invoked):
        self.invoked, self.x = invoked, 0
        self.send = invoked.send

    def move(self, pixels, shift=False):
        self.x += pixels
        return self.send("MOUSEMOVE", "NOTHING", mouse_x=self.x, shift=shift)


@pytest.fixture
def extended():
    grid = hill()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    add_extender(grid, 1, 140, 1.0)
    return grid, scenes.read_uv(grid)


@pytest.fixture
def dragged(extended, monkeypatch):
    invoked = jobs.adjust_extender(monkeypatch)
    assert invoked.result == {"RUNNING_MODAL"}
    return *extended, Dragged(invoked)


def strength_of(grid):
    return grid.data.spectral_shapes[0].strength


def after(pixels):
    """The strength after dragging from 1 by this distance: a pixel is a quarter of a percent of the amount."""
    pairs = scenes.module("core.extenders.pairs")
    half = scenes.half_of(bpy.context.edit_object.data.spectral_shapes[0])
    return pairs.strength_of(pairs.amount_of(1.0, half) + 0.25 * pixels, half)


def test_dragging_changes_the_strength_and_the_map_follows(dragged):
    grid, before, drag = dragged
    assert drag.move(-100) == {"RUNNING_MODAL"}
    assert strength_of(grid) == pytest.approx(after(-100))
    drag.move(100, shift=True)
    assert strength_of(grid) == pytest.approx(after(-90))
    assert f"Push/Pull: {grid.data.spectral_shapes[0].amount:.1f} % " in drag.invoked.status[-1]
    assert np.abs(scenes.read_uv(grid) - before).max() > 1e-3
    assert drag.send("LEFTMOUSE") == {"FINISHED"}
    assert strength_of(grid) == pytest.approx(after(-90))
    assert drag.invoked.operator.amount == pytest.approx(grid.data.spectral_shapes[0].amount)
    assert drag.invoked.left_nothing()


def test_escape_restores_exactly(dragged):
    grid, before, drag = dragged
    drag.move(-150)
    drag.move(700)
    assert drag.send("ESC") == {"CANCELLED"}
    assert_as_before(grid, before)
    assert drag.invoked.left_nothing()


def test_before_the_map_folds_it_stops_with_the_reason_and_the_last_strength_stays(dragged):
    grid, _, drag = dragged
    drag.move(-320)
    valid, uv = strength_of(grid), scenes.read_uv(grid)
    assert valid == pytest.approx(after(-320))
    drag.move(-600)
    assert "would fold the island" in drag.invoked.status[-1]
    np.testing.assert_array_equal(scenes.read_uv(grid), uv)
    assert strength_of(grid) == valid
    assert drag.send("RET") == {"FINISHED"}
    assert strength_of(grid) == valid
    np.testing.assert_allclose(scenes.read_uv(grid), uv, atol=1e-3)


def test_view_navigation_goes_on_while_dragging(dragged):
    _, _, drag = dragged
    assert drag.send("WHEELUPMOUSE") == {"PASS_THROUGH"}
    assert drag.send("A", ascii="a") == {"RUNNING_MODAL"}


def assert_as_before(grid, before):
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    assert strength_of(grid) == 1.0


def test_list_and_arrows_show_the_strength_that_is_dragged(dragged, monkeypatch):
    grid, before, drag = dragged
    bpy.context.view_layer.update()
    arrows = scenes.module("overlay.extender_arrows")
    monkeypatch.setattr(arrows, "_on_screen", lambda _context, _object, vertex: [vertex.co.xy])

    def points_outward():
        ((_, _, outward, *_),) = arrows._arrows(bpy.context)
        return outward

    assert points_outward()
    drag.move(-360)
    assert strength_of(grid) == pytest.approx(after(-360))
    assert not points_outward()
    drag.send("ESC")
    assert points_outward()
    assert_as_before(grid, before)


def test_the_name_of_the_layer_follows_for_undo(dragged):
    grid, _, drag = dragged
    drag.move(100)
    drag.send("LEFTMOUSE")
    (extender,) = grid.data.spectral_shapes
    assert extender.layer in grid.data.attributes
    assert extender.layer == f".spectral_extender:1:{extender.strength:.9g}@{scenes.half_of(extender):.3g}:Push/Pull"


def test_leaving_edit_mode_gives_map_and_strength_back(dragged):
    grid, before, drag = dragged
    drag.move(300)
    bpy.ops.object.mode_set(mode="OBJECT")
    drag.invoked.context.mode = "OBJECT"
    assert drag.move(0) == {"CANCELLED"}
    assert drag.invoked.left_nothing()
    uv = np.empty(before.size, dtype=np.float32)
    grid.data.uv_layers.active.data.foreach_get("uv", uv)
    np.testing.assert_array_equal(uv.reshape(-1, 2), before)
    bpy.ops.object.mode_set(mode="EDIT")
    assert_as_before(grid, before)


def test_edit_mode_left_and_entered_again_gives_map_and_strength_back(dragged):
    grid, before, drag = dragged
    drag.move(300)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.mode_set(mode="EDIT")
    assert drag.move(0) == {"CANCELLED"}
    assert_as_before(grid, before)


def test_a_mesh_that_is_gone_is_let_go(dragged):
    grid, _, drag = dragged
    drag.move(300)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.data.meshes.remove(grid.data)
    drag.invoked.context.mode = "OBJECT"
    assert drag.move(0) == {"CANCELLED"}


def test_a_mesh_with_another_map_keeps_it(dragged):
    grid, _, drag = dragged
    drag.move(300)
    bpy.ops.object.mode_set(mode="OBJECT")
    other = grid.data.uv_layers.new(name="Other")
    grid.data.uv_layers.active = other
    drag.invoked.context.mode = "OBJECT"
    before = np.array([loop.uv[:] for loop in other.data])
    assert drag.move(0) == {"CANCELLED"}
    np.testing.assert_array_equal(np.array([loop.uv[:] for loop in grid.data.uv_layers["Other"].data]), before)


def test_undo_in_the_middle_gives_map_and_strength_back_before(dragged):
    grid, before, drag = dragged
    drag.move(300)
    for handler in bpy.app.handlers.undo_pre:
        handler(bpy.context.scene, None)
    assert_as_before(grid, before)
    for handler in bpy.app.handlers.undo_post:
        handler(bpy.context.scene, None)
    assert drag.move(0) == {"CANCELLED"}
    assert drag.invoked.left_nothing()


@pytest.mark.parametrize("error", [RuntimeError, MemoryError])
def test_an_error_gives_map_and_strength_back(dragged, monkeypatch, error):
    grid, before, drag = dragged
    drag.move(300)

    def fail(*_arguments, **_options):
        raise error("for the test")

    monkeypatch.setattr(scenes.module("core.extenders.adjustment").ExtenderAdjustment, "map", fail)
    if error is MemoryError:
        assert drag.move(10) == {"CANCELLED"}
        assert "Not enough memory" in drag.invoked.reported[-1][1]
    else:
        with pytest.raises(error):
            drag.move(10)
    assert_as_before(grid, before)
    assert drag.invoked.left_nothing()


def test_disabling_the_add_on_gives_map_and_strength_back(dragged):
    grid, before, drag = dragged
    drag.move(300)
    addon_utils.disable("spectral_unwrap")
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    addon_utils.enable("spectral_unwrap", default_set=True)
    assert_as_before(grid, before)
    assert bpy.ops.uv.spectral_extender(amount=60.0) == {"FINISHED"}
    assert grid.data.spectral_shapes[0].amount == pytest.approx(60.0)


def test_live_unwrapping_pauses(dragged):
    grid, before, drag = dragged
    bpy.context.scene.spectral_unwrap_live = True
    for pixels in (100, 100):
        drag.move(pixels)
        bpy.context.view_layer.update()
        shown = scenes.read_uv(grid)
        scenes.module("live.following").look()
        np.testing.assert_array_equal(scenes.read_uv(grid), shown)
    drag.send("ESC")
    scenes.module("live.following").look()
    assert_as_before(grid, before)


def test_without_a_window_the_strength_is_set_at_once(extended, monkeypatch):
    grid, before = extended
    operator_class = scenes.module("operators.extender").UV_OT_spectral_extender
    properties = {**jobs.defaults(bpy.ops.uv.spectral_extender), "amount": 75.0}
    invoked = jobs.Invoked(monkeypatch, operator_class, is_waiting=False, has_window=False, **properties)
    assert invoked.result == {"FINISHED"}
    assert grid.data.spectral_shapes[0].amount == pytest.approx(75.0)
    assert np.abs(scenes.read_uv(grid) - before).max() > 1e-3


def test_in_background_mode_the_strength_is_set_at_once(extended):
    grid, before = extended
    assert bpy.ops.uv.spectral_extender("INVOKE_DEFAULT", amount=75.0) == {"FINISHED"}
    assert grid.data.spectral_shapes[0].amount == pytest.approx(75.0)
    assert np.abs(scenes.read_uv(grid) - before).max() > 1e-3


def test_a_typed_amount_that_folds_the_island_is_warned_of(reports):
    bpy.ops.mesh.primitive_monkey_add()
    scenes.edit(bpy.context.object)
    bpy.ops.uv.spectral_unwrap()
    add_extender(bpy.context.object, 74, 315, 0.0)
    reports()
    assert bpy.ops.uv.spectral_extender(amount=70.0) == {"FINISHED"}
    ((level, said),) = reports()
    assert level == "Warning" and "overlapping faces" in said
    bpy.ops.uv.spectral_extender(amount=0.0)
    assert reports() == []
    bpy.context.scene.spectral_unwrap_live = True
    lines = scenes.module("unwrapping.island_list").lines
    for amount, is_warned_of in ((70.0, True), (0.0, False)):
        bpy.context.edit_object.data.spectral_shapes[0].amount = amount
        scenes.module("live.following").look()
        assert any(level == "WARNING" and "overlapping faces" in text for level, text in lines()) == is_warned_of
