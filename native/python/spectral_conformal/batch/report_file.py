"""The report of an asset as a file, which is there whole or not at all."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..assets.temporary import temporary_beside
from . import entries


def replace(path: Path, content: bytes) -> None:
    """Write a file under another name in its folder, then give it its own."""
    partial = temporary_beside(path)
    try:
        partial.write_bytes(content)
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def write(folder: Path, report: dict[str, Any]) -> None:
    """Write the report of an asset into its folder."""
    replace(folder / entries.REPORT, json.dumps(report, indent=1, sort_keys=True).encode())


def read(folder: Path) -> dict[str, Any] | None:
    """Return the report in an asset's folder; None where there is none, or no whole one."""
    try:
        found = json.loads((folder / entries.REPORT).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) and "status" in found else None
