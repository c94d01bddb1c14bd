# SPDX-License-Identifier: GPL-3.0-or-later
"""The unit of texel densities: pixels along a unit of length, as the scene displays lengths."""

from dataclasses import dataclass

# The symbol and the meters of the units in which artists state densities. Others are useless: a kilometer or a mile has
# millions of pixels, a micrometer none.
_UNITS = {
    "METERS": ("m", 1.0),
    "CENTIMETERS": ("cm", 0.01),
    "MILLIMETERS": ("mm", 0.001),
    "FEET": ("ft", 0.3048),
    "INCHES": ("in", 0.0254),
}
_OF_SYSTEM = {"METRIC": "METERS", "IMPERIAL": "FEET"}


@dataclass(frozen=True)
class Texels:
    """How densities are measured.

    Attributes:
        side: pixels along a side of the texture, for faces whose texture is not known.
        length: the length of the unit, in Blender's units.
        symbol: of the unit; empty for Blender's unit.
    """

    side: float = 1.0
    length: float = 1.0
    symbol: str = ""


def texels_of(side: float, system: str, length_unit: str, scale_length: float) -> Texels:
    """Return how a scene measures densities.

    Args:
        side: as in `Texels`.
        system: of the scene's units: "METRIC", "IMPERIAL" or "NONE".
        length_unit: of the scene, such as "CENTIMETERS"; any that is not in `_UNITS` means meters or feet.
        scale_length: meters per Blender unit.
    """
    if system not in _OF_SYSTEM:
        return Texels(side)
    symbol, meters = _UNITS.get(length_unit) or _UNITS[_OF_SYSTEM[system]]
    return Texels(side, meters / scale_length, symbol)
