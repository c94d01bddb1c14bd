"""The report of an asset as a file that is complete or does not exist."""

from __future__ import annotations

import json
from dataclasses import fields
from pathlib import Path
from typing import Any

from ..assets.report import MapReport
from ..assets.temporary import temporary_beside

REPORT = "report.json"
_STATUSES = ("unwrapped", "kept", "incomplete", "failed", "skipped")
_NUMBERS = tuple(field.name for field in fields(MapReport))


def replace(path: Path, content: bytes) -> None:
    """Write a file under a temporary name in its folder, then rename it."""
    partial = temporary_beside(path)
    try:
        partial.write_bytes(content)
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def write(folder: Path, report: dict[str, Any]) -> None:
    """Write the report of an asset into its folder."""
    replace(folder / REPORT, json.dumps(report, indent=1, sort_keys=True).encode())


def read(folder: Path) -> dict[str, Any] | None:
    """Return the report in an asset's folder; None if there is none, or if this module did not write it."""
    try:
        found = json.loads((folder / REPORT).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    return found if _is_report(found) else None


def _is_report(found: object) -> bool:
    """Return whether all values that others use exist and have the right type: a file may be from anybody."""
    if not isinstance(found, dict) or found.get("status") not in _STATUSES:
        return False
    if found["status"] in ("failed", "skipped"):
        failure = found.get("failure")
        return isinstance(failure, dict) and all(isinstance(failure.get(name), str) for name in ("kind", "message"))
    totals, seconds = found.get("totals"), found.get("seconds")
    return (
        isinstance(totals, dict)
        and all(name in totals and is_number(totals[name], or_none=True) for name in (*_NUMBERS, "failed"))
        and isinstance(seconds, dict)
        and is_number(seconds.get("total"))
        and all(name in found for name in ("settings", "source_digest", "output_digest"))
        and isinstance(found.get("reduced_by", {}), dict)
        and all(is_number(found.get("reduced_by", {}).get(name), or_none=True) for name in ("seconds", "memory"))
    )


def is_number(value: object, or_none: bool = False) -> bool:
    """Return whether a JSON value is a number."""
    return (value is None and or_none) or (isinstance(value, (int, float)) and not isinstance(value, bool))
