# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged extenders in a file, and invalid settings: a clear message, no exception, nothing lost."""

import sys

import bpy
import numpy as np
import pytest

from tests.blender.inside import digest, scenes

NAN, INF = float("nan"), float("inf")
WHOLE = {"name": "Whole", "strength": 1.0, "use": True, "first_id": 1, "second_id": 20}
DAMAGED = {
    "a number": 5,
    "a text": "extenders",
    "numbers": [1.0, 2.0],
    "a group": {"name": "Group"},
    "wrong types": [{"name": 3, "strength": "much", "use": "yes", "first_id": "1", "second_id": [1, 2]}],
    "groups inside": [{"name": {"a": 1}, "strength": {"b": 2}}],
    "nothing inside": [{}],
    "strength NaN": [{**WHOLE, "strength": NAN}],
    "strength infinite": [{**WHOLE, "strength": INF}],
    "strength beyond its limit": [{**WHOLE, "strength": -1e38}],
    "huge identifiers": [{**WHOLE, "first_id": 2**31 - 1, "second_id": -(2**31)}],
    "identifiers twice": [WHOLE, WHOLE],
    "names twice": [WHOLE, {**WHOLE, "second_id": 30}],
    "one vertex twice": [{**WHOLE, "second_id": 1}],
    "one vertex twice, beside a whole one": [WHOLE, {**WHOLE, "second_id": 1}],
    "no vertex": [{**WHOLE, "first_id": 0, "second_id": 0}],
    "infinite beside a whole one": [WHOLE, {**WHOLE, "strength": INF, "second_id": 30}],
}
OPERATORS = {
    "unwrap": lambda: bpy.ops.uv.spectral_unwrap(),
    "adjust": lambda: bpy.ops.mesh.spectral_extender_adjust(strength=2.0),
    "adjust to NaN": lambda: bpy.ops.mesh.spectral_extender_adjust(strength=NAN),
    "remove broken": lambda: bpy.ops.mesh.spectral_extender_remove(broken=True),
    "remove": lambda: bpy.ops.mesh.spectral_extender_remove(),
    "unwrap again": lambda: bpy.ops.uv.spectral_unwrap(),
}


def stored(block):
    """Return where this Blender stores the properties of add-ons, to write arbitrary values there."""
    if hasattr(block, "bl_system_properties_get"):
        return block.bl_system_properties_get(do_create=True)
    return block


def layer_of(mesh, kind="INT", name=".spectral_extenders:damaged"):
    attribute = mesh.attributes.new(name, kind, "POINT")
    values = np.arange(len(mesh.vertices)).astype(np.int32 if kind == "INT" else np.float32)
    attribute.data.foreach_set("value", values)


def damaged(value):
    grid = scenes.bumpy_grid(8, 6)
    layer_of(grid.data)
    stored(grid.data)["spectral_extenders"] = value
    scenes.edit(grid)
    return grid


def status_of(call):
    """Call an operator; return its status. A reported error is a status, an exception is not."""
    try:
        return call()
    except RuntimeError as error:
        assert str(error).startswith("Error: "), error
        assert "Traceback" not in str(error)
        return {"CANCELLED"}


def run_all(edited):
    """Call all operators one after the other; return the status of each."""
    statuses = {}
    for name, call in OPERATORS.items():
        if not name.startswith("unwrap") and not bpy.ops.mesh.spectral_extender_remove.poll():
            continue
        if name.startswith("unwrap"):
            bpy.ops.mesh.select_all(action="SELECT")
        before, uv = digest.digest(), digest.active_uv(edited.data)
        statuses[name] = status_of(call)
        if statuses[name] == {"CANCELLED"}:
            assert digest.changes(before, digest.digest()) == [], name
            assert digest.active_uv(edited.data).tobytes() == uv.tobytes(), name
        assert np.isfinite(digest.active_uv(edited.data)).all(), name
    return statuses


@pytest.mark.parametrize("name", DAMAGED)
def test_damaged_extenders(name):
    statuses = run_all(damaged(DAMAGED[name]))
    assert statuses["unwrap"] == {"FINISHED"}
    assert statuses["unwrap again"] == {"FINISHED"}


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("one vertex twice", "Skipped 1 push/pull that lost a vertex: Whole"),
        ("huge identifiers", "Skipped 1 push/pull that lost a vertex: Whole"),
        ("nothing inside", "Skipped 1 push/pull that lost a vertex: Push/Pull"),
    ],
)
def test_damaged_extenders_are_named(name, message, reports):
    damaged(DAMAGED[name])
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    assert [text for level, text in reports() if level == "Warning"] == [message]


@pytest.mark.parametrize("name", ["strength NaN", "strength infinite", "strength beyond its limit"])
def test_a_strength_that_is_none_is_shown_as_zero(name):
    grid = damaged(DAMAGED[name])
    assert [(e.name, e.strength) for e in grid.data.spectral_extenders] == [("Whole", 0.0)]
    grid.data.spectral_extenders[0].strength = NAN
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}


def test_whole_extender_acts_beside_a_damaged_one():
    maps = []
    for value in ([WHOLE], [{**WHOLE, "second_id": 1}, WHOLE, {**WHOLE, "strength": NAN}]):
        grid = damaged(value)
        assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
        maps.append(scenes.read_uv(grid))
        bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_array_equal(*maps)


@pytest.mark.parametrize("index", [-5, 7, 2**31 - 1])
@pytest.mark.parametrize("layer", ["", "nowhere", "UVMap", ".spectral_extenders:other"])
def test_damaged_index_and_layer_name(index, layer):
    grid = damaged([WHOLE])
    stored(grid.data)["spectral_extenders_active"] = index
    stored(grid.data)["spectral_extenders_layer"] = layer
    run_all(grid)


def test_layer_of_another_type_is_left_alone():
    grid = scenes.bumpy_grid(8, 6)
    layer_of(grid.data, "FLOAT", ".spectral_extenders:0")
    layer_of(grid.data)
    stored(grid.data)["spectral_extenders"] = [WHOLE]
    scenes.edit(grid)
    assert bpy.ops.mesh.spectral_extender_adjust(strength=2.0) == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    kinds = {a.name: a.data_type for a in grid.data.attributes if a.name.startswith(".spectral_extender")}
    assert kinds == {".spectral_extenders:0": "FLOAT", ".spectral_extender:1:2:Whole": "INT"}


def test_damaged_extenders_survive_saving_and_loading(tmp_path):
    for number, value in enumerate(DAMAGED.values()):
        grid = scenes.bumpy_grid(8, 6, name=f"Grid {number}")
        layer_of(grid.data)
        stored(grid.data)["spectral_extenders"] = value
    path = tmp_path / "damaged ümläut.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    assert len(bpy.data.objects) == len(DAMAGED)
    scenes.edit(*bpy.data.objects)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    for grid in bpy.data.objects:
        assert np.isfinite(scenes.read_uv(grid)).all()


NUMBERS = ("hole_rigidity", "area_blend", "stretch", "soft_pin_strength", "margin")


@pytest.mark.parametrize("value", [NAN, INF, -INF, -5.0])
@pytest.mark.parametrize("name", NUMBERS)
def test_settings_that_are_no_numbers(name, value, reports):
    grid = scenes.bumpy_grid()
    scenes.edit(grid)
    # Two pins that a map can have, whatever their strength.
    scenes.pin(grid, [0, 40] if name == "soft_pin_strength" else [])
    bm = scenes.edit_mesh(grid)
    bm.select_history.add(bm.edges[3])
    before, uv = digest.digest(), scenes.read_uv(grid)
    reports()
    status = status_of(lambda: bpy.ops.uv.spectral_unwrap(soft_pins=True, **{name: value}))
    assert digest.changes(before, digest.digest()) == []
    assert np.isfinite(scenes.read_uv(grid)).all()
    # Blender puts every other number within the limits.
    assert status == ({"CANCELLED"} if np.isnan(value) else {"FINISHED"})
    if np.isnan(value):
        np.testing.assert_array_equal(scenes.read_uv(grid), uv)
        assert [text for level, text in reports() if level != "Info"]


def test_extender_without_a_strength_is_not_added():
    grid = scenes.bumpy_grid()
    scenes.edit(grid)
    for vertex in scenes.edit_mesh(grid).verts:
        vertex.select_set(vertex.index in (0, 20))
    with pytest.raises(RuntimeError, match="Error: The strength must be a number, not nan"):
        bpy.ops.mesh.spectral_extender_add(strength=NAN)
    assert len(grid.data.spectral_extenders) == 0


SETTINGS = [
    *(("method", 99), ("method", -1), ("method", "spectral"), ("weights", 7), ("boundary", 5)),
    *(("margin_method", 9), ("placement", 8), ("hole_rigidity", NAN), ("stretch", NAN), ("margin", NAN)),
]


@pytest.mark.parametrize(("name", "value"), SETTINGS)
def test_last_settings_of_another_version(name, value):
    """Settings stored by another version may have values that this version lacks."""
    box, grid = scenes.cube(name="Box"), scenes.bumpy_grid()
    scenes.edit(grid, box)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    for edited in (box, grid):
        for vertex in scenes.edit_mesh(edited).verts:
            vertex.select_set(edited == grid and vertex.index in (0, 20))
    assert bpy.ops.mesh.spectral_extender_add() == {"FINISHED"}
    last = bpy.context.window_manager.operator_properties_last("uv.spectral_unwrap")
    stored(last)[name] = value
    bpy.context.scene.spectral_unwrap_live = True
    calls = (
        lambda: bpy.ops.uv.spectral_suggest_seams(),
        lambda: bpy.ops.mesh.spectral_extender_adjust(strength=2.0),
        lambda: bpy.ops.uv.spectral_select_failed(),
    )
    bpy.ops.mesh.select_all(action="SELECT")
    for call in calls:
        before = digest.digest()
        if status_of(call) == {"CANCELLED"}:
            assert digest.changes(before, digest.digest()) == []
        for edited in (box, grid):
            assert np.isfinite(scenes.read_uv(edited)).all()
    sys.modules["spectral_unwrap.live.following"].look()
    assert np.isfinite(scenes.read_uv(grid)).all()
