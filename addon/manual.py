# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages that Blender's "Online Manual" opens for the add-on; they are part of the packages."""

from pathlib import Path

import bpy

from . import names

# Made by tools/manual.py for the packages; a checkout has none.
_FOLDER = Path(__file__).with_name("manual")
_USE = "guide.html#use"
_IN_PLACE = "guide.html#part-of-an-island-in-place"
_LOOK = "guide.html#look-at-the-map"
_EXTENDERS = "guide.html#how-islands-lie-pins-seams-and-extenders"
_SECTIONS = {
    names.UNWRAP_OPERATOR: _USE,
    names.RELAX_OPERATOR: "guide.html#relax-the-map-that-is-there",
    names.PACK_OPERATOR: "guide.html#pack-islands-by-their-shapes",
    names.UNWRAP_IN_PLACE_OPERATOR: _IN_PLACE,
    names.SUGGEST_SEAMS_OPERATOR: "guide.html#quick-tour",
    names.SELECT_FAILED_OPERATOR: _USE,
    names.SELECT_DEFECTS_OPERATOR: _LOOK,
    names.SELECT_DISTORTED_OPERATOR: _LOOK,
    names.INSPECT_OPERATOR: _LOOK,
    names.STORE_OPERATOR: _LOOK,
    names.ADD_EXTENDER_OPERATOR: _EXTENDERS,
    names.REMOVE_EXTENDER_OPERATOR: _EXTENDERS,
    names.ADJUST_EXTENDER_OPERATOR: _EXTENDERS,
}
_TYPES = {
    "SpectralUnwrapDefaults": _USE,
    "SpectralMapOverlay": _LOOK,
    "SpectralExtender": _EXTENDERS,
    "SpectralPreferences": "guide.html#preferences",
}


def links() -> tuple[str, tuple[tuple[str, str], ...]]:
    """Return the address of the manual, and patterns of identifiers with their sections."""
    operators = [(f"bpy.ops.{name}*", place) for name, place in _SECTIONS.items()]
    types = [(f"bpy.types.{name.lower()}*", place) for name, place in _TYPES.items()]
    live = [(f"bpy.types.scene.{names.LIVE_UNWRAP_PROPERTY}*", _EXTENDERS)]
    return f"{_FOLDER.as_uri()}/", (*operators, *types, *live)


def register() -> None:
    """Register the manual."""
    if _FOLDER.is_dir():
        bpy.utils.register_manual_map(links)


def unregister() -> None:
    """Unregister the manual."""
    if _FOLDER.is_dir():
        bpy.utils.unregister_manual_map(links)
