# SPDX-License-Identifier: GPL-3.0-or-later
"""The legend of the UV map overlay: a bar with its colours, what they stand for, and the numbers of the map."""

from collections.abc import Sequence

import bpy

from .. import user_preferences
from ..core import color_ramp, texts
from .colored_triangles import Colors
from .screen_text import LINE, draw_line, fill_box, text_width

_SOUND_TO_FLIPPED = ((0.45, 0.45, 0.45), (1.0, 0.62, 0.05), (0.90, 0.05, 0.65))
_CHECKER = ((0.12, 0.12, 0.12), (0.5, 0.5, 0.5), (0.92, 0.92, 0.92))
_FIXED = {texts.LOOK_DEFECTS: _SOUND_TO_FLIPPED, texts.LOOK_CHECKER: _CHECKER}
# The other kinds: where the preferences have their colours, and what these are without preferences.
_CHOSEN = {
    texts.LOOK_ANGLE: ("angle", color_ramp.GOOD_TO_BAD),
    texts.LOOK_SIZE: ("size", color_ramp.SMALL_TO_LARGE),
    texts.LOOK_DENSITY: ("size", color_ramp.SMALL_TO_LARGE),
}
# Pixels at a scale of 1.
_WIDTH, _BAR_HEIGHT, _PADDING, _DISTANCE = 240.0, 12.0, 10.0, 20.0
_BACKGROUND = (0.08, 0.08, 0.08, 0.72)


def colors_of(kind: str, opacity: float) -> Colors:
    """Return the colours that stand for what is shown."""
    if kind in _FIXED:
        return Colors(*_FIXED[kind], opacity)
    scale, colors = _CHOSEN[kind]
    places = ("low", "middle", "high")
    chosen = [tuple(user_preferences.read(f"{scale}_{place}", color)) for place, color in zip(places, colors)]
    return Colors(*chosen, opacity)


def draw(
    context: bpy.types.Context, kind: str, colors: Colors, low_high: tuple[float, float], lines: Sequence[str]
) -> None:
    """Draw the legend in the lower right corner of the region, left of the sidebar."""
    scale = context.preferences.system.ui_scale
    has_bar = kind != texts.LOOK_CHECKER
    height = (LINE * (1 + len(lines)) + (_BAR_HEIGHT + 1.3 * LINE if has_bar else 0.0) + 2 * _PADDING) * scale
    width = _WIDTH * scale
    right = context.region.width - _sidebar_width(context.area) - _DISTANCE * scale
    bottom = _DISTANCE * scale
    left, top = right - width, bottom + height
    if left < 0.0:
        return
    fill_box((left, bottom, right, top), (_BACKGROUND,) * 4)
    inner, y = left + _PADDING * scale, top - _PADDING * scale
    y = draw_line(texts.look(kind), inner, y, scale)
    if has_bar:
        inner_right = right - _PADDING * scale
        middle, bar_bottom = 0.5 * (inner + inner_right), y - _BAR_HEIGHT * scale
        ends = [(*color, 1.0) for color in (colors.low, colors.middle, colors.high)]
        fill_box((inner, bar_bottom, middle, y), (ends[0], ends[1], ends[1], ends[0]))
        fill_box((middle, bar_bottom, inner_right, y), (ends[1], ends[2], ends[2], ends[1]))
        low, high = low_high
        labels = texts.legend_ends(kind, low, 0.5 * (low + high), high)
        for place, label in zip((0.0, 0.5, 1.0), labels):
            x = inner + place * (inner_right - inner - text_width(label, scale))
            draw_line(label, x, bar_bottom - 0.1 * LINE * scale, scale)
        y = bar_bottom - 1.3 * LINE * scale
    for line in lines:
        y = draw_line(line, inner, y, scale)


def _sidebar_width(area: bpy.types.Area) -> float:
    """Return how much of the main region the sidebar covers."""
    if not bpy.context.preferences.system.use_region_overlap:
        return 0.0
    return max((region.width for region in area.regions if region.type == "UI" and region.width > 1), default=0.0)
