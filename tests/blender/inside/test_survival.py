# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user had on the mesh survives an unwrap, and what Blender's own Unwrap does on special input."""

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes

DOMAINS = {"FLOAT": "POINT", "INT": "FACE", "BOOLEAN": "EDGE", "FLOAT_COLOR": "CORNER"}


def fill(values, count):
    return np.random.default_rng(count).integers(0, 2, count).astype(values)


def written_mesh():
    """A grid in object mode with attributes of every domain, custom normals, two materials and sharp edges."""
    grid = scenes.bumpy_grid(4, 4)
    mesh = grid.data
    for kind, domain in DOMAINS.items():
        attribute = mesh.attributes.new(kind.title(), kind, domain)
        if kind == "FLOAT_COLOR":
            attribute.data.foreach_set("color", fill(np.float32, 4 * len(attribute.data)))
        else:
            attribute.data.foreach_set(
                "value", fill({"FLOAT": np.float32, "INT": np.int32}.get(kind, bool), len(attribute.data))
            )
    for name in ("First", "Second"):
        mesh.materials.append(bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", np.arange(len(mesh.polygons), dtype=np.int32) % 2)
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth = True
    for edge in mesh.edges:
        edge.use_edge_sharp = edge.index % 3 == 0
    normals = np.random.default_rng(3).normal(size=(len(mesh.loops), 3)) * 0.2 + (0.0, 0.0, 1.0)
    mesh.normals_split_custom_set((normals / np.linalg.norm(normals, axis=1)[:, None]).tolist())
    return grid


def contents(mesh):
    """Return attributes, normals, materials and sharp edges of a mesh in object mode."""
    if hasattr(mesh, "calc_normals_split"):
        mesh.calc_normals_split()
    found = {"normals": [tuple(loop.normal) for loop in mesh.loops]}
    for kind in DOMAINS:
        field = "color" if kind == "FLOAT_COLOR" else "value"
        values = [getattr(item, field) for item in mesh.attributes[kind.title()].data]
        found[kind] = [tuple(value) if field == "color" else value for value in values]
    found["attributes"] = sorted(attribute.name for attribute in mesh.attributes if not attribute.name.startswith("."))
    found["materials"] = [material.name for material in mesh.materials]
    found["material of face"] = [face.material_index for face in mesh.polygons]
    found["sharp"] = [edge.use_edge_sharp for edge in mesh.edges]
    found["seams"] = [edge.use_seam for edge in mesh.edges]
    return found


@pytest.mark.parametrize("options", [{}, {"use_subsurf_data": True}, {"keep_in_place": True, "fill_holes": True}])
def test_attributes_normals_materials_and_sharp_edges_survive(options):
    untouched = []
    for unwrap in (False, True):
        grid = written_mesh()
        grid.modifiers.new("Subdivision", "SUBSURF").levels = 1
        scenes.edit(grid)
        if unwrap:
            assert bpy.ops.uv.spectral_unwrap(**options) == {"FINISHED"}
        bpy.ops.object.mode_set(mode="OBJECT")
        state = contents(grid.data)
        state["materials"] = [name.partition(".")[0] for name in state["materials"]]
        untouched.append(state)
    assert untouched[0] == untouched[1]


def changed_corners(edited, unwrap):
    before = scenes.read_uv(edited)
    status = unwrap()
    after = scenes.read_uv(edited)
    scenes.write_uv(edited, before)
    return status, ~np.isclose(after, before, atol=1e-7).all(axis=1)


def fin():
    """Three squares at one edge."""
    vertices = [(0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (-1, 0, 0), (-1, 1, 0), (0, 0, 1), (0, 1, 1)]
    return scenes.new_object(vertices, [(0, 2, 3, 1), (4, 0, 1, 5), (0, 6, 7, 1)], name="Fin")


@pytest.mark.parametrize(
    ("make", "selection"),
    [
        (scenes.bumpy_grid, range(24)),
        (scenes.bumpy_grid, range(8)),
        (scenes.cylinder, range(144)),
        (fin, range(3)),
    ],
    ids=["all", "some", "seam", "three faces at an edge"],
)
def test_same_corners_change_and_same_status_as_in_blender(make, selection):
    edited = make()
    scenes.edit(edited)
    scenes.select_faces(edited, selection)
    ours, theirs = (
        changed_corners(edited, unwrap)
        for unwrap in (bpy.ops.uv.spectral_unwrap, lambda: bpy.ops.uv.unwrap(method="CONFORMAL"))
    )
    assert ours[0] == theirs[0]
    np.testing.assert_array_equal(ours[1], theirs[1])
