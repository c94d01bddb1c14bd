# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: an artist adds extenders in the sidebar and changes them."""

import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.extender_sidebar import (
    ADD,
    ICON,
    NAME,
    REMOVE,
    USE,
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
from tests.interface.session import override, picture, screenshot, xdotool

REPEL = (1.0, 0.42, 0.12)


def add_by_clicking():
    yield from click_vertices(6, 0)
    yield from click_sidebar(ADD)
    assert pairs() == [(6, 0)]
    one = [("Push/Pull", half_of(0), True)]
    yield from check_undo_and_redo([], one)

    yield from click_vertices(35, 41, 24)
    yield from click_sidebar(ADD)
    screenshot("extenders_added")
    three = [*one, ("Push/Pull.001", half_of(1), True), ("Push/Pull.002", half_of(2), True)]
    assert sorted(pairs()) == [(6, 0), (35, 24), (41, 24)]
    yield from check_undo_and_redo(one, three)


def adjust_last_operation():
    """The operator's own panel undoes the step and repeats it with other settings."""
    before = listed()
    yield from click_vertices(3, 38)
    yield from click_sidebar(ADD)
    # The operator's panel appears.
    yield
    yield from drive.open_adjust_last_operation()
    drive.point_at_row(0)
    yield
    xdotool("click", "--repeat", 2, "--delay", 60, 1)
    yield
    xdotool("key", "ctrl+a", "type", "--", "-50")
    yield
    yield from drive.send("key", "Return")
    screenshot("extenders_adjusted")
    after = [*before, ("Push/Pull.003", -half_of(-1), True)]
    assert listed() == after, listed()
    yield from check_undo_and_redo(before, after)
    yield from press("ctrl+z")


def change_in_the_list():
    start = listed()
    yield from type_amount(0, "75")
    changed = [("Push/Pull", half_of(0, 3.0), True), *start[1:]]
    yield from check_undo_and_redo(start, changed)
    yield from click_sidebar(row(1, USE))
    off = [changed[0], ("Push/Pull.001", half_of(1), False), changed[2]]
    screenshot("extenders_one_off")
    yield from check_undo_and_redo(changed, off)

    yield from click_sidebar(row(0, NAME), times=2)
    xdotool("key", "ctrl+a", "type", "Brim")
    yield from drive.send("key", "Return")
    named = [("Brim", half_of(0, 3.0), True), *off[1:]]
    yield from check_undo_and_redo(off, named)

    yield from click_sidebar(row(0, ICON))
    assert bpy.context.edit_object.data.spectral_shapes_active == 0
    yield from click_sidebar(row(0, REMOVE))
    yield from check_undo_and_redo(named, named[1:])
    yield from press("ctrl+z")
    assert listed() == named, listed()


def pixels_of_arrows(name):
    """Count the pixels of both editors that have the color of an extender that repels."""
    pixels, counts = picture(name), []
    for kind in ("VIEW_3D", "IMAGE_EDITOR"):
        region = drive.region_of(kind)
        shown = pixels[region.y : region.y + region.height, region.x : region.x + region.width]
        counts.append((np.abs(shown - REPEL).max(axis=-1) < 0.06).sum())
    return np.array(counts)


def remove_all():
    """The arrows of removed extenders go at once, with the mouse still over the sidebar; those of others stay."""
    counts = []
    with override("VIEW_3D"):
        bpy.ops.mesh.select_all("EXEC_DEFAULT", True, action="DESELECT")
    bpy.context.edit_object.data.spectral_shapes[1].use = True
    while True:
        yield
        yield
        counts.append(pixels_of_arrows(f"extenders_left_{len(listed())}"))
        if not listed():
            break
        yield from click_sidebar(row(0, REMOVE))
    assert (counts[-1] < 20).all(), counts
    assert all((after < before - 50).all() for before, after in zip(counts, counts[1:])), counts


drive.run(open_grid, add_by_clicking, adjust_last_operation, change_in_the_list, remove_all)
