# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders: made from the selection, stored with the mesh, found again after changes of it."""

import math

import bmesh
import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


def select(edited, vertices, in_order=True):
    """Select exactly these vertices, one after the other or all at once."""
    bpy.context.tool_settings.mesh_select_mode = (True, False, False)
    bm = scenes.edit_mesh(edited)
    for elements in (bm.faces, bm.edges, bm.verts):
        for element in elements:
            element.select = False
    bm.select_history.clear()
    for vertex in vertices:
        bm.verts[vertex].select = True
        if in_order:
            bm.select_history.add(bm.verts[vertex])
    bm.select_flush_mode()
    bmesh.update_edit_mesh(edited.data)


def add(edited, vertices, strength=1.0, **options):
    """Add extenders with an `amount`, or else of this strength."""
    select(edited, vertices)
    former = len(edited.data.spectral_shapes)
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER", **options) == {"FINISHED"}
    for extender in [] if options else edited.data.spectral_shapes[former:]:
        extender.strength = strength


def refused(capture, **options):
    """Return the error with which adding is refused."""
    with pytest.raises(RuntimeError) as error:
        bpy.ops.uv.spectral_shape(kind="EXTENDER", **options)
    capture()
    return str(error.value)


def pairs(edited):
    return scenes.module("edit_mesh.extenders").ends(edited.data)


def listed(edited):
    return [(e.name, round(e.strength, 5), e.use) for e in edited.data.spectral_shapes]


def resolved(edited):
    """Return the vertices and strengths of the extenders that act, and the names of broken ones."""
    forces, broken = scenes.module("edit_mesh.extenders").resolve(edited.data)
    return [force[:3] for force in forces], broken


def positions(edited):
    """Return the positions of both vertices of every extender."""
    bm = scenes.edit_mesh(edited)
    return [
        tuple(None if v < 0 else tuple(round(x, 4) for x in bm.verts[v].co) for v in pair) for pair in pairs(edited)
    ]


def edit_grid(columns=4, rows=3, **options):
    grid = scenes.grid(columns, rows, **options)
    scenes.edit(grid, select=False)
    return grid


def delete_vertices(edited, vertices):
    select(edited, vertices)
    bpy.ops.mesh.delete(type="VERT")
    bpy.context.view_layer.update()


def test_two_selected_vertices_make_an_extender():
    grid = edit_grid()
    add(grid, [7, 2], strength=-2.5)
    assert pairs(grid) == [(7, 2)]
    assert listed(grid) == [("Push/Pull", -2.5, True)]
    assert resolved(grid) == ([(7, 2, -2.5)], [])
    assert grid.data.spectral_shapes_active == 0


def test_all_begin_at_half_of_their_sliders_whatever_the_pair():
    grid = edit_grid(8, 6)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    select(grid, [0, 31, 62])
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER") == {"FINISHED"}
    extenders = grid.data.spectral_shapes
    assert [each.amount for each in extenders] == pytest.approx([50.0, 50.0], abs=1e-3)
    assert extenders[0].strength != pytest.approx(extenders[1].strength, rel=0.1)
    add(grid, [4, 5], amount=-20.0)
    assert extenders[2].amount == pytest.approx(-20.0, abs=1e-3)


def test_existing_pair_is_not_doubled(reports):
    grid = edit_grid()
    add(grid, [7, 2])
    reports()
    select(grid, [2, 7])
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER") == {"CANCELLED"}
    assert reports() == [("Warning", "Pairs that already have one: 1")]
    add(grid, [3, 7, 2])
    assert pairs(grid) == [(7, 2), (3, 2)]


def test_the_report_says_when_the_extender_acts_where_the_map_cannot_follow(reports):
    grid = edit_grid(uv_map=False)
    bpy.context.scene.spectral_unwrap_live = True
    add(grid, [7, 2])
    warning, added = reports()
    assert warning[0] == "Warning"
    assert "UV map" in warning[1]
    assert added[0] == "Info"
    assert "for the next unwrap" in added[1]


def test_every_mesh_in_edit_mode_goes_by_its_own_selection(reports):
    one, other, third = (scenes.grid(3, 3, name=name) for name in ("One", "Other", "Third"))
    scenes.edit(one, other, third, select=False)
    select(one, [0, 5])
    select(other, [3, 1, 2, 4])
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER") == {"FINISHED"}
    assert (pairs(one), sorted(pairs(other)), pairs(third)) == ([(0, 5)], [(1, 4), (2, 4), (3, 4)], [])
    # All or nothing.
    select(one, [7, 8])
    select(other, [3])
    assert "Other: " in refused(reports)
    assert len(pairs(one)) == 1


def test_vertices_are_found_after_edits_elsewhere():
    grid = edit_grid()
    add(grid, [6, 8])
    add(grid, [8, 13])
    before = positions(grid)
    delete_vertices(grid, [0, 1])
    assert positions(grid) == before
    bpy.ops.mesh.select_all(action="SELECT")
    for _ in range(3):
        bpy.ops.mesh.subdivide(number_cuts=2)
        assert positions(grid) == before
    assert resolved(grid)[1] == []


def test_extender_without_one_vertex_is_broken_and_reported(reports):
    grid = edit_grid()
    add(grid, [6, 8])
    add(grid, [11, 13])
    delete_vertices(grid, [8])
    assert [-1 in pair for pair in pairs(grid)] == [True, False]
    forces, broken = resolved(grid)
    assert broken == ["Push/Pull"]
    assert len(forces) == 1
    assert [None in pair for pair in scenes.module("edit_mesh.extenders").vertices(grid.data)] == [True, False]
    grid.data.spectral_shapes_active = 0
    with pytest.raises(RuntimeError, match="Push/Pull lost a vertex"):
        bpy.ops.uv.spectral_extender()
    assert bpy.ops.uv.spectral_shape_remove() == {"FINISHED"}
    assert [name for name, _, _ in listed(grid)] == ["Push/Pull.001"]


def test_broken_extender_that_is_off_causes_no_warning():
    grid = edit_grid()
    add(grid, [6, 8])
    delete_vertices(grid, [8])
    grid.data.spectral_shapes[0].use = False
    assert resolved(grid) == ([], [])


def test_only_extenders_that_are_on_and_not_zero_act():
    grid = edit_grid()
    for pair in ([6, 8], [11, 13], [0, 4]):
        add(grid, pair)
    grid.data.spectral_shapes[0].use = False
    grid.data.spectral_shapes[1].strength = 0.0
    assert resolved(grid) == ([(0, 4, 1.0)], [])


def test_of_duplicated_vertices_the_original_counts():
    grid = edit_grid()
    add(grid, [6, 8])
    before = positions(grid)
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.duplicate_move(TRANSFORM_OT_translate={"value": (0.0, 0.0, 5.0)})
    assert len(scenes.edit_mesh(grid).verts) == 40
    assert positions(grid) == before
    # A duplicate is a vertex of its own.
    add(grid, [6, 26])
    assert pairs(grid) == [(6, 8), (6, 26)]


def test_broken_extender_never_finds_another_vertex():
    grid = edit_grid()
    add(grid, [6, 8])
    delete_vertices(grid, [8])
    add(grid, [0, 1])
    assert pairs(grid) == [(6, -1), (0, 1)]


def test_after_removing_the_one_before_is_active():
    grid = edit_grid()
    for first in (0, 2, 4, 6):
        add(grid, [first, first + 1])

    def active():
        extenders, index = grid.data.spectral_shapes, grid.data.spectral_shapes_active
        return extenders[index].name if index < len(extenders) else None

    grid.data.spectral_shapes_active = 2
    bpy.ops.uv.spectral_shape_remove()
    assert [name for name, _, _ in listed(grid)] == ["Push/Pull", "Push/Pull.001", "Push/Pull.003"]
    assert active() == "Push/Pull.001"
    bpy.ops.uv.spectral_shape_remove()
    assert active() == "Push/Pull"
    bpy.ops.uv.spectral_shape_remove()
    assert active() == "Push/Pull.003"
    bpy.ops.uv.spectral_shape_remove()
    assert active() is None
    assert not bpy.ops.uv.spectral_shape_remove.poll()


def test_list_and_vertices_are_saved_with_the_file(tmp_path):
    grid = edit_grid()
    add(grid, [6, 8], strength=-3.0)
    add(grid, [2, 3])
    grid.data.spectral_shapes[1].use = False
    path = str(tmp_path / "scene.blend")
    for in_edit_mode in (True, False):
        if not in_edit_mode:
            bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True)
        bpy.ops.wm.open_mainfile(filepath=path)
        grid = bpy.data.objects["Grid"]
        bpy.context.view_layer.objects.active = grid
        if bpy.context.mode != "EDIT_MESH":
            bpy.ops.object.mode_set(mode="EDIT")
        assert listed(grid) == [("Push/Pull", -3.0, True), ("Push/Pull.001", 1.0, False)]
        assert pairs(grid) == [(6, 8), (2, 3)]


def test_a_file_that_was_saved_in_edit_mode_is_followed(tmp_path, capfd):
    grid = edit_grid()
    add(grid, [6, 8])
    bpy.context.scene.spectral_unwrap_live = True
    path = str(tmp_path / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    # As Blender does by itself with a window.
    scenes.module("session").begin()
    mesh = bpy.data.meshes["Grid"]
    assert mesh.is_editmode
    assert scenes.module("edit_mesh.extenders").vertices(mesh) is not None
    assert scenes.module("session.edit_meshes").kept(mesh).seen is not None
    assert "Traceback" not in "".join(capfd.readouterr())


def test_copy_of_the_object_has_extenders_of_its_own():
    grid = edit_grid()
    add(grid, [6, 8])
    bpy.ops.object.mode_set(mode="OBJECT")
    copy = grid.copy()
    copy.data = grid.data.copy()
    bpy.context.collection.objects.link(copy)
    scenes.edit(copy, select=False)
    assert pairs(copy) == [(6, 8)]
    copy.data.spectral_shapes[0].strength = 7.0
    delete_vertices(copy, [6])
    assert pairs(copy) == [(-1, 7)]
    assert listed(grid) == [("Push/Pull", 1.0, True)]


def test_joined_objects_bring_their_extenders():
    one, other = scenes.grid(4, 3), scenes.grid(2, 2, name="Other", offset=(0.0, 0.0, 9.0))
    scenes.edit(one, select=False)
    add(one, [6, 8])
    before = positions(one)
    bpy.ops.object.mode_set(mode="OBJECT")
    scenes.edit(other, select=False)
    add(other, [0, 1], strength=4.0)
    before += positions(other)
    bpy.ops.object.mode_set(mode="OBJECT")
    scenes.edit(one, other)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.join()
    scenes.edit(one, select=False)
    assert [strength for _, strength, _ in listed(one)] == [1.0, 4.0]
    assert [(a[:2], b[:2]) for a, b in positions(one)] == [(a[:2], b[:2]) for a, b in before]
    one.data.spectral_shapes[0].strength = 2.0
    assert positions(one)[0] == before[0]


def test_new_names_are_free_ones_and_others_may_be_any():
    # Without a map, all halves are the same.
    grid = edit_grid(uv_map=False)
    for first in (0, 2):
        add(grid, [first, first + 1])
    first, second = grid.data.spectral_shapes
    assert (first.name, second.name) == ("Push/Pull", "Push/Pull.001")
    second.strength = 3.0
    first.name = second.name = "Nose"
    add(grid, [4, 5])
    assert [name for name, _, _ in listed(grid)] == ["Nose", "Nose", "Push/Pull"]
    # In all the same, they would be one layer.
    second.strength = 1.0
    assert listed(grid) == [("Nose", 1.0, True), ("Nose.001", 1.0, True), ("Push/Pull", 1.0, True)]
    assert pairs(grid) == [(0, 1), (2, 3), (4, 5)]


def test_strength_is_kept_within_bounds():
    grid = edit_grid()
    add(grid, [0, 1])
    extender = grid.data.spectral_shapes[0]
    extender.strength = 1e9
    assert extender.strength == 1e4
    extender.strength = -1e9
    assert extender.strength == -1e4


def test_vertices_without_a_visible_face_get_none(reports):
    grid = scenes.bumpy_grid()
    scenes.edit(grid)
    bm = scenes.edit_mesh(grid)
    wire = [bm.verts.new((5.0, 0.0, z)) for z in (0.0, 1.0)]
    bm.edges.new(wire)
    bm.verts.index_update()
    for pair in ([vertex.index for vertex in wire], [0, wire[1].index]):
        scenes.select_vertices(grid, pair)
        with pytest.raises(RuntimeError, match="Error: No visible face has these vertices; select others"):
            bpy.ops.uv.spectral_shape(kind="EXTENDER")
        assert len(grid.data.spectral_shapes) == 0


def layers(edited):
    return [a.name for a in edited.data.attributes if a.name.startswith(".spectral_extender")]


@pytest.mark.parametrize("mode", ["EDIT", "OBJECT"])
def test_the_layer_has_the_properties_in_its_name(mode):
    grid = edit_grid()
    add(grid, [2, 3], strength=-0.5)
    add(grid, [6, 8])
    bpy.ops.object.mode_set(mode=mode)
    other, extender = grid.data.spectral_shapes
    for change, value, use, name in (
        ("strength", 5.0, 1, "Push/Pull.001"),
        ("use", False, 0, "Push/Pull.001"),
        ("name", "Nose", 0, "Nose"),
        ("name", "Nose: left", 0, "Nose: left"),
    ):
        setattr(extender, change, value)
        own = f".spectral_extender:{use}:5@{scenes.half_of(extender):.3g}:{name}"
        assert layers(grid) == [f".spectral_extender:1:-0.5@{scenes.half_of(other):.3g}:Push/Pull", own]
    bpy.ops.object.mode_set(mode="EDIT")
    assert pairs(grid) == [(2, 3), (6, 8)]
    assert listed(grid) == [("Push/Pull", -0.5, True), ("Nose: left", 5.0, False)]


@pytest.mark.parametrize("character", ["ä", "推"])
@pytest.mark.parametrize("strength", [-1.2345, 10.0])
def test_long_names_are_cut_between_characters_and_found_again(character, strength):
    # Blender cuts names of layers, from 3.4 on after 63 bytes and in 5.0 after 255.
    grid = edit_grid()
    add(grid, [6, 8], strength=strength)
    extender = grid.data.spectral_shapes[0]
    extender.name = character * 200
    assert extender.name == character * len(extender.name)
    assert 200 > len(extender.name) >= 8
    bpy.context.view_layer.update()
    assert layers(grid) == [grid.data.spectral_shapes[0].layer]
    assert pairs(grid) == [(6, 8)]


def test_ends_can_be_read_from_scripts_in_object_mode():
    grid = edit_grid()
    add(grid, [6, 8])
    bpy.ops.object.mode_set(mode="OBJECT")
    values = [value.value for value in grid.data.attributes[grid.data.spectral_shapes[0].layer].data]
    assert (np.argmax(values), np.argmin(values)) == (6, 8)
    assert np.count_nonzero(values) == 2


def test_the_list_is_that_of_the_layers_after_undo():
    # What undo in edit mode does: it puts the layers back with their names, and leaves the properties.
    grid = edit_grid()
    mesh, session = grid.data, scenes.module("session")
    add(grid, [6, 8])
    add(grid, [2, 3], strength=-4.0)
    mesh.attributes[layers(grid)[0]].name = ".spectral_extender:0:2.5@0.2:Nose"
    session.begin()
    assert listed(grid) == [("Nose", 2.5, False), ("Push/Pull.001", -4.0, True)]
    assert mesh.spectral_shapes_active == 1
    mesh.attributes.remove(mesh.attributes[layers(grid)[1]])
    session.begin()
    assert listed(grid) == [("Nose", 2.5, False)]
    assert mesh.spectral_shapes_active == 0
    assert pairs(grid) == [(6, 8)]


def test_an_extender_goes_with_its_layer():
    grid = edit_grid()
    add(grid, [6, 8])
    add(grid, [2, 3])
    bpy.ops.object.mode_set(mode="OBJECT")
    grid.data.attributes.remove(grid.data.attributes[layers(grid)[0]])
    scenes.edit(grid, select=False)
    assert listed(grid) == [("Push/Pull.001", 1.0, True)]
    assert pairs(grid) == [(2, 3)]


def test_other_layers_are_left_alone():
    grid = edit_grid()
    add(grid, [6, 8])
    for name, kind, domain in (
        (".spectral_extender:1:1@0.2:Float", "FLOAT", "POINT"),
        (".spectral_extender:1:1@0.2:Face", "INT", "FACE"),
        (".spectral_extender:1:one@0.2:Word", "INT", "POINT"),
        ("Push/Pull", "INT", "POINT"),
    ):
        grid.data.attributes.new(name, kind, domain)
    bpy.context.view_layer.update()
    assert listed(grid) == [("Push/Pull", 1.0, True)]
    assert len(layers(grid)) == 4


def test_selection_in_the_uv_editor_counts_without_sync_selection():
    selection = scenes.module("edit_mesh.selection")
    grid = edit_grid()
    select(grid, range(20))
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    scenes.set_uv_flags(grid, np.isin(scenes.corner_vertices(grid), (6, 8)))

    class Context:
        area = type("Area", (), {"type": "IMAGE_EDITOR"})
        scene = bpy.context.scene
        objects_in_mode_unique_data = bpy.context.objects_in_mode_unique_data

    found = selection.selected(Context, grid.data)
    assert (found.vertices, found.active) == ([6, 8], None)


def test_vertices_are_known_as_the_mesh_is_edited():
    storage, grid = scenes.module("edit_mesh.extenders"), edit_grid()
    add(grid, [6, 8])
    bpy.context.view_layer.update()
    known = storage.vertices(grid.data)
    assert [vertex.index for vertex in known[0]] == [6, 8]
    assert storage.vertices(grid.data) is known
    grid.data.spectral_shapes[0].strength = -2.0
    assert storage.vertices(grid.data) is known
    delete_vertices(grid, [0])
    assert [vertex.index for vertex in storage.vertices(grid.data)[0]] == [5, 7]
    bpy.ops.object.mode_set(mode="OBJECT")
    assert storage.vertices(grid.data) is None


def test_vertices_of_another_extender_with_the_same_layer_are_its_own():
    storage, grid = scenes.module("edit_mesh.extenders"), edit_grid(uv_map=False)
    add(grid, [6, 8], amount=50.0)
    former = grid.data.spectral_shapes[0].layer
    assert [vertex.index for vertex in storage.vertices(grid.data)[0]] == [6, 8]
    assert bpy.ops.uv.spectral_shape_remove() == {"FINISHED"}
    add(grid, [2, 3], amount=50.0)
    assert grid.data.spectral_shapes[0].layer == former
    assert [vertex.index for vertex in storage.vertices(grid.data)[0]] == [2, 3]


def test_arrows_of_meshes_in_edit_mode(monkeypatch):
    drawing = scenes.module("overlay.extender_arrows")
    monkeypatch.setattr(drawing, "_on_screen", lambda _context, _object, vertex: [vertex.co.xy])
    one, other = scenes.grid(4, 3), scenes.grid(2, 2, name="Other")
    scenes.edit(one, other, select=False)
    add(one, [6, 8], strength=-1.0)
    select(one, [])
    add(other, [0, 1])
    select(other, [])
    add(one, [2, 3])
    add(one, [4, 9])
    one.data.spectral_shapes[1].use = False
    delete_vertices(one, [9])
    one.data.spectral_shapes_active = 0
    arrows = drawing._arrows(bpy.context)
    assert [arrow[2] for arrow in arrows] == [True, True, False]
    # The active one is last.
    np.testing.assert_allclose(arrows[-1][:2], [(1.0, 1.0), (3.0, 1.0)])
    opaque = sorted(arrow[3][3] for arrow in arrows)
    assert opaque[0] < opaque[1] == opaque[2]


def test_uv_editor_connects_the_nearest_copies():
    drawing = scenes.module("overlay.extender_arrows")
    cube = scenes.cube(all_seams=True)
    scenes.edit(cube, select=False)
    add(cube, [0, 7])
    bpy.context.view_layer.update()
    uv = scenes.read_uv(cube)
    first, second = (uv[scenes.corner_vertices(cube) == v] for v in (0, 7))

    class View:
        view_to_region = staticmethod(lambda u, v, clip: (u, v))

    class Context:
        region = type("Region", (), {"view2d": View})
        space_data = type("Space", (), {"type": "IMAGE_EDITOR"})
        objects_in_mode_unique_data = bpy.context.objects_in_mode_unique_data
        edit_object = bpy.context.edit_object

    ((a, b, *_),) = drawing._arrows(Context)
    nearest = np.linalg.norm(first[:, None] - second[None], axis=2).min()
    assert np.linalg.norm(np.subtract(a, b)) == pytest.approx(nearest)


EXTENDERS = [
    ("Extender", 1.0, True, 0.2),
    ("No", -2.5, False, 2.78),
    ("with: colons\nand lines", 1e4, True, 0.2),
    ("Drücken 推", float(np.float32(0.1)), True, 1e-3),
    ("1:2:3", 1e-30, False, 999.0),
]


@pytest.mark.parametrize("extender", EXTENDERS)
def test_names_of_layers_hold_all_of_an_extender(extender):
    shapes = scenes.module("edit_mesh.shapes")
    name, strength, use, half = extender
    layer = shapes.layer_name(shapes.Shape(name=name, strength=strength, use=use, half=half))
    found = shapes.of_layer(layer)
    assert (found.name, np.float32(found.strength), found.use, found.half) == (name, np.float32(strength), use, half)
    assert shapes.layer_name(found) == layer


@pytest.mark.parametrize(
    ("strength", "kept"), [(math.nan, 0.0), (math.inf, 1e4), (-math.inf, -1e4), (1.1e4, 1e4), (-1e38, -1e4)]
)
def test_a_strength_in_a_name_is_a_number_within_its_limits(strength, kept):
    shapes = scenes.module("edit_mesh.shapes")
    layer = shapes.layer_name(shapes.Shape(name="Nose", strength=strength))
    assert shapes.of_layer(layer) == shapes.Shape(name="Nose", strength=kept)


@pytest.mark.parametrize("kind", ["STRAIGHT", "RECTANGLE", "GRID", "SYMMETRIC"])
def test_names_of_layers_hold_all_of_a_constraint(kind):
    shapes = scenes.module("edit_mesh.shapes")
    shape = shapes.Shape(kind, use=False, number=12, angle=-33.25, spacing=2)
    layer = shapes.layer_name(shape)
    assert layer == f".spectral_constraint:{kind}:12:0:-33.25:2"
    assert shapes.of_layer(layer) == shapes.of_layer(f"{layer}.001") == shape


@pytest.mark.parametrize(
    "name",
    [
        "",
        "Attribute",
        ".spectral_extenders:8f01",
        ".spectral_constraint:ROUND:1:1:0:0",
        ".spectral_constraint:GRID:1:1:0",
        ".spectral_extender:",
        ".spectral_extender:1:x",
    ]
    + [
        f".spectral_extender:1:{number}:x"
        for number in (*(f"{wrong}@0.2" for wrong in ("", "1e", "--1", "one", "nan", "inf", "1e5")), "1", "1@", "1@0")
        + ("1@nan", "1@2@3")
    ],
)
def test_other_layers_are_no_extenders(name):
    assert scenes.module("edit_mesh.shapes").of_layer(name) is None
