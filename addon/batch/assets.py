# SPDX-License-Identifier: GPL-3.0-or-later
"""The assets of a batch: which files, and where what is made of them goes."""

from __future__ import annotations

import difflib
import hashlib
import os
import shutil
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

# What Blender reads, given the right version. STL holds no UVs, so that nothing can be written in it.
READABLE = (".blend", ".fbx", ".glb", ".gltf", ".obj", ".ply", ".stl", ".usd", ".usda", ".usdc", ".usdz")
USD = (".usd", ".usda", ".usdc", ".usdz")
WITHOUT_UVS = {".stl": ".obj"}
WRITABLE = tuple(suffix for suffix in READABLE if suffix not in WITHOUT_UVS)
REPORT = "report.json"
LAYOUT = "layout.png"
CHECKER = "checker.png"
THUMBNAIL = "thumbnail.png"


class InputError(Exception):
    """The inputs cannot be a batch; the message says which and why."""


@dataclass(frozen=True)
class Asset:
    """A file to unwrap.

    Attributes:
        name: path below the folder that all inputs have in common, with slashes; unique in the batch.
        source: the file, absolute.
        folder: where its report and pictures go, absolute.
        target: the unwrapped file, absolute.
    """

    name: str
    source: Path
    folder: Path
    target: Path


def find(
    inputs: Sequence[str], out: Path, suffix: str = "", usd_over: bool = False, overwrite_source: bool = False
) -> list[Asset]:
    """Return the assets in files and, with all below them, folders, sorted by name.

    Args:
        inputs: files and folders. Of a folder those files count that Blender may read; a file always counts.
        out: folder of the results; what lies in it is no input.
        suffix: of the unwrapped files, with the dot; empty for that of the source.
        usd_over: USD becomes a layer over the source.
        overwrite_source: write every unwrapped file over its source.

    Raises:
        InputError: an input does not exist, nothing is found, or two results would be one file.
    """
    out = out.resolve()
    roots = [Path(name).resolve() for name in inputs]
    missing = [name for name, root in zip(inputs, roots) if not root.exists()]
    if missing:
        raise InputError(f"There is no {', no '.join(missing)}.")
    if suffix and suffix not in WRITABLE:
        closest = difflib.get_close_matches(suffix, WRITABLE, 1)
        hint = f" Did you mean {closest[0]}?" if closest else ""
        raise InputError(f"{suffix} is none of the formats that hold UVs: {', '.join(WRITABLE)}.{hint}")
    sources = sorted({source for root in roots for source in _files(root, out)})
    if not sources:
        raise InputError(f"No file to read in {', '.join(inputs)}: Blender reads {', '.join(READABLE)}.")
    common = Path(os.path.commonpath([root if root.is_dir() else root.parent for root in roots]))
    return [_asset(source, common, out, suffix, usd_over, overwrite_source) for source in sources]


def _files(root: Path, out: Path) -> Iterable[Path]:
    if root.is_file():
        return [root]
    found = (path for path in root.rglob("*") if path.suffix.lower() in READABLE and path.is_file())
    return (path for path in found if out not in path.parents)


def _asset(source: Path, common: Path, out: Path, suffix: str, usd_over: bool, overwrite_source: bool) -> Asset:
    name = source.relative_to(common).as_posix()
    folder = out / name
    own = source.suffix.lower()
    if overwrite_source:
        if suffix not in ("", own):
            raise InputError(f"{name} cannot be written over as {suffix}: leave out --format or --overwrite-source.")
        if own in WITHOUT_UVS:
            raise InputError(f"{name} cannot be written over: {own} holds no UVs.")
        return Asset(name, source, folder, source)
    if usd_over and own in USD:
        return Asset(name, source, folder, folder / f"{source.stem}.uv.usda")
    new = suffix or WITHOUT_UVS.get(own, source.suffix)
    return Asset(name, source, folder, folder / f"{source.stem}{new}")


def digest(path: Path) -> str:
    """Return a digest of a file's content."""
    state = hashlib.blake2b(digest_size=16)
    with path.open("rb") as file:
        while block := file.read(1 << 20):
            state.update(block)
    return state.hexdigest()


def remove(path: Path) -> None:
    """Remove a file or a folder, if it is there."""
    if path.is_dir():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)
