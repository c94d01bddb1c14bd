# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders and the live toggle in linked and overridden data: these never change, and nothing else fails."""

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


@pytest.fixture
def library(tmp_path):
    """The path of a file with a grid that has a map, a pin and an extender, and a scene with live unwrapping on."""
    grid = scenes.bumpy_grid(name="Linked")
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    bpy.ops.mesh.select_all(action="DESELECT")
    scenes.select_vertices(grid, (0, 20))
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER") == {"FINISHED"}
    grid.data.spectral_shapes[0].strength = 3.0
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.scene.spectral_unwrap_live = True
    bpy.context.scene.name = "Linked scene"
    path = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    return path


def link(path):
    """Link the object and the scene of the library into the file, and return the object."""
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.objects, wanted.scenes = ["Linked"], ["Linked scene"]
    bpy.context.collection.objects.link(wanted.objects[0])
    return wanted.objects[0]


def contents(linked):
    mesh = linked.data
    uv = np.empty(2 * len(mesh.loops), dtype=np.float32)
    mesh.uv_layers.active.data.foreach_get("uv", uv)
    listed = [(e.name, e.strength, e.use, e.layer) for e in mesh.spectral_shapes]
    return uv.tolist(), listed, [attribute.name for attribute in mesh.attributes]


def call_handlers():
    for event in ("undo_pre", "undo_post", "redo_pre", "redo_post"):
        for handler in getattr(bpy.app.handlers, event):
            handler(bpy.context.scene, None)
    bpy.context.view_layer.update()


@pytest.mark.parametrize("override", [False, True], ids=["linked", "overridden"])
def test_linked_data_stay_as_they_are_beside_meshes_that_are_edited(library, override, capfd):
    linked = link(library)
    if override:
        linked = linked.override_create(remap_local_usages=True)
        assert linked.override_library
    before = contents(linked)
    assert before[1][0][1] == 3.0
    grid = scenes.bumpy_grid(name="Local")
    bpy.context.scene.spectral_unwrap_live = True
    scenes.edit(grid)
    call_handlers()
    capfd.readouterr()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    bpy.ops.mesh.select_all(action="DESELECT")
    scenes.select_vertices(grid, (0, 20))
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER") == {"FINISHED"}
    assert bpy.ops.uv.spectral_extender(amount=60.0) == {"FINISHED"}
    call_handlers()
    assert contents(linked) == before
    assert "could not" not in capfd.readouterr().out
