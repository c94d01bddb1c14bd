# SPDX-License-Identifier: GPL-3.0-or-later
"""Straight, Rectangle, Grid and Symmetric: stored with the mesh, obeyed by every unwrap, switched and removed."""

import importlib

import bmesh
import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes

constraints = importlib.import_module("spectral_unwrap.edit_mesh.constraints")


def bent_sheet(columns=12, rows=7):
    """A curved sheet of quads, in edit mode; vertex (i, j) is i * (rows + 1) + j."""
    s, t = np.meshgrid(np.linspace(0, 2, columns + 1), np.linspace(0, 1, rows + 1), indexing="ij")
    points = np.c_[s.ravel(), 0.3 * np.sin(3 * s + 2 * t).ravel(), (t * (1 + 0.3 * s)).ravel()]
    first = (np.arange(columns)[:, None] * (rows + 1) + np.arange(rows)).ravel()
    faces = np.c_[first, first + rows + 1, first + rows + 2, first + 1]
    mesh = bpy.data.meshes.new("sheet")
    mesh.from_pydata(points.tolist(), [], faces.tolist())
    made = bpy.data.objects.new("sheet", mesh)
    bpy.context.collection.objects.link(made)
    bpy.context.view_layer.objects.active = made
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    return made


def select(edited, vertices):
    bpy.ops.mesh.select_mode(type="VERT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bm = scenes.edit_mesh(edited)
    bm.verts.ensure_lookup_table()
    for index in vertices:
        bm.verts[index].select_set(True)
    bm.select_flush_mode()
    bmesh.update_edit_mesh(edited.data)


def uv_of(edited, vertices):
    bm = scenes.edit_mesh(edited)
    layer = bm.loops.layers.uv.active
    bm.verts.ensure_lookup_table()
    return np.array([bm.verts[index].link_loops[0][layer].uv[:] for index in vertices])


def is_straight(values):
    """UVs are in single precision."""
    return np.ptp(values) < 2e-7


ROW = [i * 8 + 3 for i in range(13)]
COLUMN = [5 * 8 + j for j in range(8)]


def test_edges_stay_straight_until_they_are_switched_off_or_removed():
    edited = bent_sheet()
    assert not is_straight(uv_of(edited, ROW)[:, 1])
    select(edited, ROW)
    assert bpy.ops.uv.spectral_shape(kind="STRAIGHT") == {"FINISHED"}
    assert is_straight(uv_of(edited, ROW)[:, 1])
    ((layer, found),) = constraints.of(edited.data)
    assert (found.kind, found.number, found.use) == ("STRAIGHT", 1, True)
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.spectral_unwrap()
    assert is_straight(uv_of(edited, ROW)[:, 1])
    (entry,) = edited.data.spectral_shapes
    assert (entry.layer, entry.kind, entry.name, entry.use) == (layer, "STRAIGHT", "Straight 1", True)
    entry.use = False
    bpy.ops.uv.spectral_unwrap()
    assert not is_straight(uv_of(edited, ROW)[:, 1])
    ((layer, found),) = constraints.of(edited.data)
    assert not found.use
    assert bpy.ops.uv.spectral_shape_remove() == {"FINISHED"}
    assert not constraints.of(edited.data) and not edited.data.spectral_shapes


def test_a_part_in_place_keeps_them_and_the_rest_stays():
    edited = bent_sheet()
    select(edited, ROW)
    assert bpy.ops.uv.spectral_shape(kind="STRAIGHT") == {"FINISHED"}
    before = scenes.read_uv(edited)
    part = [7 * i + j for i in range(3, 9) for j in range(1, 5)]
    scenes.select_faces(edited, part)
    moved = scenes.corners_of(edited, part)
    vertices = scenes.corner_vertices(edited)
    free = moved & ~np.isin(vertices, vertices[~moved])
    scenes.write_uv(edited, np.where(free[:, None], before * 1.02, before))
    assert bpy.ops.uv.spectral_unwrap(keep_in_place=True) == {"FINISHED"}
    after = scenes.read_uv(edited)
    np.testing.assert_array_equal(after[~free], before[~free])
    np.testing.assert_allclose(after[free], before[free], atol=0.02)
    assert is_straight(uv_of(edited, ROW)[:, 1])


def test_as_it_lies_keeps_the_angle_and_both_together_hold():
    edited = bent_sheet()
    select(edited, COLUMN)
    bpy.ops.uv.spectral_shape(kind="STRAIGHT", direction="OWN")
    across = np.diff(uv_of(edited, COLUMN), axis=0)
    angle = np.radians(constraints.of(edited.data)[0][1].angle)
    assert np.abs(across @ [-np.sin(angle), np.cos(angle)]).max() < 2e-7
    select(edited, ROW)
    bpy.ops.uv.spectral_shape(kind="STRAIGHT", direction="HORIZONTAL")
    assert is_straight(uv_of(edited, ROW)[:, 1])
    assert np.abs(np.diff(uv_of(edited, COLUMN), axis=0) @ [-np.sin(angle), np.cos(angle)]).max() < 2e-7


@pytest.mark.parametrize("spacing", ["FREE", "EVEN", "LENGTH"])
def test_quads_become_a_grid(spacing):
    edited = bent_sheet()
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.uv.spectral_shape(kind="GRID", spacing=spacing) == {"FINISHED"}
    uv = uv_of(edited, range(104)).reshape(13, 8, 2)
    assert np.ptp(uv[..., 0], axis=1).max() < 2e-7 and np.ptp(uv[..., 1], axis=0).max() < 2e-7
    assert (np.ptp(np.diff(uv[:, 0, 0])) < 4e-7) == (spacing == "EVEN")


def test_halves_are_mirror_images():
    edited = bent_sheet()
    axis = [6 * 8 + j for j in range(8)]
    select(edited, axis)
    assert bpy.ops.uv.spectral_shape(kind="SYMMETRIC") == {"FINISHED"}
    uv = uv_of(edited, range(104)).reshape(13, 8, 2)
    middle = uv[6, 0, 0]
    assert is_straight(uv[6, :, 0])
    assert np.abs(uv[::-1, :, 0] - middle + (uv[..., 0] - middle)).max() < 4e-7
    assert np.abs(uv[::-1, :, 1] - uv[..., 1]).max() < 4e-7


def test_a_block_of_faces_becomes_a_rectangle_and_its_island_does_not():
    edited = bent_sheet()
    scenes.select_faces(edited, [7 * i + j for i in range(3, 9) for j in range(2, 5)])
    assert bpy.ops.uv.spectral_shape(kind="RECTANGLE") == {"FINISHED"}
    for side, axis in (([i * 8 + 2 for i in range(3, 10)], 1), ([3 * 8 + j for j in range(2, 6)], 0)):
        assert is_straight(uv_of(edited, side)[:, axis])
    assert not is_straight(uv_of(edited, [i * 8 for i in range(13)])[:, 1])


def test_the_side_of_a_cylinder_becomes_a_rectangle_without_its_caps():
    bpy.ops.mesh.primitive_cylinder_add(vertices=6)
    made = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.context.tool_settings.mesh_select_mode = (False, False, True)
    bm = scenes.edit_mesh(made)
    upright = [edge for edge in bm.edges if edge.verts[0].co.z * edge.verts[1].co.z < 0]
    for edge in bm.edges:
        edge.seam = edge == upright[0] or edge not in upright
    for face in bm.faces:
        face.select_set(len(face.verts) == 4)
    bmesh.update_edit_mesh(made.data)
    assert bpy.ops.uv.spectral_shape(kind="RECTANGLE") == {"FINISHED"}
    assert not any(face.select for face in scenes.edit_mesh(made).faces if len(face.verts) == 6)
    # Its rim is a straight line in the map of the side, and a hexagon in that of the cap.
    select(made, [vertex.index for vertex in scenes.edit_mesh(made).verts if vertex.co.z > 0])
    with pytest.raises(RuntimeError, match="Edges on a seam lie at another angle in each island"):
        bpy.ops.uv.spectral_shape(kind="STRAIGHT", direction="OWN")


def test_an_island_finds_its_mirror_plane_by_itself():
    edited = bent_sheet()
    bpy.ops.mesh.select_all(action="SELECT")
    with pytest.raises(RuntimeError, match="No mirror plane found"):
        bpy.ops.uv.spectral_shape(kind="SYMMETRIC")
    # A mesh without a plane does not keep another from its own.
    bpy.ops.object.mode_set(mode="OBJECT")
    without = edited.copy()
    without.data = edited.data.copy()
    bpy.context.scene.collection.objects.link(without)
    scenes.edit(without, edited)
    for vertex in scenes.edit_mesh(edited).verts:
        vertex.co.y = 0.5 * (vertex.co.x - 1.0) ** 2
        vertex.co.z = (vertex.index % 8) / 7.0
    bmesh.update_edit_mesh(edited.data)
    assert bpy.ops.uv.spectral_shape(kind="SYMMETRIC") == {"FINISHED"}
    assert not constraints.of(without.data)
    uv = uv_of(edited, range(104)).reshape(13, 8, 2)
    assert np.abs(uv[::-1, :, 0] - uv[6, 0, 0] + (uv[..., 0] - uv[6, 0, 0])).max() < 4e-7


def test_a_mirror_plane_may_pass_between_the_vertices():
    bent = scenes.grid(5, 6)
    scenes.edit(bent)
    for vertex in scenes.edit_mesh(bent).verts:
        vertex.co.z = 0.3 * (vertex.co.x - 2.5) ** 2 + 0.1 * vertex.co.y**2
        # A detail on one side.
        vertex.co.z += 0.5 * (vertex.index == 14)
    bmesh.update_edit_mesh(bent.data)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    before = uv_of(bent, range(42)).reshape(7, 6, 2)
    assert bpy.ops.uv.spectral_shape(kind="SYMMETRIC") == {"FINISHED"}
    uv = uv_of(bent, range(42)).reshape(7, 6, 2)
    for each, is_mirrored in ((before, False), (uv, True)):
        middle = (each[0, 2, 0] + each[0, 3, 0]) / 2
        off = np.abs(each[:, ::-1, 0] - middle + (each[..., 0] - middle)), np.abs(each[:, ::-1, 1] - each[..., 1])
        assert (np.max(off) < 4e-7) == is_mirrored, np.max(off)
    assert bpy.ops.uv.spectral_relax(steps=3) == {"FINISHED"}
    relaxed = uv_of(bent, range(42)).reshape(7, 6, 2)
    assert np.abs(relaxed[:, ::-1, 1] - relaxed[..., 1]).max() < 4e-7


def test_a_cube_that_is_cut_into_a_cross_is_symmetric():
    cube = scenes.cube()
    scenes.edit(cube)
    assert bpy.ops.uv.spectral_suggest_seams() == {"FINISHED"}
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.uv.spectral_shape(kind="SYMMETRIC") == {"FINISHED"}
    assert [each.name for each in cube.data.spectral_shapes] == ["Symmetric 1"]


def edit_suzanne():
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    return bpy.context.edit_object


def connected(bm, start):
    """Return the vertices that edges connect with one."""
    found, left = {start}, [start]
    while left:
        for edge in bm.verts[left.pop()].link_edges:
            for vertex in edge.verts:
                if vertex.index not in found:
                    found.add(vertex.index)
                    left.append(vertex.index)
    return found


def test_islands_that_mirror_each_other_are_unwrapped_alike(reports):
    edited = edit_suzanne()
    bm = scenes.edit_mesh(edited)
    # Her eyes are meshes of their own.
    bm.verts.ensure_lookup_table()
    head = max((connected(bm, vertex.index) for vertex in bm.verts), key=len)
    scenes.select_faces(edited, [face.index for face in bm.faces if face.verts[0].index not in head])
    reports()
    assert bpy.ops.uv.spectral_shape(kind="SYMMETRIC") == {"FINISHED"}
    assert ("Info", "1 pair of islands mirrors each other: both are mapped alike, without an axis") in reports()
    assert not constraints.of(edited.data)


def selected_edges(edited):
    return {tuple(sorted(v.index for v in edge.verts)) for edge in scenes.edit_mesh(edited).edges if edge.select}


def test_what_contradicts_itself_is_said_and_selected_and_the_map_stays(reports):
    edited = bent_sheet()
    before = uv_of(edited, range(104))
    select(edited, ROW[:2])
    bpy.ops.uv.spectral_shape(kind="STRAIGHT", direction="HORIZONTAL", unwrap=False)
    bpy.ops.uv.spectral_shape(kind="STRAIGHT", direction="VERTICAL")
    assert np.array_equal(uv_of(edited, range(104)), before)
    # Of a chain in a row and in a column, the edge that has no extent is selected.
    select(edited, ROW)
    bpy.ops.uv.spectral_shape(kind="STRAIGHT", direction="VERTICAL")
    assert selected_edges(edited) == {tuple(ROW[:2])}
    assert np.array_equal(uv_of(edited, range(104)), before)
    # After a plain unwrap, the sidebar offers to select it.
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.uv.spectral_unwrap() == {"CANCELLED"}
    island_list = importlib.import_module("spectral_unwrap.unwrapping.island_list")
    assert island_list.selecting() == ("FAILED",)
    reports()
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"FINISHED"}
    assert selected_edges(edited) == {tuple(ROW[:2])}
    assert reports() == [("Info", "Selected 1 edge whose shapes contradict each other")]
    select(edited, [])
    with pytest.raises(RuntimeError, match="No edges"):
        bpy.ops.uv.spectral_shape(kind="STRAIGHT")


def test_the_attribute_of_univ_is_read():
    edited = bent_sheet()
    select(edited, ROW)
    bm = scenes.edit_mesh(edited)
    layer = bm.edges.layers.int.new("univ_constraints")
    for edge in bm.edges:
        if edge.select:
            edge[layer] = 0b1111
    bmesh.update_edit_mesh(edited.data)
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.spectral_unwrap()
    assert is_straight(uv_of(edited, ROW)[:, 1])


@pytest.mark.parametrize("by", ["MOST", "EDGES"])
def test_islands_turn_upright_by_edges_and_axes(by):
    edited = bent_sheet()
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.spectral_shape(kind="GRID", spacing="EVEN")
    size = np.ptp(uv_of(edited, range(104)), axis=0)
    bm = scenes.edit_mesh(edited)
    layer = bm.loops.layers.uv.active
    for face in bm.faces:
        for loop in face.loops:
            u, v = loop[layer].uv
            loop[layer].uv = (0.9 * u - 0.4 * v, 0.4 * u + 0.9 * v)
    bmesh.update_edit_mesh(edited.data)
    select(edited, ROW)
    assert bpy.ops.uv.spectral_shape(kind="UPRIGHT", by=by) == {"FINISHED"}
    assert np.ptp(uv_of(edited, ROW)[:, 1]) < 1e-6
    assert np.allclose(np.ptp(uv_of(edited, range(104)), axis=0), np.hypot(0.9, 0.4) * size, atol=1e-5)
    assert bpy.ops.uv.spectral_shape(kind="UPRIGHT", by=by) == {"CANCELLED"}
    bpy.ops.uv.spectral_shape(kind="UPRIGHT", by="X")
    assert np.diff(uv_of(edited, ROW)[:, 1]).min() > 0


def test_packing_does_not_turn_islands_away_from_their_direction():
    edited = bent_sheet()
    for edge in scenes.edit_mesh(edited).edges:
        edge.seam = all(vertex.index in COLUMN for vertex in edge.verts)
    select(edited, ROW)
    bpy.ops.uv.spectral_shape(kind="STRAIGHT", direction="HORIZONTAL", unwrap=False)
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.uv.spectral_unwrap(rotation="FREE", hold_rest=False) == {"FINISHED"}
    for half in (ROW[:5], ROW[6:]):
        assert is_straight(uv_of(edited, half)[:, 1])


def test_relaxing_and_packing_keep_what_is_straight_and_say_so(reports):
    edited = bent_sheet()
    select(edited, ROW)
    bpy.ops.uv.spectral_shape(kind="STRAIGHT", direction="VERTICAL")
    bpy.ops.mesh.select_all(action="SELECT")
    row = uv_of(edited, ROW)
    assert bpy.ops.uv.spectral_relax(steps=3) == {"FINISHED"}
    assert "stored shape" not in str(reports())
    assert is_straight(uv_of(edited, ROW)[:, 0]) and not np.array_equal(uv_of(edited, ROW), row)
    # Where an artist has bent them, they stay.
    bm = bmesh.from_edit_mesh(edited.data)
    bm.verts.ensure_lookup_table()
    for loop in bm.verts[ROW[0]].link_loops:
        loop[bm.loops.layers.uv.active].uv.x += 0.01
    bent = uv_of(edited, ROW)
    assert bpy.ops.uv.spectral_relax(steps=3) == {"FINISHED"}
    assert "a stored shape stayed" in reports()[-2][1]
    assert np.array_equal(uv_of(edited, ROW)[:2], bent[:2])
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert bpy.ops.uv.spectral_pack(steps=1) == {"FINISHED"}
    assert "not turned" in reports()[-2][1]
    assert is_straight(uv_of(edited, ROW)[:, 0])


def test_an_extender_pushes_and_what_is_straight_stays_so_also_live():
    following = importlib.import_module("spectral_unwrap.live.following")
    edited = bent_sheet()
    select(edited, ROW)
    bpy.ops.uv.spectral_shape(kind="STRAIGHT", direction="HORIZONTAL")
    before = uv_of(edited, range(104))
    bpy.context.scene.spectral_unwrap_live = True
    following.begin()
    select(edited, [0, 103])
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER", amount=90.0) == {"FINISHED"}
    pushed = uv_of(edited, range(104))
    assert is_straight(pushed[ROW, 1]) and np.abs(pushed - before).max() > 2e-3
    edited.data.spectral_shapes[0].strength = 0.1
    following.look()
    assert is_straight(uv_of(edited, ROW)[:, 1]) and not np.array_equal(uv_of(edited, range(104)), pushed)
    # The next unwrap has both, and a constraint that is switched off is followed with the extender on.
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert is_straight(uv_of(edited, ROW)[:, 1])
    edited.data.spectral_shapes[-1].use = False
    following.look()
    assert not is_straight(uv_of(edited, ROW)[:, 1])


def test_live_follows_and_the_subdivided_mesh_is_straight_at_its_own_vertices():
    following = importlib.import_module("spectral_unwrap.live.following")
    edited = bent_sheet()
    bpy.context.scene.spectral_unwrap_live = True
    following.begin()
    select(edited, ROW)
    bpy.ops.uv.spectral_shape(kind="STRAIGHT", unwrap=False)
    bpy.context.view_layer.update()
    assert not is_straight(uv_of(edited, ROW)[:, 1])
    following.look()
    assert is_straight(uv_of(edited, ROW)[:, 1])
    # Switching it off is followed as well.
    (entry,) = edited.data.spectral_shapes
    entry.use = False
    following.look()
    assert not is_straight(uv_of(edited, ROW)[:, 1])
    entry.use = True
    bpy.context.scene.spectral_unwrap_live = False
    edited.modifiers.new("Subdivision", "SUBSURF").levels = 2
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.uv.spectral_unwrap(use_subsurf_data=True) == {"FINISHED"}
    assert is_straight(uv_of(edited, ROW)[:, 1])
    assert not is_straight(uv_of(edited, COLUMN)[:, 0])


def test_edges_without_visible_faces_are_not_stored(reports):
    edited = bent_sheet()
    for face in scenes.edit_mesh(edited).faces:
        face.hide_set(True)
    bm = scenes.edit_mesh(edited)
    ends = [bm.verts.new((x, 0.0, 3.0)) for x in range(2)]
    bm.edges.new(ends).select_set(True)
    bmesh.update_edit_mesh(edited.data)
    before = uv_of(edited, range(104))
    reports()
    for is_unwrapped in (True, False):
        with pytest.raises(RuntimeError, match="No visible face has these edges, so nothing was unwrapped"):
            bpy.ops.uv.spectral_shape(kind="STRAIGHT", unwrap=is_unwrapped)
    np.testing.assert_array_equal(uv_of(edited, range(104)), before)
    assert not constraints.of(edited.data)
    # Beside others, they are left out.
    bm = scenes.edit_mesh(edited)
    for face in bm.faces:
        face.hide_set(False)
    select(edited, [*ROW, *(end.index for end in bm.verts[-2:])])
    assert bpy.ops.uv.spectral_shape(kind="STRAIGHT") == {"FINISHED"}
    ((layer, _),) = constraints.of(edited.data)
    assert len(scenes.module("edit_mesh.elements").marked_edges(edited.data, layer)) == len(ROW) - 1


@pytest.mark.parametrize("name", ["RECTANGLE", "GRID"])
def test_parts_that_cannot_are_selected_and_the_others_done(name, reports):
    sheet, cube = scenes.grid(3, 2, name="Sheet"), scenes.cube(name="Cube")
    scenes.edit(sheet, cube)
    assert bpy.ops.uv.spectral_shape(kind=name) == {"FINISHED"}
    level, said = reports()[-1]
    assert level == "Warning" and said.endswith("; 1 part stays as it is, now selected")
    assert len(constraints.of(sheet.data)) == 1 and not constraints.of(cube.data)
    assert not any(face.select for face in bmesh.from_edit_mesh(sheet.data).faces)
    assert all(face.select for face in bmesh.from_edit_mesh(cube.data).faces)
    with pytest.raises(RuntimeError, match="single border|do not form a grid"):
        bpy.ops.uv.spectral_shape(kind=name)


def test_what_is_missing_is_said():
    bent_sheet()
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="Nothing selected; select faces, or the four corners of an island"):
        bpy.ops.uv.spectral_shape(kind="RECTANGLE")


def test_where_nothing_is_unwrapped_nothing_is_stored(reports):
    cube = scenes.cube()
    scenes.edit(cube)
    select(cube, [vertex.index for vertex in scenes.edit_mesh(cube).edges[0].verts])
    reports()
    assert bpy.ops.uv.spectral_shape(kind="STRAIGHT") == {"CANCELLED"}
    assert reports()[-1] == ("Warning", "Nothing was unwrapped, so nothing was stored")
    assert not constraints.of(cube.data) and not cube.data.spectral_shapes
    # Unless it is only to be stored.
    assert bpy.ops.uv.spectral_shape(kind="STRAIGHT", unwrap=False) == {"FINISHED"}
    assert len(cube.data.spectral_shapes) == 1


def test_shapes_that_the_first_version_stored_are_read():
    edited = bent_sheet()
    bpy.ops.object.mode_set(mode="OBJECT")
    mesh = edited.data
    straight = mesh.attributes.new(".spectral_constraint:STRAIGHT:2:1:0:0", "INT", "EDGE")
    for edge, value in zip(mesh.edges, straight.data):
        value.value = 1 if set(edge.vertices) <= set(ROW) else 0
    mesh.attributes.new(".spectral_constraint:GRID:1:0:0:1", "INT", "EDGE")
    pushed = mesh.attributes.new(".spectral_extender:1:0.25@0.2:Nose: left", "INT", "POINT")
    pushed.data[0].value, pushed.data[103].value = 2**23, -(2**23)
    scenes.edit(edited)
    bpy.context.view_layer.update()
    found = [(each.kind, each.name, each.use) for each in mesh.spectral_shapes]
    assert found == [
        ("EXTENDER", "Nose: left", True),
        ("STRAIGHT", "Straight 2", True),
        ("GRID", "Grid 1", False),
    ]
    assert mesh.spectral_shapes[0].strength == 0.25
    before = uv_of(edited, range(104))
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert is_straight(uv_of(edited, ROW)[:, 1])
    assert np.abs(uv_of(edited, range(104)) - before).max() > 1e-2
    # Each is removed by its place in the list.
    assert bpy.ops.uv.spectral_shape_remove(index=1) == {"FINISHED"}
    assert [each.kind for each in mesh.spectral_shapes] == ["EXTENDER", "GRID"]
    with pytest.raises(RuntimeError, match="no such entry"):
        bpy.ops.uv.spectral_shape_remove(index=2)
