# SPDX-License-Identifier: GPL-3.0-or-later
"""Long solves in background mode: printed progress, cancelling, and errors from the thread that solves."""

import importlib
import re
import time

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes

edit_mode_unwrap = importlib.import_module("spectral_unwrap.edit_mode_unwrap")
progress = importlib.import_module("spectral_unwrap.progress")
solving = importlib.import_module("spectral_unwrap.solving")
unwrapping = importlib.import_module("spectral_unwrap.core.unwrapping")
native = importlib.import_module("spectral_unwrap.core.native")


def started():
    """Start to unwrap in a thread what is in edit mode."""
    settings = edit_mode_unwrap.Settings(unwrapping.Options())
    return solving.UnwrapInThread(settings, edit_mode_unwrap.read(bpy.context, settings))


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
    percents = [int(re.fullmatch(r"Spectral Unwrap: (\d+) % \([a-z ]+\)", line)[1]) for line in lines]
    assert percents == sorted(set(percents))
    assert 0 < percents[0] <= percents[-1] <= 100


def test_lines_are_a_second_apart(capfd):
    with progress.blocking(bpy.context) as report:
        start = time.monotonic()
        while time.monotonic() < start + 2.5:
            report((time.monotonic() - start) / 2.5, "phase")
            time.sleep(0.001)
    assert len(printed(capfd)) == 2


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


def test_unwrap_in_a_thread_gives_what_the_operator_gives():
    grid = scenes.grid(20, 20)
    scenes.edit(grid)
    running = started()
    assert running.worker.wait(60.0)
    assert running.is_current(bpy.context)
    assert running.write(bpy.context).summary.solved == 1
    threaded = scenes.read_uv(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    np.testing.assert_array_equal(scenes.read_uv(grid), threaded)


def test_cancelled_solve_changes_nothing():
    grid = scenes.grid(100, 100)
    scenes.edit(grid)
    before, state = scenes.read_uv(grid), scenes.state(grid)
    running = started()
    running.worker.cancel()
    assert running.worker.wait(60.0)
    with pytest.raises(native.spectral_conformal().Cancelled):
        running.write(bpy.context)
    np.testing.assert_array_equal(scenes.read_uv(grid), before)
    assert scenes.state(grid) == state
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}


def test_error_in_the_thread_is_raised_on_writing(monkeypatch):
    def fail(*_arguments):
        raise native.NativeModuleError("not installed")

    monkeypatch.setattr(edit_mode_unwrap, "solve", fail)
    grid = scenes.grid(2, 2)
    scenes.edit(grid)
    before = scenes.read_uv(grid)
    running = started()
    assert running.worker.wait(60.0)
    with pytest.raises(native.NativeModuleError, match="not installed"):
        running.write(bpy.context)
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


def _deselect(grid):
    scenes.select_faces(grid, [3])


def _turn_face(grid):
    scenes.select_faces(grid, [3])
    bpy.ops.mesh.flip_normals()
    bpy.ops.mesh.select_all(action="SELECT")


@pytest.mark.parametrize(
    "change",
    [_leave_edit_mode, _delete_object, _replace_object, _open_other_file, _add_face, _deselect, _turn_face],
    ids=lambda change: change.__name__[1:],
)
def test_changed_meshes_are_noticed(change):
    grid = scenes.grid(4, 4)
    scenes.edit(grid)
    running = started()
    assert running.worker.wait(60.0)
    assert running.is_current(bpy.context)
    change(grid)
    assert not running.is_current(bpy.context)


def test_operator_is_not_available_while_a_solve_runs(monkeypatch):
    scenes.edit(scenes.grid(4, 4))
    operator = importlib.import_module("spectral_unwrap.operators.unwrap").UV_OT_spectral_unwrap
    running = started()
    monkeypatch.setattr(operator, "_running", running)
    monkeypatch.setattr(type(running.worker), "is_wanted", True)
    assert not bpy.ops.uv.spectral_unwrap.poll()
    monkeypatch.undo()
    assert bpy.ops.uv.spectral_unwrap.poll()
