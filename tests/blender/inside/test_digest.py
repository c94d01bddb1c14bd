# SPDX-License-Identifier: GPL-3.0-or-later
"""The digest by which other tests find changes notices every kind of change, and makes none."""

import bmesh
import bpy
import pytest

from tests.blender.inside import digest, scenes


def scene():
    """A grid with shape keys, two UV maps, an attribute and a modifier, in edit mode."""
    grid = scenes.bumpy_grid(3, 3)
    grid.data.uv_layers.new(name="Second")
    grid.data.attributes.new("Field", "FLOAT", "FACE")
    grid.shape_key_add(name="Basis")
    grid.shape_key_add(name="Key")
    grid.vertex_groups.new(name="Group").add([0, 3], 0.25, "REPLACE")
    grid.modifiers.new("Mirror", "MIRROR")
    grid.data.materials.append(bpy.data.materials.new("Material"))
    scenes.edit(grid)
    return grid


def _set_pin(grid):
    scenes.pin(grid, [3])


def _set_other_map(grid):
    bm = scenes.edit_mesh(grid)
    bm.faces[0].loops[0][bm.loops.layers.uv["Second"]].uv = (3.0, 4.0)


def _set_shape_key(grid):
    bm = scenes.edit_mesh(grid)
    bm.verts[4][bm.verts.layers.shape["Key"]].x += 1.0


def _set_attribute(grid):
    bm = scenes.edit_mesh(grid)
    bm.faces[2][bm.faces.layers.float["Field"]] = 7.0


def _set_weight(grid):
    bm = scenes.edit_mesh(grid)
    bm.verts[0][bm.verts.layers.deform.active][0] = 0.75


def _set_uv_selection(grid):
    flags = [False] * len(scenes.read_uv(grid))
    scenes.set_uv_flags(grid, [True, *flags[1:]])


def _add_extender(grid):
    scenes.select_vertices(grid, (0, 15))
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER") == {"FINISHED"}


CHANGES = {
    "position": lambda grid: setattr(scenes.edit_mesh(grid).verts[2].co, "z", 9.0),
    "seam": lambda grid: setattr(scenes.edit_mesh(grid).edges[3], "seam", True),
    "sharp": lambda grid: setattr(scenes.edit_mesh(grid).edges[3], "smooth", False),
    "hide": lambda grid: scenes.edit_mesh(grid).faces[1].hide_set(True),
    "selection": lambda grid: scenes.select_faces(grid, [1, 2]),
    "select mode": lambda grid: bpy.ops.mesh.select_mode(type="EDGE"),
    "active face": lambda grid: setattr(scenes.edit_mesh(grid).faces, "active", scenes.edit_mesh(grid).faces[5]),
    "material of a face": lambda grid: setattr(scenes.edit_mesh(grid).faces[5], "material_index", 1),
    "topology": lambda grid: bmesh.ops.reverse_faces(
        scenes.edit_mesh(grid), faces=scenes.edit_mesh(grid).faces[:1], flip_multires=False
    ),
    "pin": _set_pin,
    "other UV map": _set_other_map,
    "shape key": _set_shape_key,
    "attribute": _set_attribute,
    "weight": _set_weight,
    "UV selection": _set_uv_selection,
    "extender": _add_extender,
    "modifier": lambda grid: setattr(grid.modifiers[0], "use_clip", True),
    "object": lambda grid: setattr(grid, "name", "Other"),
    "active UV map": lambda grid: setattr(grid.data.uv_layers, "active_index", 1),
    "data block": lambda grid: bpy.data.meshes.new("Left over"),
    "tool setting": lambda grid: setattr(bpy.context.scene.tool_settings, "use_mesh_automerge", True),
}


@pytest.mark.parametrize("name", CHANGES)
def test_change_is_seen(name):
    grid = scene()
    before = digest.digest()
    assert digest.changes(before, digest.digest()) == []
    CHANGES[name](grid)
    assert digest.changes(before, digest.digest()) != []


def test_coordinates_of_the_active_map_are_apart():
    grid = scene()
    before, uv = digest.digest(), digest.active_uv(grid.data)
    scenes.write_uv(grid, scenes.read_uv(grid) + 1.0)
    assert digest.changes(before, digest.digest()) == []
    assert (digest.active_uv(grid.data) != uv).all()
