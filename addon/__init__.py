# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectral Unwrap: UV unwrapping by Spectral Conformal Parameterization (Mullen, Tong, Alliez, Desbrun 2008)."""

from . import live_unwrap, menus, operators

# Read by Blender 3.4 to 4.1, which parses this literal without running the file; 4.2 and later read
# blender_manifest.toml. Both versions must equal pyproject.toml's (tests/core/test_addon_metadata.py).
bl_info = {
    "name": "Spectral Unwrap",
    "author": "The Spectral Unwrap developers",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Edit Mode > UV > Spectral Unwrap",
    "description": "Unwrap with low angle distortion and without pins",
    "category": "UV",
}


def register() -> None:
    """Add the operators, live unwrapping and menu entries to Blender."""
    operators.register()
    live_unwrap.register()
    menus.register()


def unregister() -> None:
    """Remove everything that `register` added."""
    menus.unregister()
    live_unwrap.unregister()
    operators.unregister()
