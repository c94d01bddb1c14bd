# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: an artist lets a map relax, restores it by Esc and keeps it by Enter or a click.

Packing goes on in the same way.
"""

import importlib
import time

import bmesh
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.extender_sidebar import SHOW_MAP, click_sidebar, open_sidebar
from tests.interface.session import area_of, override, point_at, screenshot, uv, xdotool

SIZE = 24  # faces along a side
# Steps that relaxations may take; the rest wait, because they would end before a key is pressed.
allowed = [0]


def let_steps_wait():
    relax = importlib.import_module("spectral_unwrap.operators.relax")

    class Waiting(relax.Relaxing):
        def step(self, n, progress):
            while self._steps >= allowed[0] and progress(0.0, ""):
                time.sleep(0.01)
            return super().step(n, progress)

    relax.Relaxing = Waiting


def let_all_but_one_step_of_packing_wait():
    pack = importlib.import_module("spectral_unwrap.operators.pack")

    class Waiting(pack.MapPacking):
        def step(self, n, progress):
            while self.now().steps and progress(0.0, ""):
                time.sleep(0.01)
            return super().step(n, progress) or progress(0.0, "")

    pack.MapPacking = Waiting


def open_hill():
    """Put a hill into edit mode whose map is its view from above."""
    with override("VIEW_3D"):
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=SIZE, y_subdivisions=SIZE)
        bpy.ops.object.mode_set(mode="EDIT")
        mesh = bpy.context.edit_object.data
        bm = bmesh.from_edit_mesh(mesh)
        layer = bm.loops.layers.uv.active
        for vertex in bm.verts:
            x, y, _ = vertex.co
            for loop in vertex.link_loops:
                loop[layer].uv = (0.5 + 0.3 * x, 0.5 + 0.3 * y)
            vertex.co.z = 1.2 * np.exp(-6.0 * ((x - 0.2) ** 2 + (y + 0.1) ** 2))
        bmesh.update_edit_mesh(mesh)
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="Hill")
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    settings = bpy.context.window_manager.spectral_map_overlay
    settings.show = True
    yield from drive.show_uvs()


def choice():
    running = importlib.import_module("spectral_unwrap.operators.job_operator").running()
    return running and running.choice


def relax(steps):
    """Start it from the viewport, and wait until this many steps are drawn."""
    allowed[0] = steps
    point_at("VIEW_3D", 0.4, 0.4)
    with override("VIEW_3D"):
        assert bpy.ops.uv.spectral_relax("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield from drive.until(lambda: choice() and choice().answer and choice().answer.steps == steps)


def view():
    return area_of("VIEW_3D").spaces.active.region_3d.view_distance


def steps():
    history = bpy.context.window_manager.operators
    yield from open_hill()
    let_steps_wait()
    before, done = uv(), len(history)

    # Keys do nothing and the wheel moves the view, as the map goes on; Esc brings back every bit.
    yield from relax(2)
    assert not np.array_equal(uv(), before)
    distance = view()
    xdotool("key", "x", "key", "Tab", "key", "a", "click", 4)
    yield from drive.until(lambda: view() != distance)
    assert bpy.context.mode == "EDIT_MESH"
    screenshot("relaxing")
    xdotool("key", "Escape")
    yield from drive.until(lambda: choice() is None)
    yield
    np.testing.assert_array_equal(uv(), before)
    assert len(history) == done
    screenshot("relax_restored")

    # Enter keeps what is drawn, as one step to undo, and as often as it was repeated.
    yield from relax(3)
    xdotool("key", "Return")
    yield from drive.until(lambda: choice() is None)
    yield
    kept = uv()
    assert not np.array_equal(kept, before)
    assert (history[-1].bl_idname, history[-1].steps) == ("UV_OT_spectral_relax", 3)
    screenshot("relax_kept")
    yield from drive.check_undo_and_redo(before, kept)
    yield from drive.send("key", "ctrl+z")
    with override("VIEW_3D"):
        assert bpy.ops.uv.spectral_relax("EXEC_DEFAULT", True, steps=3) == {"FINISHED"}
    np.testing.assert_array_equal(uv(), kept)

    # The panel works meanwhile.
    yield from open_sidebar()
    yield from relax(2)
    yield from click_panel("relax_panel")
    xdotool("key", "Escape")
    yield from drive.until(lambda: choice() is None)
    yield
    np.testing.assert_array_equal(uv(), kept)

    # A click keeps it, too; and without either it ends by itself.
    yield from relax(1)
    xdotool("click", 1)
    yield from drive.until(lambda: choice() is None)
    allowed[0] = 1000
    with override("VIEW_3D"):
        assert bpy.ops.uv.spectral_relax("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield from drive.until(lambda: choice() is None)
    yield
    screenshot("relaxed")
    assert history[-1].steps == 200
    assert choice() is None
    let_all_but_one_step_of_packing_wait()
    yield from pack(history)


def click_panel(name):
    """Click a switch of the sidebar while maps get better, which works it and ends nothing."""
    settings = bpy.context.window_manager.spectral_map_overlay
    shown = settings.show
    yield from click_sidebar(SHOW_MAP)
    screenshot(name)
    assert settings.show != shown, "the click is swallowed"
    assert choice(), "the click ends the view"
    yield from click_sidebar(SHOW_MAP)
    assert settings.show == shown
    point_at("VIEW_3D", 0.4, 0.4)
    yield


def start_packing(seconds):
    with override("VIEW_3D"):
        assert bpy.ops.uv.spectral_pack("INVOKE_DEFAULT", True, seconds=seconds) == {"RUNNING_MODAL"}
    yield from drive.until(lambda: choice() and choice().answer)


def pack(history):
    """Pack the four quarters of the hill."""
    with override("VIEW_3D"):
        bm = bmesh.from_edit_mesh(bpy.context.edit_object.data)
        for edge in bm.edges:
            edge.seam = any(all(abs(v.co[axis]) < 1e-6 for v in edge.verts) for axis in (0, 1))
        assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
        bpy.ops.ed.undo_push(message="Quarters")
    before, done = uv(), len(history)
    yield from start_packing(600.0)
    assert not np.array_equal(uv(), before)
    yield
    screenshot("packing")
    yield from click_panel("pack_panel")
    xdotool("key", "Escape")
    yield from drive.until(lambda: choice() is None)
    yield
    np.testing.assert_array_equal(uv(), before)
    assert len(history) == done

    # What the panel does to the map stays.
    yield from start_packing(600.0)
    with override("VIEW_3D"):
        assert bpy.ops.mesh.select_all(action="SELECT") == {"FINISHED"}
        assert bpy.ops.uv.spectral_unwrap("EXEC_DEFAULT", keep_in_place=True) == {"FINISHED"}
    changed = uv()
    xdotool("key", "Escape")
    yield from drive.until(lambda: choice() is None)
    yield
    np.testing.assert_array_equal(uv(), changed)
    with override("VIEW_3D"):
        bpy.ops.ed.undo_push(message="Changed")
    before, done = uv(), len(history)

    # Kept, undone and repeated with as many steps.
    yield from start_packing(600.0)
    xdotool("key", "Return")
    yield from drive.until(lambda: choice() is None)
    yield
    kept, steps_done = uv(), history[-1].steps
    assert history[-1].bl_idname == "UV_OT_spectral_pack"
    yield from drive.check_undo_and_redo(before, kept)
    yield from drive.send("key", "ctrl+z")
    with override("VIEW_3D"):
        assert bpy.ops.uv.spectral_pack("EXEC_DEFAULT", True, steps=steps_done) == {"FINISHED"}
    np.testing.assert_array_equal(uv(), kept)
    # Blender draws the map before the second step.
    yield
    yield
    screenshot("packed")


drive.run(steps)
