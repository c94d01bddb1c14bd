# SPDX-License-Identifier: GPL-3.0-or-later
"""Long solves in background mode: printed progress, canceling, and errors from the thread that solves."""

import importlib
import re
import time
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from tests.blender.inside import jobs, scenes

options = importlib.import_module("spectral_unwrap.core.solve.options")
progress = importlib.import_module("spectral_unwrap.ui.progress")
read = importlib.import_module("spectral_unwrap.edit_mesh.read")
steps = importlib.import_module("spectral_unwrap.unwrapping.steps")
worker = importlib.import_module("spectral_unwrap.core.solve.worker")
native = importlib.import_module("spectral_unwrap.core.native")


def printed(capfd):
    return [line for line in capfd.readouterr().out.splitlines() if line.startswith("Spectral Unwrap: ")]


def test_large_mesh_prints_its_progress(capfd, monkeypatch):
    # The time between lines is not what is tested, and no computer should have to work for seconds.
    monkeypatch.setattr(progress, "_PRINT_SECONDS", 0.01)
    scenes.edit(scenes.grid(300, 300))
    capfd.readouterr()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    lines = printed(capfd)
    assert lines
    said = [re.fullmatch(r"Spectral Unwrap: (\d+) % \([A-Z][a-z ]+\)", line) for line in lines]
    assert all(said), [line for line, each in zip(lines, said) if not each]
    percents = [int(each[1]) for each in said]
    assert percents == sorted(set(percents))
    assert 0 < percents[0] <= percents[-1] <= 100


def test_lines_are_a_second_apart(capfd):
    with progress.blocking(bpy.context) as report:
        start = time.monotonic()
        while time.monotonic() < start + 2.5:
            report((time.monotonic() - start) / 2.5, "phase")
            time.sleep(0.001)
    assert len(printed(capfd)) == 2


def test_a_window_is_told_every_percent_once(monkeypatch):
    monkeypatch.setattr(progress, "bpy", SimpleNamespace(app=SimpleNamespace(background=False)))
    told = []
    manager = SimpleNamespace(progress_begin=lambda *_: None, progress_update=told.append, progress_end=lambda: None)
    with progress.blocking(SimpleNamespace(window_manager=manager)) as report:
        for step in range(1001):
            report(step / 1000, "phase")
    assert told == list(range(1, 101))


def test_small_mesh_prints_nothing(capfd):
    scenes.edit(scenes.grid(20, 20))
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert printed(capfd) == []


def test_invoked_in_background_mode_the_operator_is_done_when_it_returns():
    grid = scenes.grid(20, 20)
    scenes.edit(grid)
    before = scenes.read_uv(grid)
    assert bpy.ops.uv.spectral_unwrap("INVOKE_DEFAULT") == {"FINISHED"}
    assert not np.array_equal(scenes.read_uv(grid), before)


def test_unwrap_in_a_thread_gives_what_the_operator_gives(monkeypatch):
    grid = scenes.grid(20, 20)
    scenes.edit(grid)
    waiting = jobs.unwrap(monkeypatch)
    assert waiting.result == {"RUNNING_MODAL"}
    waiting.wait()
    assert waiting.result == {"FINISHED"}
    assert waiting.left_nothing()
    assert waiting.reported[0][1].startswith("Unwrapped 1 island")
    threaded = scenes.read_uv(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    np.testing.assert_array_equal(scenes.read_uv(grid), threaded)


@pytest.mark.parametrize("key", ["ESC", "RIGHTMOUSE"])
def test_cancelled_solve_changes_nothing(key, monkeypatch):
    grid = scenes.grid(100, 100)
    scenes.edit(grid)
    before, state = scenes.read_uv(grid), scenes.state(grid)
    waiting = jobs.unwrap(monkeypatch)
    solve = waiting.worker
    assert waiting.send(key) == {"CANCELLED"}
    assert waiting.reported == [("INFO", "Spectral Unwrap: Canceled")]
    assert waiting.left_nothing()
    assert solve.wait(60.0)
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    assert scenes.state(grid) == state
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}


@pytest.mark.parametrize("error", [native.NativeModuleError("not installed"), MemoryError("std::bad_alloc")])
def test_error_in_the_thread_is_reported(error, monkeypatch):
    def fail(*_arguments):
        raise error

    monkeypatch.setattr(steps, "solve_all", fail)
    grid = scenes.grid(2, 2)
    scenes.edit(grid)
    before = scenes.read_uv(grid)
    waiting = jobs.unwrap(monkeypatch)
    waiting.wait()
    assert waiting.result == {"CANCELLED"}
    ((level, text),) = waiting.reported
    assert level == "ERROR"
    assert text == "not installed" or text.startswith("Not enough memory")
    assert waiting.left_nothing()
    np.testing.assert_array_equal(scenes.read_uv(grid), before)


def _leave_edit_mode(grid):
    bpy.ops.object.mode_set(mode="OBJECT")


def _delete_object(grid):
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.data.objects.remove(grid)


def _replace_object(grid):
    _delete_object(grid)
    scenes.edit(scenes.grid(4, 4))


def _open_other_file(grid):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


def _add_face(grid):
    bpy.ops.mesh.primitive_plane_add()
    bpy.ops.mesh.select_all(action="SELECT")


def _turn_face(grid):
    scenes.select_faces(grid, [3])
    bpy.ops.mesh.flip_normals()
    bpy.ops.mesh.select_all(action="SELECT")


@pytest.mark.parametrize(
    "change",
    [_leave_edit_mode, _delete_object, _replace_object, _open_other_file, _add_face, _turn_face],
    ids=lambda change: change.__name__[1:],
)
def test_changed_meshes_are_noticed(change):
    grid = scenes.grid(4, 4)
    scenes.edit(grid)
    settings = options.Settings()
    edit_meshes = steps.read(bpy.context, settings)
    assert read.unchanged(edit_meshes)
    change(grid)
    assert not read.unchanged(edit_meshes)


def test_nothing_is_written_into_changed_meshes(monkeypatch):
    grid = scenes.grid(4, 4)
    scenes.edit(grid)
    waiting = jobs.unwrap(monkeypatch)
    _turn_face(grid)
    before = scenes.read_uv(grid)
    waiting.wait()
    assert waiting.result == {"CANCELLED"}
    assert waiting.reported[-1][0] == "WARNING"
    assert waiting.left_nothing()
    np.testing.assert_array_equal(scenes.read_uv(grid), before)


def test_operators_are_not_available_while_a_solve_runs(monkeypatch):
    scenes.edit(scenes.grid(4, 4))
    waiting = jobs.unwrap(monkeypatch)
    with monkeypatch.context() as patch:
        patch.setattr(worker.Worker, "is_wanted", True)
        assert not bpy.ops.uv.spectral_unwrap.poll()
        assert not bpy.ops.uv.spectral_suggest_seams.poll()
    waiting.send("ESC")
    assert bpy.ops.uv.spectral_unwrap.poll()
    assert bpy.ops.uv.spectral_suggest_seams.poll()
