# SPDX-License-Identifier: GPL-3.0-or-later
"""Text and boxes on a region of the screen, in pixels, scaled with Blender's interface."""

from collections.abc import Sequence

import blf
import gpu
from gpu_extras.batch import batch_for_shader

from .. import compatibility

LINE = 17.0
"""Height of a line in pixels at a scale of 1."""
_SIZE = 11
_COLOR = (0.92, 0.92, 0.92, 1.0)


def fill_box(box: tuple[float, float, float, float], corner_colors: Sequence[tuple[float, ...]]) -> None:
    """Fill a rectangle, given its left, bottom, right and top, and the colors of its corners, counterclockwise.

    Colors are red, green, blue and opacity, 0 to 1.
    """
    left, bottom, right, top = box
    corners = [(left, bottom, 0.0), (right, bottom, 0.0), (right, top, 0.0), (left, top, 0.0)]
    order = [0, 1, 2, 0, 2, 3]
    shader = gpu.shader.from_builtin(compatibility.SMOOTH_COLOR_SHADER)
    values = {"pos": [corners[k] for k in order], "color": [corner_colors[k] for k in order]}
    batch = batch_for_shader(shader, "TRIS", values)
    gpu.state.blend_set("ALPHA")
    try:
        batch.draw(shader)
    finally:
        gpu.state.blend_set("NONE")


def text_width(text: str, scale: float) -> float:
    """Return the width of a line in pixels."""
    blf.size(0, _SIZE * scale)
    return blf.dimensions(0, text)[0]


def draw_line(text: str, x: float, top: float, scale: float) -> float:
    """Write a line below `top` and return where the next one begins."""
    blf.size(0, _SIZE * scale)
    blf.color(0, *_COLOR)
    blf.position(0, x, top - 0.75 * LINE * scale, 0.0)
    blf.draw(0, text)
    return top - LINE * scale
