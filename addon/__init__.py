# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectral Unwrap: UV unwrapping by Spectral Conformal Parameterization (Mullen, Tong, Alliez, Desbrun 2008)."""

from types import ModuleType

# Read by Blender 3.4 to 4.1, which parses this literal without running the file; 4.2 and later read
# blender_manifest.toml. Packing copies the version from pyproject.toml to both (tools/packaging.py).
bl_info = {
    "name": "Spectral Unwrap",
    "author": "The Spectral Unwrap developers",
    "blender": (3, 4, 0),
    "location": "Edit Mode > UV > Spectral Unwrap",
    "description": "Unwrap with low angle distortion and without pins",
    "category": "UV",
}


def _parts() -> tuple[ModuleType, ...]:
    """Return the parts in the order of registration; each may use the ones before it.

    Imported here, so that a Python without Blender can import the core.
    """
    from . import handlers, manual, operators, preferences, properties, translations
    from .overlay import covers
    from .ui import menus, panels

    return (
        *(translations, properties, operators, preferences, manual, menus, panels, covers),
        # Unregistered first, because it ends what the others have begun.
        handlers,
    )


def register() -> None:
    """Add the translations, properties, operators, live unwrapping, menu entries, panels and drawing to Blender."""
    for part in _parts():
        part.register()


def unregister() -> None:
    """Remove everything that `register` added."""
    for part in reversed(_parts()):
        part.unregister()
