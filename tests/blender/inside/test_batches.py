# SPDX-License-Identifier: GPL-3.0-or-later
"""Many objects at once: each is solved as if alone, and Blender evaluates each once."""

from collections import Counter

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


@pytest.fixture
def updates():
    """Count how often each mesh was updated, by name, from now on."""
    counted = Counter()

    def count(_scene, depsgraph):
        blocks = [update.id.original for update in depsgraph.updates if update.is_updated_geometry]
        counted.update({block.name for block in blocks if isinstance(block, bpy.types.Mesh)})

    bpy.context.view_layer.update()
    bpy.app.handlers.depsgraph_update_post.append(count)
    yield counted
    bpy.app.handlers.depsgraph_update_post.remove(count)


@pytest.mark.parametrize("keep_in_place", [False, True])
@pytest.mark.parametrize("uv_map", [True, False])
def test_blender_is_told_of_every_mesh_once(updates, keep_in_place, uv_map):
    edited = [scenes.bumpy_grid(3 + k, 3, name=f"Grid {k}", uv_map=uv_map) for k in range(4)]
    scenes.edit(*edited)
    if uv_map:
        # Pinned as a whole, it is written but not packed.
        scenes.pin(edited[1], np.arange(8))
    bpy.context.view_layer.update()
    updates.clear()
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=keep_in_place) == {"FINISHED"}
    bpy.context.view_layer.update()
    assert set(updates) == {item.data.name for item in edited}
    if uv_map:
        # The packer tells of those once more that it has not packed.
        assert [updates[edited[k].data.name] for k in (0, 2, 3)] == [1, 1, 1]
