# SPDX-License-Identifier: GPL-3.0-or-later
"""What artists read in the language of their Blender. bpy's wheels are built without languages and stay English."""

import importlib

import bpy  # isort: skip - makes addon_utils importable
import addon_utils
import pytest

from tests.blender.inside import scenes

ADDON = "spectral_unwrap"
SWITCHES = ("interface", "tooltips", "reports", "new_dataname")
REPORT = "Das Objekt ist negativ skaliert; abgewickelt wird das Mesh ohne Spiegelung"
SCALE = "Object has negative scale, unwrap will operate on a non-flipped version of the mesh"

texts = importlib.import_module(f"{ADDON}.core.words.texts")
translation = importlib.import_module(f"{ADDON}.core.words.translation")


@pytest.fixture
def in_german():
    """Turn German on if this Blender has it; return whether it has."""
    view = bpy.context.preferences.view
    language = view.language
    has_languages = bpy.app.build_options.international
    assert has_languages == bool(bpy.app.translations.locales)
    if has_languages:
        view.language = "de_DE"
        for name in SWITCHES:
            if hasattr(view, f"use_translate_{name}"):
                setattr(view, f"use_translate_{name}", True)
    yield has_languages
    view.language = language


def _unwrap_mirrored_cube(capfd):
    """Unwrap a cube with a negative scale, and return what was printed of it."""
    cube = scenes.cube(all_seams=True)
    cube.scale.x = -1.0
    scenes.edit(cube)
    bpy.context.view_layer.update()
    capfd.readouterr()
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    return capfd.readouterr().out


def test_reports_come_in_the_language_of_the_user(in_german, capfd):
    printed = _unwrap_mirrored_cube(capfd)
    if in_german:
        assert REPORT in printed
        assert "6 Inseln abgewickelt: Winkel weichen im Mittel um 0.0 % ab, höchstens um 0.0 %; keine" in printed
    else:
        assert SCALE in printed
        assert "Unwrapped 6 islands: angles off by 0.0 % on average, 0.0 % at worst; no flipped faces" in printed


def test_constants_in_reports_do_too(in_german, capfd):
    scenes.edit(scenes.grid(1, 1))
    bpy.ops.mesh.hide()
    capfd.readouterr()
    bpy.ops.uv.spectral_unwrap()
    assert ("Keine Flächen ausgewählt" if in_german else "No faces selected") in capfd.readouterr().out


def test_labels_come_in_the_language_of_the_user(in_german):
    overlay = bpy.context.window_manager.spectral_map_overlay
    item = bpy.types.UILayout.enum_item_name(overlay, "kind", "CHECKER")
    description = bpy.types.UILayout.enum_item_description(overlay, "kind", "CHECKER")
    operator = bpy.app.translations.pgettext_iface(texts.SUGGEST_SEAMS_LABEL, "Operator")
    panel = bpy.app.translations.pgettext_iface(texts.EXTENDERS_LABEL)
    if in_german:
        assert (item, operator, panel) == ("Schachbrett", "Nähte vorschlagen", "Drücken/Ziehen")
        assert description == "Schachbrett auf der Oberfläche; Materialien bleiben, wie sie sind"
    else:
        assert (item, operator, panel) == ("Checker", "Suggest Seams", "Push/Pull")


def test_switched_off_reports_stay_english(in_german, capfd):
    view = bpy.context.preferences.view
    name = "use_translate_reports" if hasattr(view, "use_translate_reports") else "use_translate_tooltips"
    setattr(view, name, False)
    assert SCALE in _unwrap_mirrored_cube(capfd)


def test_language_is_asked_for_when_something_is_said(capfd):
    translation.use(lambda text: text.replace("Unwrapped", "Flattened"))
    assert "Flattened 6 islands: angles off by" in _unwrap_mirrored_cube(capfd)


def test_translations_come_and_go_with_the_add_on(in_german):
    for _ in range(2):
        assert translation.translate("Suggest Seams") == ("Nähte vorschlagen" if in_german else "Suggest Seams")
        addon_utils.disable(ADDON)
        assert translation.translate("Suggest Seams") == "Suggest Seams"
        assert bpy.app.translations.pgettext("Suggest Seams") == "Suggest Seams"
        addon_utils.enable(ADDON)
