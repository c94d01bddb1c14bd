# SPDX-License-Identifier: GPL-3.0-or-later
"""One asset of a batch: whatever happens is in its report."""

import importlib

import bpy
import pytest

from tests.blender.inside import scenes


@pytest.mark.parametrize("error", [ValueError("no {0} of it"), KeyError("mesh"), AssertionError()])
def test_an_error_that_nobody_expected_is_in_the_report(error, tmp_path, monkeypatch):
    task, settings = (importlib.import_module(f"spectral_unwrap.batch.{name}") for name in ("task", "settings"))

    def fail(*_):
        raise error

    monkeypatch.setattr(task, "_run", fail)
    source = tmp_path / "a.obj"
    source.write_text("v 0 0 0\n")
    request = task.Request(
        "a.obj", str(source), str(tmp_path), str(tmp_path / "b.obj"), settings.from_values({}).as_json()
    )
    report = task.run(request)
    assert report["status"] == "failed"
    assert report["failure"] == {"kind": "error", "message": f"{type(error).__name__}: {error}"}
    assert (tmp_path / "report.json").is_file()


@pytest.mark.parametrize("name", ["chair{0}", "a{", "ch###", "50%", "[1]"])
def test_a_checker_is_rendered_whatever_the_asset_is_called(name, tmp_path):
    checker = importlib.import_module("spectral_unwrap.batch.checker")
    scenes.bumpy_grid(3, 3)
    bpy.context.view_layer.update()
    (tmp_path / name).mkdir()
    checker.render(tmp_path / name / "checker.png", 32)
    assert [path.name for path in (tmp_path / name).iterdir()] == ["checker.png"]
    assert (tmp_path / name / "checker.png").read_bytes()[:4] == b"\x89PNG"
    assert len(bpy.data.scenes) == 1
