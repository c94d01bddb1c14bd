# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages that Blender's "Online Manual" opens for the add-on; they are part of the packages."""

from pathlib import Path

import bpy

from . import names

# Made by tools/manual.py for the packages; a checkout has none.
_FOLDER = Path(__file__).with_name("manual")
_USE = "guide.html#unwrap"
_LOOK = "guide.html#look-at-the-map"
_DENSITY = "guide.html#texel-density"
_SHAPES = "guide.html#shapes"
_PUSH = "guide.html#pushpull"
_SEAMS = "guide.html#suggest-seams"
_SECTIONS = {
    **dict.fromkeys((names.SHAPE_OPERATOR, names.REMOVE_SHAPE_OPERATOR), _SHAPES),
    names.EXTENDER_OPERATOR: _PUSH,
    **dict.fromkeys((names.SUGGEST_SEAMS_OPERATOR, names.SEAM_HINT_OPERATOR), _SEAMS),
    names.UNWRAP_OPERATOR: _USE,
    names.RELAX_OPERATOR: "guide.html#relax-an-existing-map",
    **dict.fromkeys((names.PACK_OPERATOR, names.ARRANGE_OPERATOR), "guide.html#pack-islands-by-their-shapes"),
    names.NEW_TEXTURES_OPERATOR: "guide.html#my-asset-has-a-texture-already",
    **dict.fromkeys((names.SELECT_OPERATOR, names.INSPECT_OPERATOR, names.STORE_OPERATOR), _LOOK),
    names.DENSITY_OPERATOR: _DENSITY,
}
_TYPES = {
    "SpectralUnwrapDefaults": _USE,
    "SpectralMapOverlay": _LOOK,
    "SpectralShape": _SHAPES,
    "SpectralPreferences": "guide.html#preferences",
}


def links() -> tuple[str, tuple[tuple[str, str], ...]]:
    """Return the address of the manual, and patterns of identifiers with their sections."""
    # Blender takes the first pattern that fits, and names begin with the names of others.
    longest_first = sorted(_SECTIONS.items(), key=lambda section: -len(section[0]))
    operators = [(f"bpy.ops.{name}*", place) for name, place in longest_first]
    types = [(f"bpy.types.{name.lower()}*", place) for name, place in _TYPES.items()]
    live = [(f"bpy.types.scene.{names.LIVE_UNWRAP_PROPERTY}*", "guide.html#quick-tour")]
    return f"{_FOLDER.as_uri()}/", (*operators, *types, *live)


def register() -> None:
    """Register the manual."""
    if _FOLDER.is_dir():
        bpy.utils.register_manual_map(links)


def unregister() -> None:
    """Unregister the manual."""
    if _FOLDER.is_dir():
        bpy.utils.unregister_manual_map(links)
