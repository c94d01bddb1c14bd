# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: an artist makes two extenders and drags their strength while the map follows."""

import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.extender_sidebar import (
    check_map_undo_and_redo,
    drag,
    half_of,
    listed,
    make_two,
    open_grid,
    pairs,
    raise_a_hill,
)
from tests.interface.session import VERDICT, screenshot, uv, xdotool


def drag_and_confirm():
    before, start = uv(), listed()
    yield from drag(300)
    assert np.abs(uv() - before).max() > 0.005
    screenshot("extender_dragged")
    # The list shows the strength that is dragged.
    assert listed()[0] == start[0]
    assert listed()[1][1] > 2.0, listed()
    yield from drive.send("click", 1)
    after = uv()
    assert listed()[0] == start[0]
    name, strength, use = listed()[1]
    assert strength > 2.0, strength
    yield from check_map_undo_and_redo(before, after)
    assert listed() == [start[0], (name, strength, use)]


def drag_and_give_up():
    before, start = uv(), listed()
    yield from drag(-100)
    assert not np.array_equal(uv(), before)
    yield from drive.send("key", "Escape")
    np.testing.assert_array_equal(uv(), before)
    assert listed() == start


def type_a_number():
    """The operator's own panel takes the amount as a number, and the map follows."""
    start = listed()
    yield from drag(20)
    yield from drive.send("click", 1)
    before = uv()
    yield from drive.open_adjust_last_operation()
    drive.point_at_row(0)
    yield
    xdotool("click", "--repeat", 2, "--delay", 60, 1)
    yield
    xdotool("key", "ctrl+a", "type", "93.75")
    yield
    yield from drive.send("key", "Return")
    screenshot("extender_typed")
    # 93.75 / (100 - 93.75) halves.
    assert abs(listed()[1][1] - 15.0 * half_of(1)) < 0.01, listed()
    assert listed()[0] == start[0]
    assert not np.array_equal(uv(), before)


def save_and_reopen():
    before = listed(), pairs(), uv()
    path = str(VERDICT.with_name("adjusted.blend"))
    bpy.ops.wm.save_as_mainfile(filepath=path)
    yield
    bpy.ops.wm.open_mainfile(filepath=path)
    yield
    yield
    assert (listed(), pairs()) == before[:2]
    np.testing.assert_array_equal(uv(), before[2])
    screenshot("extender_reopened")


drive.run(open_grid, raise_a_hill, make_two, drag_and_confirm, drag_and_give_up, type_a_number, save_and_reopen)
