# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that the add-on remembers between calls is in `addon/session`."""

import ast
from pathlib import Path

import pytest

ADDON = Path(__file__).resolve().parents[2] / "addon"
MODULES = {path.relative_to(ADDON).as_posix(): path for path in sorted(ADDON.rglob("*.py"))}
# The look-up of texts that Blender's layer hands to the core when the add-on is registered: nothing of a file.
REGISTERED = {("core/words/translation.py", "_look_up")}
# Methods that change a dictionary, list or set.
CHANGES = {
    *("add", "append", "clear", "difference_update", "discard", "extend", "insert", "intersection_update", "pop"),
    *("popitem", "remove", "reverse", "setdefault", "sort", "symmetric_difference_update", "update"),
}
# What the calls at the top of a module may make, as it cannot change.
CONSTANTS = {
    *("TypeVar", "frozenset", "getattr", "hasattr", "tuple", "Path(__file__).with_name"),
    "bpy.utils.register_classes_factory",
}
CACHES = {"cache", "lru_cache", "functools.cache", "functools.lru_cache"}
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)


def stored(node):
    """Return the names that are bound somewhere in a piece of code."""
    return {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}


def is_module(name):
    return any(ADDON.rglob(f"{name}.py")) or (ADDON / name).is_dir()


def names_of_module(tree):
    """Return the names at the top of a module whose objects could change: no modules, no bpy."""
    found = set()
    for statement in tree.body:
        if isinstance(statement, (ast.Assign, ast.AnnAssign)):
            found |= stored(statement)
        elif isinstance(statement, ast.ClassDef):
            found.add(statement.name)
        elif isinstance(statement, ast.ImportFrom):
            objects = [each for each in statement.names if not is_module(each.name)]
            found |= {alias.asname or alias.name for alias in objects}
    return found


def bound_in(function):
    """Return the names that a function binds itself."""
    every = ast.walk(function.args)
    return stored(function) | {argument.arg for argument in every if isinstance(argument, ast.arg)}


def root(node):
    """Return the name at the left of items and attributes; empty where there is another expression."""
    while isinstance(node, (ast.Attribute, ast.Subscript)):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def changed_in(function):
    """Yield what a function changes: assigned or deleted items and attributes, objects with a changing method."""
    for node in ast.walk(function):
        if isinstance(node, (ast.Attribute, ast.Subscript)) and isinstance(node.ctx, (ast.Store, ast.Del)):
            yield node
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in CHANGES:
            yield node.func.value


def is_dataclass(node):
    return isinstance(node, ast.ClassDef) and any("dataclass" in ast.unparse(d) for d in node.decorator_list)


def begins_empty(statement):
    """Return whether an assignment begins with nothing: None or a collection without contents, to be filled later."""
    value = statement.value
    is_none = isinstance(value, ast.Constant) and value.value is None
    is_empty = isinstance(value, (ast.List, ast.Dict)) and not (
        getattr(value, "elts", None) or getattr(value, "keys", None)
    )
    return is_none or is_empty


def memories(source, may_cache=False):
    """Return the names by which a module remembers something."""
    tree = ast.parse(source)
    nodes = list(ast.walk(tree))
    found = {name for node in nodes if isinstance(node, ast.Global) for name in node.names}
    of_module = names_of_module(tree)
    for function in (node for node in nodes if isinstance(node, FUNCTIONS)):
        found |= {root(node) for node in changed_in(function)} & (of_module - bound_in(function))
        decorators = {ast.unparse(decorator).split("(")[0] for decorator in getattr(function, "decorator_list", ())}
        if decorators & CACHES and not may_cache:
            found.add(function.name)
    for body in (tree, *(node for node in nodes if isinstance(node, ast.ClassDef))):
        for statement in body.body:
            if not isinstance(statement, (ast.Assign, ast.AnnAssign)) or statement.value is None:
                continue
            is_made = body is tree and isinstance(statement.value, ast.Call)
            if (is_made and ast.unparse(statement.value.func) not in CONSTANTS) or (
                begins_empty(statement) and not (is_dataclass(body) and "ClassVar" not in ast.unparse(statement))
            ):
                found |= stored(statement)
    return found


@pytest.mark.parametrize("name", [name for name in MODULES if not name.startswith("session/")])
def test_no_module_remembers_by_itself(name):
    # What a function of the core returns depends on its arguments alone.
    found = memories(MODULES[name].read_text(encoding="utf-8"), may_cache=name.startswith("core/"))
    assert {(name, memory) for memory in found} <= REGISTERED


@pytest.mark.parametrize(
    "source",
    [
        "known = {}\ndef f(key):\n    known[key] = 1\n",
        "known = {'a': 1}\ndef f():\n    known.clear()\n",
        "known = {'a': 1}\ndef f():\n    del known['a']\n",
        "known: list = []\n",
        "known = None\ndef f():\n    global known\n    known = 1\n",
        "known = 0\ndef f():\n    global known\n    known += 1\n",
        "known = set()\n",
        "known = Search()\n",
        "from collections import deque\nknown = deque(maxlen=3)\n",
        "class known:\n    count = 0\ndef f():\n    known.count += 1\n",
        "class A:\n    known = None\n",
        "class A:\n    known: 'ClassVar[A | None]' = None\n",
        "from .elsewhere import known\ndef f():\n    known.append(1)\n",
        "import functools\n@functools.cache\ndef known(n):\n    return n\n",
        "from functools import lru_cache\n@lru_cache(maxsize=3)\ndef known(n):\n    return n\n",
    ],
)
def test_the_scan_sees_a_memory(source):
    assert memories(source) == {"known"}


@pytest.mark.parametrize(
    "source",
    [
        "TABLE = {'a': 1}\ndef f():\n    return TABLE['a']\n",
        "def f():\n    known = {}\n    known['a'] = 1\n    known.update(b=2)\n",
        "def f(known):\n    known.x = 1\n    known.append(2)\n",
        "from dataclasses import dataclass\n@dataclass\nclass A:\n    x: int | None = None\n",
        "class A:\n    def __init__(self):\n        self.known = {}\n    def f(self):\n        self.known['a'] = 1\n",
    ],
)
def test_the_scan_lets_others_pass(source):
    assert memories(source) == set()
