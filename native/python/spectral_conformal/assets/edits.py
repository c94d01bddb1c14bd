"""Helpers for writing UVs into existing bytes."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Integers = npt.NDArray[np.int64]


def edited(data: bytes, starts: Integers, ends: Integers, texts: Sequence[bytes]) -> bytes:
    """Return data with some parts replaced; parts are disjoint, and those at one position keep the given order."""
    order = np.argsort(starts, kind="stable")
    kept = zip(np.append(0, ends[order]).tolist(), np.append(starts[order], len(data)).tolist())
    pieces = [data[start:end] for start, end in kept]
    new = [texts[k] for k in order.tolist()]
    return b"".join(itertools.chain.from_iterable(zip(pieces, [*new, b""])))


def in_order_of_use(keys: npt.NDArray) -> tuple[Integers, Integers]:
    """Return the first index of each distinct row, ascending, and for each row its number among these."""
    _, first, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return first[order], rank[number.ravel()]


def numbered(vertices: Integers, uv: npt.NDArray[np.float64]) -> tuple[Integers, npt.NDArray[np.float64], Integers]:
    """Return the distinct pairs of vertex and UV in the order of their first use, and the pair of each corner.

    Returns:
        vertices (n,), UVs (n, 2), and the index of each corner's pair (C,).
    """
    first, number = in_order_of_use(np.c_[vertices, uv])
    return vertices[first], uv[first], number


def indices_of_copies(vertices: Integers, n_vertices: int) -> tuple[npt.NDArray[np.bool_], Integers]:
    """Append copies of vertices that occur several times; the first occurrence keeps its index.

    Returns:
        which of `vertices` (n,) are copies, and the index of each.
    """
    is_copy = np.ones(len(vertices), dtype=bool)
    is_copy[np.unique(vertices, return_index=True)[1]] = False
    return is_copy, np.where(is_copy, n_vertices - 1 + np.cumsum(is_copy), vertices)
