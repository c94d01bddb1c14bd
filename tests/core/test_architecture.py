# SPDX-License-Identifier: GPL-3.0-or-later
"""Dependencies point one way: bpy layer -> core -> spectral_conformal, folder by folder as docs/developing.md says.

What of the standard library may be imported at all is for test_access.py.
"""

import ast
import graphlib
import re
from pathlib import Path

import grimp

ADDON = Path(__file__).resolve().parents[2] / "addon"
BLENDER = {"bpy", "bmesh", "gpu", "gpu_extras", "blf", "mathutils", "bpy_extras", "addon_utils"}
TABLES = (ADDON.parent / "docs" / "developing.md").read_text(encoding="utf-8")
ALL_IMPORTS = grimp.build_graph("addon", include_external_packages=True, cache_dir=None)
# Without those for type checkers alone.
AT_RUN_TIME = grimp.build_graph("addon", exclude_type_checking_imports=True, cache_dir=None)
MODULES = sorted(AT_RUN_TIME.modules)


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


def imported(module):
    return AT_RUN_TIME.find_modules_directly_imported_by(module)


def folder_of(module, package, known):
    """Return which of the known folders of a package holds a module, or is it; empty for those beside them."""
    part = module.removeprefix(f"{package}.").split(".")[0]
    return part if part in known else ""


def test_core_knows_no_blender_and_the_blender_layer_no_solver():
    found = {module: ALL_IMPORTS.find_modules_directly_imported_by(module) for module in MODULES}
    assert "bpy" in found["addon.operators.unwrap"], "the graph has what is imported from outside"
    for module, names in found.items():
        if module.startswith("addon.core"):
            # native.py alone imports by name: spectral_conformal stands in one of two places.
            forbidden = BLENDER | ({"importlib"} if module != "addon.core.native" else set())
            forbidden |= {name for name in names if name.startswith("addon.") and not name.startswith("addon.core")}
        else:
            forbidden = {"spectral_conformal"}
        assert not names & forbidden, module


def test_folders_import_downwards_only():
    assert {path.parent.name for path in ADDON.glob("*/__init__.py")} == set(BELOW)
    for module in MODULES:
        folder = folder_of(module, "addon", BELOW)
        allowed = {folder} | BELOW.get(folder, set())
        common = GROUND if folder != "core" else set()
        upwards = {name for name in imported(module) - common if folder_of(name, "addon", BELOW) not in allowed}
        assert not (folder and upwards), (module, upwards)


def test_folders_of_core_import_downwards_only():
    assert {path.parent.name for path in (ADDON / "core").glob("*/__init__.py")} == set(BELOW_IN_CORE)
    for module in (name for name in MODULES if name.startswith("addon.core.")):
        folder = folder_of(module, "addon.core", BELOW_IN_CORE)
        allowed = {"", folder} | BELOW_IN_CORE.get(folder, {"words"})
        upwards = {name for name in imported(module) if folder_of(name, "addon.core", BELOW_IN_CORE) not in allowed}
        assert not upwards, (module, upwards)


def test_what_stands_below_all_folders_imports_nothing_of_the_add_on():
    assert GROUND
    assert {module: imported(module) for module in GROUND} == dict.fromkeys(GROUND, set())


def test_modules_import_each_other_in_one_direction():
    # It raises CycleError, with the modules.
    graphlib.TopologicalSorter({module: imported(module) for module in MODULES}).prepare()


def test_identifiers_of_the_add_on_stand_in_names_only():
    for path in set(ADDON.rglob("*.py")) - {ADDON / "names.py"}:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                assert not node.value.startswith(IDENTIFIERS), (path, node.value)
