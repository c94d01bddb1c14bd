# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with windows: whatever ends a long solve, Blender goes on as if there had been none.

blender --factory-startup --python drive_jobs.py -- <folder for the screenshots> <file for the verdict>
"""

import sys
import threading
from pathlib import Path

import addon_utils
import bpy
import numpy as np

sys.path.append(str(Path(__file__).resolve().parent))

import driving as drive  # noqa: E402 - found only now
from session import area_of, override, point_at, screenshot, uv, xdotool  # noqa: E402

SIZE = 300  # faces along a side; its solve takes longer than an operator waits before it lets Blender go on


def open_landscape():
    """Put a grid with hills into edit mode."""
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=SIZE, y_subdivisions=SIZE)
        mesh = bpy.context.object.data
        points = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.vertices.foreach_get("co", points)
        x, y, _ = points.reshape(-1, 3).T
        points[2::3] = 0.15 * np.sin(7.0 * x) * np.cos(5.0 * y) + 0.02 * np.sin(31.0 * x + 23.0 * y)
        mesh.vertices.foreach_set("co", points)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_mode(type="FACE")
    point_at("VIEW_3D")
    yield


def solving():
    return any(thread.name == "spectral_unwrap" for thread in threading.enumerate())


def running():
    return sys.modules["spectral_unwrap.operators.job_operator"].JobOperator._running


def start(window=None):
    """Begin a long solve in a window."""
    window = window or drive.window()
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        assert bpy.ops.uv.spectral_unwrap("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    assert running() is not None
    assert solving()


def check_blender_goes_on(name):
    """Blender takes keys again, which a job would have kept for itself, and shows nothing of one."""
    yield from drive.until(lambda: not solving())
    screenshot(name)
    mode = bpy.context.mode
    point_at("VIEW_3D")
    xdotool("key", "Tab")
    yield
    yield
    assert bpy.context.mode != mode
    xdotool("key", "Tab")
    yield
    yield
    assert bpy.context.mode == mode


def without_a_window():
    """Invoke the operator as scripts and timers do, without a window: it is done when it returns."""
    before = uv()
    with bpy.context.temp_override(window=None):
        assert bpy.ops.uv.spectral_unwrap("INVOKE_DEFAULT") == {"FINISHED"}
    assert not solving()
    assert running() is None
    assert not np.array_equal(uv(), before)
    yield from check_blender_goes_on("jobs_no_window")


def disabled():
    before = uv()
    start()
    yield
    addon_utils.disable("spectral_unwrap")
    yield from check_blender_goes_on("jobs_disabled")
    np.testing.assert_array_equal(uv(), before)
    assert addon_utils.enable("spectral_unwrap", default_set=True)
    yield


def scripts_reloaded():
    start()
    yield
    job = running()
    with override("VIEW_3D"):
        bpy.ops.script.reload()
    yield from drive.until(lambda: job.is_ended)
    yield
    assert running() is None
    yield from check_blender_goes_on("jobs_reloaded")


def window_closed():
    with override("VIEW_3D"):
        bpy.ops.wm.window_new()
    yield
    other = bpy.context.window_manager.windows[-1]
    other.screen.areas[0].type = "VIEW_3D"
    yield
    start(other)
    job = running()
    yield
    with bpy.context.temp_override(window=other):
        bpy.ops.wm.window_close()
    yield
    yield
    assert job.is_ended
    assert running() is None
    xdotool("search", "--onlyvisible", "--class", "blender", "windowfocus")
    yield
    yield from check_blender_goes_on("jobs_window_closed")


def file_loaded():
    start()
    yield
    job = running()
    with override("VIEW_3D"):
        bpy.ops.wm.read_homefile(use_factory_startup=False)
    yield
    yield
    assert job.is_ended
    assert running() is None
    yield from drive.until(lambda: not solving())
    assert area_of("VIEW_3D")
    yield from check_blender_goes_on("jobs_file_loaded")


def steps():
    yield from drive.open_uv_editing()
    yield from open_landscape()
    yield from without_a_window()
    yield from disabled()
    yield from scripts_reloaded()
    yield from window_closed()
    yield from file_loaded()


drive.run(steps())
