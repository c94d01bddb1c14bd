"""Helpers for writing UVs into existing bytes."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from .._distinct_rows import Integers, in_order_of_use, parts

# Of a file, per step: memory beside the file and its mesh does not grow with them.
BLOCK = 1 << 16


def edited(data: bytes, start: int, end: int, places: npt.ArrayLike, texts: Sequence[bytes]) -> bytes:
    """Return a range of data with some parts replaced.

    Args:
        data: the whole.
        start: of the range to return.
        end: of the range to return.
        places: (n, 2) begin and end of each part in data; parts are disjoint, and those at one position keep the given
            order.
        texts: n replacements.
    """
    starts, ends = np.asarray(places, dtype=np.int64).reshape(-1, 2).T
    order = np.argsort(starts, kind="stable")
    kept = zip(np.append(start, ends[order]).tolist(), np.append(starts[order], end).tolist())
    pieces = [data[first:last] for first, last in kept]
    new = [texts[k] for k in order.tolist()]
    return b"".join(itertools.chain.from_iterable(zip(pieces, [*new, b""])))


def pieces(data: bytes, start: int, end: int) -> Iterator[bytes]:
    """Yield a range of data in blocks."""
    for first in range(start, end, BLOCK):
        yield data[first : min(first + BLOCK, end)]


def ranges(starts: Integers, counts: Integers, step: int = 1) -> Integers:
    """Return the concatenated ranges start, start + step, ... of each, with `counts` numbers."""
    before = np.cumsum(counts) - counts
    return np.repeat(starts - step * before, counts) + step * np.arange(int(counts.sum()))


def joined(columns: list[npt.NDArray], empty: npt.NDArray) -> npt.NDArray:
    """Return the rows of arrays as one, `empty` if there are none; the list is emptied."""
    if not columns:
        return empty
    result = np.empty((sum(map(len, columns)), *columns[0].shape[1:]), columns[0].dtype)
    at = len(result)
    while columns:
        last = columns.pop()
        result[at - len(last) : at] = last
        at -= len(last)
    return result


def _first_uses(numbers: npt.NDArray[np.integer], total: int, chosen: npt.NDArray[np.bool_] | None = None) -> Integers:
    """Return the first place of each number in `numbers` (n,) below `total`, n for those that do not occur."""
    first = np.full(total, len(numbers), dtype=np.int64)
    for part in reversed(list(parts(len(numbers)))):
        places = np.arange(part.start, part.stop)
        places = places if chosen is None else places[chosen[part]]
        # Of several values for one index, the last one stays.
        first[numbers[places[::-1]]] = places[::-1]
    return first


def renumbered(rows: npt.NDArray[np.integer], number_of_row: Integers) -> tuple[Integers, Integers]:
    """Return the numbers of rows (n,) in the order of their first use, and for each of the rows its place there."""
    total = int(number_of_row.max(initial=-1)) + 1
    result = number_of_row[rows]
    first = _first_uses(result, total)
    used = np.argsort(first, kind="stable")[: int((first < len(rows)).sum())]
    rank = np.empty(total, dtype=np.int64)
    rank[used] = np.arange(len(used))
    for part in parts(len(rows)):
        result[part] = rank[result[part]]
    return used, result


def numbered(
    vertices: npt.NDArray[np.integer], uv: npt.NDArray[np.floating], chosen: npt.NDArray[np.bool_] | None = None
) -> tuple[Integers, npt.NDArray[np.int32]]:
    """Return the distinct pairs of vertex and UV in the order of their first use.

    Args:
        vertices: (C,) of each corner.
        uv: (C, 2)
        chosen: (C,) the corners that count; None for all.

    Returns:
        first: (n,) the first corner of each pair, ascending.
        number: (C,) the pair of each corner, -1 for corners that do not count.
    """
    n_corners, n_vertices = len(vertices), int(vertices.max(initial=-1)) + 1
    # Most vertices have one UV: only the corners that differ from the first one at their vertex are sorted.
    first_of_vertex = _first_uses(vertices, n_vertices, chosen)
    differing = []
    for part in parts(n_corners):
        differs = (uv[part] != uv[first_of_vertex[vertices[part]].clip(max=n_corners - 1)]).any(axis=1)
        differs &= True if chosen is None else chosen[part]
        differing.append(part.start + np.flatnonzero(differs))
    others = joined(differing, np.zeros(0, np.int64))
    first, number_of_other = in_order_of_use(np.column_stack([vertices[others], uv[others]]))
    is_used = first_of_vertex < n_corners
    all_first = np.concatenate([first_of_vertex[is_used], others[first]])
    order = np.argsort(all_first, kind="stable")
    rank = np.empty(len(order), dtype=np.int32)
    rank[order] = np.arange(len(order), dtype=np.int32)
    n_used = int(is_used.sum())
    rank_of_vertex = np.full(n_vertices, -1, dtype=np.int32)
    rank_of_vertex[is_used] = rank[:n_used]
    number = rank_of_vertex[vertices]
    if chosen is not None:
        number[~chosen] = -1
    number[others] = rank[n_used:][number_of_other]
    return all_first[order], number


def indices_of_copies(vertices: Integers, n_vertices: int) -> tuple[npt.NDArray[np.bool_], Integers]:
    """Append copies of vertices that occur several times; the first occurrence keeps its index.

    Returns:
        which of `vertices` (n,) are copies, and the index of each.
    """
    is_copy = _first_uses(vertices, n_vertices)[vertices] != np.arange(len(vertices))
    return is_copy, np.where(is_copy, n_vertices - 1 + np.cumsum(is_copy), vertices)
