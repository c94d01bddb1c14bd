# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: extenders while the mesh is edited, undone, saved and reopened."""

import importlib

import bpy

from tests.interface import driving as drive
from tests.interface.extender_sidebar import (
    REMOVE,
    check_undo_and_redo,
    click_sidebar,
    click_vertices,
    half_of,
    listed,
    open_grid,
    pairs,
    press,
    row,
    type_amount,
)
from tests.interface.session import VERDICT, override, point_at, screenshot, uv, xdotool


def add_extenders():
    for pair, amount in (((0, 6), 70.0), ((35, 24), -80.0), ((41, 24), 80.0)):
        yield from click_vertices(*pair)
        with override("VIEW_3D"):
            assert bpy.ops.uv.spectral_shape("EXEC_DEFAULT", True, kind="EXTENDER", amount=amount) == {"FINISHED"}
    yield


def break_one():
    start = pairs()
    yield from click_vertices(41)
    yield from press("x")
    # The Delete menu's entry with this letter: Vertices.
    yield from drive.send("key", "v")
    screenshot("extenders_broken")
    assert sum(-1 in pair for pair in pairs()) == 1, pairs()
    before = listed()
    # The last one that was added is the broken one.
    yield from click_sidebar(row(2, REMOVE))
    yield from check_undo_and_redo(before, [item for item in before if item[0] != "Push/Pull.002"])
    yield from press("ctrl+z", "ctrl+z")
    assert pairs() == start, pairs()
    screenshot("extenders_whole_again")


def move_a_vertex():
    yield from click_vertices(0)
    xdotool("key", "g")
    yield
    yield from drive.send("mousemove_relative", "--", -40, 60)
    screenshot("extenders_moving")
    xdotool("key", "Escape")
    yield


def move_a_uv():
    """A running transform holds pointers to the UVs, which drawing must not move in memory."""
    before = uv()
    point_at("IMAGE_EDITOR", 0.3, 0.3)
    xdotool("key", "g")
    yield
    for _ in range(3):
        xdotool("mousemove_relative", "--", -10, 20)
        yield
    screenshot("extenders_moving_uv")
    xdotool("click", 1)
    yield
    moved = (uv() != before).any(axis=1)
    assert moved.any()
    assert not moved.all()
    yield from drive.check_undo_and_redo(before, uv())


def undo_and_redo_all():
    """Undo to the start and redo to the end, selections too."""
    end = listed()
    point_at("VIEW_3D", 0.3, 0.2)
    for key, wanted in (("ctrl+z", []), ("ctrl+shift+z", end)):
        for _ in range(40):
            xdotool("key", key)
            yield
            if listed() == wanted:
                break
        assert listed() == wanted, listed()


def leave_edit_mode_and_come_back():
    before = listed(), pairs()
    yield from press("Tab")
    assert bpy.context.mode == "OBJECT"
    yield from press("ctrl+z")
    assert (listed(), pairs()) == before
    yield from type_amount(0, "50")
    yield from check_undo_and_redo(before[0], [("Push/Pull", half_of(0), True), *before[0][1:]])
    yield from press("ctrl+z")


def save_and_reopen():
    before = listed(), pairs()
    path = str(VERDICT.with_name("extenders.blend"))
    bpy.ops.wm.save_as_mainfile(filepath=path)
    yield
    bpy.ops.wm.read_homefile(use_empty=True)
    yield
    bpy.ops.wm.open_mainfile(filepath=path)
    yield
    yield
    assert (listed(), pairs()) == before
    screenshot("extenders_reopened")
    storage = importlib.import_module("spectral_unwrap.edit_mesh.extenders")
    assert storage.vertices(bpy.context.edit_object.data) is not None, "no arrows are drawn"
    yield from type_amount(0, "50")
    yield from check_undo_and_redo(before[0], [("Push/Pull", half_of(0), True), *before[0][1:]])


drive.run(
    *(open_grid, add_extenders, break_one, move_a_vertex, move_a_uv),
    *(undo_and_redo_all, leave_edit_mode_and_come_back, save_and_reopen),
)
