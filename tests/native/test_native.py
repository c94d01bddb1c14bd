# SPDX-License-Identifier: GPL-3.0-or-later
"""Build the C++ library and its own tests in every flavor and run them."""

import os
from pathlib import Path

import pytest

from tests.native import flavors

# Each takes minutes to compile; the thread sanitizer is left for --all.
FLAVORS = [pytest.param(name, marks=[pytest.mark.all] if name == "thread" else []) for name in flavors.FLAVORS]


@pytest.mark.ahead
@pytest.mark.parametrize("flavor", FLAVORS)
def test_ctest(flavor, request):
    left_out = () if request.config.getoption("--all") else ("-E", "^large$")
    suppressions = Path(__file__).with_name("thread_sanitizer_suppressions.txt")
    _, only = flavors.ONLY.get(flavor, (None, ".*"))
    summary = flavors.run(
        flavors.TOOLS / "ctest",
        *("--test-dir", flavors.build(flavor), "--output-on-failure", "--no-tests=error"),
        *("-j", os.cpu_count(), "-R", f"^{only}$", *left_out),
        UBSAN_OPTIONS="print_stacktrace=1",
        TSAN_OPTIONS=f"suppressions='{suppressions}' halt_on_error=1",
    )
    assert "100% tests passed" in summary


@pytest.mark.parametrize("flavor", FLAVORS)
def test_cholmod_is_linked(flavor):
    cache = (flavors.build(flavor) / "CMakeCache.txt").read_text()
    assert "CHOLMOD_LIBRARY:FILEPATH=" in cache
    assert "CHOLMOD_LIBRARY-NOTFOUND" not in cache
