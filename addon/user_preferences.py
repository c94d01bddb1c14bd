# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the add-on's preferences, which preferences.py defines."""

from typing import Any

import bpy

# Default of the limit: larger meshes slow down every edit noticeably.
MAX_FACES = 2_000_000
# Default of the limit of Live Spectral Unwrap, which blocks Blender: half a second on two cores.
LIVE_MAX_FACES = 100_000


def read(name: str, without: Any) -> Any:  # noqa: ANN401 - of whatever type the preference is
    """Return a preference, or `without` if the add-on has none, as when a script enables it."""
    addon = bpy.context.preferences.addons.get(__package__)
    return without if addon is None or addon.preferences is None else getattr(addon.preferences, name)
