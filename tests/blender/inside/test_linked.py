# SPDX-License-Identifier: GPL-3.0-or-later
"""Linked and overridden data: they never change, and only Blender's own messages are reported."""

import contextlib

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes

OPERATORS = ("spectral_unwrap", "spectral_suggest_seams", "spectral_select")


@pytest.fixture
def library(tmp_path):
    """A file with an object; returns its path."""
    path = str(tmp_path / "library.blend")
    scenes.cylinder(name="Linked")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True, load_ui=False)
    return path


def link(path):
    with bpy.data.libraries.load(path, link=True) as (_, found):
        found.objects = ["Linked"]
    linked = bpy.data.objects["Linked"]
    bpy.context.collection.objects.link(linked)
    return linked


def overridden(path):
    return link(path).override_create(remap_local_usages=True)


def with_linked_mesh(path):
    made = bpy.data.objects.new("Local", link(path).data)
    bpy.context.collection.objects.link(made)
    return made


# Meshes themselves cannot be overridden.
MAKE = [link, overridden, with_linked_mesh]


def map_of(linked):
    uv = np.empty(2 * len(linked.data.loops), dtype=np.float32)
    linked.data.uv_layers.active.data.foreach_get("uv", uv)
    return uv, [edge.use_seam for edge in linked.data.edges]


@pytest.mark.parametrize("make", MAKE, ids=lambda make: make.__name__)
def test_what_is_not_of_this_file_is_left_alone(make, library):
    linked, grid = make(library), scenes.bumpy_grid()
    before = map_of(linked)
    linked.select_set(True)
    scenes.edit(grid, linked)
    # Blender takes nothing linked into edit mode.
    assert [item.name for item in bpy.context.objects_in_mode] == [grid.name]
    former = scenes.read_uv(grid)
    for operator in OPERATORS:
        getattr(bpy.ops.uv, operator)()
    for kind in ("FAILED", "DEFECTS"):
        bpy.ops.uv.spectral_select(kind=kind)
    assert not np.array_equal(scenes.read_uv(grid), former)
    bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_array_equal(map_of(linked)[0], before[0])
    assert map_of(linked)[1] == before[1]


@pytest.mark.parametrize("make", MAKE, ids=lambda make: make.__name__)
def test_operators_are_not_available_where_blender_does_not_edit(make, library):
    linked = make(library)
    linked.select_set(True)
    bpy.context.view_layer.objects.active = linked
    with contextlib.suppress(RuntimeError, TypeError):
        bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.context.mode == "OBJECT"
    for operator in (*OPERATORS, "spectral_shape", "spectral_extender", "spectral_shape_remove"):
        assert not getattr(bpy.ops.uv, operator).poll()


@pytest.mark.parametrize("make", MAKE, ids=lambda make: make.__name__)
def test_operators_of_object_mode_say_what_is_linked(make, library, reports):
    linked = make(library)
    linked.select_set(True)
    bpy.context.view_layer.objects.active = linked
    before = map_of(linked)[0]
    for operator in (bpy.ops.uv.spectral_new_textures, bpy.ops.mesh.spectral_store_distortion):
        assert operator() == {"CANCELLED"}
        said = "The selected meshes belong to linked files, and cannot be changed; make them local first"
        assert reports() == [("Warning", said)]
    np.testing.assert_array_equal(map_of(linked)[0], before)
