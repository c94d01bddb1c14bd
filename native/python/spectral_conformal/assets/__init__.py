"""Files of meshes: read once for their geometry, and UVs written into what is there.

Own code, since no library that we know keeps what it does not read, or says which line is broken.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence
from pathlib import Path

from . import references
from .gltf import GltfAsset
from .mesh import Asset, AssetError, AssetMesh, UvMap
from .obj import ObjAsset, PlainAsset
from .off import read_off
from .ply import PlyAsset
from .stl import read_stl
from .temporary import temporary_beside
from .usd import UsdAsset

__all__ = ["READABLE", "Asset", "AssetError", "AssetMesh", "UvMap", "read", "write", "written_as"]

_READERS = {
    ".glb": GltfAsset,
    ".gltf": GltfAsset,
    ".obj": ObjAsset,
    ".off": read_off,
    ".ply": PlyAsset,
    ".stl": read_stl,
    **dict.fromkeys((".usd", ".usda", ".usdc", ".usdz"), UsdAsset),
}
_WITHOUT_UV = (".off", ".stl")
READABLE = tuple(_READERS)


def read(path: Path, uv_map: str = "") -> Asset:
    """Read a mesh; the suffix says which format it is in.

    Args:
        path: the file.
        uv_map: which of its UV maps is read, and written; of a format that has one alone, that. See `GltfAsset` and
            `UsdAsset`.

    Raises:
        AssetError: the suffix is none of READABLE, or the content is broken.
        OSError: the file cannot be opened.
    """
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise AssetError(f"{path}: only {', '.join(READABLE)} files can be read, not '{path.suffix}'.")
    return reader(path, uv_map) if reader in (GltfAsset, UsdAsset) else reader(path)


def written_as(path: Path) -> str:
    """Return the suffix, with the dot, that a file gets when UVs are written: its own, if its format holds them."""
    suffix = path.suffix.lower()
    return PlainAsset.suffix if suffix in _WITHOUT_UV else suffix


def write(path: Path, asset: Asset, maps: Sequence[UvMap]) -> list[str]:
    """Write an asset with other UV maps, every file of it whole or not at all; return what is to be said of it.

    In its own format all that it had is as it was; an OBJ file of another format has the meshes alone. Textures and
    materials that it names by paths from its folder are copied where it is written into another one.

    Args:
        path: where to, with the asset's suffix or .obj.
        asset: as it was read.
        maps: of each of its meshes.

    Raises:
        OSError: it cannot be written, or is not read back as it was written; what lay there is as it was.
    """
    if path.suffix.lower() != asset.suffix:
        asset = PlainAsset(asset.meshes)
    written = {}
    try:
        for named, content in asset.files(path, maps).items():
            # What a link names is written, and the link stays.
            target = Path(os.path.realpath(named))
            temporary = temporary_beside(target)
            written[temporary] = target
            with temporary.open("wb") as file:
                file.write(content)
                file.flush()
                os.fsync(file.fileno())
            if temporary.read_bytes() != content:
                raise OSError(f"{named}: what was written cannot be read again; is the disk full or failing?")
            if target.exists():
                shutil.copymode(target, temporary)
        copied = references.copy_along(asset.path, path, asset.references()) if asset.path else []
        for temporary, target in written.items():
            temporary.replace(target)
    finally:
        for temporary in written:
            temporary.unlink(missing_ok=True)
    return [*asset.warnings, *copied]
