# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders, hole rigidity, the blend from angles to areas and stretching, in the operator."""

import bmesh
import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes


def select(edited, elements):
    """Add vertices or edges to the selection history, the last one active; the selected faces stay."""
    bm = scenes.edit_mesh(edited)
    bm.select_history.clear()
    for element in elements(bm):
        element.select = True
        bm.select_history.add(element)
    bmesh.update_edit_mesh(edited.data)


def add_extender(edited, first, second, strength):
    """Add an extender, all faces being selected afterward."""
    bpy.context.tool_settings.mesh_select_mode = (True, False, False)
    bpy.ops.mesh.select_all(action="DESELECT")
    select(edited, lambda bm: [bm.verts[first], bm.verts[second]])
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER") == {"FINISHED"}
    edited.data.spectral_shapes[-1].strength = strength
    bpy.ops.mesh.select_all(action="SELECT")


def hill(columns=12, rows=10, height=4.0, **options):
    """A grid with a hill in it that is not in the middle, in edit mode."""
    new = scenes.grid(columns, rows, **options)
    for vertex in new.data.vertices:
        x, y, _ = vertex.co
        vertex.co.z = height * np.exp(-((x - 0.6 * columns) ** 2 + (y - 0.45 * rows) ** 2) / 8.0)
    scenes.edit(new)
    return new


def distance(edited, first, second):
    """Return how far apart two vertices are in the map, relative to its size."""
    uv = scenes.read_uv(edited)
    places = [np.flatnonzero(scenes.corner_vertices(edited) == vertex)[0] for vertex in (first, second)]
    return np.linalg.norm(np.subtract(*uv[places])) / np.sqrt(area(edited))


def area(edited):
    """Return the area of the map."""
    uv = scenes.read_uv(edited).reshape(-1, 4, 2)
    following = np.roll(uv, -1, axis=1)
    return np.abs((uv[..., 0] * following[..., 1] - uv[..., 1] * following[..., 0]).sum(axis=1)).sum() / 2.0


def warnings(reports):
    return [text for level, text in reports() if level == "Warning"]


def test_extenders_without_effect_are_told_where_they_were_meant(reports):
    grid = hill()
    add_extender(grid, 0, 140, 3.0)
    for edge in scenes.edit_mesh(grid).edges:
        edge.seam = all(vertex.co.x == 6.0 for vertex in edge.verts)
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert [text for text in warnings(reports) if "1 push/pull had no effect" in text]
    # Nobody meant it where neither vertex is unwrapped.
    middle = [f.index for f in scenes.edit_mesh(grid).faces if 2.0 < f.calc_center_median().y < 5.0]
    scenes.select_faces(grid, middle)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert warnings(reports) == []


def test_extenders_act_on_the_subdivided_mesh():
    grid = hill()
    grid.modifiers.new("Subdivision", "SUBSURF")
    assert bpy.ops.uv.spectral_unwrap(use_subsurf_data=True) == {"FINISHED"}
    before = distance(grid, 1, 140)
    add_extender(grid, 1, 140, 5.0)
    assert bpy.ops.uv.spectral_unwrap(use_subsurf_data=True) == {"FINISHED"}
    assert distance(grid, 1, 140) > before + 1e-4


@pytest.mark.parametrize("subdivide", [True, False])
def test_adjusting_tells_that_it_does_not_subdivide(reports, monkeypatch, subdivide):
    grid = hill()
    grid.modifiers.new("Subdivision", "SUBSURF")
    add_extender(grid, 1, 140, 1.0)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    settings = scenes.module("core.solve.options").Settings(use_subsurf=subdivide)
    monkeypatch.setattr(scenes.module("operators.extender"), "settings_for", lambda _operator: settings)
    reports()
    assert bpy.ops.uv.spectral_extender(amount=75.0) == {"FINISHED"}
    assert any("ignores the Subdivision Surface" in text for _, text in reports()) == subdivide


def test_adjusting_sets_the_strength_and_keeps_place_and_size():
    grid = hill()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    add_extender(grid, 1, 140, 0.0)
    before, former_area, state = scenes.read_uv(grid), area(grid), scenes.state(grid)
    assert bpy.ops.uv.spectral_extender(amount=90.0) == {"FINISHED"}
    assert grid.data.spectral_shapes[0].amount == pytest.approx(90.0)
    assert scenes.state(grid) == state
    adjusted = scenes.read_uv(grid)
    assert not np.allclose(adjusted, before, atol=1e-3)
    assert area(grid) == pytest.approx(former_area, rel=1e-5)
    np.testing.assert_allclose(adjusted.mean(axis=0), before.mean(axis=0), atol=1e-5)
    stretched = distance(grid, 1, 140)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert distance(grid, 1, 140) == pytest.approx(stretched, abs=1e-5)
    # Back at no strength the map is what it was.
    scenes.write_uv(grid, adjusted)
    assert bpy.ops.uv.spectral_extender(amount=0.0) == {"FINISHED"}
    np.testing.assert_allclose(scenes.read_uv(grid), before, atol=1e-4)


def test_adjusting_leaves_other_islands_and_hidden_faces_alone():
    grid = hill()
    for edge in scenes.edit_mesh(grid).edges:
        edge.seam = all(vertex.co.x == 4.0 for vertex in edge.verts)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    add_extender(grid, 10, 140, 0.0)
    faces = scenes.edit_mesh(grid).faces
    left = scenes.corners_of(grid, [f.index for f in faces if f.calc_center_median().x < 4.0])
    before = scenes.read_uv(grid)
    assert bpy.ops.uv.spectral_extender(amount=90.0) == {"FINISHED"}
    after = scenes.read_uv(grid)
    np.testing.assert_array_equal(after[left], before[left])
    assert np.abs(after[~left] - before[~left]).max() > 1e-3


def test_adjusting_what_cannot_be_adjusted_changes_nothing(reports):
    grid = hill()
    add_extender(grid, 0, 140, 1.0)
    for edge in scenes.edit_mesh(grid).edges:
        edge.seam = all(vertex.co.x == 6.0 for vertex in edge.verts)
    before = scenes.read_uv(grid)
    with pytest.raises(RuntimeError, match="vertices lie in different islands"):
        bpy.ops.uv.spectral_extender(amount=75.0)
    grid.data.spectral_shapes_active = 7
    with pytest.raises(RuntimeError, match="no such entry"):
        bpy.ops.uv.spectral_extender()
    assert grid.data.spectral_shapes[0].strength == 1.0
    np.testing.assert_array_equal(scenes.read_uv(grid), before)


def test_adjusting_a_mesh_without_map_asks_for_one():
    grid = hill(uv_map=False)
    add_extender(grid, 1, 140, 1.0)
    with pytest.raises(RuntimeError, match="UV map"):
        bpy.ops.uv.spectral_extender(amount=75.0)
    assert not grid.data.uv_layers
    assert grid.data.spectral_shapes[0].strength == 1.0


def torn_hat():
    """A lopsided tube whose torn upper edge is the longest border, so that the lower one is a hole of the map."""
    torn = scenes.cylinder(24, 10, closed_seam=False)
    for vertex in torn.data.vertices:
        x, y, z = vertex.co
        radius = 1.0 - 0.325 * z
        is_peak = vertex.index >= 240 and vertex.index % 2
        vertex.co = (radius * x * (1.0 + 0.2 * x), radius * y, 0.25 * z + 0.25 * is_peak)
    scenes.edit(torn)
    return torn


# Properties of the operator, and the module's options that they stand for.
PROPERTIES = [
    ({}, {}),
    ({"automatic_hole_rigidity": False}, {"hole_rigidity": 0.0}),
    ({"hole_rigidity": 0.2}, {"hole_rigidity": 0.2}),
    ({"fill_holes": True}, {"fill_holes": True}),
    ({"weights": "INVERSE_AREA"}, {"weights": "inverse_area"}),
    ({"boundary": "VERTEX"}, {"boundary": "vertex"}),
    ({"method": "LSCM"}, {"method": "lscm"}),
    ({"area_blend": 0.5}, {"area_blend": 0.5}),
    ({"polish": "OFF", "automatic_hole_rigidity": False}, {"polish": "off", "hole_rigidity": 0.0}),
]


def test_properties_reach_the_solver_and_only_uvs_change():
    torn = torn_hat()
    state = scenes.state(torn)
    expected = [scenes.normalized(scenes.directly_solved(torn, **options)) for _, options in PROPERTIES]
    for k, map_ in enumerate(expected):
        assert all(np.abs(map_ - other).max() > 1e-3 for other in expected[:k]), PROPERTIES[k]
    for (properties, _), map_ in zip(PROPERTIES, expected):
        assert bpy.ops.uv.spectral_unwrap(**properties) == {"FINISHED"}
        np.testing.assert_allclose(scenes.normalized(scenes.read_uv(torn)), map_, atol=1e-5, err_msg=str(properties))
        assert scenes.state(torn) == state


def test_stretching_goes_along_the_active_edge(reports):
    grid = scenes.grid(6, 4)
    scenes.edit(grid)
    edge_along_x = lambda bm: [e for e in bm.edges if abs(e.verts[0].co.x - e.verts[1].co.x) == 1.0][3:4]  # noqa: E731
    select(grid, edge_along_x)
    assert bpy.ops.uv.spectral_unwrap(stretch=2.0) == {"FINISHED"}
    width, height = np.sort(np.ptp(scenes.read_uv(grid), axis=0))[::-1]
    assert width / height == pytest.approx(2.0 * 6.0 / 4.0, rel=1e-5)
    assert warnings(reports) == []
    scenes.edit_mesh(grid).select_history.clear()
    assert bpy.ops.uv.spectral_unwrap(stretch=2.0) == {"FINISHED"}
    width, height = np.sort(np.ptp(scenes.read_uv(grid), axis=0))[::-1]
    assert width / height == pytest.approx(6.0 / 4.0, rel=1e-5)
    assert [text for text in warnings(reports) if "no edge is active" in text]
