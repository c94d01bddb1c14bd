# SPDX-License-Identifier: GPL-3.0-or-later
"""Neither add-on nor module reaches files, network or processes, except by the module's commands."""

import ast
import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
# The commands that unwrap files, which run only if called on a command line.
MODULE = ROOT / "native" / "python" / "spectral_conformal"
BATCH = set((MODULE / "batch").rglob("*.py"))
COMMAND = {MODULE / "__main__.py", MODULE / "_command_line.py", *(MODULE / "assets").glob("*.py"), *BATCH}
PYTHON = sorted({*(ROOT / "addon").rglob("*.py"), *(ROOT / "native" / "python").rglob("*.py")} - COMMAND)
# Everything of the standard library that may be imported: nothing that reaches outside the process.
MODULES = {
    *(
        "__future__",
        "collections",
        "contextlib",
        "dataclasses",
        "enum",
        "functools",
        "hashlib",
        "importlib",
        "itertools",
    ),
    *(
        "cmath",
        "difflib",
        "inspect",
        "json",
        "math",
        "numbers",
        "operator",
        "re",
        "textwrap",
        "threading",
        "time",
        "types",
        "typing",
    ),
    "typing_extensions",  # for type checkers alone
    "pkgutil",  # the add-on's own translations
    "pathlib",  # where the add-on's own manual lies; what reads and writes is among METHODS
    *("bpy", "bmesh", "gpu", "gpu_extras", "blf", "mathutils", "bpy_extras", "numpy"),
}
# The one file that may use more, this and no other of it: Blender's context manager of temporary data lets go of a
# reference that it has given away, and only Python's own function can make up for that.
REFERENCES = {"ctypes.pythonapi.Py_IncRef", "ctypes.py_object"}
MORE = {ROOT / "addon" / "compatibility.py": REFERENCES}
BUILTINS = {"open", "exec", "eval", "compile", "__import__", "input", "breakpoint"}
METHODS = {
    *("load", "save", "savez", "savez_compressed", "loadtxt", "savetxt", "genfromtxt", "fromfile", "tofile", "memmap"),
    *("read_text", "read_bytes", "write_text", "write_bytes", "unlink", "mkdir", "rmdir", "dump", "dumps_to_file"),
    *("execfile", "url_open", "open_mainfile", "save_mainfile", "save_as_mainfile", "libraries", "save_render"),
    *("addon_utils", "script_paths", "user_resource", "online_access", "filepath", "environ", "getenv"),
}
# Blender's operators that the add-on calls.
OPERATORS = {"view3d.zoom", "ed.undo_push", "ed.undo", "ed.redo", "object.mode_set"}

# What the compiled part would call to reach outside the process. What it may include is for test_cpp_architecture.py.
CALLS = "|".join(
    (
        r"fopen|freopen|fdopen|tmpfile|mkstemp|openat|creat|unlink|mmap",
        r"printf|fprintf|puts",
        r"system|popen|fork|vfork|posix_spawn\w*|exec[lv]\w*",
        r"socket|getaddrinfo|gethostbyname|sendto|recvfrom",
        r"getenv|secure_getenv|setenv|putenv|unsetenv",
    )
)


def relative(path):
    return str(path.relative_to(ROOT))


def chain(node):
    """Return a dotted name such as `bpy.ops.uv.unwrap`; empty for anything else."""
    if isinstance(node, ast.Attribute):
        inner = chain(node.value)
        return f"{inner}.{node.attr}" if inner else ""
    return node.id if isinstance(node, ast.Name) else ""


def findings(source, more=frozenset()):
    """Return what a Python source uses to reach outside the process, except functions named in `more`."""
    found = []
    modules = {name.partition(".")[0] for name in more}
    tree = ast.parse(source)
    used = {id(node) for name in (n for n in ast.walk(tree) if chain(n) in more) for node in ast.walk(name)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found += [
                alias.name
                for alias in node.names
                if alias.name.partition(".")[0] not in MODULES and (alias.name not in modules or alias.asname)
            ]
        elif isinstance(node, ast.Name) and node.id in modules and id(node) not in used:
            found.append(node.id)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            found += [node.module] * (node.module.partition(".")[0] not in MODULES)
        elif isinstance(node, ast.Name) and node.id in BUILTINS:
            found.append(node.id)
        elif isinstance(node, ast.Attribute):
            found += [node.attr] * (node.attr in METHODS)
            _, is_operator, operator = chain(node).partition("bpy.ops.")
            found += [operator] * bool(is_operator and operator.count(".") == 1 and operator not in OPERATORS)
    return found


@pytest.mark.parametrize("path", PYTHON, ids=relative)
def test_python_reaches_nothing_outside_the_process(path):
    assert findings(path.read_text(encoding="utf-8"), MORE.get(path, frozenset())) == []


@pytest.mark.parametrize(
    "source",
    [
        *(
            "import ctypes\nctypes.CDLL('file')",
            "import ctypes\nlibrary = ctypes",
            "import ctypes as c\nc.CDLL('file')",
        ),
        *("import ctypes\nctypes.pythonapi.PyRun_SimpleString(b'')", "from ctypes import CDLL", "import ctypes.util"),
        *("import sys\nsys.modules['os'].system('ls')", "import os"),
    ],
)
def test_the_one_file_that_may_use_more_may_use_nothing_else(source):
    assert findings("import ctypes\nctypes.pythonapi.Py_IncRef(ctypes.py_object(data))", REFERENCES) == []
    assert findings(source, REFERENCES) != []


@pytest.mark.parametrize(
    "source",
    [
        *("import socket", "import urllib.request", "from subprocess import run", "import os", "import ctypes"),
        *("open('file')", "exec('code')", "import numpy as np\nnp.save('file', 1)"),
        *("import bpy\nbpy.ops.wm.save_mainfile()", "import bpy\nbpy.ops.image.open()", "p.write_text('')"),
        *("import bpy\nbpy.data.libraries.load('file')", "__import__('os')", "image.filepath = 'file'"),
    ],
)
def test_the_scan_sees_what_is_forbidden(source):
    assert findings(source) != []


def test_compiled_module_names_no_function_that_reaches_outside():
    folder = Path(importlib.util.find_spec("spectral_conformal").origin).parent
    (library,) = (path for path in folder.glob("_native*") if path.suffix != ".pyi")
    names = {name.decode(errors="replace") for name in library.read_bytes().split(b"\0")}
    assert "PyErr_SetString" in names
    assert {name for name in names if re.fullmatch(CALLS, name)} == set()


def imported(path):
    """Return every name that a file imports, with the module that it comes from, relative ones without their dots."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            found |= {".".join(filter(None, (node.module, alias.name))) for alias in node.names}
    return found


def test_the_modules_commands_are_loaded_by_themselves_alone():
    """Neither the add-on nor the module's functions import what reads files, starts processes or uses the network."""
    for path in PYTHON:
        names = {name for name in imported(path) if not name.startswith("gpu_extras.")}
        assert not re.search(r"\b(assets|batch|__main__|_command_line)\b", " ".join(names)), path


def test_reading_files_needs_neither_processes_nor_network():
    reached = {name.partition(".")[0] for path in COMMAND - BATCH for name in imported(path)}
    assert not reached & {"subprocess", "socket", "urllib.request", "distributed", "multiprocessing"}
    assert {"subprocess", "distributed"} <= {name.partition(".")[0] for path in BATCH for name in imported(path)}


def test_blender_is_reached_by_what_is_for_it_alone():
    """The module runs without Blender: only one folder of the batch needs it, which the task imports on demand."""
    for path in (ROOT / "native" / "python").rglob("*.py"):
        is_for_blender = path.parent == MODULE / "batch" / "blender"
        assert is_for_blender or not {"bpy", "mathutils"} & {name.partition(".")[0] for name in imported(path)}, path


def test_importers_and_exporters_of_blender_are_for_fbx_alone():
    pattern = re.compile(
        r"(import_scene|export_scene|import_mesh|export_mesh|wm)[._]\w*(import|export|fbx|gltf|obj|ply|stl|usd)"
    )
    for path in {*PYTHON, *COMMAND}:
        names = {found[0] for found in pattern.finditer(path.read_text(encoding="utf-8"))}
        allowed = {"wm.fbx_import", "import_scene.fbx", "export_scene.fbx"} if path.parent.name == "blender" else set()
        assert names <= allowed, path


def test_manifest_asks_for_no_permission():
    manifest = (ROOT / "addon" / "blender_manifest.toml").read_text(encoding="utf-8")
    keys = set(re.findall(r"^\s*\[?([\w.]+)\]?\s*(?==|$)", manifest, re.MULTILINE))
    assert keys == {
        *("schema_version", "id", "name", "tagline", "type", "maintainer", "license", "copyright"),
        *("tags", "blender_version_min"),
    }
