"""Files that an asset references by relative paths: they are copied when the asset goes to another folder."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterable
from pathlib import Path, PurePosixPath

from .temporary import temporary_beside

# From "MTL material format", Wavefront's appendix to the manual of OBJ, and from later programs.
_TEXTURE = re.compile(rb"^[ \t]*(?:map_\w+|bump|disp|decal|refl|norm)[ \t]+([^\r\n]+)", re.MULTILINE | re.IGNORECASE)


def elsewhere(name: str, source: Path, target: Path) -> str:
    """Return the path by which an asset references a file after it is written to another folder.

    A file in or below the asset's folder is copied along and keeps its path, and so does a missing file.

    Args:
        name: path relative to the folder of the source.
        source: the asset.
        target: the file to write.
    """
    origin, goal = source.resolve().parent, target.resolve().parent
    found = Path(os.path.normpath(origin / name))
    if origin == goal or PurePosixPath(name).is_absolute() or not found.is_file() or origin in found.parents:
        return name
    return Path(os.path.relpath(found, goal)).as_posix()


def copy_along(source: Path, target: Path, names: Iterable[str]) -> list[str]:
    """Copy referenced files along with an asset; return warnings about those that cannot be copied.

    Args:
        source: the asset.
        target: the file to write.
        names: paths relative to the folder of the source; the files may be missing.
    """
    origin, goal = source.resolve().parent, target.resolve().parent
    if origin == goal:
        return []
    warnings = []
    for name in dict.fromkeys(names):
        if not (origin / name).is_file():
            continue
        if elsewhere(name, source, target) != name or PurePosixPath(name).is_absolute():
            warnings.append(f"{name} was not copied, because it is outside the folder of {source.name}.")
            continue
        there = goal / name
        if not there.exists():
            there.parent.mkdir(parents=True, exist_ok=True)
            partial = temporary_beside(there)
            try:
                shutil.copy2(origin / name, partial)
                partial.replace(there)
            finally:
                partial.unlink(missing_ok=True)
    return warnings


def textures_of(library: Path) -> list[str]:
    """Return the relative paths in a material file; empty if it cannot be read."""
    try:
        lines = _TEXTURE.findall(library.read_bytes())
    except OSError:
        return []
    rests = [os.fsdecode(line.strip()).replace("\\", "/") for line in lines]
    # A name may contain spaces; options may precede it.
    return [rest if (library.parent / rest).is_file() else rest.split()[-1] for rest in rests]
