# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on in Blender's lists: operator, properties, menus; and nothing left when it is disabled."""

import fnmatch
import importlib
import inspect
import re
import sys
import types
from pathlib import Path

import bpy  # isort: skip - makes addon_utils importable
import addon_utils
import numpy as np
import pytest

from tests.blender.inside import scenes

ADDON = "spectral_unwrap"
MENUS = (
    *("VIEW3D_MT_uv_map", "IMAGE_MT_uvs_unwrap", "IMAGE_MT_uvs", "VIEW3D_MT_edit_mesh_edges"),
    *("IMAGE_MT_select", "VIEW3D_MT_edit_mesh_select_by_trait", "VIEW3D_MT_object"),
)


def _entries():
    """Return which of the menus hold a draw function of the add-on."""
    return [
        name
        for name in MENUS
        if any(draw.__module__.startswith(ADDON) for draw in getattr(getattr(bpy.types, name).draw, "_draw_funcs", []))
    ]


# What scripts may give each operator, with its default; the defaults of Spectral Unwrap are the core's.
OPERATORS = {
    "spectral_unwrap": (
        "Spectral Unwrap",
        dict.fromkeys(
            (
                *("method", "weights", "boundary", "fill_holes", "use_subsurf_data", "soft_pins", "blend"),
                *("polish", "correct_aspect", "keep_in_place", "margin", "texture_size"),
                *("hole_rigidity", "area_blend", "stretch", "hold_rest", "fold_free", "straighten"),
                *("automatic_hole_rigidity", "rotation", "show_advanced"),
            ),
        ),
    ),
    "spectral_suggest_seams": (
        "Suggest Seams",
        {
            "sharp_angle": pytest.approx(np.radians(30.0)),
            "style": "AUTO",
            "scale_limit": 1.25,
            "angle_distortion": pytest.approx(10.0),
            "longest_side": 1.75,
            "max_length": 0.0,
            "keep_front": 0.5,
            "seam_group": "",
            "seam_group_use": "AVOID",
            "cuts": 0,
            "unwrap": True,
        },
    ),
    "spectral_new_textures": (
        "New UV Map and Textures",
        {"margin": 4.0, "texture_size": 0, "rotation": "SQUARE", "size": "SAME"},
    ),
    **dict.fromkeys(("spectral_select", "spectral_shape", "spectral_extender", "spectral_shape_remove"), ("", {})),
}


@pytest.mark.parametrize("identifier", OPERATORS)
def test_operators_are_described_as_blender_does(identifier):
    label, defaults = OPERATORS[identifier]
    operator = getattr(bpy.ops.uv, identifier).get_rna_type()
    properties = {prop.identifier: prop for prop in operator.properties if prop.identifier != "rna_type"}
    if label:
        assert operator.name == label
        assert set(properties) == set(defaults)
    assert {name: properties[name].default for name, default in defaults.items() if default is not None} == {
        name: default for name, default in defaults.items() if default is not None
    }
    items = [item for prop in properties.values() for item in getattr(prop, "enum_items", ())]
    for item in (operator, *properties.values(), *items):
        assert item.description
        assert not item.description.endswith(".")


@pytest.mark.parametrize(
    ("identifier", "property_name", "chosen"),
    [
        ("uv.spectral_select", "kind", "FLIPPED"),
        ("uv.spectral_shape", "kind", "GRID"),
        ("uv.spectral_density", "kind", "EQUAL"),
        ("mesh.spectral_seam_hint", "hint", "NEVER"),
        ("uv.spectral_relax", "border", "HELD"),
    ],
)
def test_a_button_is_described_by_its_item(identifier, property_name, chosen):
    last = bpy.context.window_manager.operator_properties_last(identifier)
    before = getattr(last, property_name)
    setattr(last, property_name, chosen)
    try:
        prefix, name = identifier.split(".")
        said = getattr(bpy.types, f"{prefix.upper()}_OT_{name}").description(bpy.context, last)
        # Blender shows the operator's own description where nothing is said.
        expected = last.bl_rna.properties[property_name].enum_items[chosen].description
        assert said == ("" if identifier == "uv.spectral_relax" else expected)
    finally:
        setattr(last, property_name, before)


def test_defaults_are_those_of_the_core_and_of_blenders_own_operator():
    settings = importlib.import_module("spectral_unwrap.unwrapping.last_settings")
    ours, theirs = bpy.ops.uv.spectral_unwrap.get_rna_type(), bpy.ops.uv.unwrap.get_rna_type()
    defaults = {prop.identifier: prop.default for prop in ours.properties if prop.identifier != "rna_type"}
    expected = settings.Settings()
    assert settings.settings_of(types.SimpleNamespace(**defaults), expected.margin, expected.rotation) == expected
    scene = bpy.context.scene
    assert scene.spectral_margin / scene.spectral_texture_size == expected.margin
    assert (defaults["margin"], defaults["rotation"]) == (scene.spectral_margin, scene.spectral_rotation)
    for name in ("correct_aspect", "use_subsurf_data"):
        assert defaults[name] == pytest.approx(theirs.properties[name].default)


def test_shared_properties_are_named_as_in_blenders_own_operator():
    ours, theirs = bpy.ops.uv.spectral_unwrap.get_rna_type(), bpy.ops.uv.unwrap.get_rna_type()
    for name in ("fill_holes", "correct_aspect", "use_subsurf_data"):
        ours_, theirs_ = ours.properties[name], theirs.properties[name]
        assert ours_.name == theirs_.name
        if theirs_.type == "ENUM":
            items = [[(item.identifier, item.name) for item in prop.enum_items] for prop in (ours_, theirs_)]
            assert items[0] == items[1]


# Properties of the four verbs that neither module nor commands have, or that stand for another quantity there.
IN_BLENDER_ALONE = {
    *("hold_rest", "keep_in_place", "automatic_hole_rigidity", "stretch", "use_subsurf_data", "correct_aspect"),
    *("show_advanced", "blend", "stacks", "groups", "hold_pinned", "tiles", "tile_count", "box", "sharp_angle"),
    *("angle_distortion", "keep_front", "seam_group", "seam_group_use", "cuts", "unwrap", "size", "steps"),
}


def test_one_thing_has_one_name():
    text = (Path(__file__).resolve().parents[3] / "docs" / "scripting.md").read_text()
    rows = re.findall(r"^\| `(\w+)` \| ([\w, ]+) \| ([\w`, ]+) \| (yes)? ?\| ([\w ]+) \|$", text, re.MULTILINE)
    sc = importlib.import_module("spectral_unwrap.core.native").spectral_conformal()
    settings = importlib.import_module(f"{sc.__name__}.batch.settings")
    named = {}
    for name, operators, places, has_option, label in rows:
        for operator in operators.split(", "):
            rna = getattr(bpy.ops.uv, f"spectral_{operator}").get_rna_type()
            assert rna.properties[name].name == label
            named.setdefault(operator, set()).add(name)
        for place in re.findall(r"`(\w+)`", places):
            assert name in inspect.signature(getattr(sc, place)).parameters
        assert (name in settings.NAMES) == bool(has_option), name
    assert len(rows) > 20
    for operator in ("unwrap", "relax", "pack", "suggest_seams", "new_textures"):
        rna = getattr(bpy.ops.uv, f"spectral_{operator}").get_rna_type()
        own = {each.identifier for each in rna.properties} - {"rna_type"}
        assert own - named[operator] <= IN_BLENDER_ALONE, operator


def test_menus_and_operator_come_and_go_with_the_add_on():
    for _ in range(2):
        assert _entries() == list(MENUS)
        assert hasattr(bpy.types, "UV_OT_spectral_unwrap")
        addon_utils.disable(ADDON)
        assert _entries() == []
        assert not hasattr(bpy.types, "UV_OT_spectral_unwrap")
        addon_utils.enable(ADDON)


def test_panels_and_shapes_come_and_go_with_the_add_on():
    parts = ("main", "seams", "advanced", "result", "map_overlay", "overlay_settings", "shapes", "density")
    panels = [f"{space}_PT_spectral_{part}" for space in ("VIEW3D", "IMAGE") for part in parts]
    for _ in range(2):
        assert all(hasattr(bpy.types, panel) for panel in panels)
        assert hasattr(bpy.types.Mesh, "spectral_shapes")
        addon_utils.disable(ADDON)
        assert not any(hasattr(bpy.types, panel) for panel in panels)
        for owner in (bpy.types.Mesh, bpy.types.Scene, bpy.types.WindowManager):
            assert not any(name.startswith("spectral") for name in owner.bl_rna.properties.keys())  # noqa: SIM118
        for kind in (
            "UV_UL_spectral_islands",
            "UV_OT_spectral_select",
            "SpectralMapOverlay",
            "UV_MT_spectral",
        ):
            assert not hasattr(bpy.types, kind)
        for event in ("depsgraph_update_post", "undo_post", "redo_post", "load_pre", "load_post"):
            assert not any(f.__module__.startswith(ADDON) for f in getattr(bpy.app.handlers, event)), event
        addon_utils.enable(ADDON)


def load_file():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True, load_ui=False)


@pytest.mark.parametrize("end", [load_file, lambda: addon_utils.disable(ADDON)], ids=["load", "disable"])
def test_nothing_is_remembered_of_a_file_that_was_left(end):
    session = importlib.import_module(f"{ADDON}.session")
    overlay = importlib.import_module(f"{ADDON}.overlay.map_overlay")
    bpy.context.scene.spectral_unwrap_live = True
    grid = scenes.bumpy_grid()
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_suggest_seams(unwrap=True) <= {"FINISHED", "CANCELLED"}
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    scenes.select_vertices(grid, (0, 5))
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER") == {"FINISHED"}
    assert bpy.ops.uv.spectral_select(kind="FAILED") <= {"FINISHED", "CANCELLED"}
    overlay.views(bpy.context)
    remembered = {kind.__name__ for kind in session._memory}
    assert {
        "EditMeshes",
        "KeptMaps",
        "Overlay",
        "Searched",
        "_Identities",
        "_LastResult",
        "_Results",
    } <= remembered
    left = [session.of(kind) for kind in session._memory]
    end()
    assert not [each for each in session._memory.values() if any(each is old for old in left)]


def test_values_stay_in_the_file_when_the_add_on_is_disabled():
    scenes.edit(scenes.grid(2, 2), select=False)
    scenes.select_vertices(bpy.context.edit_object, (0, 5))
    assert bpy.ops.uv.spectral_shape(kind="EXTENDER") == {"FINISHED"}
    bpy.context.edit_object.data.spectral_shapes[0].strength = 2.0
    bpy.context.scene.spectral_unwrap_live = True
    addon_utils.disable(ADDON)
    assert not hasattr(bpy.context.scene, "spectral_unwrap_live")
    addon_utils.enable(ADDON)
    assert bpy.context.scene.spectral_unwrap_live
    assert [extender.strength for extender in bpy.context.edit_object.data.spectral_shapes] == [2.0]


def _handlers():
    """Return the add-on's handlers of all events, by event and name."""
    events = {event: getattr(bpy.app.handlers, event) for event in dir(bpy.app.handlers)}
    return [
        (event, function.__name__)
        for event, functions in events.items()
        if isinstance(functions, list)
        for function in functions
        if function.__module__.startswith(ADDON)
    ]


def test_reload_scripts_leaves_one_of_everything():
    bpy.context.scene.spectral_unwrap_live = True
    before, entries = sorted(_handlers()), _entries()
    # What Reload Scripts does to an add-on.
    addon_utils.disable(ADDON)
    assert _handlers() == []
    addon_utils.enable(ADDON)
    addon_utils.disable(ADDON)
    addon_utils.enable(ADDON)
    assert sorted(_handlers()) == before
    assert len(before) == len(set(before))
    assert _entries() == entries
    scenes.edit(scenes.bumpy_grid())
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}


def test_module_is_found_in_the_layout_of_this_installation():
    native = sys.modules[f"{ADDON}.core.native"].spectral_conformal()
    # A Blender with a program of its own has the layout of the older zip, bpy that of an extension
    # (tests/blender/blenders.py).
    bundled = bool(bpy.app.binary_path)
    assert native.__name__ == (f"{ADDON}.spectral_conformal" if bundled else "spectral_conformal")


def test_f1_opens_the_section_of_each_operator():
    _, sections = importlib.import_module(f"{ADDON}.manual").links()
    names = importlib.import_module(f"{ADDON}.names")

    def opened(operator):
        # As Blender looks a setting of it up.
        return next(place for pattern, place in sections if fnmatch.fnmatchcase(f"bpy.ops.{operator}.x", pattern))

    assert opened(names.UNWRAP_OPERATOR) == "guide.html#unwrap"
    assert opened(names.DENSITY_OPERATOR) == "guide.html#texel-density"
    assert opened(names.SHAPE_OPERATOR) == opened(names.REMOVE_SHAPE_OPERATOR) == "guide.html#shapes"
    assert opened(names.EXTENDER_OPERATOR) == "guide.html#pushpull"
    assert opened(names.NEW_TEXTURES_OPERATOR) == "guide.html#my-asset-has-a-texture-already"
    assert all(opened(name) for constant, name in vars(names).items() if constant.endswith("_OPERATOR"))
