# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders without Blender: identifiers of their vertices, pairs from a selection, and names.

An extender is a soft force between two vertices (Mullen et al. 2008, section 4.2): it pushes them apart where its
strength is positive, and pulls them together where it is negative.
"""

import hashlib
import json
from collections.abc import Collection, Iterator, Sequence
from dataclasses import astuple, dataclass
from itertools import count

import numpy as np

from ..errors import ReadableError
from ..words import texts
from ..words.translation import translate


@dataclass(frozen=True)
class Extender:
    """One extender as a mesh stores it; `first_id` and `second_id` are the identifiers of its vertices."""

    name: str
    strength: float
    use: bool
    first_id: int
    second_id: int


class SelectionError(ReadableError, ValueError):
    """The selected vertices form no pairs; the message says what to select."""


def layer_name(prefix: str, extenders: Sequence[Extender]) -> str:
    """Return the name of the vertex layer for exactly this list of extenders."""
    return prefix + _digest(json.dumps([astuple(extender) for extender in extenders]), 12).hex()


def fresh_ids(taken: Collection[int]) -> Iterator[int]:
    """Yield vertex identifiers that are not in `taken`, always in the same order.

    They lie below 2**24, which single precision holds exactly: Blender interpolates the integers of vertices in it. And
    they are scattered, so that values interpolated between vertices hardly ever equal another identifier; none of those
    between the first hundred does.
    """
    used = {0, *taken}
    for number in count():
        vertex_id = int.from_bytes(_digest(f"extender {number}", 3), "big")
        if vertex_id not in used:
            used.add(vertex_id)
            yield vertex_id


def _digest(text: str, size: int) -> bytes:
    return hashlib.blake2b(text.encode(), digest_size=size).digest()


def first_with(vertex_ids: np.ndarray, wanted: Sequence[int]) -> list[int]:
    """Return for every `wanted` identifier the lowest index that has it in `vertex_ids` (V,), -1 if none has.

    Duplicated geometry has the identifiers of the original, which comes first.
    """
    carriers = np.flatnonzero(np.isin(vertex_ids, list(wanted)) & (vertex_ids != 0))
    found, position = np.unique(vertex_ids[carriers], return_index=True)
    index = dict(zip(found.tolist(), carriers[position].tolist()))
    return [index.get(vertex_id, -1) for vertex_id in wanted]


def pairs(selected: Sequence[int], active: int | None) -> list[tuple[int, int]]:
    """Return the pairs of every other `selected` vertex and the `active` one; two vertices need none that is active.

    Raises:
        SelectionError: fewer than two vertices are selected, or more and none of them is active.
    """
    if len(selected) < 2:
        raise SelectionError(translate(texts.SELECT_PAIR))
    if active is None and len(selected) > 2:
        raise SelectionError(translate(texts.NO_ACTIVE_VERTEX))
    last = selected[-1] if active is None else active
    return [(vertex, last) for vertex in selected if vertex != last]


def free_name(name: str, taken: Collection[str]) -> str:
    """Return `name`, or as Blender does the first of name.001, name.002, ... that is not in `taken`."""
    return next(new for new in (name, *(f"{name}.{k:03d}" for k in range(1, len(taken) + 2))) if new not in taken)
