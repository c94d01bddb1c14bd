# SPDX-License-Identifier: GPL-3.0-or-later
"""Which version of the add-on this is."""

from __future__ import annotations

import re
from pathlib import Path

_ADDON = Path(__file__).resolve().parents[1]
# A packed extension's, a packed legacy add-on's, and in a checkout the one that goes into both.
_PLACES = (
    (_ADDON / "blender_manifest.toml", r'^version = "(.*?)"$'),
    (_ADDON / "__init__.py", r'^ +"version": \((.*?)\),$'),
    (_ADDON.parent / "pyproject.toml", r'^version = "(.*?)"$'),
)


def version() -> str:
    """Return the version, "unknown" where it stands nowhere."""
    for path, pattern in _PLACES:
        found = re.search(pattern, path.read_text(encoding="utf-8"), re.MULTILINE) if path.is_file() else None
        if found:
            return found.group(1).replace(", ", ".")
    return "unknown"
