"""Checks of an asset as read back, before it replaces anything."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .mesh import AssetError, AssetMesh, UvMap

# In single precision, maybe scaled by a material.
_ROUNDING = 1e-4


def compare(source: Sequence[AssetMesh], written: Sequence[AssetMesh], has_all_meshes: bool) -> None:
    """Raise AssetError unless the result has the meshes and faces of the source; OBJ files are one mesh."""
    before, after = ([len(mesh.face_offsets) - 1 for mesh in meshes] for meshes in (source, written))
    if before != after if has_all_meshes else sum(before) != sum(after):
        counts = [f"{len(each)} meshes with {sum(each)} faces" for each in (before, after)]
        raise AssetError(f"The source has {counts[0]}, the result {counts[1]}: something was lost on the way.")


def check_maps(target: Path, written: Sequence[AssetMesh], maps: Sequence[UvMap]) -> None:
    """Raise OSError unless the meshes have these maps, up to single precision; an OBJ file has all as one."""
    found = [mesh.corner_uv for mesh in written]
    if any(each is None for each in found):
        found = [
            np.full((int(mesh.face_offsets[-1]), 2), np.nan) if uv is None else uv for mesh, uv in zip(written, found)
        ]
    is_mapped = np.concatenate([each.mapped for each in maps])
    sizes = np.concatenate([np.diff(mesh.face_offsets) for mesh in written])
    chosen = np.repeat(is_mapped, sizes)
    new, old = np.concatenate(found)[chosen], np.concatenate([each.uv for each in maps])[chosen]
    if not (np.abs(new - old) <= _ROUNDING * (1.0 + np.abs(old))).all():
        raise OSError(f"{target}: its map does not read back as written.")
