"""What the ways to write UVs into bytes have in common."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Integers = npt.NDArray[np.int64]


def edited(data: bytes, starts: Integers, ends: Integers, texts: Sequence[bytes]) -> bytes:
    """Return data with others in place of some of its parts; parts are apart, those in one place in the order given."""
    order = np.argsort(starts, kind="stable")
    kept = zip(np.append(0, ends[order]).tolist(), np.append(starts[order], len(data)).tolist())
    pieces = [data[start:end] for start, end in kept]
    new = [texts[k] for k in order.tolist()]
    return b"".join(itertools.chain.from_iterable(zip(pieces, [*new, b""])))


def numbered(vertices: Integers, uv: npt.NDArray[np.float64]) -> tuple[Integers, npt.NDArray[np.float64], Integers]:
    """Return the different pairs of vertex and UV in the order in which they are used first, and each corner's.

    Returns:
        vertices (n,), UVs (n, 2), and of each corner (C,) which.
    """
    keys = np.c_[vertices, uv]
    different, first, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return vertices[first[order]], different[order, 1:], rank[number.ravel()]
