# SPDX-License-Identifier: GPL-3.0-or-later
"""One asset of a batch: whatever happens is in its report."""

import importlib

import pytest


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
