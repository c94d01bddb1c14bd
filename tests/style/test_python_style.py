# SPDX-License-Identifier: GPL-3.0-or-later
"""Ruff has nothing to say about the Python code that git tracks, and no file changes where Python looks for modules."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def tracked_files():
    """Return the paths of the Python files that git tracks, relative to the project's folder."""
    tracked = subprocess.run(["git", "ls-files", "*.py"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    return [name for name in tracked.stdout.splitlines() if (ROOT / name).is_file()]


@pytest.mark.parametrize("arguments", [["check"], ["format", "--check"]], ids=" ".join)
def test_ruff(arguments):
    files = tracked_files()
    assert files
    result = subprocess.run(
        [sys.executable, "-m", "ruff", *arguments, *files],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    hint = "\nInstall it with: pip install ruff" if "No module named ruff" in result.stdout else ""
    assert result.returncode == 0, result.stdout + hint


def uses_of_the_module_path(source):
    """Return the lines that name `sys.path`, or the function of `site` that appends to it."""
    names = {("sys", "path"), ("site", "addsitedir")}
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and (node.value.id, node.attr) in names:
            found.append(node.lineno)
        elif isinstance(node, ast.ImportFrom):
            found += [node.lineno for alias in node.names if (node.module, alias.name) in names]
        # Programs for other processes, in texts.
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and "sys.path." in node.value:
            found.append(node.lineno)
    return sorted(found)


def test_modules_are_found_without_editing_the_path():
    """`tests` and `tools` are packages of the project's folder, which is pytest's root, or that of `python -m`."""
    files = [name for name in tracked_files() if ROOT / name != Path(__file__)]
    found = {name: uses_of_the_module_path((ROOT / name).read_text(encoding="utf-8")) for name in files}
    assert {name: lines for name, lines in found.items() if lines} == {}


@pytest.mark.parametrize(
    "line",
    [
        "sys.path.insert(0, 'x')",
        "sys.path[:0] = ['x']",
        "from sys import path",
        "import site; site.addsitedir('x')",
        "code = 'import sys; sys.path.append(1)'",
    ],
)
def test_the_scan_sees_an_edit(line):
    assert uses_of_the_module_path(f"import sys\n{line}\n") == [2]
    assert uses_of_the_module_path("import sys\nsys.argv\n") == []
