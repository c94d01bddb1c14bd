# SPDX-License-Identifier: GPL-3.0-or-later
"""The package's types agree with each other, and the stubs of its compiled part with the compiled module."""

import ast
import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest
from spectral_conformal import _native

ROOT = Path(__file__).resolve().parents[2]
STUB = ROOT / "native" / "python" / "spectral_conformal" / "_native.pyi"


def mypy(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "mypy", "--cache-dir", ROOT / "build" / "mypy", *arguments],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


@pytest.mark.slow
def test_mypy():
    result = mypy()
    assert result.returncode == 0, result.stdout


@pytest.mark.slow
@pytest.mark.parametrize(
    ("call", "said"),
    [
        ("sc.parameterize([[0.0, 0, 0]], [[0, 1, 2]], polish=1.5)", '"polish"|"bool"'),
        ("sc.unwrap([[0.0, 0, 0]], [[0, 1, 2]], foldfree=True)", "foldfree"),
        ("sc._native.pack_boxes([1.0])", "pack_boxes"),
    ],
)
def test_mypy_sees_what_callers_do_wrong(call, said, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(f"import spectral_conformal as sc\n\n{call}\n")
    result = mypy("--config-file", ROOT / "pyproject.toml", script)
    assert result.returncode == 1
    assert any(word.strip('"') in result.stdout for word in said.split("|")), result.stdout


def members(body):
    """Return the names that the body of a module or class defines."""
    names = set()
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.add(node.name)
        elif isinstance(node, ast.AnnAssign):
            names.add(node.target.id)
    return {name for name in names if not name.startswith("_") or name == "__init__"}


def test_the_stub_has_what_is_compiled():
    tree = ast.parse(STUB.read_text(encoding="utf-8"))
    assert members(tree.body) == {name for name in vars(_native) if not name.startswith("_")}
    for node in tree.body:
        if isinstance(node, ast.ClassDef) and not issubclass(getattr(_native, node.name), BaseException):
            compiled = vars(getattr(_native, node.name))
            assert members(node.body) == {name for name in compiled if not name.startswith("_") or name == "__init__"}


def test_the_stub_gives_every_function_as_many_arguments_as_it_takes():
    tree = ast.parse(STUB.read_text(encoding="utf-8"))
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    assert functions
    for node in functions:
        # pybind11 documents them: name(arg0: int, arg1: ...) -> ..., for every overload. Some have names of their own.
        lines = inspect.getdoc(getattr(_native, node.name)).splitlines()
        signatures = [line for line in lines if re.search(rf"\b{node.name}\((?!\*args)", line)]
        assert signatures
        assert {len(re.findall(r"[(,] ?\w+: ", line)) for line in signatures} == {len(node.args.args)}, lines
