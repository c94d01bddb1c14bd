# SPDX-License-Identifier: GPL-3.0-or-later
"""Free room in a rectangle of the screen that other rectangles partly cover."""

import functools
from collections.abc import Sequence

Box = tuple[float, float, float, float]
"""Left, bottom, right and upper end, in pixels."""


@functools.lru_cache(maxsize=64)
def free_boxes(size: tuple[float, float], covers: tuple[Box, ...]) -> Sequence[Box]:
    """Return the maximal rectangles in a region of this width and height that no cover touches.

    Empty where the covers leave nothing.
    """
    boxes = [(0.0, 0.0, *size)] if min(size) > 0.0 else []
    for cover in covers:
        boxes = [part for box in boxes for part in _beside(box, cover)]
        boxes = [box for k, box in enumerate(boxes) if not any(_holds(other, box) for other in _others(boxes, k))]
    return boxes


def lower_right(size: tuple[float, float], covers: tuple[Box, ...], width: float, height: float) -> Box | None:
    """Return where a box of this size goes: as large as possible, then as low, then as far right.

    It is scaled down if it fits nowhere at full size. None if nothing is free.
    """
    fits = [(*box, min(1.0, (box[2] - box[0]) / width, (box[3] - box[1]) / height)) for box in free_boxes(size, covers)]
    if not fits:
        return None
    _, bottom, right, _, scale = max(fits, key=lambda fit: (fit[4], -fit[1], fit[2]))
    return right - scale * width, bottom, right, bottom + scale * height


def _beside(box: Box, cover: Box) -> Sequence[Box]:
    """Return the largest parts of a box on each side of a cover; the box itself if they do not overlap."""
    left, bottom, right, top = box
    if cover[0] >= right or cover[2] <= left or cover[1] >= top or cover[3] <= bottom or _is_empty(cover):
        return [box]
    parts = (
        (left, bottom, cover[0], top),
        (cover[2], bottom, right, top),
        (left, bottom, right, cover[1]),
        (left, cover[3], right, top),
    )
    return [part for part in parts if not _is_empty(part)]


def _is_empty(box: Box) -> bool:
    return box[2] <= box[0] or box[3] <= box[1]


def _others(boxes: Sequence[Box], k: int) -> Sequence[Box]:
    """Return the boxes that contain box `k`; of equal ones the first counts."""
    return [other for i, other in enumerate(boxes) if i != k and (other != boxes[k] or i < k)]


def _holds(outer: Box, inner: Box) -> bool:
    return outer[0] <= inner[0] and outer[1] <= inner[1] and outer[2] >= inner[2] and outer[3] >= inner[3]
