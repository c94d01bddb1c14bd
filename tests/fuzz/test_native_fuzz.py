# SPDX-License-Identifier: GPL-3.0-or-later
"""A short run of the libFuzzer targets, always the same."""

import subprocess
from concurrent.futures import ThreadPoolExecutor

import pytest

from tests.fuzz import run_native

RUNS = {"fuzz_charts": 20000, "fuzz_solver": 1000}


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory):
    """Run all targets at once, one on each core; yields their codes and outputs."""
    folder = run_native.build()
    with pytest.MonkeyPatch.context() as patch, ThreadPoolExecutor(len(RUNS)) as threads:
        patch.setattr(run_native, "FINDINGS", tmp_path_factory.mktemp("findings"))
        commands = {target: run_native.command(folder, target, RUNS[target], seed=1) for target in RUNS}
        yield {target: threads.submit(outcome, command) for target, command in commands.items()}


def outcome(command):
    return subprocess.run(
        command, env=run_native.environ(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace"
    )


@pytest.mark.parametrize("target", run_native.TARGETS)
def test_nothing_is_found(target, outcomes):
    result = outcomes[target].result()
    assert result.returncode == 0, result.stdout[-20000:]
    assert f"Done {RUNS[target]} runs" in result.stdout
