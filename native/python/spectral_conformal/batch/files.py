"""Assets of all formats: read them, write them with UVs, and read them back."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .. import assets
from .._texture_size import TextureSize
from ..assets import Asset, AssetMesh, SharedTextures, UvMap, inventory
from ..assets.temporary import temporary_beside
from ..assets.usd import UsdAsset
from .entries import OF_BLENDER, USD
from .settings import SMART, BatchSettings

if TYPE_CHECKING:
    from .blender.files import BlenderAsset

_Z_UP = (".blend", ".ply", ".stl", ".off")


def needs_blender(source: Path, settings: BatchSettings) -> bool:
    """Return whether an asset needs a worker with Blender."""
    return source.suffix.lower() in OF_BLENDER or settings.checker or settings.seams == SMART


def read(source: Path, settings: BatchSettings) -> Asset | BlenderAsset:
    """Read an asset.

    Raises:
        AssetError: it cannot be read, or contains nothing to unwrap.
        OSError: the file cannot be opened.
    """
    suffix = source.suffix.lower()
    if suffix in OF_BLENDER:
        try:
            from .blender.files import BlenderAsset
        except ImportError as error:
            raise assets.AssetError(f"{source.name} needs Blender, as bpy in this Python: pip install bpy.") from error
        return BlenderAsset(source, settings.uv_map)
    if source.stat().st_size == 0:
        raise assets.AssetError(f"{source.name} is empty.")
    if settings.usd_over and suffix in USD:
        return UsdAsset(source, settings.uv_map, over=True)
    return assets.read(source, settings.uv_map)


def write(
    target: Path, asset: Asset | BlenderAsset, maps: Sequence[UvMap], textures: TextureSize | None = None
) -> tuple[Sequence[AssetMesh], Sequence[str]]:
    """Write an asset with new UVs; return its meshes as read back, and the warnings.

    With `textures`, those that read the map are drawn anew, where the format allows it (`assets.write`).
    An existing file is replaced only after the new one has been read back and checked.

    Raises:
        AssetError: it cannot be written, or something of the source would be lost.
        OSError: it cannot be written, or does not read back as written.
    """
    if target.suffix.lower() not in OF_BLENDER:
        return assets.write(target, asset, maps, textures)
    partial = temporary_beside(target)
    try:
        written = _saved(partial, target, asset, maps, textures)
        if lost := asset.lost(written):
            raise assets.AssetError(inventory.message(target, lost))
        partial.replace(os.path.realpath(target))
    finally:
        partial.unlink(missing_ok=True)
    return written.meshes, asset.warnings


def share(
    target: Path, asset: Asset | BlenderAsset, maps: Sequence[UvMap], textures: TextureSize, shared: SharedTextures
) -> None:
    """Add the textures of an asset to those that it shares with others, before it is written, as `assets.share`."""
    if target.suffix.lower() in OF_BLENDER:
        asset.share(maps, textures, shared)
    else:
        assets.share(target, asset, maps, textures, shared)


def _saved(
    partial: Path, target: Path, asset: BlenderAsset, maps: Sequence[UvMap], textures: TextureSize | None
) -> BlenderAsset:
    """Let Blender write an asset beside its target; return it as read back."""
    try:
        asset.save(partial, maps, textures)
        with partial.open("rb+") as file:
            os.fsync(file.fileno())
        written = type(asset)(partial, asset.uv_map)
        asset.check(written, maps)
    except (assets.AssetError, OSError) as error:
        reason = str(error).replace(str(partial), target.name).replace(partial.name, target.name)
        raise OSError(f"It cannot be written, or does not read back as written; is the disk full? {reason}") from error
    return written


def y_is_up(source: Path) -> bool:
    """Return whether the second axis points upward by the convention of the format."""
    return source.suffix.lower() not in _Z_UP
