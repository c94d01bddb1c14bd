# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading a mesh gives its content, at a cost that does not grow with the file."""

import gc
import importlib
import sys
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes

compatibility = importlib.import_module("spectral_unwrap.compatibility")
read = importlib.import_module("spectral_unwrap.edit_mesh.read")
subsurf = importlib.import_module("spectral_unwrap.edit_mesh.subsurf")


def test_reading_makes_nothing_in_the_file(monkeypatch):
    grid = scenes.grid(3, 2)
    scenes.edit(grid)
    monkeypatch.setattr(compatibility, "bpy", SimpleNamespace(data=SimpleNamespace(temp_data=bpy.data.temp_data)))
    monkeypatch.setattr(read, "bpy", SimpleNamespace(types=bpy.types))
    polygons = read.read_mesh(grid).polygons
    assert (len(polygons.selected_faces), len(polygons.uv)) == (6, 24)


def test_reading_leaves_the_graph_of_objects_alone():
    grid = scenes.grid(3, 2)
    scenes.edit(grid)
    bpy.context.view_layer.update()
    updates = []

    def on_update(_scene, graph):
        updates.extend(update.id.name for update in graph.updates)

    bpy.app.handlers.depsgraph_update_post.append(on_update)
    try:
        read.read_mesh(grid)
        bpy.context.view_layer.update()
        assert not updates
        # What it would be like.
        bpy.data.meshes.remove(bpy.data.meshes.new("Mesh"))
        bpy.context.view_layer.update()
        assert updates
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(on_update)


def test_data_of_no_file_is_freed_once():
    before = {mesh.name for mesh in bpy.data.meshes}
    held = []
    for _ in range(20):
        with compatibility.data_of_no_file() as data:
            held.append((data, data.meshes.new("Mesh")))
            # Within each other, too, and while Python looks for what nobody refers to.
            with compatibility.data_of_no_file() as inner:
                inner.meshes.new("Mesh")
            gc.collect()
            assert [mesh.name for mesh in data.meshes] == ["Mesh"]
    assert {mesh.name for mesh in bpy.data.meshes} == before
    for data, mesh in held:
        assert sys.getrefcount(data) == 3  # `held`, `data` and the argument
        with pytest.raises(ReferenceError):
            _ = mesh.vertices
    # What is let go of while other data is there is not the other's.
    with compatibility.data_of_no_file() as data:
        held.clear()
        gc.collect()
        data.meshes.new("Mesh")


def test_the_mesh_to_subdivide_goes_without_a_search_of_the_file(monkeypatch):
    cylinder = scenes.cylinder()
    cylinder.modifiers.new("Subdivision", "SUBSURF").levels = 1
    scenes.edit(cylinder)
    meshes, removals = bpy.data.meshes, []

    def remove(mesh, **options):
        # Nothing refers to it.
        assert mesh.users == 0
        removals.append(options)
        meshes.remove(mesh, **options)

    data = bpy.data
    spied = SimpleNamespace(
        meshes=SimpleNamespace(new=meshes.new, remove=remove), scenes=data.scenes, objects=data.objects
    )
    monkeypatch.setattr(subsurf, "bpy", SimpleNamespace(data=spied, types=bpy.types))
    before = {mesh.name for mesh in meshes}
    assert read.read_meshes([cylinder], read.Reading(use_subsurf=True))[0].subdivision is not None
    # By default Blender looks through the whole file for references, and redraws all windows.
    assert [options["do_unlink"] for options in removals] == [False]
    assert {mesh.name for mesh in meshes} == before


def element_by_element(mesh, elements, name, dtype):
    return np.array([getattr(element, name) for element in getattr(mesh, elements)], dtype=dtype)


@pytest.mark.parametrize("is_marked", [False, True])
def test_arrays_are_those_that_the_elements_tell(is_marked):
    mesh = scenes.grid(3, 2).data
    for face in mesh.polygons:
        face.select = is_marked and face.index != 2
    for index in (1, 5):
        mesh.edges[index].use_seam = is_marked
    mesh.polygons[4].hide = is_marked
    for elements, name in (("edges", "use_seam"), ("polygons", "select"), ("polygons", "hide")):
        flags = compatibility.flags(mesh, elements, name)
        assert flags.any() == is_marked
        np.testing.assert_array_equal(flags, element_by_element(mesh, elements, name, bool))
    np.testing.assert_array_equal(
        compatibility.positions(mesh), element_by_element(mesh, "vertices", "co", np.float32), strict=True
    )
    np.testing.assert_array_equal(
        compatibility.edge_vertices(mesh), element_by_element(mesh, "edges", "vertices", np.int32), strict=True
    )
    np.testing.assert_array_equal(
        compatibility.corner_vertices(mesh), element_by_element(mesh, "loops", "vertex_index", np.int32), strict=True
    )
    uv = [point.uv for point in mesh.uv_layers.active.data]
    np.testing.assert_array_equal(compatibility.corner_uv(mesh), np.array(uv, dtype=np.float32), strict=True)
    assert compatibility.face_offsets(mesh).tolist() == [*range(0, 25, 4)]


@pytest.mark.parametrize("name", ["position", ".edge_verts", ".corner_vert", ".hide_poly", "uv_seam", ".uv_seam"])
def test_an_attribute_of_the_users_is_not_taken_for_one_of_blenders(name):
    mesh = scenes.grid(3, 2).data
    # Where the name is taken it is Blender's own.
    if name not in mesh.attributes:
        mesh.attributes.new(name, "FLOAT", "CORNER")
    assert not compatibility.flags(mesh, "edges", "use_seam").any()
    assert not compatibility.flags(mesh, "polygons", "hide").any()
    assert compatibility.positions(mesh)[-1].tolist() == [3.0, 2.0, 0.0]
    assert compatibility.edge_vertices(mesh).max() == compatibility.corner_vertices(mesh).max() == 11


def test_meshes_of_an_asset_stand_where_it_places_them():
    package = importlib.import_module("spectral_unwrap.core.native").spectral_conformal().__name__
    assets, meshes = (importlib.import_module(f"{package}.{name}") for name in ("assets", "batch.blender.meshes"))
    placement = np.eye(4)
    placement[:3] = ((1.0, 0.5, 0.0, 3.0), (0.0, 1.0, 0.0, -2.0), (0.0, 0.0, 2.0, 1.0))
    triangle = assets.AssetMesh(np.eye(3), np.array([0, 3]), np.array([0, 1, 2]), placement=placement)
    (item,) = meshes.link([triangle], bpy.context.scene)
    np.testing.assert_array_equal(item.matrix_world, placement)
