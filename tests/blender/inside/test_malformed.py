# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged extenders in a file, and invalid settings: a clear message, no exception, nothing lost."""

import sys

import bpy
import numpy as np
import pytest

from tests.blender.inside import digest, scenes

NAN, INF = float("nan"), float("inf")
WHOLE = ".spectral_extender:1:1@0.2:Whole"
# What a file may have in place of the list of layers.
LISTS = {
    "a number": 5,
    "a text": "extenders",
    "numbers": [1.0, 2.0],
    "a group": {"layer": "Group"},
    "wrong types": [{"layer": 3}],
    "groups inside": [{"layer": {"a": 1}}],
    "nothing inside": [{}],
    "another layer": [{"layer": "UVMap"}],
    "layer that is gone": [{"layer": WHOLE}, {"layer": f"{WHOLE}.001"}],
    "layer twice": [{"layer": WHOLE}, {"layer": WHOLE}],
}
PUSH, PULL = 1 << 23, -(1 << 23)
# Layers, with values at vertices.
LAYERS = {
    "strength NaN": {".spectral_extender:1:nan@0.2:Damaged": {1: PUSH, 20: PULL}},
    "strength infinite beside a whole one": {
        ".spectral_extender:1:inf@0.2:Damaged": {1: PUSH, 30: PULL},
        WHOLE: {1: PUSH, 20: PULL},
    },
    "half of zero": {".spectral_extender:1:1@0:Damaged": {1: PUSH, 20: PULL}},
    "no vertex": {WHOLE: {}},
    "one vertex": {WHOLE: {1: PUSH}},
    "other values": {WHOLE: {1: 5, 20: PULL + 1}},
    "many vertices": {WHOLE: dict.fromkeys(range(1, 20), PUSH) | dict.fromkeys(range(20, 40), PULL)},
}
OPERATORS = {
    "unwrap": lambda: bpy.ops.uv.spectral_unwrap(),
    "adjust": lambda: bpy.ops.uv.spectral_extender(amount=60.0),
    "adjust to NaN": lambda: bpy.ops.uv.spectral_extender(amount=NAN),
    "remove": lambda: bpy.ops.uv.spectral_shape_remove(),
    "unwrap again": lambda: bpy.ops.uv.spectral_unwrap(),
}


def stored(block):
    """Return where this Blender stores the properties of add-ons, to write arbitrary values there."""
    if hasattr(block, "bl_system_properties_get"):
        return block.bl_system_properties_get(do_create=True)
    return block


def add_layers(mesh, layers):
    for name, values in layers.items():
        attribute = mesh.attributes.new(name, "INT", "POINT")
        for vertex, value in values.items():
            attribute.data[vertex].value = value


def damaged(layers, listed=None):
    grid = scenes.bumpy_grid(8, 6)
    add_layers(grid.data, layers)
    if listed is not None:
        stored(grid.data)["spectral_shapes"] = listed
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
        if not name.startswith("unwrap") and not bpy.ops.uv.spectral_shape_remove.poll():
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


@pytest.mark.parametrize("name", LISTS)
def test_a_damaged_list_is_that_of_the_layers(name):
    grid = damaged({WHOLE: {1: PUSH, 20: PULL}}, LISTS[name])
    assert [(e.name, e.strength, e.layer) for e in grid.data.spectral_shapes] == [("Whole", 1.0, WHOLE)]
    statuses = run_all(grid)
    assert statuses["unwrap"] == statuses["adjust"] == statuses["unwrap again"] == {"FINISHED"}


@pytest.mark.parametrize("name", LAYERS)
def test_damaged_layers(name, reports):
    grid = damaged(LAYERS[name])
    reports()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    is_broken = name in {"no vertex", "one vertex", "other values"}
    expected = ["Skipped 1 push/pull that lost a vertex: Whole"] if is_broken else []
    assert [text for level, text in reports() if level == "Warning"] == expected
    run_all(grid)


def test_a_strength_that_is_none_is_zero():
    grid = damaged({WHOLE: {1: PUSH, 20: PULL}})
    grid.data.spectral_shapes[0].strength = NAN
    assert grid.data.spectral_shapes[0].strength == 0.0
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}


def test_whole_extender_acts_beside_a_damaged_one():
    maps = []
    whole = {WHOLE: {1: PUSH, 20: PULL}}
    for layers in (whole, {".spectral_extender:1:2@0.2:Damaged": {1: PUSH}, **whole, **LAYERS["strength NaN"]}):
        grid = damaged(layers)
        assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
        maps.append(scenes.read_uv(grid))
        bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_array_equal(*maps)


@pytest.mark.parametrize("index", [-5, 7, 2**31 - 1])
def test_damaged_index(index):
    grid = damaged({WHOLE: {1: PUSH, 20: PULL}})
    stored(grid.data)["spectral_shapes_active"] = index
    run_all(grid)


def test_damaged_extenders_survive_saving_and_loading(tmp_path):
    for number, value in enumerate(LISTS.values()):
        grid = scenes.bumpy_grid(8, 6, name=f"Grid {number}")
        add_layers(grid.data, {WHOLE: {1: PUSH, 20: PULL}})
        stored(grid.data)["spectral_shapes"] = value
    path = tmp_path / "damaged ümläut.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    assert len(bpy.data.objects) == len(LISTS)
    scenes.edit(*bpy.data.objects)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    for grid in bpy.data.objects:
        assert np.isfinite(scenes.read_uv(grid)).all()


NUMBERS = ("hole_rigidity", "area_blend", "stretch", "soft_pins", "margin")


@pytest.mark.parametrize("value", [NAN, INF, -INF, -5.0])
@pytest.mark.parametrize("name", NUMBERS)
def test_settings_that_are_no_numbers(name, value, reports):
    grid = scenes.bumpy_grid()
    scenes.edit(grid)
    # Two pins that a map can have, whatever their strength.
    scenes.pin(grid, [0, 40] if name == "soft_pins" else [])
    bm = scenes.edit_mesh(grid)
    bm.select_history.add(bm.edges[3])
    before, uv = digest.digest(), scenes.read_uv(grid)
    reports()
    status = status_of(lambda: bpy.ops.uv.spectral_unwrap(**{name: value}))
    assert digest.changes(before, digest.digest()) == []
    assert np.isfinite(scenes.read_uv(grid)).all()
    # Blender puts every other number within the limits.
    assert status == ({"CANCELLED"} if np.isnan(value) else {"FINISHED"})
    if np.isnan(value):
        np.testing.assert_array_equal(scenes.read_uv(grid), uv)
        assert [text for level, text in reports() if level != "Info"]


WITH_NUMBERS = [
    *("uv.spectral_new_textures", "uv.spectral_pack", "uv.spectral_extender"),
    *("uv.spectral_relax", "uv.spectral_select", "uv.spectral_density", "uv.spectral_shape"),
    *("uv.spectral_suggest_seams", "uv.spectral_unwrap"),
]


@pytest.mark.parametrize("identifier", WITH_NUMBERS)
def test_what_is_no_number_is_named_and_changes_nothing(identifier):
    grid = scenes.bumpy_grid()
    scenes.edit(grid)
    scenes.select_vertices(grid, (0, 20))
    bpy.ops.uv.spectral_shape(kind="EXTENDER")
    scenes.select_faces(grid, range(8))
    before, uv = digest.digest(), scenes.read_uv(grid)
    operator = getattr(bpy.ops.uv, identifier.removeprefix("uv."))
    kinds = {"uv.spectral_shape": {"kind": "EXTENDER"}, "uv.spectral_unwrap": {"keep_in_place": True}}
    for each in operator.get_rna_type().properties:
        if each.type == "FLOAT":
            value = [*each.default_array][:-1] + [NAN] if each.is_array else NAN
            with pytest.raises(RuntimeError, match=f"Error: {each.name} must be a number, not nan"):
                operator(**{**kinds.get(identifier, {}), each.identifier: value})
            assert digest.changes(before, digest.digest()) == []
            np.testing.assert_array_equal(scenes.read_uv(grid), uv)


SETTINGS = [
    *(("method", 99), ("method", -1), ("method", "spectral"), ("weights", 7), ("boundary", 5)),
    *(("keep_in_place", 8), ("hole_rigidity", NAN), ("stretch", NAN), ("soft_pins", NAN)),
]


@pytest.mark.parametrize(("name", "value"), SETTINGS)
def test_last_settings_of_another_version(name, value):
    """Settings stored by another version may have values that this version lacks."""
    box, grid = scenes.cube(name="Box"), scenes.bumpy_grid()
    scenes.edit(grid, box)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    scenes.select_vertices(box, ())
    scenes.select_vertices(grid, (0, 20))
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER") == {"FINISHED"}
    last = bpy.context.window_manager.operator_properties_last("uv.spectral_unwrap")
    stored(last)[name] = value
    bpy.context.scene.spectral_unwrap_live = True
    calls = (
        lambda: bpy.ops.uv.spectral_suggest_seams(),
        lambda: bpy.ops.uv.spectral_extender(amount=60.0),
        lambda: bpy.ops.uv.spectral_select(kind="FAILED"),
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
