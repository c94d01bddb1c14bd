# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with windows: whatever ends a long solve, Blender goes on as if there had been none."""

import sys
import threading
import time

import addon_utils
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.session import area_of, override, point_at, screenshot, uv, xdotool


def solve_until_cancelled(_meshes, _options, progress, _kept):
    """A stand-in for a solve that takes longer than anybody waits."""
    while progress(0.5, "solving"):
        time.sleep(0.05)


def open_cube():
    """Put a cube into edit mode."""
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_cube_add()
        bpy.ops.object.mode_set(mode="EDIT")
    point_at("VIEW_3D")
    yield


def solving():
    return any(thread.name == "spectral_unwrap" for thread in threading.enumerate())


def running():
    return sys.modules["spectral_unwrap.operators.job_operator"].running()


def start(window=None):
    """Begin a long solve in a window."""
    sys.modules["spectral_unwrap.unwrapping.steps"].solve_all = solve_until_cancelled
    window = window or drive.window()
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        assert bpy.ops.uv.spectral_unwrap("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield
    assert running() is not None
    assert solving()


def check_blender_goes_on(name):
    """Blender takes keys again, which a job would have kept, and shows no trace of the job."""
    yield from drive.until(lambda: not solving())
    screenshot(name)
    mode = bpy.context.mode
    point_at("VIEW_3D")
    yield from drive.send("key", "Tab")
    assert bpy.context.mode != mode
    yield from drive.send("key", "Tab")
    assert bpy.context.mode == mode


def disabled():
    before = uv()
    yield from start()
    addon_utils.disable("spectral_unwrap")
    yield from check_blender_goes_on("jobs_disabled")
    np.testing.assert_array_equal(uv(), before)
    assert addon_utils.enable("spectral_unwrap", default_set=True)
    yield


def window_closed():
    with override("VIEW_3D"):
        bpy.ops.wm.window_new()
    yield
    other = bpy.context.window_manager.windows[-1]
    other.screen.areas[0].type = "VIEW_3D"
    yield
    yield from start(other)
    job = running()
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
    yield from start()
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


drive.run(open_cube, disabled, window_closed, file_loaded)
