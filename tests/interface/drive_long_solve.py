# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: an artist cancels a long solve, then lets one finish."""

import importlib
import threading
import time

import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.session import area_of, override, point_at, screenshot, uv, xdotool

SIZE = 200  # faces along a side
# No solve ends before: how long a large one takes, and how long Blender takes to draw its mesh without a graphics
# card, depends on the machine.
let_end = threading.Event()


def make_solves_long():
    """Let the native solve wait at each progress call until it is canceled."""
    steps_of_unwrap = importlib.import_module("spectral_unwrap.unwrapping.steps")
    solve = steps_of_unwrap.solve_all

    def solve_long(meshes, options, progress, kept):
        def wait(fraction, phase):
            while progress(fraction, phase) and not let_end.is_set():
                time.sleep(0.01)
            return progress(fraction, phase)

        return solve(meshes, options, wait, kept)

    steps_of_unwrap.solve_all = solve_long


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
        bpy.ops.view3d.view_selected()
        bpy.ops.mesh.select_mode(type="FACE")
        bpy.ops.ed.undo_push(message="Landscape")
    yield


def solving():
    """Return whether a solve runs, wanted or not."""
    return any(thread.name == "spectral_unwrap" for thread in threading.enumerate())


def unwrap_by_mouse():
    """Click Spectral Unwrap in the viewport's UV menu, and wait until its solve runs."""
    drive.point_at_header("VIEW_3D", drive.UV_MENU)
    xdotool("click", 1)
    yield
    yield from drive.click_below(drive.LAYOUT.header_to_unwrap)
    yield from drive.until(solving)
    point_at("VIEW_3D")
    yield


def view():
    return area_of("VIEW_3D").spaces.active.region_3d.view_distance


def steps():
    jobs = importlib.import_module("spectral_unwrap.operators.job_operator")
    history = bpy.context.window_manager.operators
    yield from open_landscape()
    make_solves_long()
    before, done = uv(), list(history)

    yield from unwrap_by_mouse()
    assert jobs.running() is not None
    assert not bpy.ops.uv.spectral_unwrap.poll()
    # Keys do nothing, the wheel moves the view.
    view_before = view()
    xdotool("key", "x", "key", "Tab", "key", "a", "click", 4)
    yield from drive.until(lambda: view() != view_before)
    screenshot("solving")
    assert bpy.context.mode == "EDIT_MESH"
    assert jobs.running() is not None
    xdotool("key", "Escape")
    yield
    assert jobs.running() is None
    yield from drive.until(lambda: not solving())
    yield
    screenshot("cancelled")
    np.testing.assert_array_equal(uv(), before)
    assert list(history) == done

    yield from unwrap_by_mouse()
    let_end.set()
    yield from drive.until(lambda: jobs.running() is None)
    yield
    after = uv()
    assert drive.last_operator()
    assert len(history) == len(done) + 1
    assert np.isfinite(after).all()
    assert not np.array_equal(after, before)
    yield from drive.show_uvs()
    screenshot("solved")
    yield from drive.check_undo_and_redo(before, after)


drive.run(steps)
