"""Files of meshes: read once for their geometry, and UVs written into what is there.

Own code, since no library that we know keeps what it does not read, or says which line is broken.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import numpy.typing as npt

from .mesh import Asset, AssetError, AssetMesh
from .obj import ObjAsset, PlainAsset
from .off import read_off
from .ply import PlyAsset
from .stl import read_stl

__all__ = ["READABLE", "Asset", "AssetError", "AssetMesh", "read", "write", "written_as"]

_READERS = {".obj": ObjAsset, ".off": read_off, ".ply": PlyAsset, ".stl": read_stl}
READABLE = tuple(_READERS)


def read(path: Path) -> Asset:
    """Read a mesh; the suffix says which format it is in.

    Raises:
        AssetError: the suffix is none of READABLE, or the content is broken.
        OSError: the file cannot be opened.
    """
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise AssetError(f"{path}: only {', '.join(READABLE)} files can be read, not '{path.suffix}'.")
    return reader(path)


def written_as(path: Path) -> str:
    """Return the suffix, with the dot, that a file gets when UVs are written: its own, if its format holds them."""
    reader = _READERS.get(path.suffix.lower())
    return getattr(reader, "suffix", PlainAsset.suffix)


def write(path: Path, asset: Asset, uv: npt.NDArray[np.float64], mapped: npt.NDArray[np.bool_]) -> None:
    """Write a file with a UV map, whole or not at all.

    In the format of the asset all that it had is as it was; an OBJ file of another format has the mesh alone.

    Args:
        path: where to, with the asset's suffix or .obj.
        asset: as it was read.
        uv: (C, 2).
        mapped: (faces,) faces without a map get no UVs.

    Raises:
        OSError: it cannot be written, or is not read back as it was written; what lay there is as it was.
    """
    if path.suffix.lower() != asset.suffix:
        asset = PlainAsset(asset.mesh)
    content = asset.with_uv(uv, mapped)
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        with temporary.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if temporary.read_bytes() != content:
            raise OSError(f"{path}: what was written cannot be read again; is the disk full or failing?")
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
