"""The assets of a batch: their files, and the paths of their results."""

from __future__ import annotations

import fnmatch
import functools
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from .. import assets
from . import report_file

OF_BLENDER = (".blend", ".fbx")
READABLE = (*OF_BLENDER, *assets.READABLE)
_PLAIN = ".obj"
USD = (".usd", ".usda", ".usdc", ".usdz")
REPORT = report_file.REPORT
LAYOUT = "layout.png"
CHECKER = "checker.png"
# With the suffix of its format.
PATTERN = "pattern"
THUMBNAIL = "thumbnail.png"


class InputError(Exception):
    """The inputs do not form a batch; the message says which and why."""


@dataclass(frozen=True)
class Entry:
    """An asset: a file to unwrap.

    Attributes:
        name: path relative to the common folder of all inputs, with slashes; unique in the batch.
        source: the file, absolute.
        folder: for its report and pictures, absolute.
        target: the unwrapped file, absolute.
    """

    name: str
    source: Path
    folder: Path
    target: Path


def find(
    inputs: Sequence[str],
    out: Path,
    suffix: str = "",
    usd_over: bool = False,
    overwrite_source: bool = False,
    include: Sequence[str] = (),
    exclude: Sequence[str] = (),
    on_result: Callable[[Path], object] = lambda path: None,
) -> list[Entry]:
    """Return the assets in files and (recursively) folders, sorted by name.

    Args:
        inputs: files and folders. In a folder, only files of readable formats count; a file always counts.
        out: folder of the results; its content is not an input.
        suffix: ".obj" for unwrapped files with only the meshes; empty for the source's suffix.
        usd_over: USD becomes a layer over the source.
        overwrite_source: write every unwrapped file over its source.
        include: patterns such as "props/*.obj"; only assets whose name fits one of them count. Empty for all.
        exclude: patterns of the names of assets to leave out.
        on_result: takes each file in a folder that is left out, since an earlier run has written it.

    Raises:
        InputError: an input does not exist or is a result of an earlier run, nothing is found, or two results would
            have the same path.
    """
    out = out.resolve()
    roots = [_resolved(name) for name in inputs]
    missing = [name for name, root in zip(inputs, roots) if not root.exists()]
    if missing:
        raise InputError(f"Not found: {', '.join(missing)}.")
    if out in roots:
        raise InputError(f"--out {out} is an input, too: name another folder for the results.")
    if suffix not in ("", _PLAIN):
        raise InputError(f"--format {suffix[1:]}: files keep their format, or become {_PLAIN[1:]}.")
    is_result = _has_report()
    written = [root for root in roots if root.is_file() and is_result(root)]
    if written:
        raise InputError(f"{written[0]} is a result of an earlier run: name its source, or move it elsewhere.")
    sources = sorted({source for root in roots for source in _files(root, out)})
    results = {source for source in sources if is_result(source)}
    for path in sorted(results):
        on_result(path)
    if results and len(results) == len(sources):
        raise InputError(f"All files in {', '.join(inputs)} are results of earlier runs: name their sources.")
    sources = [source for source in sources if source not in results]
    if not sources:
        raise InputError(f"No file to read in {', '.join(inputs)}; readable are {', '.join(READABLE)}.")
    common = Path(os.path.commonpath([root if root.is_dir() else root.parent for root in roots]))

    def chosen(source: Path) -> bool:
        name = source.relative_to(common).as_posix()
        return (fits(name, include) or not include) and not fits(name, exclude)

    found = [_entry(source, common, out, suffix, usd_over, overwrite_source) for source in sources if chosen(source)]
    if not found:
        raise InputError(f"None of {len(sources)} files is left by --include and --exclude.")
    return found


def fits(name: str, patterns: Sequence[str]) -> bool:
    """Return whether the name of an asset fits one of the patterns, such as "props/*.obj"."""
    return any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)


def _resolved(name: str) -> Path:
    try:
        return Path(name).resolve()
    except (OSError, RuntimeError) as error:
        raise InputError(f"{name} is a link that leads nowhere: {error}.") from error


def _files(root: Path, out: Path) -> Iterable[Path]:
    if root.is_file():
        return [root]
    # Links to folders are not followed, since they may form cycles; an unreadable folder is skipped.
    walked = (Path(folder, name) for folder, _, names in os.walk(root) for name in names)
    found = (path for path in walked if path.suffix.lower() in READABLE and path.is_file())
    return (path for path in found if out not in path.parents and not path.name.startswith("."))


def _has_report() -> Callable[[Path], bool]:
    """Return the test whether a file is in or below a folder that the batch made for an asset, with its report."""

    @functools.cache
    def is_of_asset(folder: Path) -> bool:
        report = report_file.read(folder)
        if report is not None and Path(str(report.get("name", ""))).name == folder.name:
            return True
        return folder.parent != folder and is_of_asset(folder.parent)

    return lambda path: is_of_asset(path.parent)


def _entry(source: Path, common: Path, out: Path, suffix: str, usd_over: bool, overwrite_source: bool) -> Entry:
    name = source.relative_to(common).as_posix()
    folder = out / name
    own = source.suffix.lower()
    if overwrite_source:
        if suffix not in ("", own):
            raise InputError(f"{name} cannot be overwritten as {suffix}: leave out --format or --overwrite-source.")
        if own not in OF_BLENDER and assets.written_as(source) != own:
            raise InputError(f"{name} cannot be overwritten: {own} holds no UVs.")
        return Entry(name, source, folder, source)
    if usd_over and own in USD:
        return Entry(name, source, folder, folder / f"{source.stem}.uv.usda")
    new = suffix or (source.suffix if own in OF_BLENDER or assets.written_as(source) == own else _PLAIN)
    return Entry(name, source, folder, folder / f"{source.stem}{new}")
