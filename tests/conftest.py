# SPDX-License-Identifier: GPL-3.0-or-later
"""Every test is marked with the name of its folder; --blender leaves out the tests in other Blenders."""

import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parent
BUILDS = pytest.StashKey()


def pytest_addoption(parser):
    parser.addoption(
        "--blender", action="append", metavar="NAME", help="of the tests in Blender, run those in this one only"
    )


def pytest_terminal_summary(terminalreporter):
    if sys.platform != "linux":
        # The tests of the module run in a Python for Windows, too, where the tools that build do not load.
        return
    from tools import systems

    for line in systems.left_out():
        terminalreporter.write_line(line)


def pytest_collection_modifyitems(config, items):
    for item in items:
        item.add_marker(item.path.relative_to(TESTS).parts[0])
    wanted = config.getoption("--blender")
    if not wanted:
        return
    from tests.blender import blenders

    known = [blender.name for blender in (*blenders.all_blenders(), *blenders.further_blenders())]
    if not set(wanted) <= set(known):
        raise pytest.UsageError(f"--blender must be one of {', '.join(known)}, not {', '.join(wanted)}")
    left_out = [item for item in items if blender_of(item) not in (None, *wanted)]
    if left_out:
        config.hook.pytest_deselected(items=left_out)
        items[:] = [item for item in items if item not in left_out]


def pytest_collection_finish(session):
    """Begin to build what the C++ tests need, beside the tests that leave a core idle."""
    fuzzed = any(item.path == TESTS / "fuzz" / "test_native_fuzz.py" for item in session.items)
    tested = [item.callspec.params["build"] for item in session.items if item.path == TESTS / "native/test_native.py"]
    if session.config.option.collectonly or not (fuzzed or tested):
        return
    from tests.fuzz import run_native
    from tests.native import flavours

    wanted = [("sanitized", *run_native.TARGETS)] if fuzzed else []
    session.stash[BUILDS] = flavours.build_ahead([*wanted, *((flavour,) for flavour in dict.fromkeys(tested))])


def pytest_sessionfinish(session):
    if BUILDS in session.stash:
        session.stash[BUILDS].shutdown(wait=False, cancel_futures=True)


def blender_of(item):
    """Return the name of the Blender that a test runs in, None for other tests."""
    parameters = item.callspec.params if hasattr(item, "callspec") else {}
    blender = getattr(item, "blender", None) or parameters.get("blender")
    return blender.name if blender else None
