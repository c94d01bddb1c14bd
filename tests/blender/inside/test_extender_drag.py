# SPDX-License-Identifier: GPL-3.0-or-later
"""Adjust Extender dragged by the mouse: map, list and arrows follow, and all is given back unless it ends well."""

import sys
from types import FunctionType, SimpleNamespace

import bpy  # isort: skip - makes addon_utils importable
import addon_utils
import numpy as np
import pytest

from tests.blender.inside import scenes
from tests.blender.inside.test_control import add_extender, hill


def module(name):
    return sys.modules[f"spectral_unwrap.{name}"]


class Dragged:
    """Drives the modal operator without a window."""

    def __init__(self, has_window=True, strength=1.0):
        self.operator_class = module("operators.extender_adjust").MESH_OT_spectral_extender_adjust
        # What a bpy operator instance would have.
        self.operator = SimpleNamespace(index=-1, strength=strength, reported=[])
        self.operator.report = lambda levels, text: self.operator.reported.append(text)
        for cls in reversed(self.operator_class.__mro__):
            for name, function in vars(cls).items():
                if isinstance(function, FunctionType) and cls.__module__.startswith("spectral_unwrap"):
                    setattr(self.operator, name, function.__get__(self.operator))
        self.status = []
        self.context = SimpleNamespace(
            edit_object=bpy.context.edit_object,
            mode="EDIT_MESH",
            scene=bpy.context.scene,
            window=SimpleNamespace() if has_window else None,
            area=None,
            workspace=SimpleNamespace(status_text_set=self.status.append, name="Workspace"),
            window_manager=SimpleNamespace(modal_handler_add=lambda _operator: None, windows=[]),
        )
        self.x = 100
        self.result = self.operator_class.invoke(self.operator, self.context, self.event())

    def event(self, kind="MOUSEMOVE", value="NOTHING", **others):
        properties = {"type": kind, "value": value, "mouse_x": self.x, "shift": False, "ascii": "", **others}
        return SimpleNamespace(**properties)

    def send(self, *arguments, **others):
        return self.operator_class.modal(self.operator, self.context, self.event(*arguments, **others))

    def move(self, pixels, **others):
        self.x += pixels
        return self.send(**others)


@pytest.fixture
def extended(monkeypatch):
    # As if this were no background mode.
    app = SimpleNamespace(background=False)
    monkeypatch.setattr(module("operators.extender_adjust"), "bpy", SimpleNamespace(app=app, context=bpy.context))
    grid = hill()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    add_extender(grid, 1, 140, 1.0)
    return grid, scenes.read_uv(grid)


@pytest.fixture
def dragged(extended):
    drag = Dragged()
    assert drag.result == {"RUNNING_MODAL"}
    return *extended, drag


def test_dragging_changes_the_strength_and_the_map_follows(dragged):
    grid, before, drag = dragged
    assert drag.move(200) == {"RUNNING_MODAL"}
    assert drag.operator.strength == pytest.approx(3.0)
    drag.move(100, shift=True)
    assert drag.operator.strength == pytest.approx(3.1)
    assert "strength 3.100" in drag.status[-1]
    assert np.abs(scenes.read_uv(grid) - before).max() > 1e-3
    assert drag.send("LEFTMOUSE", "PRESS") == {"FINISHED"}
    assert grid.data.spectral_extenders[0].strength == pytest.approx(3.1)
    assert drag.status[-1] is None


def test_escape_restores_exactly(dragged):
    grid, before, drag = dragged
    drag.move(-150)
    drag.move(700)
    assert drag.send("ESC", "PRESS") == {"CANCELLED"}
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    assert grid.data.spectral_extenders[0].strength == 1.0
    assert drag.status[-1] is None


def test_a_number_can_be_typed(dragged):
    grid, _, drag = dragged
    for key, character in (("TWO", "2"), ("PERIOD", "."), ("FIVE", "5"), ("FIVE", "5"), ("BACK_SPACE", "")):
        assert drag.send(key, "PRESS", ascii=character) == {"RUNNING_MODAL"}
    assert drag.operator.strength == 2.5
    assert "[2.5|]" in drag.status[-1]
    drag.move(50)
    assert drag.operator.strength == 2.5
    assert drag.send("RET", "PRESS") == {"FINISHED"}
    assert grid.data.spectral_extenders[0].strength == 2.5


def test_where_the_map_cannot_follow_it_stays_and_the_reason_is_shown(dragged):
    grid, _, drag = dragged
    for key, character in (("MINUS", "-"), ("NINE", "9"), ("NINE", "9"), ("NINE", "9"), ("NINE", "9")):
        drag.send(key, "PRESS", ascii=character)
    shown = scenes.read_uv(grid)
    assert np.isfinite(shown).all()
    assert "weaken or remove extenders" in drag.status[-1]
    assert drag.send("RET", "PRESS") == {"CANCELLED"}
    assert grid.data.spectral_extenders[0].strength == 1.0


def test_view_navigation_goes_on_while_dragging(dragged):
    _, _, drag = dragged
    assert drag.send("WHEELUPMOUSE", "PRESS") == {"PASS_THROUGH"}
    assert drag.send("A", "PRESS", ascii="a") == {"RUNNING_MODAL"}


def assert_as_before(grid, before):
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    assert grid.data.spectral_extenders[0].strength == 1.0


def test_list_and_arrows_show_the_strength_that_is_dragged(dragged):
    grid, before, drag = dragged
    bpy.context.view_layer.update()
    arrows = module("overlay.extender_arrows")

    def points_outward():
        in_plane = lambda _context, _object, _track: lambda first, second: (tuple(first.co.xy), tuple(second.co.xy))  # noqa: E731
        ((_, _, outward, *_),) = arrows._arrows(bpy.context, in_plane)
        return outward

    assert points_outward()
    drag.move(-150)
    assert grid.data.spectral_extenders[0].strength == pytest.approx(-0.5)
    assert not points_outward()
    drag.send("ESC", "PRESS")
    assert points_outward()
    assert_as_before(grid, before)


def test_the_layer_is_named_after_the_list_when_the_drag_has_ended(dragged):
    grid, _, drag = dragged
    storage = module("extenders.storage")
    name = grid.data.spectral_extenders_layer
    drag.move(100)
    assert grid.data.spectral_extenders_layer == name
    drag.send("LEFTMOUSE", "PRESS")
    core = module("core.extenders.pairs")
    wanted = core.layer_name(".spectral_extenders:", storage._read(grid.data))
    assert grid.data.spectral_extenders_layer == wanted != name


def test_leaving_edit_mode_gives_map_and_strength_back(dragged):
    grid, before, drag = dragged
    drag.move(300)
    bpy.ops.object.mode_set(mode="OBJECT")
    drag.context.mode = "OBJECT"
    assert drag.send() == {"CANCELLED"}
    assert drag.status[-1] is None
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
    assert drag.send() == {"CANCELLED"}
    assert_as_before(grid, before)


def test_a_mesh_that_is_gone_is_let_go(dragged):
    grid, _, drag = dragged
    drag.move(300)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.data.meshes.remove(grid.data)
    drag.context.mode = "OBJECT"
    assert drag.send() == {"CANCELLED"}


def test_undo_in_the_middle_gives_map_and_strength_back_before(dragged):
    grid, before, drag = dragged
    drag.move(300)
    for handler in bpy.app.handlers.undo_pre:
        handler(bpy.context.scene, None)
    assert_as_before(grid, before)
    for handler in bpy.app.handlers.undo_post:
        handler(bpy.context.scene, None)
    assert drag.send() == {"CANCELLED"}
    assert drag.status[-1] is None


@pytest.mark.parametrize("error", [RuntimeError, MemoryError])
def test_an_error_gives_map_and_strength_back(dragged, monkeypatch, error):
    grid, before, drag = dragged
    drag.move(300)

    def fail(*_arguments, **_options):
        raise error("for the test")

    monkeypatch.setattr(module("core.extenders.adjustment").ExtenderAdjustment, "map", fail)
    if error is MemoryError:
        assert drag.move(10) == {"CANCELLED"}
        assert "Not enough memory" in drag.operator.reported[-1]
    else:
        with pytest.raises(error):
            drag.move(10)
    assert_as_before(grid, before)
    assert drag.status[-1] is None


def test_disabling_the_add_on_gives_map_and_strength_back(dragged):
    grid, before, drag = dragged
    drag.move(300)
    addon_utils.disable("spectral_unwrap")
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    addon_utils.enable("spectral_unwrap", default_set=True)
    assert_as_before(grid, before)
    assert bpy.ops.mesh.spectral_extender_adjust(strength=2.0) == {"FINISHED"}
    assert grid.data.spectral_extenders[0].strength == 2.0


def test_live_unwrapping_pauses(dragged):
    grid, before, drag = dragged
    bpy.context.scene.spectral_unwrap_live = True
    for pixels in (100, 100):
        drag.move(pixels)
        bpy.context.view_layer.update()
        shown = scenes.read_uv(grid)
        module("live.following").look()
        np.testing.assert_array_equal(scenes.read_uv(grid), shown)
    drag.send("ESC", "PRESS")
    module("live.following").look()
    assert_as_before(grid, before)


def test_without_a_window_the_strength_is_set_at_once(extended):
    grid, before = extended
    assert Dragged(has_window=False, strength=3.0).result == {"FINISHED"}
    assert grid.data.spectral_extenders[0].strength == 3.0
    assert np.abs(scenes.read_uv(grid) - before).max() > 1e-3


def test_in_background_mode_the_strength_is_set_at_once():
    grid = hill()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    add_extender(grid, 1, 140, 1.0)
    before = scenes.read_uv(grid)
    assert bpy.ops.mesh.spectral_extender_adjust("INVOKE_DEFAULT", strength=3.0) == {"FINISHED"}
    assert grid.data.spectral_extenders[0].strength == 3.0
    assert np.abs(scenes.read_uv(grid) - before).max() > 1e-3
