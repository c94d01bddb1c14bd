# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in Blender: install a package, enable, unwrap, disable, enable, remove; write the observations as JSON.

The arguments after `--` are the package and the file for the observations; without a package, only the shared
libraries of this Blender are written.
"""

import json
import math
import sys
from fnmatch import fnmatchcase
from pathlib import Path
from urllib.parse import urlparse
from urllib.request import url2pathname

import bpy
import numpy  # noqa: F401 - with the libraries that are its own, not the package's

NAME = "spectral_unwrap"
NATIVE = "spectral_conformal"
*packages, result_file = (Path(argument) for argument in sys.argv[sys.argv.index("--") + 1 :])
legacy = any("legacy" in path.name for path in packages)
module = NAME if legacy else f"bl_ext.user_default.{NAME}"


def in_area(operator, **arguments):
    """Call an operator that redraws its area afterward; in background mode there is an area but no active one."""
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, area=window.screen.areas[0]):
        return operator(**arguments)


def traces() -> dict:
    """Return everything in Blender that the add-on could leave behind, the files in the profile apart."""
    menus = (getattr(bpy.types, name) for name in ("VIEW3D_MT_uv_map", "IMAGE_MT_uvs", "IMAGE_MT_uvs_unwrap")
             if hasattr(bpy.types, name))  # fmt: skip
    entries = [entry for menu in menus for entry in getattr(menu.draw, "_draw_funcs", ())]
    return {
        "enabled": module in bpy.context.preferences.addons,
        "operator": hasattr(bpy.types, "UV_OT_spectral_unwrap"),
        "menu entries": sum(NAME in entry.__module__ for entry in entries),
        "manual": manual_place(),
    }


def manual_place() -> str:
    """Return the page that Blender opens about the operator, if it exists; empty for none."""
    for prefix, sections in bpy.utils.manual_map():
        found = [place for pattern, place in sections if fnmatchcase("bpy.ops.uv.spectral_unwrap.margin", pattern)]
        if found:
            page, anchor = found[0].split("#")
            file = Path(url2pathname(urlparse(prefix).path), page)
            return page if f'id="{anchor}"' in file.read_text(encoding="utf-8") else ""
    return ""


def unwrap_cylinder() -> dict:
    """Unwrap an open cylinder with one seam and return the size of its single island."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=32, radius=1, depth=2, end_fill_type="NOTHING")
    mesh = bpy.context.object.data
    for edge in mesh.edges:
        edge.use_seam = all(mesh.vertices[i].co.y > 0.999 for i in edge.vertices)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    result = bpy.ops.uv.spectral_unwrap()
    bpy.ops.object.mode_set(mode="OBJECT")
    corners = [item.uv[:] for item in mesh.uv_layers.active.data]
    sides = sorted(max(values) - min(values) for values in zip(*corners))
    finite = all(math.isfinite(value) for corner in corners for value in corner)
    return {"result": sorted(result), "aspect": sides[1] / sides[0], "finite": finite}


def loaded_libraries() -> set:
    """Return the shared libraries that this process has mapped; none where Windows does not tell."""
    if sys.platform == "win32":
        return set()
    lines = Path("/proc/self/maps").read_text().splitlines()
    return {line.split(maxsplit=5)[5] for line in lines if ".so" in line}


def enable() -> None:
    """Enable the add-on as the preferences do."""
    bpy.ops.preferences.addon_enable(module=module)


def install_and_remove(package: Path) -> dict:
    """Go through the life of the add-on in this Blender and return the observations."""
    libraries = loaded_libraries()
    seen = {"version": list(bpy.app.version), "before": traces()}
    if legacy:
        bpy.ops.preferences.addon_install(filepath=str(package))
        enable()
    else:
        bpy.ops.extensions.package_install_files(filepath=str(package), repo="user_default", enable_on_install=True)
    seen["installed"] = traces()
    seen["first"] = unwrap_cylinder()
    seen["libraries"] = sorted(loaded_libraries() - libraries)
    seen["build"] = next(found.build_info() for name, found in sys.modules.items() if name.endswith(NATIVE))
    bpy.ops.preferences.addon_disable(module=module)
    seen["disabled"] = traces()
    enable()
    seen["second"] = unwrap_cylinder()
    if legacy:
        in_area(bpy.ops.preferences.addon_remove, module=module)
    else:
        repositories = [repository.module for repository in bpy.context.preferences.extensions.repos]
        bpy.ops.extensions.package_uninstall(repo_index=repositories.index("user_default"), pkg_id=NAME)
    seen["after"] = traces()
    return seen


observed = install_and_remove(*packages) if packages else {"libraries": sorted(loaded_libraries())}
result_file.write_text(json.dumps(observed))
