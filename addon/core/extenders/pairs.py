# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders without Blender: amounts in sliders, pairs from a selection, and free names.

An extender is a soft force between two vertices (Mullen et al. 2008, section 4.2): it pushes them apart where its
strength is positive, and pulls them together where it is negative.
"""

from collections.abc import Collection, Sequence

from ..errors import ReadableError
from ..words import texts
from ..words.translation import translate

# Limit of all strengths, in drags and scripts.
STRENGTH_LIMIT = 1e4
# Strength with half of the effect of an infinite one, between the measured 0.1 to 0.26 at the border and 0.7 to 2.6
# inside (tests/benchmarks/extender_response.py).
_HALF = 0.2


def amount_of(strength: float) -> float:
    """Return the amount in percent, -100 to 100, that stands for a strength s in sliders: s / (|s| + h).

    The change of the pair's distance follows a curve of this form, h being the strength with half of the whole
    effect, so it is about even in the amount.
    """
    return 100.0 * strength / (abs(strength) + _HALF)


def strength_of(amount: float) -> float:
    """Return the strength that an amount in percent stands for, the inverse of `amount_of`."""
    part = min(max(amount / 100.0, -1.0), 1.0)
    return _HALF * part / max(1.0 - abs(part), _HALF / STRENGTH_LIMIT)


def pairs(selected: Sequence[int], active: int | None) -> list[tuple[int, int]]:
    """Return the pairs of every other `selected` vertex and the `active` one; two vertices need none that is active.

    Raises:
        ReadableError: fewer than two vertices are selected, or more and none of them is active.
    """
    if len(selected) < 2:
        raise ReadableError(translate(texts.SELECT_PAIR))
    if active is None and len(selected) > 2:
        raise ReadableError(translate(texts.NO_ACTIVE_VERTEX))
    last = selected[-1] if active is None else active
    return [(vertex, last) for vertex in selected if vertex != last]


def free_name(name: str, taken: Collection[str]) -> str:
    """Return `name`, or as Blender does the first of name.001, name.002, ... that is not in `taken`."""
    return next(new for new in (name, *(f"{name}.{k:03d}" for k in range(1, len(taken) + 2))) if new not in taken)
