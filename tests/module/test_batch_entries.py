# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files are a batch, and where their results go."""

import os

import pytest
from spectral_conformal.assets.temporary import temporary_beside
from spectral_conformal.batch import command, entries
from spectral_conformal.batch.entries import InputError


@pytest.fixture
def folder(tmp_path):
    for name in ("a/x.obj", "b/x.obj", "b/c/y.STL", "b/notes.txt", "out/a/x.obj/x.obj", "z.usdc"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name)
    return tmp_path


def test_folders_are_searched_and_results_are_no_inputs(folder):
    found = entries.find([str(folder)], folder / "out")
    assert [entry.name for entry in found] == ["a/x.obj", "b/c/y.STL", "b/x.obj", "z.usdc"]
    assert len({entry.target for entry in found}) == len({entry.folder for entry in found}) == 4
    assert found[0].target == folder / "out" / "a" / "x.obj" / "x.obj"
    assert found[1].target.name == "y.obj"


def test_files_of_one_name_in_different_folders_are_told_apart(folder):
    found = entries.find([str(folder / "a" / "x.obj"), str(folder / "b" / "x.obj")], folder / "out")
    assert [entry.name for entry in found] == ["a/x.obj", "b/x.obj"]


def test_format_layer_and_source(folder):
    def targets(**options):
        return [entry.target.name for entry in entries.find([str(folder)], folder / "out", **options)]

    assert targets(suffix=".obj") == ["x.obj", "y.obj", "x.obj", "z.obj"]
    assert targets(usd_over=True)[-1] == "z.uv.usda"
    (only,) = entries.find([str(folder / "a")], folder / "out", overwrite_source=True)
    assert only.target == only.source
    with pytest.raises(InputError, match="y.STL cannot be overwritten"):
        targets(overwrite_source=True)
    with pytest.raises(InputError, match="cannot be overwritten as .obj"):
        targets(overwrite_source=True, suffix=".obj")
    with pytest.raises(InputError, match="files keep their format, or become obj"):
        targets(suffix=".glb")


def test_inputs_that_are_not_there_are_named(folder):
    with pytest.raises(InputError, match="Not found: nothing.obj"):
        entries.find([str(folder), "nothing.obj"], folder / "out")
    (folder / "empty").mkdir()
    with pytest.raises(InputError, match="No file to read in"):
        entries.find([str(folder / "empty")], folder / "out")


def test_links_in_circles_and_pipes_are_no_inputs(folder):
    (folder / "round").symlink_to(folder / "round")
    (folder / "a" / "up").symlink_to(folder, target_is_directory=True)
    os.mkfifo(folder / "pipe.obj")
    assert len(entries.find([str(folder)], folder / "out")) == 4
    with pytest.raises(InputError, match="round"):
        entries.find([str(folder / "round")], folder / "out")
    with pytest.raises(InputError, match="No file to read"):
        entries.find([str(folder / "pipe.obj")], folder / "out")


@pytest.mark.parametrize("name", ["plain.obj", "[1].obj", "a*b.obj", "a?.obj", "x" * 251 + ".obj"])
def test_what_a_killed_worker_left_is_removed_whatever_the_name(name, folder):
    (folder / "a" / name).write_text("v 0 0 0")
    wanted = command.plan([str(folder / "a" / name), "--out", str(folder / "out"), "--overwrite-source"])
    (entry,) = wanted.entries
    left, other = (temporary_beside(folder / "a" / each) for each in (name, "other.obj"))
    for path in (left, other):
        path.touch()
    failed = {"status": "failed", "failure": {"kind": "crash", "message": "gone"}}
    command._completed(entry, failed, wanted)
    assert not left.exists() and other.exists()


def test_patterns_choose_among_the_inputs(tmp_path):
    for name in ("a/x.obj", "a/x_low.obj", "b/y.ply"):
        (tmp_path / "in" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "in" / name).touch()

    def names(**patterns):
        return [found.name for found in entries.find([str(tmp_path / "in")], tmp_path / "out", **patterns)]

    assert names(include=["a/*", "*.ply"]) == ["a/x.obj", "a/x_low.obj", "b/y.ply"]
    assert names(include=["a/*"], exclude=["*_low.*"]) == ["a/x.obj"]
    with pytest.raises(InputError, match="None of 3 files is left by --include and --exclude"):
        names(exclude=["*"])
    with pytest.raises(InputError, match="in is an input, too: name another folder"):
        entries.find([str(tmp_path / "in")], tmp_path / "in")
