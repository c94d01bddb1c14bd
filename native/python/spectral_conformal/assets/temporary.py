"""Names of temporary files that are renamed after they are written."""

from __future__ import annotations

import functools
import hashlib
import os
from collections.abc import Iterator
from pathlib import Path

# Of what is written, and of files in reports.
blake2b = functools.partial(hashlib.blake2b, digest_size=16)


def digest(path: Path) -> str:
    """Return a digest of a file's content."""
    state = blake2b()
    with path.open("rb") as file:
        while block := file.read(1 << 20):
            state.update(block)
    return state.hexdigest()


def temporary_beside(target: Path) -> Path:
    """Return the temporary path under which this process writes a file; its length does not depend on the name's.

    It keeps the file's suffix, by which programs recognize the format.
    """
    return target.with_name(f"{_beginning(target)}{os.getpid()}.partial{target.suffix}")


def left_beside(target: Path) -> Iterator[Path]:
    """Yield the temporary files that killed processes may have left."""
    return target.parent.glob(f"{_beginning(target)}*.partial*")


def _beginning(target: Path) -> str:
    return f".{hashlib.blake2b(os.fsencode(target.name), digest_size=6).hexdigest()}."
