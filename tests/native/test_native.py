# SPDX-License-Identifier: GPL-3.0-or-later
"""Build the C++ library and its own tests in every flavor and run them."""

import os
from pathlib import Path

import pytest

from tests.native import flavours


@pytest.mark.ahead
@pytest.mark.parametrize("flavour", flavours.FLAVOURS)
def test_ctest(flavour):
    suppressions = Path(__file__).with_name("thread_sanitizer_suppressions.txt")
    _, only = flavours.ONLY.get(flavour, (None, ".*"))
    summary = flavours.run(
        flavours.TOOLS / "ctest",
        *("--test-dir", flavours.build(flavour), "--output-on-failure", "--no-tests=error"),
        *("-j", os.cpu_count(), "-R", f"^{only}$"),
        UBSAN_OPTIONS="print_stacktrace=1",
        TSAN_OPTIONS=f"suppressions='{suppressions}' halt_on_error=1",
    )
    assert "100% tests passed" in summary


@pytest.mark.parametrize("flavour", flavours.FLAVOURS)
def test_cholmod_is_linked(flavour):
    cache = (flavours.build(flavour) / "CMakeCache.txt").read_text()
    assert "CHOLMOD_LIBRARY:FILEPATH=" in cache
    assert "CHOLMOD_LIBRARY-NOTFOUND" not in cache
