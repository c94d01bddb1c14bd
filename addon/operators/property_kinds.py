# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's properties by what an artist enters: a switch, a choice, a number, a share or several numbers.

The functions take further arguments of `bpy.props` by their names.
"""

from collections.abc import Sequence
from typing import Any

from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty

from ..core import choices


def switch(name: str, description: str, default: bool = False, **others: Any) -> Any:  # noqa: ANN401 - as bpy.props
    """Return a property that is on or off."""
    return BoolProperty(name=name, description=description, default=default, **others)


def choice(name: str, description: str, items: Sequence[tuple], default: str = "", **others: Any) -> Any:  # noqa: ANN401
    """Return a property with one of the `items`, (identifier, label, description) each; the first by default."""
    return EnumProperty(name=name, description=description, items=items, default=default or items[0][0], **others)


def number(name: str, description: str, default: float, limits: Sequence[float | None], **others: Any) -> Any:  # noqa: ANN401
    """Return a property for a number, whole if the default is.

    `limits` are the least and the largest number, None for any; between them may stand the largest of the slider, or
    its least and its largest.
    """
    least, *slider, largest = limits
    ends = {"min": least, **dict(zip(("soft_max", "soft_min"), reversed(slider))), "max": largest}
    others.update((end, value) for end, value in ends.items() if value is not None)
    kind = IntProperty if isinstance(default, int) else FloatProperty
    return kind(name=name, description=description, default=default, **others)


def share(name: str, description: str, default: float = 0.0, **others: Any) -> Any:  # noqa: ANN401
    """Return a property from 0 to 1 with a slider."""
    return number(name, description, default, (0.0, 1.0), subtype="FACTOR", **others)


def numbers(name: str, description: str, default: Sequence[float], **others: Any) -> Any:  # noqa: ANN401
    """Return a property for several numbers."""
    return FloatVectorProperty(name=name, description=description, size=len(default), default=default, **others)


def pixel_margin(**others: Any) -> Any:  # noqa: ANN401
    """Return the property of scenes and operators for the margin."""
    return number(
        "Margin",
        "Pixels of the texture between islands, and between them and the border of the tile",
        choices.MARGIN,
        (0.0, 64.0, 4096.0),
        precision=1,
        **others,
    )


def rotation(**others: Any) -> Any:  # noqa: ANN401
    """Return the property of scenes and operators for how packed islands may turn."""
    return choice(
        "Rotation",
        "How Unwrap and Pack may turn islands",
        (
            (
                "SQUARE",
                "Straight Upright",
                "Straight islands stand upright, in quarter turns; the others turn by any angle",
            ),
            ("FREE", "Free", "By any angle, which fills the most"),
            ("UPRIGHT", "Upright", "Straighten islands that lean, and turn them by quarter turns"),
            ("QUARTERS", "Quarter Turns", "By quarter turns; straight islands stay straight, and leaning ones leaning"),
            ("NONE", "None", "Not at all; Unwrap leaves what is higher on the mesh higher in the map"),
        ),
        choices.ROTATION,
        **others,
    )


def push_amount(**others: Any) -> Any:  # noqa: ANN401
    """Return the property of shapes and operators for the amount of a Push/Pull."""
    return number(
        "Push/Pull",
        "Above 0 pushes the vertices apart, below 0 pulls them together; start at 50 %, as 100 % may fold the island. "
        "In an island with pins, and in a part whose rest is held, 50 % doubles their distance and -50 % halves it",
        50.0,
        (-100.0, 100.0),
        subtype="PERCENTAGE",
        precision=1,
        **others,
    )
