"""Files that an asset names by paths from its own folder: they go along where it is written into another one."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterable
from pathlib import Path, PurePosixPath

from .temporary import temporary_beside

# Of "MTL material format", Wavefront's appendix to the manual of OBJ, and what later programs have added.
_TEXTURE = re.compile(rb"^[ \t]*(?:map_\w+|bump|disp|decal|refl|norm)[ \t]+([^\r\n]+)", re.MULTILINE | re.IGNORECASE)


def elsewhere(name: str, source: Path, target: Path) -> str:
    """Return by what path an asset that is written elsewhere names a file that does not go along.

    Of one that does, since it lies in or below the asset's folder, or is not there, this is the path that it has.

    Args:
        name: path from the folder of the source.
        source: the asset.
        target: where it is written.
    """
    origin, goal = source.resolve().parent, target.resolve().parent
    found = Path(os.path.normpath(origin / name))
    if origin == goal or PurePosixPath(name).is_absolute() or not found.is_file() or origin in found.parents:
        return name
    return Path(os.path.relpath(found, goal)).as_posix()


def copy_along(source: Path, target: Path, names: Iterable[str]) -> list[str]:
    """Copy files to where an asset that is written elsewhere names them; return what could not be, in sentences.

    Args:
        source: the asset.
        target: where it is written.
        names: paths from the folder of the source, which may not be there.
    """
    origin, goal = source.resolve().parent, target.resolve().parent
    if origin == goal:
        return []
    warnings = []
    for name in dict.fromkeys(names):
        if not (origin / name).is_file():
            continue
        if elsewhere(name, source, target) != name or PurePosixPath(name).is_absolute():
            warnings.append(f"{name} stays where it is, above the folder of {source.name}, which names it.")
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
    """Return what a file of materials names, by paths from its folder; empty for one that cannot be read."""
    try:
        lines = _TEXTURE.findall(library.read_bytes())
    except OSError:
        return []
    rests = [os.fsdecode(line.strip()).replace("\\", "/") for line in lines]
    # A name may have blanks; options may stand before it.
    return [rest if (library.parent / rest).is_file() else rest.split()[-1] for rest in rests]
