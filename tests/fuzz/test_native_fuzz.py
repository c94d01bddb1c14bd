# SPDX-License-Identifier: GPL-3.0-or-later
"""A short run of the libFuzzer targets, always the same."""

import subprocess

import pytest

from tests.fuzz import run_native

RUNS = {"fuzz_charts": 20000, "fuzz_solver": 1000}


@pytest.fixture(scope="module")
def folder():
    return run_native.build()


@pytest.mark.parametrize("target", run_native.TARGETS)
def test_nothing_is_found(target, folder, tmp_path, monkeypatch):
    monkeypatch.setattr(run_native, "FINDINGS", tmp_path)
    command = run_native.command(folder, target, RUNS[target], seed=1)
    result = subprocess.run(
        command, env=run_native.environ(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace"
    )
    assert result.returncode == 0, result.stdout[-20000:]
    assert f"Done {RUNS[target]} runs" in result.stdout
