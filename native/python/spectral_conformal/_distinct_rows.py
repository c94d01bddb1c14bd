"""Large arrays row by row: in blocks, and without repetitions."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

Integers = npt.NDArray[np.int64]

# Per step: memory beside the arrays does not grow with them.
_ROWS = 1 << 12


def parts(total: int, size: int = _ROWS) -> Iterator[slice]:
    """Yield slices that together cover so many rows, at most `size` in each."""
    return (slice(first, min(first + size, total)) for first in range(0, total, size))


def in_order_of_use(keys: npt.NDArray) -> tuple[Integers, Integers]:
    """Return the first index of each distinct row of (n, k) keys, ascending, and for each row its number among these.

    A NaN equals nothing.
    """
    if not len(keys):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    order = np.lexsort(keys.T)
    is_new = np.ones(len(keys), dtype=bool)
    for part in parts(len(keys) - 1):
        rows = keys[order[part.start : part.stop + 1]]
        is_new[part.start + 1 : part.stop + 1] = (rows[1:] != rows[:-1]).any(axis=1)
    # The sort is stable, so the first of equal rows is the first in `keys`.
    first_of_group = order[is_new]
    first = np.sort(first_of_group)
    rank = np.searchsorted(first, first_of_group)
    result = np.empty(len(keys), dtype=np.int64)
    at = np.cumsum(is_new)
    at -= 1
    for part in parts(len(keys)):
        result[order[part]] = rank[at[part]]
    return first, result
