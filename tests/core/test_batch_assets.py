# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files are a batch, and where their results go."""

import pytest
from spectral_unwrap.batch import assets, command
from spectral_unwrap.batch.assets import InputError
from spectral_unwrap.batch.settings import from_values


@pytest.fixture
def folder(tmp_path):
    for name in ("a/x.obj", "b/x.obj", "b/c/y.STL", "b/notes.txt", "out/a/x.obj/x.obj", "z.usdc"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name)
    return tmp_path


def test_folders_are_searched_and_results_are_no_inputs(folder):
    found = assets.find([str(folder)], folder / "out")
    assert [asset.name for asset in found] == ["a/x.obj", "b/c/y.STL", "b/x.obj", "z.usdc"]
    assert len({asset.target for asset in found}) == len({asset.folder for asset in found}) == 4
    assert found[0].target == folder / "out" / "a" / "x.obj" / "x.obj"
    assert found[1].target.name == "y.obj"


def test_files_of_one_name_in_different_folders_are_told_apart(folder):
    found = assets.find([str(folder / "a" / "x.obj"), str(folder / "b" / "x.obj")], folder / "out")
    assert [asset.name for asset in found] == ["a/x.obj", "b/x.obj"]


def test_format_layer_and_source(folder):
    def targets(**options):
        return [asset.target.name for asset in assets.find([str(folder)], folder / "out", **options)]

    assert targets(suffix=".glb") == ["x.glb", "y.glb", "x.glb", "z.glb"]
    assert targets(usd_over=True)[-1] == "z.uv.usda"
    (only,) = assets.find([str(folder / "a")], folder / "out", overwrite_source=True)
    assert only.target == only.source
    with pytest.raises(InputError, match="y.STL cannot be written over"):
        targets(overwrite_source=True)
    with pytest.raises(InputError, match="cannot be written over as .glb"):
        targets(overwrite_source=True, suffix=".glb")
    with pytest.raises(InputError, match="Did you mean .gltf"):
        targets(suffix=".gtlf")


def test_inputs_that_are_not_there_are_named(folder):
    with pytest.raises(InputError, match="There is no nothing.obj"):
        assets.find([str(folder), "nothing.obj"], folder / "out")
    (folder / "empty").mkdir()
    with pytest.raises(InputError, match="No file to read in"):
        assets.find([str(folder / "empty")], folder / "out")


@pytest.mark.parametrize("name", ["plain.obj", "[1].obj", "a*b.obj", "a?.obj"])
def test_what_a_killed_worker_left_is_removed_whatever_the_name(name, tmp_path):
    asset = assets.Asset(name, tmp_path / name, tmp_path / "out" / name, tmp_path / "out" / name / name)
    asset.folder.mkdir(parents=True)
    left, other = (asset.folder / f".{each}.7.partial" for each in (name, "other.obj"))
    for path in (left, other):
        path.touch()
    failed = {"status": "failed", "failure": {"kind": "crash", "message": "gone"}}
    command._completed(asset, failed, from_values({}))
    assert not left.exists() and other.exists()
