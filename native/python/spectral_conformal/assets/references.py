"""Files that an asset references by relative paths: they are copied when the asset goes to another folder."""

from __future__ import annotations

import functools
import itertools
import os
import re
import shutil
from collections.abc import Callable, Container, Iterable
from pathlib import Path, PurePosixPath

from .temporary import temporary_beside

# From "MTL material format", Wavefront's appendix to the manual of OBJ, and from later programs.
_TEXTURE = re.compile(rb"^[ \t]*(?:map_\w+|bump|disp|decal|refl|norm)[ \t]+([^\r\n]+)", re.MULTILINE | re.IGNORECASE)

# Takes the source of a copy, the copy, and the function that changes a path.
Renamer = Callable[[Path, Path, Callable[[str], str]], None]


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


def free_beside(out: Path, name: str, source: Path, taken: Container[str]) -> Path:
    """Return the path of a new file with about this name beside the file `out`.

    The name is not taken, and where the source is, too, not that of an existing file.
    """
    first, is_source = Path(name), out.resolve().parent == source.resolve().parent
    numbered = (f"{first.stem}_{number}{first.suffix}" for number in itertools.count(1))
    paths = (out.with_name(each) for each in itertools.chain([name], numbered))
    return next(path for path in paths if path.name not in taken and not (is_source and path.exists()))


def copy_along(source: Path, target: Path, names: Iterable[str], rename: Renamer | None = None) -> list[str]:
    """Copy referenced files along with an asset; return warnings about those that stay where they are.

    Copies name files outside the asset's folder by paths from where they are.

    Args:
        source: the asset.
        target: the file to write.
        names: paths relative to the folder of the source; the files may be missing.
        rename: changes the paths in a copied file, if the format's files have any.
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
                if rename:
                    rename(
                        origin / name,
                        partial,
                        functools.partial(_from_copy, origin, (origin / name).parent, there.parent),
                    )
                partial.replace(there)
            finally:
                partial.unlink(missing_ok=True)
    return warnings


def _from_copy(root: Path, folder: Path, new_folder: Path, name: str) -> str:
    """Return the path by which a copied file names another one, which goes along if it is in or below `root`."""
    found = Path(os.path.normpath(folder / name))
    if not name or PurePosixPath(name).is_absolute() or not found.is_file() or root in found.parents:
        return name
    return Path(os.path.relpath(found, new_folder)).as_posix()


def rename_textures(source: Path, copy: Path, named: Callable[[str], str]) -> None:
    """Change the paths of textures in the copy of a material file; other files stay."""
    if source.suffix.lower() != ".mtl":
        return

    def changed(found: re.Match[bytes]) -> bytes:
        name = name_of(os.fsdecode(found[1].strip()), source.parent)
        new = named(name.replace("\\", "/"))
        return found[0] if new == name.replace("\\", "/") else found[0].replace(os.fsencode(name), os.fsencode(new))

    copy.write_bytes(_TEXTURE.sub(changed, copy.read_bytes()))


def textures_of(library: Path) -> list[str]:
    """Return the relative paths in a material file; empty if it cannot be read."""
    try:
        lines = _TEXTURE.findall(library.read_bytes())
    except OSError:
        return []
    return [name_of(os.fsdecode(line.strip()), library.parent).replace("\\", "/") for line in lines]


def textures_of_materialx(library: Path) -> list[str]:
    """Return the relative paths of the textures that a MaterialX file names, which USD lists only with a plugin."""
    text = library.read_text(encoding="utf-8", errors="replace")
    prefix = "".join(re.findall(r'<materialx\b[^>]*\bfileprefix="([^"]*)"', text)[:1])
    files = [tag for tag in re.findall(r"<input\b[^>]*>", text) if 'type="filename"' in tag]
    return [prefix + name for tag in files for name in re.findall(r'\bvalue="([^"]+)"', tag)]


def name_of(rest: str, folder: Path) -> str:
    """Return the file that a line of a material file names; a name may contain spaces, and options may precede it."""
    ends = [rest[word.start() :] for word in re.finditer(r"\S+", rest)]
    return next((name for name in ends if (folder / name.replace("\\", "/")).is_file()), ends[-1])
