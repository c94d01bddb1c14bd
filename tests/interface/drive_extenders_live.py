# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: extenders followed live, and the add-on disabled in the middle of a drag."""

import sys

import addon_utils
import bpy
import numpy as np

from tests.interface import driving as drive
from tests.interface.extender_sidebar import (
    ADD,
    check_map_undo_and_redo,
    click_sidebar,
    click_vertices,
    drag,
    listed,
    make_two,
    open_grid,
    press,
    raise_a_hill,
    type_amount,
)
from tests.interface.session import screenshot, uv


def add_and_type_live():
    """With live unwrapping on, the map follows extenders that are added or changed in the list, and undo knows it."""
    bpy.context.scene.spectral_unwrap_live = True
    before, start = uv(), listed()
    yield from click_vertices(3, 38)
    yield from click_sidebar(ADD)
    yield
    added = uv()
    assert len(listed()) == len(start) + 1
    assert np.abs(added - before).max() > 1e-4, "the map does not follow the extender"
    screenshot("extender_added_live")
    yield from check_map_undo_and_redo(before, added)
    yield from type_amount(len(start), "9")
    for _ in range(3):
        yield
    typed = uv()
    assert np.abs(typed - added).max() > 1e-4, "the map does not follow the strength"
    screenshot("extender_typed_live")
    # The amount and its map are one step.
    yield from press("ctrl+z")
    yield
    np.testing.assert_array_equal(uv(), added)
    yield from press("ctrl+shift+z")
    yield
    np.testing.assert_array_equal(uv(), typed)
    yield from press("ctrl+z")
    yield
    np.testing.assert_array_equal(uv(), added)
    yield from press("ctrl+z")
    yield
    np.testing.assert_array_equal(uv(), before)
    assert listed() == start
    bpy.context.scene.spectral_unwrap_live = False


def drag_and_disable():
    """Disable the add-on in the middle of a drag, as a script may, and enable it again; the mouse stays in the drag."""
    before, start = uv(), listed()
    yield from drag(200)
    assert not np.array_equal(uv(), before)
    addon_utils.disable("spectral_unwrap")
    np.testing.assert_array_equal(uv(), before)
    yield
    yield
    screenshot("extender_disabled")
    addon_utils.enable("spectral_unwrap", default_set=True)
    yield
    yield
    assert listed() == start
    np.testing.assert_array_equal(uv(), before)
    # Without another update of the mesh, the arrows are there again.
    storage = sys.modules["spectral_unwrap.edit_mesh.extenders"]
    assert storage.vertices(bpy.context.edit_object.data) is not None
    screenshot("extender_enabled_again")


drive.run(open_grid, raise_a_hill, make_two, add_and_type_live, drag_and_disable)
