# SPDX-License-Identifier: GPL-3.0-or-later
"""Dependencies point one way: bpy layer -> core -> spectral_conformal."""

import ast
import re
from pathlib import Path

import pytest

ADDON = Path(__file__).resolve().parents[2] / "addon"
CORE = ADDON / "core"
BLENDER = {"bpy", "bmesh", "gpu", "gpu_extras", "blf", "mathutils", "bpy_extras", "addon_utils"}
STANDARD = {
    "__future__",
    "collections",
    "contextlib",
    "dataclasses",
    "enum",
    "functools",
    "hashlib",
    "itertools",
    "json",
    "math",
    "pathlib",
    "pkgutil",
    "re",
    "textwrap",
    "threading",
    "time",
    "types",
    "typing",
}

TABLES = (ADDON.parent / "docs" / "developing.md").read_text(encoding="utf-8")


def rows(pattern):
    """Return the rows of the tables of folders whose first cell matches, as {name: other cells}."""
    found = re.findall(rf"^\| {pattern} \| (.*?) \| (.*?) \|$", TABLES, re.MULTILINE)
    return {name: cells for name, *cells in found}


def folders(pattern):
    """Return what each folder may import besides itself and the common modules."""
    imports = {name: set(allowed.split(", ")) - {"nothing"} for name, (_, allowed) in rows(pattern).items()}
    assert imports
    assert set().union(*imports.values()) <= set(imports)
    return imports


BELOW = folders(r"`addon/(\w+)/`")
BELOW_IN_CORE = folders(r"`addon/core/(\w+)/`")
GROUND = {f"addon.{name}" for name in re.findall(r"`(\w+)\.py`", rows("(ground)")["ground"][0])}

IDENTIFIERS = (
    *("uv.spectral", "mesh.spectral", "spectral_shapes", ".spectral"),
    *("VIEW3D_MT_", "VIEW3D_PT_", "IMAGE_MT_", "IMAGE_PT_", "MESH_UL_", "UV_UL_"),
)


def imports(path, for_types_too=True):
    """Return the imported modules of a file, relative ones as absolute names below `addon`."""
    package = ["addon", *path.relative_to(ADDON).parts[:-1]]
    found = set()
    tree = ast.parse(path.read_text(encoding="utf-8"))
    if not for_types_too:
        is_for_types = lambda node: isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"  # noqa: E731
        tree.body = [node for node in tree.body if not is_for_types(node)]
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            base = [*base, *(node.module or "").split(".")] if node.module else base
            found.update(".".join([*base, alias.name]) for alias in node.names)
    return found


def modules():
    """Return every module of the add-on with its file; a package is its `__init__`."""
    found = {}
    for path in ADDON.rglob("*.py"):
        parts = ["addon", *path.relative_to(ADDON).with_suffix("").parts]
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imported_modules(path, known):
    """Return which of the `known` modules a file imports; a name out of a module counts as that module."""
    found = set()
    for name in imports(path, for_types_too=False):
        found.add(name if name in known else name.rpartition(".")[0])
    return found & set(known)


def cycle(graph):
    """Return a cycle of a directed graph, a dictionary of sets, as a list of its nodes; empty for none."""
    state, path = {}, []

    def visit(node):
        state[node] = "open"
        path.append(node)
        for target in sorted(graph.get(node, ())):
            if state.get(target) == "open":
                return [*path[path.index(target) :], target]
            if target not in state:
                found = visit(target)
                if found:
                    return found
        path.pop()
        state[node] = "done"
        return []

    return next((found for node in sorted(graph) if node not in state and (found := visit(node))), [])


def relative(path):
    return str(path.relative_to(ADDON))


@pytest.mark.parametrize("path", sorted(CORE.rglob("*.py")), ids=relative)
def test_core_imports_numpy_and_itself_only(path):
    # native.py alone imports by name: spectral_conformal stands in one of two places.
    allowed = {"numpy", *STANDARD} | ({"importlib"} if path.name == "native.py" else set())
    for name in imports(path):
        assert name.startswith("addon.core") or name.partition(".")[0] in allowed, name


@pytest.mark.parametrize("path", sorted(set(ADDON.rglob("*.py")) - set(CORE.rglob("*.py"))), ids=relative)
def test_blender_layer_reaches_the_solver_through_core_only(path):
    # What it may use of them is for test_access.py.
    for_references = ("ctypes",) if path == ADDON / "compatibility.py" else ()
    allowed = {"numpy", *BLENDER, *STANDARD, *for_references}
    for name in imports(path):
        assert "spectral_conformal" not in name
        assert name.startswith("addon.") or name.partition(".")[0] in allowed, name


def folder_of(module):
    """Return the folder that holds a module; empty for the modules that hold the folders together."""
    return module.split(".")[1] if module.count(".") > 1 or module.partition(".")[2] in BELOW else ""


def test_folders_import_downwards_only():
    known, upwards = modules(), []
    assert {path.parent.name for path in ADDON.glob("*/__init__.py")} == set(BELOW)
    for module, path in sorted(known.items()):
        folder = folder_of(module)
        allowed = {folder} | BELOW.get(folder, set())
        for target in sorted(imported_modules(path, known)):
            if folder and folder_of(target) not in allowed and target not in (GROUND if folder != "core" else ()):
                upwards.append(f"{relative(path)} imports {target}")
    assert upwards == []


def test_folders_of_core_import_downwards_only():
    known, upwards = modules(), []
    assert {path.name for path in CORE.iterdir() if (path / "__init__.py").exists()} == set(BELOW_IN_CORE)
    for module, path in sorted(known.items()):
        folder = folder_of_core(module)
        allowed = {"", folder} | BELOW_IN_CORE.get(folder, {"words"})
        targets = [name for name in imported_modules(path, known) if name.startswith("addon.core.")]
        if module.startswith("addon.core."):
            upwards += [f"{relative(path)} imports {name}" for name in targets if folder_of_core(name) not in allowed]
    assert upwards == []


def folder_of_core(module):
    """Return the folder of core that holds a module; empty for those beside the folders."""
    part = module.removeprefix("addon.core.").split(".")[0]
    return part if part in BELOW_IN_CORE else ""


def test_what_stands_below_all_folders_imports_nothing_of_the_add_on():
    known = modules()
    assert GROUND
    for module in GROUND:
        assert imported_modules(known[module], known) == set()


def test_modules_import_each_other_in_one_direction():
    known = modules()
    # A package imports what it offers; that its modules name the package is no import of each other.
    assert cycle({module: imported_modules(path, known) - {module} for module, path in known.items()}) == []


def test_a_cycle_is_seen():
    assert cycle({"a": {"b"}, "b": {"c"}, "c": set()}) == []
    assert cycle({"a": {"b"}, "b": {"c", "d"}, "c": set(), "d": {"a"}}) == ["a", "b", "d", "a"]


def test_identifiers_of_the_add_on_stand_in_names_only():
    for path in set(ADDON.rglob("*.py")) - {ADDON / "names.py"}:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                assert not node.value.startswith(IDENTIFIERS), (path, node.value)


def test_scan_sees_a_forbidden_import(tmp_path, monkeypatch):
    monkeypatch.setitem(globals(), "ADDON", tmp_path)
    (tmp_path / "core").mkdir()
    file = tmp_path / "core" / "bad.py"
    file.write_text("def f():\n    import bpy\n    from .. import mesh_io\n    from ..packing import pack\n")
    assert imports(file) == {"bpy", "addon.mesh_io", "addon.packing.pack"}
