# SPDX-License-Identifier: GPL-3.0-or-later
"""Every test is marked with the name of its folder; --blender leaves out the tests in other Blenders, --all none."""

import collections
import shlex
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parent
LEFT_FOR_ALL = pytest.StashKey()
TRIED = pytest.StashKey()


def pytest_addoption(parser):
    parser.addoption("--all", action="store_true", help="also the tests that are marked `all`, in every Blender")
    parser.addoption("--keep", action="store_true", help="put what was run in which Blender into README's table")
    parser.addoption(
        "--blender", action="append", metavar="NAME", help="of the tests in Blender, run those in this one only"
    )


def pytest_configure(config):
    """Check the names of Blenders before any test begins, in the process that begins the others."""
    wanted = config.getoption("--blender")
    if not wanted or is_worker(config):
        return
    from tests.blender import blenders

    known = [blender.name for blender in (*blenders.all_blenders(), *blenders.further_blenders())]
    if not set(wanted) <= set(known):
        raise pytest.UsageError(
            f"--blender must be one of {', '.join(known)}, not {', '.join(wanted)}; "
            "build_addon.py test installs those of other Debian releases first, if it can"
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
    first = {item.path for item in items if item.get_closest_marker("ahead")}
    items.sort(key=lambda item: item.path not in first)
    config.stash[LEFT_FOR_ALL] = []
    wanted = config.getoption("--blender")
    if not wanted:
        if not config.getoption("--all") and not names_tests(config):
            leave_for_all(config, items)
        return
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


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
    report = (yield).get_result()
    if item.config.getoption("--keep", default=False) and blender_of(item):
        from tests import tried

        counts = item.config.stash.setdefault(TRIED, {})
        folder = item.path.relative_to(TESTS).parts[0]
        tried.note(counts, blender_of(item), folder, report.when, report.outcome)


def pytest_sessionfinish(session):
    counts = session.config.stash.get(TRIED, {})
    if is_worker(session.config):
        # Of plain types, since it goes to another process.
        named = [[blender.name, folder, dict(counted)] for (blender, folder), counted in counts.items()]
        session.config.workeroutput.update(left=session.config.stash.get(LEFT_FOR_ALL, []), tried=named)
    elif counts:
        from tests import tried
        from tools import environment

        words = [word for word in session.config.invocation_params.args if word not in environment.ON_ALL_CORES]
        tried.keep(counts, shlex.join(["python3", "build_addon.py", "test", *words]))


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node):
    """Take over what a worker of pytest-xdist noted; one that crashed noted nothing."""
    noted = getattr(node, "workeroutput", None)
    if not noted:
        return
    node.config.stash[LEFT_FOR_ALL] = noted["left"]
    counts = node.config.stash.setdefault(TRIED, {})
    if named := noted["tried"]:
        from tests.blender import blenders

        known = {blender.name: blender for blender in (*blenders.all_blenders(), *blenders.further_blenders())}
        for name, folder, counted in named:
            counts.setdefault((known[name], folder), collections.Counter()).update(counted)


def is_worker(config):
    """Return whether this is a worker of pytest-xdist, which reports to the process that began it."""
    return hasattr(config, "workerinput")


def blender_of(item):
    """Return the Blender that a test runs in, None for other tests."""
    parameters = item.callspec.params if hasattr(item, "callspec") else {}
    return getattr(item, "blender", None) or parameters.get("blender")
