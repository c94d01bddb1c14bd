"""Mesh files: read their geometry, and write UVs into the existing content.

This is our own code because no library that we know preserves what it does not read, or names the broken line.
"""

from __future__ import annotations

import contextlib
import gc
import os
import shutil
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from .._drawing_plan import DrawingPlan
from .._native import Cancelled
from .._texture_size import TextureSize
from . import inventory, reading_back, references
from .gltf import GltfAsset
from .mesh import Asset, AssetError, AssetMesh, NoMeshError, UvMap, check_kind
from .obj import ObjAsset, PlainAsset
from .off import read_off
from .ply import PlyAsset
from .shared_textures import SharedTextures
from .stl import read_stl
from .temporary import blake2b, digest, temporary_beside
from .usd import UsdAsset

__all__ = [
    "READABLE",
    "Asset",
    "AssetError",
    "AssetMesh",
    "NoMeshError",
    "SharedTextures",
    "TextureSize",
    "UvMap",
    "planned",
    "read",
    "share",
    "write",
    "written_as",
]

_OF_USD = (".usd", ".usda", ".usdc", ".usdz")
_READERS = {
    ".glb": GltfAsset,
    ".gltf": GltfAsset,
    ".obj": ObjAsset,
    ".off": read_off,
    ".ply": PlyAsset,
    ".stl": read_stl,
    **dict.fromkeys(_OF_USD, UsdAsset),
}
_WITHOUT_UV = (".off", ".stl")
READABLE = tuple(_READERS)


def read(path: Path, uv_map: str = "", places: Mapping[Path, Path] | None = None) -> Asset:
    """Read a mesh; the suffix determines the format.

    Args:
        path: the file.
        uv_map: the UV map to read and write; see `GltfAsset` and `UsdAsset`. Formats with a single map replace that
            one, with a warning.
        places: where the content of files is that have no names of their own yet, by their resolved paths.

    Raises:
        AssetError: the suffix is not in READABLE, or the content is broken.
        OSError: the file cannot be opened.
    """
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise AssetError(f"{path}: only {', '.join(READABLE)} files can be read, not '{path.suffix}'.")
    check_kind(path)
    if reader is GltfAsset:
        return GltfAsset(path, uv_map, places)
    if reader is UsdAsset:
        return UsdAsset(path, uv_map)
    asset = reader(path)
    if uv_map:
        said = f"{written_as(path)} files have one UV map without a name: it was replaced, not added as {uv_map}."
        asset.warnings = [*asset.warnings, said]
    return asset


def written_as(path: Path) -> str:
    """Return the suffix, with the dot, for writing a file with UVs: its own if the format holds UVs."""
    suffix = path.suffix.lower()
    return PlainAsset.suffix if suffix in _WITHOUT_UV else suffix


def write(
    path: Path, asset: Asset, maps: Sequence[UvMap], textures: TextureSize | None = None
) -> tuple[Sequence[AssetMesh], list[str]]:
    """Write an asset with new UV maps, each of its files completely or not at all.

    In its own format all other content stays unchanged; an OBJ file made from another format contains only the meshes.
    If the asset goes to another folder, the textures and materials that it references by relative paths are copied.
    Before anything is replaced, its meshes are read back, and readers of their own compare what the source and the
    result have (`inventory`).

    Args:
        path: the destination, with the asset's suffix or .obj.
        asset: as read.
        maps: one for each of its meshes.
        textures: draw the textures that read the replaced map anew, in this size; of PLY only vertex colors, and of
            others none, with a warning.

    Returns:
        The meshes as read back, and the warnings.

    Raises:
        AssetError: something of the source would be lost; existing files stay unchanged.
        OSError: it cannot be written, or its map does not read back as written; existing files stay unchanged.
    """
    uv_map, is_whole = asset.uv_map, path.suffix.lower() == asset.suffix
    meshes = asset.meshes
    if isinstance(asset, PlainAsset):
        # Its source can have no textures.
        textures = None
    elif path.suffix.lower() != asset.suffix:
        asset = PlainAsset(asset.meshes)
    written = {}
    try:
        for named, content in _files(path, asset, maps, textures).items():
            # Write the target of a link and keep the link.
            target = Path(os.path.realpath(named))
            temporary = temporary_beside(target)
            written[temporary] = target
            state = blake2b()
            with temporary.open("wb") as file:
                for piece in content:
                    file.write(piece)
                    state.update(piece)
                file.flush()
                os.fsync(file.fileno())
            if digest(temporary) != state.hexdigest():
                raise OSError(f"{named}: what was written cannot be read again; is the disk full or failing?")
            if target.exists():
                shutil.copymode(target, temporary)
        copied = references.copy_along(asset.path, path, asset.references(), asset.rename) if asset.path else []
        places = {target: temporary for temporary, target in written.items()}
        read_back = _read_back(path, uv_map, places)
        changed = "shared" if getattr(asset, "shared", None) else "own" if textures else "no"
        if asset.path and (lost := inventory.lost(asset.path, path, places, changed)):
            raise AssetError(inventory.message(path, lost))
        reading_back.compare(meshes, read_back, is_whole)
        reading_back.check_maps(path, read_back, maps)
        for temporary, target in written.items():
            temporary.replace(target)
    except OSError as error:
        # The file that the user knows.
        if isinstance(error.filename, (str, Path)) and Path(error.filename) in written:
            error.filename = str(written[Path(error.filename)])
        raise
    finally:
        for temporary in written:
            temporary.unlink(missing_ok=True)
    return read_back, [*asset.warnings, *copied]


def _read_back(path: Path, uv_map: str, places: Mapping[Path, Path]) -> Sequence[AssetMesh]:
    """Return the meshes of a file whose content is still elsewhere."""
    place = places[Path(os.path.realpath(path))]
    try:
        meshes = read(place, uv_map, places).meshes
    except AssetError as error:
        raise OSError(str(error).replace(str(place), str(path)).replace(place.name, path.name)) from error
    if path.suffix.lower() in _OF_USD:
        # Its library keeps files open, and Windows does not rename these.
        gc.collect()
    return meshes


def planned(path: Path, asset: Asset, maps: Sequence[UvMap], textures: TextureSize) -> DrawingPlan | None:
    """Return what drawing the textures of an asset would take, None if none would be drawn.

    The arguments are those of `write`, but only the areas of faces in the maps count.

    Raises:
        AssetError: its content is broken.
    """
    found: list[DrawingPlan] = []

    def stop(plan: DrawingPlan) -> bool:
        found.append(plan)
        return False

    with contextlib.suppress(Cancelled):
        _files(path, asset, maps, replace(textures, colors=False, limits=replace(textures.limits, tell=stop)))
    return found[0] if found else None


def share(path: Path, asset: Asset, maps: Sequence[UvMap], textures: TextureSize, shared: SharedTextures) -> None:
    """Add the textures of an asset to those that it shares with others, before these are drawn and it is written.

    The arguments are those of `write`.

    Raises:
        AssetError: its content is broken.
    """
    if path.suffix.lower() == asset.suffix and isinstance(asset, (GltfAsset, ObjAsset, PlyAsset, UsdAsset)):
        asset.share(path, maps, textures, shared)


def _files(
    path: Path, asset: Asset, maps: Sequence[UvMap], textures: TextureSize | None
) -> Mapping[Path, Iterable[bytes]]:
    if textures is None:
        return asset.files(path, maps)
    if isinstance(asset, (GltfAsset, ObjAsset, UsdAsset)):
        return asset.files(path, maps, textures)
    files = asset.files(path, maps, textures) if isinstance(asset, PlyAsset) else asset.files(path, maps)
    if isinstance(asset, PlyAsset) and (asset.drawn_textures or not [*asset.references()]):
        return files
    said = f"Textures of {path.suffix} files are not drawn anew: they do not fit the new map."
    asset.warnings = [*asset.warnings, said]
    return files
