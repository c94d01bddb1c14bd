# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences: the operator's first settings, limits, and that nothing depends on their presence."""

import importlib
import sys
import types

import addon_utils
import bmesh
import bpy
import numpy as np
import pytest

from tests.blender.inside import scenes

ADDON = "spectral_unwrap"


@pytest.fixture
def preferences():
    """Return the preferences, and put all of them back."""
    yield bpy.context.preferences.addons[ADDON].preferences
    chosen = bpy.context.preferences.addons[ADDON].preferences
    for name in ("defaults", "threads", "overlay_max_faces", "live_max_faces"):
        chosen.property_unset(name)
    importlib.import_module(f"{ADDON}.operators.unwrap_properties").take_as_last(chosen.defaults)


def last():
    return bpy.context.window_manager.operator_properties_last("uv.spectral_unwrap")


def test_operator_begins_with_the_defaults_of_the_preferences(preferences):
    operator = bpy.ops.uv.spectral_unwrap.get_rna_type().properties
    ours = preferences.defaults.bl_rna.properties
    # The others are of one call, or of the scene.
    names = set(operator.keys()) - {"rna_type", "blend", "margin", "texture_size", "rotation"}
    assert names <= set(ours.keys())
    assert {name: getattr(preferences.defaults, name) for name in names} == {
        name: getattr(last(), name) for name in names
    }
    preferences.defaults.keep_in_place = True
    preferences.defaults.area_blend = 0.25
    addon_utils.disable(ADDON)
    addon_utils.enable(ADDON)
    # The entry of the preferences, and what stands in it, stay.
    assert (last().keep_in_place, last().area_blend) == (True, 0.25)
    # What a script does not say has its documented default.
    settings = sys.modules[f"{ADDON}.unwrapping.last_settings"]
    assert settings.last_settings().keep_in_place
    assert not bpy.ops.uv.spectral_unwrap.get_rna_type().properties["keep_in_place"].default


def test_scripts_are_not_changed_by_the_preferences(preferences):
    grid = scenes.grid(4, 4)
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    expected = scenes.read_uv(grid)
    preferences.defaults.area_blend = 0.3
    importlib.import_module(f"{ADDON}.operators.unwrap_properties").take_as_last(preferences.defaults)
    assert last().area_blend == pytest.approx(0.3)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    np.testing.assert_array_equal(scenes.read_uv(grid), expected)


def test_threads_are_limited_where_solves_begin(preferences):
    native = importlib.import_module(f"{ADDON}.core.native").spectral_conformal()
    worker = importlib.import_module(f"{ADDON}.core.solve.worker")
    seen = worker.Worker(lambda _progress: native.limit_threads(0), threads=3).result()
    assert seen == 3
    preferences.threads = 2
    assert native.limit_threads(2) == 2
    addon_utils.disable(ADDON)
    assert native.limit_threads(0) == 0
    addon_utils.enable(ADDON)
    assert native.limit_threads(2) == 2
    bpy.context.preferences.addons[ADDON].preferences.threads = 0
    assert native.limit_threads(0) == 0


def bent_row():
    """Edit a bent sheet of 6 x 8 quads, and select one of its rows of edges."""
    sheet = scenes.grid(6, 8)
    for vertex in sheet.data.vertices:
        vertex.co.z = 0.1 * vertex.co.x**2 + 0.05 * vertex.co.x * vertex.co.y
    scenes.edit(sheet)
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.context.tool_settings.mesh_select_mode = (False, True, False)
    for edge in scenes.edit_mesh(sheet).edges:
        edge.select_set(all(vertex.index // 7 == 3 for vertex in edge.verts))
    bmesh.update_edit_mesh(sheet.data)
    return sheet


def test_what_an_artist_has_chosen_does_not_reach_the_shapes_of_scripts(preferences):
    maps = []
    for weight in (0.0, 1.0):
        last().area_blend = weight
        sheet = bent_row()
        assert bpy.ops.uv.spectral_shape(kind="STRAIGHT") == {"FINISHED"}
        maps.append(scenes.read_uv(sheet))
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.data.objects.remove(sheet)
    np.testing.assert_array_equal(*maps)


def test_meshes_beyond_the_limit_are_neither_colored_nor_followed(preferences):
    session = importlib.import_module(f"{ADDON}.session")
    map_overlay = importlib.import_module(f"{ADDON}.overlay.map_overlay")
    identity = importlib.import_module(f"{ADDON}.session.identity")
    snapshot = importlib.import_module(f"{ADDON}.live.snapshot")
    texts = importlib.import_module(f"{ADDON}.core.words.texts")
    grid = scenes.grid(4, 4)
    scenes.edit(grid)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    try:
        for most, is_read in ((15, False), (16, True)):
            preferences.overlay_max_faces = preferences.live_max_faces = most
            session.drop(map_overlay.Overlay)
            assert len(map_overlay.views(bpy.context)) == int(is_read)
            assert session.of(map_overlay.Overlay).meshes[identity.key(grid)].is_too_large is not is_read
            assert (snapshot.take(grid, True) is not None) is is_read
    finally:
        session.drop(map_overlay.Overlay)
    assert texts.too_many_faces(["Grid"])[1] == "Grid"


class _Layout:
    """Stands for Blender's in drawing, and keeps the labels."""

    def __init__(self, labels):
        self.labels = labels

    def label(self, text="", **_arguments):
        self.labels.append(text)

    def prop(self, *_arguments, **_keywords):
        pass

    def __getattr__(self, _name):
        return lambda *_arguments, **_keywords: self


def drawn(preferences):
    """Return the labels that the preferences draw."""
    labels = []
    module = importlib.import_module(f"{ADDON}.preferences")
    drawn_on = types.SimpleNamespace(layout=_Layout(labels), defaults=preferences.defaults)
    module.SpectralPreferences.draw(drawn_on, bpy.context)
    return labels


def test_preferences_say_for_which_processor_the_solver_works(preferences, monkeypatch):
    native = importlib.import_module(f"{ADDON}.core.native")
    build = native.spectral_conformal().build_info()
    assert build["kernel"]
    assert f"{build['factorization']}, OpenBLAS kernels for {build['kernel']}" in drawn(preferences)
    only_eigen = types.SimpleNamespace(build_info=lambda: {"factorization": "Eigen 3.4.0", "blas": "", "kernel": ""})
    monkeypatch.setattr(native, "spectral_conformal", lambda: only_eigen)
    assert "Eigen 3.4.0" in drawn(preferences)


def test_preferences_are_drawn_without_the_module(preferences, monkeypatch):
    native = importlib.import_module(f"{ADDON}.core.native")

    def missing():
        raise native.NativeModuleError("for another Python")

    monkeypatch.setattr(native, "spectral_conformal", missing)
    assert "for another Python" in drawn(preferences)


def test_without_preferences_everything_has_its_default():
    user_preferences = importlib.import_module(f"{ADDON}.user_preferences")
    assert user_preferences.read("threads", 7) == 0
    unknown = user_preferences.__package__
    user_preferences.__package__ = "no_such_add_on"
    try:
        assert user_preferences.read("threads", 7) == 7
    finally:
        user_preferences.__package__ = unknown
