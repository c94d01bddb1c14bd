# SPDX-License-Identifier: GPL-3.0-or-later
"""The legend of the UV map overlay: a bar with its colors, their values, and the numbers of the map."""

import itertools
from collections.abc import Sequence

import bpy

from .. import user_preferences
from ..core import choices
from ..core.drawing import color_ramp
from ..core.words import texts
from ..edit_mesh.texture_size import texels
from . import covers
from .colored_triangles import Colors
from .screen_text import LINE, draw_line, fill_box, text_width

_SOUND_TO_FLIPPED = ((0.45, 0.45, 0.45), (1.0, 0.62, 0.05), (0.90, 0.05, 0.65))
_CHECKER = ((0.12, 0.12, 0.12), (0.5, 0.5, 0.5), (0.92, 0.92, 0.92))
_ALONE = ((0.45, 0.45, 0.45),) * 3
_FIXED = {choices.LOOK_DEFECTS: _SOUND_TO_FLIPPED, choices.LOOK_CHECKER: _CHECKER, choices.LOOK_STACKS: _ALONE}
# The other kinds: the prefix of their colors in the preferences, and their default colors.
_CHOSEN = {
    choices.LOOK_ANGLE: ("angle", color_ramp.GOOD_TO_BAD),
    choices.LOOK_SIZE: ("size", color_ramp.SMALL_TO_LARGE),
    choices.LOOK_DENSITY: ("size", color_ramp.SMALL_TO_LARGE),
}
# Pixels at a scale of 1.
_WIDTH, _BAR_HEIGHT, _PADDING, _DISTANCE = 240.0, 12.0, 10.0, 20.0
_LABELS = 1.3 * LINE
_BACKGROUND = (0.08, 0.08, 0.08, 0.72)
# Letters below seven pixels are illegible.
_MIN_SCALE = 0.6


def colors_of(kind: str, opacity: float) -> Colors:
    """Return the colors of a kind that the overlay shows."""
    if kind in _FIXED:
        return Colors(*_FIXED[kind], opacity)
    scale, colors = _CHOSEN[kind]
    ends = ("low", "middle", "high")
    chosen = [tuple(user_preferences.read(f"{scale}_{end}", color)) for end, color in zip(ends, colors)]
    return Colors(*chosen, opacity)


def draw(
    context: bpy.types.Context, kind: str, colors: Colors, low_high: tuple[float, float], lines: Sequence[str]
) -> None:
    """Draw the legend in the lower right corner, beside what lies over it there, scaled down if necessary.

    If it would be illegible, it lies below the sidebar, then loses its numbers, then shrinks further.
    """
    low, high = low_high
    labels = (
        ()
        if kind in (choices.LOOK_CHECKER, choices.LOOK_STACKS)
        else texts.legend_ends(kind, low, 0.5 * (low + high), high)
    )
    lines = (texts.look(kind, texels(context).symbol), *lines)
    scale = context.preferences.system.ui_scale
    for shown, with_sidebar in itertools.product((lines, lines[:1]), (True, False)):
        width, height = _size(shown, labels, scale)
        left, bottom, right, top = covers.free_box(context.area, context.region, width, with_sidebar)
        part = min(1.0, (right - left) / width, (top - bottom) / height)
        if scale * part >= _MIN_SCALE:
            break
    if part <= 0.0:
        return
    lines, scale, width, height = shown, part * scale, part * width, part * height
    distance, padding = _DISTANCE * scale, _PADDING * scale
    left, bottom, right, top = right - width + distance, bottom + distance, right - distance, bottom + height - distance
    fill_box((left, bottom, right, top), (_BACKGROUND,) * 4)
    y = draw_line(lines[0], left + padding, top - padding, scale)
    if labels:
        y = _draw_bar(colors, labels, (left + padding, right - padding), y, scale)
    for line in lines[1:]:
        y = draw_line(line, left + padding, y, scale)


def _size(lines: Sequence[str], labels: Sequence[str], scale: float) -> tuple[float, float]:
    """Return width and height of the legend in pixels, with the distance around it."""
    widths = [text_width(line, scale) for line in lines]
    if labels:
        # One label at either end, one in the middle.
        ends = max(text_width(label, scale) for label in (labels[0], labels[-1]))
        widths.append(2.0 * ends + text_width(labels[1], scale) + 2.0 * _PADDING * scale)
    around = 2.0 * _DISTANCE + 2.0 * _PADDING
    rows = LINE * len(lines) + (_BAR_HEIGHT + _LABELS if labels else 0.0)
    return max(_WIDTH * scale, max(widths) + 2.0 * _PADDING * scale) + 2.0 * _DISTANCE * scale, (rows + around) * scale


def _draw_bar(colors: Colors, labels: Sequence[str], ends: tuple[float, float], top: float, scale: float) -> float:
    """Draw the bar with the colors between its `ends`, its labels below it; return where the next line begins."""
    left, right = ends
    middle, bottom = 0.5 * (left + right), top - _BAR_HEIGHT * scale
    low, between, high = ((*color, 1.0) for color in (colors.low, colors.middle, colors.high))
    fill_box((left, bottom, middle, top), (low, between, between, low))
    fill_box((middle, bottom, right, top), (between, high, high, between))
    for part, label in zip((0.0, 0.5, 1.0), labels):
        x = left + part * (right - left - text_width(label, scale))
        draw_line(label, x, bottom - 0.1 * LINE * scale, scale)
    return bottom - _LABELS * scale
