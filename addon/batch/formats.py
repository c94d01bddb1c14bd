# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of all formats into an empty Blender, and out of it, by whatever operators this version has."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import bpy

from ..core.errors import ReadableError

_Calls = Sequence[tuple[str, dict[str, Any]]]

# The operators of newer versions first. Legacy ones are told not to split or sort what they read.
_READERS: dict[str, _Calls] = {
    ".fbx": (("wm.fbx_import", {}), ("import_scene.fbx", {})),
    ".glb": (("import_scene.gltf", {}),),
    ".gltf": (("import_scene.gltf", {}),),
    ".obj": (
        ("wm.obj_import", {}),
        ("import_scene.obj", {"use_split_objects": False, "use_split_groups": False, "split_mode": "OFF"}),
    ),
    ".ply": (("wm.ply_import", {}), ("import_mesh.ply", {})),
    ".stl": (("wm.stl_import", {}), ("import_mesh.stl", {})),
    **{suffix: (("wm.usd_import", {}),) for suffix in (".usd", ".usda", ".usdc", ".usdz")},
}
_WRITERS: dict[str, _Calls] = {
    ".fbx": (("export_scene.fbx", {}),),
    ".glb": (("export_scene.gltf", {"export_format": "GLB"}),),
    ".gltf": (("export_scene.gltf", {"export_format": "GLTF_SEPARATE"}),),
    ".obj": (("wm.obj_export", {}), ("export_scene.obj", {})),
    ".ply": (("wm.ply_export", {}), ("export_mesh.ply", {})),
    **{suffix: (("wm.usd_export", {}),) for suffix in (".usd", ".usda", ".usdc", ".usdz")},
}
BLEND = ".blend"


class FormatError(ReadableError):
    """A file could not be read or written; the message says why, and what to do where that is known."""


def clear() -> None:
    """Empty Blender, with its factory settings."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


def read(path: Path) -> None:
    """Read a file into an empty Blender.

    Raises:
        FormatError: this Blender cannot read the format, or the file is broken.
    """
    clear()
    suffix = path.suffix.lower()
    if path.stat().st_size == 0:
        raise FormatError(f"{path.name} is empty.")
    if suffix == BLEND:
        # Scripts in files of others do not run.
        _call("wm.open_mainfile", {"filepath": str(path), "load_ui": False, "use_scripts": False}, path)
        return
    name, options = _first(_READERS.get(suffix, ()), f"read {suffix} ({path.name})")
    _call(name, {"filepath": str(path), **options}, path)


def write(path: Path) -> None:
    """Write what Blender holds.

    Raises:
        FormatError: this Blender cannot write the format, or did not.
    """
    suffix = path.suffix.lower()
    if suffix == BLEND:
        _call("wm.save_as_mainfile", {"filepath": str(path), "copy": True, "check_existing": False}, path)
    else:
        name, options = _first(_WRITERS.get(suffix, ()), f"write {suffix}")
        _call(name, {"filepath": str(path), "check_existing": False, **options}, path)
    if not path.is_file():
        raise FormatError(f"Blender wrote no {path.name}.")


def _operator(name: str) -> Any:  # noqa: ANN401 - Blender's own type has no name
    module, _, function = name.partition(".")
    return getattr(getattr(bpy.ops, module), function)


def _first(calls: _Calls, what: str) -> tuple[str, dict[str, Any]]:
    """Return the first operator that this Blender has."""
    for name, options in calls:
        try:
            known = _operator(name).get_rna_type().properties.keys()
        except KeyError:
            continue
        return name, {key: value for key, value in options.items() if key in known}
    version = ".".join(map(str, bpy.app.version))
    tried = " or ".join(name for name, _ in calls) or "such an operator"
    raise FormatError(f"Blender {version} cannot {what}: it has no {tried}. Use another Blender or format.")


def _call(name: str, arguments: dict[str, Any], path: Path) -> None:
    operator = _operator(name)
    known = operator.get_rna_type().properties.keys()
    try:
        status = operator(**{key: value for key, value in arguments.items() if key in known})
    except Exception as error:  # noqa: BLE001 - importers are others' Python, which a broken file may fail anywhere
        # Of a traceback, before the line that says where in Blender it was seen, the error itself.
        lines = [line for line in str(error).splitlines() if line.strip() and not line.startswith((" ", "Location:"))]
        reason = lines or [type(error).__name__]
        raise FormatError(f"{path.name}: {name} failed: {reason[-1]}") from error
    if "FINISHED" not in status:
        raise FormatError(f"{path.name}: {name} was cancelled.")
