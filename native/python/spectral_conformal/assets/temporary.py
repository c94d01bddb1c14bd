"""Names under which files are written before they take their places."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from pathlib import Path


def temporary_beside(target: Path) -> Path:
    """Return the path under which this process writes a file; as short for names of any length.

    It has the file's suffix, by which programs know the format.
    """
    return target.with_name(f"{_beginning(target)}{os.getpid()}.partial{target.suffix}")


def left_beside(target: Path) -> Iterator[Path]:
    """Yield what processes that were killed may have left of writing a file."""
    return target.parent.glob(f"{_beginning(target)}*.partial*")


def _beginning(target: Path) -> str:
    return f".{hashlib.blake2b(os.fsencode(target.name), digest_size=6).hexdigest()}."
