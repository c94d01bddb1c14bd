# SPDX-License-Identifier: GPL-3.0-or-later
"""Dependencies point one way: bpy layer -> core -> spectral_conformal."""

import ast
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
    "hashlib",
    "itertools",
    "json",
    "threading",
    "time",
    "types",
    "typing",
}

IDENTIFIERS = (
    *("uv.spectral", "mesh.spectral", "spectral_extenders", ".spectral"),
    *("VIEW3D_MT_", "VIEW3D_PT_", "IMAGE_MT_", "IMAGE_PT_", "MESH_UL_"),
)


def imports(path):
    """Return the imported modules of a file, relative ones as absolute names below `addon`."""
    package = ["addon", *path.relative_to(ADDON).parts[:-1]]
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            base = [*base, *(node.module or "").split(".")] if node.module else base
            found.update(".".join([*base, alias.name]) for alias in node.names)
    return found


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
    for name in imports(path):
        assert "spectral_conformal" not in name
        assert name.startswith("addon.") or name.partition(".")[0] in {"numpy", *BLENDER, *STANDARD}, name


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
