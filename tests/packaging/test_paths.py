# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths on the command line: spaces, letters of any script and ~ work; anything else is reported."""

import os
from pathlib import Path

import pytest

from tools import demo, packaging, paths
from tools.steps import StepError


@pytest.mark.parametrize("name", ["mesh.obj", "my mesh.obj", "Ümläut 网格.obj", "mesh.OBJ", "-mesh.obj", "a'b\"c.obj"])
def test_file_of_any_name_is_taken(name, tmp_path):
    (tmp_path / name).touch()
    assert demo.check_mesh(tmp_path / name) == tmp_path / name


def test_home_and_relative_paths_are_made_absolute(tmp_path, monkeypatch):
    (tmp_path / "mesh.obj").touch()
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    for path in ("~/mesh.obj", "mesh.obj", "./mesh.obj"):
        assert demo.check_mesh(Path(path)) == (tmp_path / "mesh.obj").resolve()


def test_no_mesh_is_none():
    assert demo.check_mesh(None) is None


def test_what_is_no_file_is_told(tmp_path, monkeypatch):
    (tmp_path / "folder.obj").mkdir()
    os.mkfifo(tmp_path / "pipe.obj")
    (tmp_path / "mesh.txt").touch()
    (tmp_path / "link.obj").symlink_to(tmp_path / "gone.obj")
    (tmp_path / "loop.obj").symlink_to(tmp_path / "loop.obj")
    expected = {
        "folder.obj": "this is a folder; give a file",
        "pipe.obj": "not a regular file",
        "mesh.txt": r"expected one of \.obj, \.ply, \.stl, \.blend",
        "link.obj": "no such file",
        "gone.obj": "no such file",
    }
    for name, message in expected.items():
        with pytest.raises(StepError, match=message):
            demo.check_mesh(tmp_path / name)
    for path in (Path("//mesh.obj"), Path("~nobody-of-this-name/mesh.obj"), tmp_path / "loop.obj"):
        with pytest.raises(StepError):
            demo.check_mesh(path)


def test_file_that_cannot_be_read_is_told(tmp_path, monkeypatch):
    (tmp_path / "mesh.obj").touch()
    monkeypatch.setattr(paths.os, "access", lambda *_: False)
    with pytest.raises(StepError, match="cannot be read; check its permissions"):
        demo.check_mesh(tmp_path / "mesh.obj")


def test_folder_of_wheels(tmp_path, monkeypatch):
    assert paths.existing_folder(tmp_path) == tmp_path
    (tmp_path / "file").touch()
    for name, message in {"file": "not a folder", "gone": "no such folder"}.items():
        with pytest.raises(StepError, match=message):
            packaging.run_with_wheels(tmp_path / name, tmp_path / "output")
    with pytest.raises(StepError, match="holds no wheel"):
        packaging.run_with_wheels(tmp_path, tmp_path / "output")
    monkeypatch.setattr(paths.os, "access", lambda *_: False)
    with pytest.raises(StepError, match="cannot be read"):
        packaging.run_with_wheels(tmp_path, tmp_path / "output")


@pytest.mark.parametrize("name", ["spectral_conformal-1.whl", "spectral_conformal-1-py3-none-any.whl"])
def test_wheel_without_tags_is_told(name, tmp_path):
    (tmp_path / name).touch()
    with pytest.raises(StepError, match="ends with its tags"):
        packaging.run_with_wheels(tmp_path, tmp_path / "output")


def test_tags_of_a_wheel_are_read():
    names = ("a_b-0.1.0-cp311-cp311-linux_x86_64.whl", "a_b-0.1-1build-cp310-abi3-manylinux_2_17_x86_64.whl")
    assert [packaging.python_tag(Path(name)) for name in names] == ["cp311", "cp310"]


def test_damaged_wheel_is_told(tmp_path):
    wheel = tmp_path / "spectral_conformal-0.1.0-cp311-cp311-manylinux_2_17_x86_64.whl"
    wheel.write_bytes(b"PK\x03\x04 and then nothing")
    with pytest.raises(StepError, match="wheel is incomplete"):
        packaging.legacy_files(wheel)
