# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the batch: every option of maps and seams, on the command line, in a file and as JSON."""

import json
import re
from dataclasses import fields

import pytest
from spectral_conformal import Options, SeamOptions
from spectral_conformal._options import documented
from spectral_conformal._texture_size import TextureSize
from spectral_conformal.assets.unwrapping import Layout
from spectral_conformal.batch import command
from spectral_conformal.batch.settings import NAMES, BatchSettings, SettingsError, from_values


@pytest.fixture
def arguments(tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0\n")
    return [str(tmp_path / "a.obj"), "--out", str(tmp_path / "out")]


def test_every_option_of_maps_and_search_is_there_once():
    assert {field.name for record in (Options, SeamOptions) for field in fields(record)} <= set(NAMES)
    own = {field.name for field in fields(BatchSettings)} - {"options", "suggestion"}
    assert own <= set(NAMES) and not own & {field.name for record in (Options, SeamOptions) for field in fields(record)}
    assert all(re.search(rf"--{name.replace('_', '-')}\b", command.parser().format_help()) for name in NAMES)
    assert {name for name in own if not documented(BatchSettings).get(name)} == set()


def test_json_comes_back_as_the_same_settings():
    changed = from_values(
        {"seams": "sharp", "area_blend": 1, "front": [0, -1, 0], "margin": 8, "fold_free": True}
        | {"max_length": None, "texture_size": 2048}
    )
    assert changed.options.area_blend == 1.0
    assert changed.options.fold_free
    assert changed.layout == Layout(margin=8.0, width=2048, height=2048)
    assert changed.suggestion.front == (0.0, -1.0, 0.0)
    assert from_values(json.loads(json.dumps(changed.as_json()))) == changed
    assert from_values({}) == BatchSettings()


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"area_blended": 1.0}, "area_blended"),
        ({"area_blend": "much"}, "area_blend must"),
        ({"fold_free": 1}, "fold_free must be True or False"),
        ({"pack": 1}, "pack must be one of shape, box, none"),
        ({"udim": 0}, "udim must be auto, or from 1 to 100"),
        ({"udim": "many"}, "udim must be auto, or from 1 to 100"),
        ({"udim": 2, "pack": "box"}, 'udim must be 1 without pack "shape"'),
        ({"udim": "auto"}, "udim must be a number without texel_density"),
        ({"min_size": -1.0}, "min_size must be from 0"),
        ({"snap": True, "pack": "box"}, 'snap must be false without pack "shape"'),
        ({"keep_overlaps": True}, "keep_overlaps must be false with unwrap"),
        ({"pack_by": "part"}, "pack_by must be one of asset, object, material"),
        ({"pack_by": "object", "pack": "none"}, "pack_by must be asset without pack"),
        ({"rebake": "4k"}, "rebake must be none, auto, same, or a size such as 2048 or 2048x1024"),
        ({"rebake": "auto", "udim": 4}, "udim must be 1 with rebake"),
        ({"seams": "everywhere"}, "one of keep, suggest, sharp, merge, smart"),
        ({"front": [1.0, 2.0]}, "front must be three finite numbers"),
        ({"texture_size": 0}, "texture_size must be at least 1"),
        ({"texture_size": "2048x"}, "texture_size must be at least 1"),
        ({"texel_density": 512.0, "pack": False}, "texel_density must be 0 without"),
        ({"texel_density": -1.0}, "texel_density must be a finite number of at least 0"),
        ({"texel_density": "high"}, "texel_density must be a number, not 'high'"),
        ({"picture_size": 64.5}, "picture_size must be a whole number"),
        ({"snap": "on"}, "snap must be true or false"),
        ({"margin": 64.0, "texture_size": "128x64"}, "margin must be"),
        ({"picture_size": 3}, "picture_size must be"),
        ({"weld_distance": 1.0}, "weld_distance must be"),
    ],
)
def test_wrong_values_are_named(values, said):
    with pytest.raises(SettingsError, match=said):
        from_values(values)


def test_a_texture_has_one_size_or_two():
    assert BatchSettings().texture == (1024, 1024)
    assert from_values({"texture_size": "2048x512"}).texture == (2048, 512)
    assert from_values({"pack": False}).layout.pack == "none"
    assert from_values({"pack": True}) == BatchSettings()


def test_textures_have_a_rule_or_a_size(arguments):
    assert BatchSettings().textures is None
    assert from_values({"rebake": True, "texture_size": "64x32"}).textures == TextureSize("auto", (64, 32))
    assert from_values({"rebake": 512}).textures == TextureSize("size", (512, 512))
    assert from_values({"rebake_colors": True, "texture_size": 64}).textures == TextureSize("auto", (64, 64), True)
    assert from_values({"rebake_colors": True, "rebake": "same"}).textures.rule == "same"
    assert command.plan([*arguments, "--merge-islands"]).settings.cutting.seams == "merge"
    assert command.plan([*arguments, "--rebake"]).settings.rebake == "auto"
    assert command.plan([*arguments, "--rebake", "512x256"]).settings.textures == TextureSize("size", (512, 256))


def test_search_solves_as_the_maps_are_made():
    options = from_values({"weights": "inverse_area", "qc_limit": 1.5}).cutting.options
    assert (options.weights, options.qc_limit) == ("inverse_area", 1.5)


def test_the_limits_of_suggest_seams_in_blender_can_be_set():
    assert BatchSettings().suggestion != SeamOptions()
    assert from_values({"qc_limit": 1.1, "qc_gain": 0.0}).suggestion == SeamOptions()


def test_an_option_goes_before_the_settings_file(arguments, tmp_path):
    file = tmp_path / "batch.toml"
    file.write_text('seams = "keep"\narea_blend = 0.25\nfold_free = true\nfront = [0, 0, 1]\n')
    settings = command.plan([*arguments, "--settings", str(file), "--area-blend", "0.5", "--no-fold-free"]).settings
    assert (settings.seams, settings.suggestion.front) == ("keep", (0.0, 0.0, 1.0))
    assert settings.options.area_blend == 0.5
    assert not settings.options.fold_free


@pytest.mark.parametrize("text", ["seams = keep", "color = 1"])
def test_a_wrong_settings_file_is_named(arguments, tmp_path, text):
    file = tmp_path / "batch.toml"
    file.write_text(text)
    with pytest.raises(SettingsError, match=r"batch\.toml|color"):
        command.plan([*arguments, "--settings", str(file)])


def test_the_example_of_the_document_is_valid(tmp_path):
    document = (command.Path(__file__).parents[2] / "docs" / "batch.md").read_text(encoding="utf-8")
    file = tmp_path / "batch.toml"
    file.write_text(document.partition("```toml\n")[2].partition("```")[0])
    for name in ("a.lod1.obj", "props/b.obj"):
        path = tmp_path / "in" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    wanted = command.plan([str(tmp_path / "in"), "--out", str(tmp_path / "new"), "--settings", str(file)])
    assert wanted.settings.margin == 4.0
    found = [wanted.settings_of(entry) for entry in wanted.entries]
    assert [(each.seams, each.texel_density) for each in found] == [("keep", 0.0), ("suggest", 512.0)]
    codes = {command.ALL_WORKED, command.SOME_WORKED, command.NONE_WORKED, command.WRONG_USE, command.INTERRUPTED}
    table = document.partition("| exit code |")[2].partition("\n\n")[0]
    assert {int(row.split("|")[1]) for row in table.splitlines()[2:]} == codes
