"""Files that only Blender reads and writes: .blend and FBX."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ..._texture_size import DrawnTexture, TextureSize
from ...assets import AssetError, AssetMesh, NoMeshError, SharedTextures, UvMap, images
from ...assets.inventory import lacking
from ...assets.mesh import checked
from . import baking, fbx_inventory, inventory, meshes, textures

BLEND, FBX = ".blend", ".fbx"
# Of files that Blender compressed: gzip before 3.0, Zstandard since.
_COMPRESSED = (b"\x1f\x8b", b"\x28\xb5\x2f\xfd")
# The importer of newer versions comes first.
_IMPORTERS = ("wm.fbx_import", "import_scene.fbx")
_IMPORT = {"use_custom_props": True}
# Avoid options that add bones, or that apply modifiers and shape keys.
_WAS_TEXT = "The file was FBX as text (ASCII), and is binary now; what Blender left out was not counted."
_EXPORT = {"use_custom_props": True, "add_leaf_bones": False, "use_mesh_modifiers": False, "check_existing": False}
# Textures that the file contained stay in it.
_EMBEDDED = {"path_mode": "COPY", "embed_textures": True}
_RELATIVE = {"path_mode": "RELATIVE"}


class BlenderAsset:
    """A .blend or .fbx file that Blender has read; writing reopens it, whatever Blender holds by then.

    Attributes:
        path: of the file.
        suffix: of the file.
        uv_map: name of the map, empty for the active one.
        meters: per unit of length in the scene.
        meshes: of the objects in any scene, each once.
        warnings: what was left unchanged, and why.
        drawn_textures: those that `save` drew last.
    """

    def __init__(self, path: Path, uv_map: str = "") -> None:
        """Read the file.

        Args:
            path: of a .blend or .fbx file.
            uv_map: name of the map to read and write, created if missing; by default the active one.

        Raises:
            AssetError: Blender cannot read it, or there is nothing to unwrap.
        """
        self.path, self.suffix = path, path.suffix.lower()
        self.uv_map = uv_map
        self.warnings: list[str] = []
        self.drawn_textures: list[DrawnTexture] = []
        self._replaced: inventory.Items = Counter()
        self._atlas: textures.Atlas | None = None
        with path.open("rb") as file:
            data = file.read(-1 if self.suffix == FBX else len(fbx_inventory.MAGIC))
        if not data:
            raise AssetError(f"{path.name} is empty.")
        self._is_compressed = data.startswith(_COMPRESSED)
        self._is_text = self.suffix == FBX and not data.startswith(fbx_inventory.MAGIC)
        # Importers skip what they cannot read.
        if self.suffix == FBX and not self._is_text and (found := fbx_inventory.damage(data)):
            raise AssetError(f"{path.name}: is a damaged FBX file: {found}.")
        self._counts = fbx_inventory.count(data)
        del data
        self._open()
        self.meters = float(bpy.context.scene.unit_settings.scale_length)
        self._items = inventory.listed()
        if self.suffix == FBX:
            self._items = Counter({key: n for key, n in self._items.items() if key[0] in inventory.CONVERTED})
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
                self.warnings.append(f"The extenders of {mesh.name} were ignored: only the add-on applies them.")
        if self.suffix == BLEND and bpy.data.version[:2] != bpy.app.version[:2]:
            before, now = (".".join(map(str, version[:2])) for version in (bpy.data.version, bpy.app.version))
            self.warnings.append(f"The file was saved by Blender {before}, and now by {now}.")
        if linked:
            self.warnings.append(f"Left unchanged, because they belong to linked files: {', '.join(sorted(linked))}.")
        if not self.meshes:
            raise NoMeshError(f"{path.name}: has no mesh of its own with faces; there is nothing to unwrap.")

    def _open(self) -> bool:
        """Let Blender read the file, and leave edit mode; return whether the file was in edit mode."""
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        if self.suffix == BLEND:
            # Scripts in the file do not run.
            _call("wm.open_mainfile", {"filepath": str(self.path), "load_ui": False, "use_scripts": False}, self.path)
            bpy.context.view_layer.update()
            # In edit mode, its own mesh would replace the written one; other modes have no mesh of their own.
            is_edited = bpy.context.mode == "EDIT_MESH"
            if is_edited:
                bpy.ops.object.mode_set(mode="OBJECT")
            return is_edited
        importer = next(filter(_is_known, _IMPORTERS), None)
        if importer is None:
            raise AssetError(f"{self.path.name}: Blender {bpy.app.version_string} has no FBX importer enabled.")
        if self._is_text and importer != _IMPORTERS[0]:
            raise AssetError(
                f"{self.path.name}: Blender {bpy.app.version_string} cannot read FBX as text (ASCII): save it as "
                "binary FBX, or use Blender 4.5 or later."
            )
        _call(importer, {"filepath": str(self.path), **_IMPORT}, self.path)
        return False

    def share(self, maps: Sequence[UvMap], size: TextureSize, shared: SharedTextures) -> None:
        """Add the textures to those that it shares with others; the arguments are those of `assets.share`."""
        if not images.can_write():
            self._warn(f"{self.path.name} has images of its own: this Blender has no OpenImageIO, which atlases need.")
            return
        self._open()
        given = self._open_meshes(), self.meshes, maps
        self._atlas = textures.share(*given, self.uv_map, shared, self._warn)
        if size.colors:
            self._warn(f"Vertex colors of {self.suffix} files are not in the atlas: they have images of their own.")

    def _layer(self, of: Sequence[bpy.types.Mesh]) -> str:
        """Return the name of the map as nodes give it; empty for the one that renders use in every mesh."""
        layers = [each.uv_layers.get(self.uv_map) if self.uv_map else each.uv_layers.active for each in of]
        found = [each for each in layers if each is not None]
        return "" if all(each.active_render for each in found) else found[0].name

    def _open_meshes(self) -> list[bpy.types.Mesh]:
        return [bpy.data.meshes[name] for name in self._names]

    def _baked(self, maps: Sequence[UvMap], size: TextureSize) -> list[baking.BakedInput]:
        """Return what only Blender can draw for the new maps; afterwards, the file is not as it was."""
        wanted, warnings = textures.to_bake(self._open_meshes(), self.meshes, maps, self.uv_map)
        self.warnings += warnings
        try:
            return baking.bake(wanted, self._open_meshes(), maps, self.uv_map, size) if wanted else []
        except RuntimeError as error:
            self._warn(f"What is not an image was not baked for the new map: {str(error).strip()}")
            self._open()
            self._part_materials(maps)
            return []

    def _part_materials(self, maps: Sequence[UvMap]) -> None:
        textures.part_materials(self._open_meshes(), self.meshes, maps, self.uv_map)

    def _warn(self, warning: str) -> None:
        self.warnings += [] if warning in self.warnings else [warning]

    def save(self, path: Path, maps: Sequence[UvMap], size: TextureSize | None = None) -> None:
        """Write the file with new UVs to a path of the same suffix, and adapt its relative paths.

        With `size`, image textures that read the map are drawn anew, and stored in the file; those that it shares with
        other assets are named.

        Raises:
            AssetError: Blender cannot write it.
        """
        was_edited = self._open()
        # Textures drawn anew are read as they are.
        if not size and textures.are_moved(self._open_meshes(), self.uv_map):
            self._warn("Materials scale, turn or move textures of the map, which was left.")
        if size:
            before = inventory.listed()
            self._part_materials(maps)
            baked = self._baked(maps, size) if self.suffix == BLEND else []
            if baked:
                was_edited = self._open()
                self._part_materials(maps)
            given = self._open_meshes(), self.meshes, maps
            how = self._atlas, self.suffix == BLEND
            self.drawn_textures, warnings = textures.redraw(*given, self.uv_map, size, *how)
            self.warnings += warnings
            self.drawn_textures += [each.apply(self._layer(given[0])) for each in baked]
            if size.colors:
                self.drawn_textures += textures.draw_colors(*given, self.uv_map, size, self.suffix == FBX)
            self._replaced = before - inventory.listed()
        for name, uv_map in zip(self._names, maps):
            meshes.write_uv(bpy.data.meshes[name], self.uv_map, uv_map)
        if was_edited:
            bpy.ops.object.mode_set(mode="EDIT")
        if self.suffix == BLEND:
            inventory.keep()
            options = {"copy": True, "check_existing": False, "compress": self._is_compressed}
            _call("wm.save_as_mainfile", {"filepath": str(path), **options}, path)
        else:
            textures.unlink_full_opacity()
            is_embedded = any(each.packed_file for each in bpy.data.images)
            paths = _EMBEDDED if is_embedded else _RELATIVE if self._atlas else {}
            _call("export_scene.fbx", {"filepath": str(path), **_EXPORT, **paths}, path)
        if not path.is_file():
            raise AssetError(f"{path.name}: Blender wrote nothing; is the disk full?")

    def check(self, written: BlenderAsset, maps: Sequence[UvMap]) -> None:
        """Compare the file as read back with the intended content; warn of what Blender's exporter left out or added.

        Raises:
            OSError: a mesh is missing, or has other faces or another map.
        """
        if self.suffix == FBX:
            lost = fbx_inventory.lost(self._counts, written._counts)
            self.warnings += [_WAS_TEXT] if self._is_text else lost
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
                raise OSError(f"{written.path.name}: does not read back as written; is the disk full?")

    def lost(self, written: BlenderAsset) -> list[str]:
        """Return what the file as read back lacks: a phrase for each kind."""
        return lacking(self._items - self._replaced, written._items)


def _operator(name: str) -> Any:  # noqa: ANN401 - Blender's own type has no name
    module, _, function = name.partition(".")
    return getattr(getattr(bpy.ops, module), function)


def _is_known(name: str) -> bool:
    """Return whether this Blender has an operator."""
    try:
        _operator(name).get_rna_type()
    except KeyError:
        return False
    return True


def _call(name: str, arguments: dict[str, Any], path: Path) -> None:
    """Call a Blender operator with the arguments that it supports in this version.

    Raises:
        AssetError: it failed or was canceled.
    """
    operator = _operator(name)
    known = operator.get_rna_type().properties.keys()
    try:
        status = operator(**{key: value for key, value in arguments.items() if key in known})
    except Exception as error:  # noqa: BLE001 - importers are third-party Python; a broken file may fail anywhere
        # The error itself comes before the traceback's line about its position in Blender.
        lines = [line for line in str(error).splitlines() if line.strip() and not line.startswith((" ", "Location:"))]
        reason = (lines or [type(error).__name__])[-1].removeprefix("Error: ")
        # Blender names the path, maybe twice, before it says why.
        reason = re.sub(rf"^.*{re.escape(str(path))}['\"](?: failed)?[: ]*(?=.)", "", reason)
        raise AssetError(f"{path.name}: {name} failed: {reason}") from error
    if "FINISHED" not in status:
        raise AssetError(f"{path.name}: {name} was canceled.")
