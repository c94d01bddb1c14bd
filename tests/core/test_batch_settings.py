# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the batch: every one of the operator's, on the command line, in a file and as JSON."""

import json
from dataclasses import fields

import pytest
from spectral_unwrap.batch import command
from spectral_unwrap.batch.settings import SETTINGS, BatchSettings, SettingsError, from_values
from spectral_unwrap.core import seam_suggestion
from spectral_unwrap.core.options import Options, Settings


@pytest.fixture
def arguments(tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0\n")
    return [str(tmp_path / "a.obj"), "--out", str(tmp_path / "out")]


def test_every_setting_of_operator_and_search_is_there_once():
    names = [setting.name for setting in SETTINGS]
    assert len(names) == len(set(names))
    assert {field.name for field in fields(Options)} <= set(names)
    assert {field.name for field in fields(Settings)} - {"options", "margin", "keep_in_place"} <= set(names)
    assert {field.name for field in fields(seam_suggestion.Options)} <= set(names)
    assert {"margin", "margin_method"} <= set(names)
    assert all(setting.description for setting in SETTINGS)


def test_json_comes_back_as_the_same_settings():
    changed = from_values(
        {"seams": "sharp", "area_blend": 1, "front": [0, -1, 0], "margin": 0.5, "fold_free": True, "max_length": None}
    )
    assert changed.operator.options.area_blend == 1.0
    assert changed.operator.options.fold_free
    assert changed.operator.margin.size == 0.5
    assert changed.suggestion.front == (0.0, -1.0, 0.0)
    assert from_values(json.loads(json.dumps(changed.as_json()))) == changed
    assert from_values({}) == BatchSettings()


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"area_blended": 1.0}, "area_blended"),
        ({"area_blend": "much"}, "area_blend must be of type float"),
        ({"fold_free": 1}, "fold_free must be of type bool"),
        ({"seams": "everywhere"}, "one of keep, suggest, sharp, smart"),
        ({"front": [1.0, 2.0]}, "front must be three numbers"),
        ({"texture_size": 0}, "texture_size must be at least 1"),
        ({"margin_pixels": 64.0, "texture_size": 64}, "margin_pixels must be"),
        ({"picture_size": 3}, "picture_size must be"),
    ],
)
def test_wrong_values_are_named(values, said):
    with pytest.raises(SettingsError, match=said):
        from_values(values)


def test_margin_in_pixels_is_a_fraction_of_the_texture():
    margin = from_values({"margin_pixels": 4.0, "texture_size": 512}).operator_settings().margin
    # Around each of two islands.
    assert (margin.size, margin.method) == (2.0 / 512, "FRACTION")
    assert from_values({"margin": 0.25}).operator_settings().margin.size == 0.25
    assert from_values({"pack": False}).operator_settings().keep_in_place
    assert not BatchSettings().operator_settings().keep_in_place


def test_search_solves_as_the_operator_does():
    options = from_values({"weights": "inverse_area", "qc_limit": 1.5}).seam_options()
    assert (options.weights, options.qc_limit) == ("inverse_area", 1.5)


def test_the_limits_of_suggest_seams_in_blender_can_be_set():
    assert BatchSettings().suggestion != seam_suggestion.Options()
    assert from_values({"qc_limit": 1.1, "qc_gain": 0.0}).suggestion == seam_suggestion.Options()


def test_an_option_goes_before_the_settings_file(arguments, tmp_path):
    file = tmp_path / "batch.toml"
    file.write_text('seams = "keep"\narea_blend = 0.25\nfold_free = true\nfront = [0, 0, 1]\n')
    settings = command.plan([*arguments, "--settings", str(file), "--area-blend", "0.5", "--no-fold-free"]).settings
    assert (settings.seams, settings.suggestion.front) == ("keep", (0.0, 0.0, 1.0))
    assert settings.operator.options.area_blend == 0.5
    assert not settings.operator.options.fold_free


@pytest.mark.parametrize("text", ["seams = keep", "colour = 1"])
def test_a_wrong_settings_file_is_named(arguments, tmp_path, text):
    file = tmp_path / "batch.toml"
    file.write_text(text)
    with pytest.raises(SettingsError, match=r"batch\.toml|colour"):
        command.plan([*arguments, "--settings", str(file)])


def test_the_example_of_the_document_is_valid(arguments, tmp_path):
    document = (command.Path(__file__).parents[2] / "docs" / "batch.md").read_text(encoding="utf-8")
    file = tmp_path / "batch.toml"
    file.write_text(document.partition("```toml\n")[2].partition("```")[0])
    settings = command.plan([*arguments, "--settings", str(file)]).settings
    assert settings.margin_pixels == 4.0
    codes = {command.ALL_WORKED, command.SOME_WORKED, command.NONE_WORKED, command.WRONG_USE, command.INTERRUPTED}
    table = document.partition("| exit code |")[2].partition("\n\n")[0]
    assert {int(row.split("|")[1]) for row in table.splitlines()[2:]} == codes
