# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders without Blender: names of their layers, pairs from a selection, and free names.

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
# Blender's limit for names of layers in version 3.4, in bytes.
_MAX_BYTES = 63


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


def layer_name(prefix: str, name: str, strength: float, use: bool) -> str:
    """Return the name of the layer of an extender, with all digits of a strength in single precision.

    A long name is cut. A strength that is no number or beyond its limit, as in damaged files, counts as 0.
    """
    strength = strength if abs(strength) <= STRENGTH_LIMIT else 0.0
    text = f"{prefix}{use:d}:{strength:.9g}:{name}"
    return text.encode()[:_MAX_BYTES].decode(errors="ignore")


def properties(prefix: str, layer: str) -> tuple[str, float, bool] | None:
    """Return name, strength and switch of the extender with this layer; None if it is another layer."""
    if not layer.startswith(prefix):
        return None
    try:
        use, strength, name = layer[len(prefix) :].split(":", 2)
        return (name, float(strength), use == "1") if abs(float(strength)) <= STRENGTH_LIMIT else None
    except ValueError:
        return None


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
