"""Files that Blender alone reads and writes: its own, and FBX."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ...assets import AssetError, AssetMesh, UvMap
from ...assets.mesh import checked
from . import fbx_inventory, meshes

BLEND, FBX = ".blend", ".fbx"
# Of files that Blender has compressed: gzip before 3.0, Zstandard since.
_COMPRESSED = (b"\x1f\x8b", b"\x28\xb5\x2f\xfd")
# The importer of newer versions first.
_IMPORTERS = ("wm.fbx_import", "import_scene.fbx")
_IMPORT = {"use_custom_props": True}
# What would add bones, or take modifiers and shape keys for good.
_EXPORT = {"use_custom_props": True, "add_leaf_bones": False, "use_mesh_modifiers": False, "check_existing": False}


class BlenderAsset:
    """A .blend or .fbx file that Blender has read; writing opens it again, whatever it holds meanwhile.

    Attributes:
        path: of the file.
        suffix: of the file.
        uv_map: name of the map, empty for the active one.
        meshes: that objects of any scene have, each once.
        warnings: what was left alone, and why.
    """

    def __init__(self, path: Path, uv_map: str = "") -> None:
        """Read the file.

        Args:
            path: of a .blend or .fbx file.
            uv_map: name of the map that is read and written, made where it is missing; the active one unless given.

        Raises:
            AssetError: Blender cannot read it, or there is nothing to unwrap.
        """
        self.path, self.suffix = path, path.suffix.lower()
        self.uv_map = uv_map
        self.warnings: list[str] = []
        with path.open("rb") as file:
            if not (head := file.read(4)):
                raise AssetError(f"{path.name} is empty.")
        self._is_compressed = head.startswith(_COMPRESSED)
        self._open()
        self.meshes: list[AssetMesh] = []
        self._names: list[str] = []
        linked = []
        for item, mesh in meshes.of_objects():
            if mesh.library is not None:
                linked.append(mesh.name)
                continue
            self.meshes.append(checked(path, meshes.read(item, uv_map)))
            self._names.append(mesh.name)
            if meshes.has_extenders(mesh):
                self.warnings.append(f"The extenders of {mesh.name} were not used: they act in Blender's window.")
        if self.suffix == BLEND and bpy.data.version[:2] != bpy.app.version[:2]:
            before, now = (".".join(map(str, version[:2])) for version in (bpy.data.version, bpy.app.version))
            self.warnings.append(f"The file was of Blender {before}, and is of {now} now.")
        if linked:
            self.warnings.append(f"Left alone, since other files hold them: {', '.join(sorted(linked))}.")
        if not self.meshes:
            raise AssetError(f"{path.name}: there is no mesh with faces in it that is its own.")

    def _open(self) -> bool:
        """Let Blender read the file; return whether it was in edit mode, which is left."""
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        if self.suffix == BLEND:
            # Scripts in files of others do not run.
            _call("wm.open_mainfile", {"filepath": str(self.path), "load_ui": False, "use_scripts": False}, self.path)
            bpy.context.view_layer.update()
            # The mesh of edit mode would take the place of what is written; other modes have none of their own.
            is_edited = bpy.context.mode == "EDIT_MESH"
            if is_edited:
                bpy.ops.object.mode_set(mode="OBJECT")
            return is_edited
        importer = next(filter(_is_known, _IMPORTERS), None)
        if importer is None:
            raise AssetError(f"{self.path.name}: Blender {bpy.app.version_string} has no importer of FBX switched on.")
        _call(importer, {"filepath": str(self.path), **_IMPORT}, self.path)
        return False

    def save(self, path: Path, maps: Sequence[UvMap]) -> None:
        """Write the file with other UVs to a path of the same suffix, from which relative paths in it hold.

        Raises:
            AssetError: Blender cannot write it.
        """
        was_edited = self._open()
        for name, uv_map in zip(self._names, maps):
            meshes.write_uv(bpy.data.meshes[name], self.uv_map, uv_map)
        if was_edited:
            bpy.ops.object.mode_set(mode="EDIT")
        if self.suffix == BLEND:
            options = {"copy": True, "check_existing": False, "compress": self._is_compressed}
            _call("wm.save_as_mainfile", {"filepath": str(path), **options}, path)
        else:
            _call("export_scene.fbx", {"filepath": str(path), **_EXPORT}, path)
            before, after = (fbx_inventory.count(each.read_bytes()) for each in (self.path, path))
            self.warnings += fbx_inventory.lost(before, after)
        if not path.is_file():
            raise AssetError(f"{path.name}: Blender wrote nothing; is the disk full?")

    def check(self, written: BlenderAsset, maps: Sequence[UvMap]) -> None:
        """Compare what was written, read again, with what it should be.

        Raises:
            OSError: a mesh is missing, has other faces, or not the map.
        """
        found = dict(zip(written._names, written.meshes))
        for name, mesh, uv_map in zip(self._names, self.meshes, maps):
            again = found.get(name)
            corners = np.repeat(uv_map.mapped, np.diff(mesh.face_offsets))
            if not uv_map.mapped.any() and again is not None:
                continue
            if (
                again is None
                or not np.array_equal(again.face_offsets, mesh.face_offsets)
                or again.corner_uv is None
                or not np.allclose(again.corner_uv[corners], uv_map.uv[corners], rtol=1e-6, atol=1e-6)
            ):
                raise OSError(f"{written.path.name}: what was written is not what is read again; is the disk full?")


def _operator(name: str) -> Any:  # noqa: ANN401 - Blender's own type has no name
    module, _, function = name.partition(".")
    return getattr(getattr(bpy.ops, module), function)


def _is_known(name: str) -> bool:
    """Tell whether this Blender has an operator."""
    try:
        _operator(name).get_rna_type()
    except KeyError:
        return False
    return True


def _call(name: str, arguments: dict[str, Any], path: Path) -> None:
    """Call an operator of Blender's, with those of the arguments that it has in this version.

    Raises:
        AssetError: it failed, or was cancelled.
    """
    operator = _operator(name)
    known = operator.get_rna_type().properties.keys()
    try:
        status = operator(**{key: value for key, value in arguments.items() if key in known})
    except Exception as error:  # noqa: BLE001 - importers are others' Python, which a broken file may fail anywhere
        # Of a traceback, before the line that says where in Blender it was seen, the error itself.
        lines = [line for line in str(error).splitlines() if line.strip() and not line.startswith((" ", "Location:"))]
        reason = lines or [type(error).__name__]
        raise AssetError(f"{path.name}: {name} failed: {reason[-1]}") from error
    if "FINISHED" not in status:
        raise AssetError(f"{path.name}: {name} was cancelled.")
