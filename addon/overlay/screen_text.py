# SPDX-License-Identifier: GPL-3.0-or-later
"""Text and boxes on a region of the screen, in pixels, scaled with Blender's interface."""

from collections.abc import Sequence

import blf
import numpy as np

from .fill import fill_triangles

LINE = 17.0
"""Height of a line in pixels at a scale of 1."""
_SIZE = 11
_COLOR = (0.92, 0.92, 0.92, 1.0)


def fill_box(box: tuple[float, float, float, float], corner_colors: Sequence[tuple[float, ...]]) -> None:
    """Fill a rectangle, given its left, bottom, right and top, and the colors of its corners, counterclockwise."""
    left, bottom, right, top = box
    corners = np.array([(left, bottom), (right, bottom), (right, top), (left, top)])
    order = [0, 1, 2, 0, 2, 3]
    fill_triangles(corners[order], np.array(corner_colors)[order])


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
