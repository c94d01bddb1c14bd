# SPDX-License-Identifier: GPL-3.0-or-later
"""Every test is marked with the name of its folder; --blender leaves out the tests in other Blenders, --all none."""

import collections
import os
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parent
AHEAD = pytest.StashKey()
LEFT_FOR_ALL = pytest.StashKey()
TRIED = pytest.StashKey()


def pytest_addoption(parser):
    parser.addoption("--all", action="store_true", help="also the tests that are marked `all`, in every Blender")
    parser.addoption("--keep", action="store_true", help="put what was run in which Blender into README's table")
    parser.addoption(
        "--blender", action="append", metavar="NAME", help="of the tests in Blender, run those in this one only"
    )


def pytest_terminal_summary(terminalreporter, config):
    """Say what was not run and, after all tests, which tables of the documents are of older code."""
    if sys.platform != "linux":
        # The tests of the module run in a Python for Windows, too, where the tools that build do not load.
        return
    from tools import systems

    for line in config.stash.get(LEFT_FOR_ALL, []):
        terminalreporter.write_line(line)
    if config.getoption("--all", default=False):
        for line in systems.left_out():
            terminalreporter.write_line(line)
    # Whoever names tests wants to know of these alone.
    if not names_tests(config):
        from tests.benchmarks import documents

        for line in documents.outdated(documents.read()):
            terminalreporter.write_line(line)


def pytest_collection_modifyitems(config, items):
    for item in items:
        item.add_marker(item.path.relative_to(TESTS).parts[0])
    config.stash[LEFT_FOR_ALL] = []
    wanted = config.getoption("--blender")
    if not wanted:
        if not config.getoption("--all") and not names_tests(config):
            leave_for_all(config, items)
        return
    from tests.blender import blenders

    known = [blender.name for blender in (*blenders.all_blenders(), *blenders.further_blenders())]
    if not set(wanted) <= set(known):
        raise pytest.UsageError(f"--blender must be one of {', '.join(known)}, not {', '.join(wanted)}")
    left_out = [item for item in items if blender_of(item) and blender_of(item).name not in wanted]
    if left_out:
        config.hook.pytest_deselected(items=left_out)
        items[:] = [item for item in items if item not in left_out]


def names_tests(config):
    """Return whether the command line names files, folders or tests."""
    return config.args_source is config.ArgsSource.ARGS


def leave_for_all(config, items):
    """Deselect what only --all runs, and note how much of each folder that is."""
    left = {item for item in items if item.get_closest_marker("all") or getattr(blender_of(item), "is_further", False)}
    if left:
        config.hook.pytest_deselected(items=list(left))
        items[:] = [item for item in items if item not in left]
    folders = collections.Counter(item.path.relative_to(TESTS).parts[0] for item in left)
    counts = "".join(f", {count} in tests/{folder}" for folder, count in sorted(folders.items()))
    config.stash[LEFT_FOR_ALL] = [
        f"left for --all: tests that take long, further Blenders, clang on files that did not change{counts}"
    ]


def pytest_collection_finish(session):
    """Begin the tests marked `ahead`, one after the other, each in a process of low priority."""
    ahead = [item.nodeid for item in session.items if item.get_closest_marker("ahead")]
    # A single test runs here, as in that process.
    if session.config.option.collectonly or len(session.items) == 1 or sys.platform != "linux" or not ahead:
        return
    worker = ThreadPoolExecutor(1)
    # Tests of what happens without memory limit that of this process meanwhile.
    command = ["nice", "-n", "15", "prlimit", "--as=unlimited"]
    command += [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    command += ["--all"] if session.config.getoption("--all") else []
    options = {"cwd": TESTS.parent, "env": {**os.environ}, "stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE}
    options.update(stderr=subprocess.STDOUT, text=True, errors="replace")
    begun = {nodeid: worker.submit(subprocess.run, [*command, nodeid], **options) for nodeid in ahead}
    session.stash[AHEAD] = worker, begun


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
    report = (yield).get_result()
    if item.config.getoption("--keep", default=False) and blender_of(item):
        from tests import tried

        counts = item.config.stash.setdefault(TRIED, {})
        folder = item.path.relative_to(TESTS).parts[0]
        tried.note(counts, blender_of(item), folder, report.when, report.outcome)


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem):
    _, begun = pyfuncitem.session.stash.get(AHEAD, (None, {}))
    if pyfuncitem.nodeid not in begun:
        return None
    result = begun[pyfuncitem.nodeid].result()
    if result.returncode:
        pytest.fail(result.stdout, pytrace=False)
    return True


def pytest_sessionfinish(session):
    if counts := session.config.stash.get(TRIED, {}):
        from tests import tried

        tried.keep(counts, shlex.join(["python3", "build_addon.py", "test", *session.config.invocation_params.args]))
    if AHEAD in session.stash:
        session.stash[AHEAD][0].shutdown(wait=False, cancel_futures=True)


def blender_of(item):
    """Return the Blender that a test runs in, None for other tests."""
    parameters = item.callspec.params if hasattr(item, "callspec") else {}
    return getattr(item, "blender", None) or parameters.get("blender")
