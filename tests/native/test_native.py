# SPDX-License-Identifier: GPL-3.0-or-later
"""Build the C++ library and its own tests in every flavour and run them."""

import os
from pathlib import Path

import pytest

from tests.native import flavours


@pytest.fixture(scope="module", params=flavours.FLAVOURS)
def build(request):
    return flavours.build(request.param)


def test_ctest(build, monkeypatch):
    monkeypatch.setenv("UBSAN_OPTIONS", "print_stacktrace=1")
    suppressions = Path(__file__).with_name("thread_sanitizer_suppressions.txt")
    monkeypatch.setenv("TSAN_OPTIONS", f"suppressions='{suppressions}' halt_on_error=1")
    _, only = flavours.ONLY.get(build.name, (None, ".*"))
    summary = flavours.run(
        flavours.TOOLS / "ctest",
        *("--test-dir", build, "--output-on-failure", "--no-tests=error", "-j", os.cpu_count(), "-R", f"^{only}$"),
    )
    assert "100% tests passed" in summary


def test_cholmod_is_linked_unless_left_out(build):
    cache = (build / "CMakeCache.txt").read_text()
    assert ("CHOLMOD_LIBRARY:FILEPATH=" in cache) == (build.name != "eigen_only")
    assert "CHOLMOD_LIBRARY-NOTFOUND" not in cache
