# SPDX-License-Identifier: GPL-3.0-or-later
"""Collect the tests in `inside` without importing them: each function in each Blender is one test.

    pytest tests/blender/inside/test_pins.py::test_name            in every Blender
    pytest tests/blender/inside/test_pins.py --blender bpy-5.0.1   in one

A file runs in one process per Blender, with the functions that are selected.
"""

import ast
import tempfile
import xml.etree.ElementTree
from pathlib import Path

import pytest

from tests.blender import blenders

INSIDE = Path(__file__).with_name("inside")
SECONDS = 600


# What became of the functions of a file in a Blender, by path and name.
OUTCOMES = pytest.StashKey[dict[tuple[Path, str], dict[str, str]]]()


class InsideFile(pytest.File):
    """A file whose tests run in Blender."""

    def collect(self):
        named = self.config.getoption("--blender") or ()
        further = [blender for blender in blenders.further_blenders() if blender.name in named]
        for blender in (*blenders.all_blenders(), *further):
            for function in functions_of(self.path):
                name = f"{function}[{blender.name}]"
                yield InsideTest.from_parent(self, name=name, inner=function, blender=blender)


class InsideTest(pytest.Item):
    """A function of such a file, in one Blender."""

    def __init__(self, *, inner, blender, **rest):
        super().__init__(**rest)
        self.inner = inner
        self.blender = blender
        self.key = (self.path, blender.name)

    def runtest(self):
        known = self.session.stash.setdefault(OUTCOMES, {})
        if self.key not in known:
            beside = [item.inner for item in self.session.items if getattr(item, "key", None) == self.key]
            known[self.key] = run(self.path, beside, self.blender)
        if wrong := known[self.key][self.inner]:
            pytest.fail(wrong, pytrace=False)

    def reportinfo(self):
        return self.path, None, f"{self.path.stem}.{self.name}"


def functions_of(path):
    """Return the names of the test functions of a file."""
    nodes = ast.parse(path.read_text(encoding="utf-8")).body
    return [node.name for node in nodes if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")]


def run(path, functions, blender):
    """Run functions of a file in a Blender; return each one's failure, an empty text if it passed."""
    whole = functions == functions_of(path)
    selected = [str(path)] if whole else [f"{path}::{function}" for function in functions]
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder, "report.xml")
        options = ["-v", "--tb=short", "--color=no", "-p", "no:cacheprovider", "-p", "tests.blender.inside.fixtures"]
        options += [f"--rootdir={INSIDE}", f"--confcutdir={INSIDE}", f"--junitxml={report}", "-ojunit_logging=all"]
        environ = blender.make_profile(Path(folder))
        if not blender.python:
            blenders.add_pytest(Path(folder))
        command = [*blender.pytest_command(), *options, *selected]
        code, printed = blenders.run(command, environ=environ, folder=Path(folder), seconds=SECONDS)
        if code is None:
            return dict.fromkeys(functions, f"{blender.name} was still running after {SECONDS} s:\n{printed}")
        found = outcomes(report) if report.exists() else {}
    # Also if Blender crashes at its end, or if pytest and this file do not find the same tests.
    is_complete = code in (0, 1) and (set(found) == set(functions) if whole else set(found) >= set(functions))
    if not is_complete or (code == 1 and not any(found.values())):
        text = f"{path.name} in {blender.name}, exit code {code}:\n{printed}"
        return {function: found.get(function) or text for function in functions}
    return {function: found[function] for function in functions}


def outcomes(report):
    """Read a JUnit report: function -> text of its failures, those of all its parameters in one."""
    found = {}
    for case in xml.etree.ElementTree.parse(report).iter("testcase"):
        function = case.get("name", "").partition("[")[0]
        # A test that is skipped shows nothing.
        bad = [case.find(kind) for kind in ("failure", "error", "skipped")]
        texts = [f"{entry.get('message', '')}\n{entry.text or ''}" for entry in bad if entry is not None]
        if texts:
            printed = (case.findtext(stream) or "" for stream in ("system-out", "system-err"))
            texts = [f"{case.get('name')}: ", *texts, *filter(None, printed)]
        found[function] = "\n".join(filter(None, [found.get(function, ""), *texts]))
    return found
