# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever ends an operator that waits for a thread, nothing is left of it."""

import importlib
import threading

import addon_utils
import bpy
import numpy as np
import pytest

from tests.blender.inside import jobs, scenes

native = importlib.import_module("spectral_unwrap.core.native")

WAITING = {"unwrap": jobs.unwrap, "suggest seams": jobs.suggest_seams}


def threads():
    return [thread for thread in threading.enumerate() if thread.name == "spectral_unwrap"]


def disable():
    addon_utils.disable("spectral_unwrap")


def load_file():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True, load_ui=False)


def reload_scripts():
    # What Blender's Reload Scripts does, from its event loop.
    bpy.utils.load_scripts(reload_scripts=True)


# Without any add-on, bpy 4.2 and 4.5 crash or hang on leaving Python once scripts have been reloaded.
MAY_RELOAD = not (4, 2, 0) <= bpy.app.version < (5, 0, 0)
ENDS = [disable, load_file, *([reload_scripts] if MAY_RELOAD else [])]


@pytest.mark.parametrize("end", ENDS, ids=lambda end: end.__name__)
@pytest.mark.parametrize("operator", WAITING)
def test_nothing_is_left_of_a_job(operator, end, monkeypatch):
    scenes.edit(scenes.cylinder())
    waiting = WAITING[operator](monkeypatch)
    assert waiting.result == {"RUNNING_MODAL"}
    assert waiting.timers
    assert not waiting.left_nothing()
    end()
    assert waiting.left_nothing()
    for thread in threads():
        thread.join(60.0)
        assert not thread.is_alive()
    # Where Blender still has the operator, its next event ends it.
    assert waiting.send("TIMER", "NOTHING") == {"CANCELLED"}
    assert waiting.reported == []
    waiting.operator.cancel(waiting.context)


@pytest.mark.parametrize("end", [disable, load_file], ids=lambda end: end.__name__)
def test_nothing_is_left_of_a_preview(end, monkeypatch):
    scenes.edit(scenes.cylinder(closed_seam=False))
    waiting = jobs.suggest_seams(monkeypatch)
    waiting.wait()
    preview = waiting.choice
    assert preview is not None
    end()
    assert waiting.left_nothing()
    assert preview._lines._handle is None
    assert waiting.send("RET") == {"CANCELLED"}


@pytest.mark.parametrize("name", ["unwrap", "suggest_seams"])
def test_without_a_window_the_operator_is_done_when_it_returns(name, monkeypatch):
    head = scenes.cylinder(closed_seam=name == "unwrap")
    scenes.edit(head)
    before = scenes.read_uv(head)
    # However long it takes.
    monkeypatch.setattr(jobs.worker.Worker, "wait", lambda _self, _seconds: False)
    module = importlib.import_module(f"spectral_unwrap.operators.{name}")
    operator = getattr(bpy.ops.uv, f"spectral_{name}")
    properties = jobs.defaults(operator)
    invoked = jobs.Invoked(
        monkeypatch, getattr(module, f"UV_OT_spectral_{name}"), is_waiting=False, has_window=False, **properties
    )
    assert invoked.result == {"FINISHED"}
    assert (invoked.timers, invoked.handlers) == ([], [])
    assert not np.array_equal(scenes.read_uv(head), before)


def test_a_job_that_nobody_ended_gives_way_to_the_next(monkeypatch):
    scenes.edit(scenes.cylinder(closed_seam=False))
    first = jobs.suggest_seams(monkeypatch)
    first.wait()
    second = jobs.suggest_seams(monkeypatch)
    assert first.choice is None
    assert first.timers == []
    assert first.send("TIMER", "NOTHING") == {"CANCELLED"}
    assert second.send("ESC") == {"CANCELLED"}
    assert second.left_nothing()


def test_an_error_of_the_preview_ends_the_job(monkeypatch):
    scenes.edit(scenes.cylinder(closed_seam=False))
    waiting = jobs.suggest_seams(monkeypatch)
    waiting.wait()

    def fail(*_arguments):
        raise ZeroDivisionError

    monkeypatch.setattr(type(waiting.choice), "update", fail)
    with pytest.raises(ZeroDivisionError):
        waiting.send("TIMER", "NOTHING")
    assert waiting.left_nothing()


# What of the compiled module each operator calls.
@pytest.mark.parametrize(
    ("operator", "options", "function"),
    [
        ("spectral_unwrap", {}, "unwrap"),
        ("spectral_suggest_seams", {}, "suggest_cuts"),
        ("spectral_select", {"kind": "DEFECTS"}, "map_defects"),
    ],
)
def test_too_little_memory_is_told(operator, options, function, monkeypatch):
    cylinder = scenes.cylinder()
    scenes.edit(cylinder)
    before, state = scenes.read_uv(cylinder), scenes.state(cylinder)

    def fail(*_arguments, **_options):
        raise MemoryError("std::bad_alloc")

    monkeypatch.setattr(native.spectral_conformal(), function, fail)
    with pytest.raises(RuntimeError, match="Error: Not enough memory, so nothing was changed") as error:
        getattr(bpy.ops.uv, operator)(**options)
    assert "Traceback" not in str(error.value)
    np.testing.assert_array_equal(scenes.read_uv(cylinder), before)
    assert scenes.state(cylinder) == state
