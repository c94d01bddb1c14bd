# SPDX-License-Identifier: GPL-3.0-or-later
"""The islands of Last Result: those that the map has now, whoever has unwrapped it, and whatever the mesh is called."""

import importlib

import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes
from tests.blender.inside.test_control import add_extender, hill
from tests.blender.inside.test_live_unwrap import bumpy_grid, mark_seams

texts = importlib.import_module("spectral_unwrap.core.words.texts")
options = importlib.import_module("spectral_unwrap.core.solve.options")
handlers = importlib.import_module("spectral_unwrap.handlers")
following = importlib.import_module("spectral_unwrap.live.following")
island_list = importlib.import_module("spectral_unwrap.unwrapping.island_list")
read_map = importlib.import_module("spectral_unwrap.edit_mesh.read_map")
map_view = importlib.import_module("spectral_unwrap.core.measure.map_view")

# Across the grid of 8 x 6 faces, its columns 0 to 3 on one side.
ACROSS = [(4 + 9 * row, 4 + 9 * (row + 1)) for row in range(6)]
LEFT = {face for face in range(48) if face % 8 < 4}


def rows():
    return [row.name for row in bpy.context.window_manager.spectral_islands]


def click(index):
    """Click a row; return the faces selected then, by the name of their object."""
    bpy.context.window_manager.spectral_islands_active = index
    return {
        edited.name: {face.index for face in scenes.edit_mesh(edited).faces if face.select}
        for edited in bpy.context.objects_in_mode_unique_data
    }


def says_gone():
    return ("WARNING", texts.ISLAND_GONE) in island_list.lines()


def unwrapped_grid():
    grid = bumpy_grid()
    scenes.edit(grid)
    bpy.context.scene.spectral_unwrap_live = True
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    return grid


def let_live_place(monkeypatch, keep_in_place):
    """Set where live unwrapping places islands: background mode does not remember settings by itself."""
    settings = options.Settings(keep_in_place=keep_in_place)
    monkeypatch.setattr(following, "last_settings", lambda: settings)


@pytest.mark.parametrize("keep_in_place", [False, True])
def test_islands_that_live_unwrapping_has_split_are_listed(keep_in_place, monkeypatch):
    let_live_place(monkeypatch, keep_in_place)
    grid = unwrapped_grid()
    assert len(rows()) == 1
    mark_seams(grid, ACROSS)
    following.look()
    assert len(rows()) == 2
    assert {frozenset(click(index)[grid.name]) for index in range(2)} == {
        frozenset(LEFT),
        frozenset(set(range(48)) - LEFT),
    }
    assert any("Unwrapped 2 islands" in text for _, text in island_list.lines())
    assert not says_gone()


def test_islands_that_live_unwrapping_leaves_stay_in_the_list(monkeypatch):
    let_live_place(monkeypatch, keep_in_place=True)
    grid = unwrapped_grid()
    mark_seams(grid, ACROSS)
    following.look()
    # The left island alone is split, between its rows 2 and 3.
    mark_seams(grid, [(27 + column, 28 + column) for column in range(4)])
    following.look()
    found = {frozenset(click(index)[grid.name]) for index in range(len(rows()))}
    lower = frozenset(face for face in LEFT if face < 24)
    assert found == {lower, frozenset(LEFT) - lower, frozenset(set(range(48)) - LEFT)}


def test_islands_that_undo_has_joined_again_are_gone():
    grid = unwrapped_grid()
    whole = scenes.read_uv(grid)
    mark_seams(grid, ACROSS)
    following.look()
    bpy.context.scene.spectral_unwrap_live = False
    # As undo does.
    mark_seams(grid, ACROSS, seam=False)
    scenes.write_uv(grid, whole)
    before = click(-1)
    assert click(0) == before
    assert says_gone()


def test_a_result_that_is_undone_is_hidden_until_redo():
    grid = bumpy_grid()
    scenes.edit(grid)
    before = scenes.read_uv(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    after, lines = scenes.read_uv(grid), island_list.lines()
    assert lines and rows()
    # As undo and redo do.
    for uv, is_shown in ((after * 0.5, True), (before, False), (after, True), (after + 1.0, True)):
        handlers._before_undo()
        scenes.write_uv(grid, uv.tolist())
        handlers._after_undo()
        assert island_list.lines() == (lines if is_shown else [])
        assert bool(rows()) == is_shown


def test_islands_are_those_of_the_map_until_it_is_unwrapped_again():
    grid = unwrapped_grid()
    bpy.context.scene.spectral_unwrap_live = False
    mark_seams(grid, ACROSS)
    # The next seam is looked for in the map as it is.
    assert click(0)[grid.name] == set(range(48))
    assert not says_gone()
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.unwrap(method="CONFORMAL")
    scenes.select_faces(grid, [])
    assert click(-1) == click(0)
    assert says_gone()


def test_a_renamed_mesh_is_the_same():
    grid = unwrapped_grid()
    grid.data.name = "Renamed"
    assert click(0)[grid.name] == set(range(48))
    assert not says_gone()
    bpy.data.meshes.new("Another").name = "Grid"
    assert click(-1) is not None
    assert click(0)[grid.name] == set(range(48))


def test_of_two_meshes_that_change_names_each_stays_itself():
    objects = [scenes.grid(2, 2, name=name) for name in ("First", "Second")]
    scenes.edit(*objects)
    for edited, offset in zip(objects, (0.0, 0.5)):
        scenes.edit_mesh(edited).verts[4].co.z = 0.2 + offset
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    distorted = scenes.edit_mesh(objects[1])
    first, second = (each.data for each in objects)
    first.name, second.name, first.name = "Third", "First", "Second"
    assert {face.index for face in distorted.faces} == click(0)["Second"], "the worst is of the second object"
    assert click(0)["First"] == set()


def test_failed_islands_of_a_renamed_mesh_are_remembered():
    cube = scenes.cube()
    scenes.edit(cube)
    assert bpy.ops.uv.spectral_unwrap() == {"CANCELLED"}
    cube.data.name = "Renamed"
    bpy.ops.mesh.select_all(action="DESELECT")
    assert bpy.ops.uv.spectral_select(kind="FAILED") == {"FINISHED"}
    assert len([face for face in scenes.edit_mesh(cube).faces if face.select]) == 6


def test_an_extender_that_changes_changes_the_numbers():
    grid = hill()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    before = rows()
    add_extender(grid, 1, 140, 1.0)
    assert bpy.ops.uv.spectral_extender(amount=90.0) == {"FINISHED"}
    (row,) = rows()
    assert row != before[0]
    view = map_view.MapView(read_map.read_map(bpy.context, grid))
    assert row.startswith(texts.island_row(view.numbers().faces, view.numbers().mean_qc, view.numbers().max_qc, 0, 0))


@pytest.mark.parametrize("shape", ["grid", "monkey"])
def test_list_report_and_legend_have_one_worst(shape, reports):
    if shape == "grid":
        edited = bumpy_grid()
    else:
        bpy.ops.mesh.primitive_monkey_add()
        edited = bpy.context.object
    scenes.edit(edited)
    reports()
    bpy.ops.uv.spectral_unwrap()
    view = map_view.MapView(read_map.read_map(bpy.context, edited))
    ((_, text),) = [pair for pair in reports() if pair[1].startswith("Unwrapped")]
    _, angles, *_ = texts.legend_numbers(texts.LEGEND_MESH, view.numbers())
    mean, worst = angles.removeprefix("Angles off ").split(", worst ")
    assert f"angles off by {mean} on average, {worst} at worst" in text, (angles, text)
    legend, worst = float(worst.split()[0]), max(float(row.split("/")[1].split()[0]) for row in rows())
    assert legend == worst, (angles, rows())
    assert np.isclose(100.0 * (view.qc.max() - 1.0), worst, atol=0.6)


def test_an_island_of_a_subdivided_mesh_has_the_faces_of_the_mesh():
    grid = scenes.bumpy_grid(8, 6)
    grid.modifiers.new("Subdivision", "SUBSURF").levels = 1
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap(use_subsurf_data=True) == {"FINISHED"}
    (row,) = rows()
    assert "48 f." in row
    assert click(0) == {grid.name: set(range(48))}
