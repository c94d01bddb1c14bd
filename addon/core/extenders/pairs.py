# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders without Blender: identifiers of their vertices, pairs from a selection, and names.

An extender is a soft force between two vertices (Mullen et al. 2008, section 4.2): it pushes them apart where its
strength is positive, and pulls them together where it is negative.
"""

import hashlib
import json
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import ReadableError
from ..words import texts
from ..words.translation import translate

# Identifiers are smaller: Blender interpolates integers of vertices in single precision, which holds these exactly.
ID_LIMIT = 1 << 24
# Odd, so that multiplying by them modulo ID_LIMIT loses nothing.
_FACTORS = (0x9E3779, 0x85EBCB, 0xC2B2AF, 0x27D4EB)
_SHIFT = 13


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
    fields = [(e.name, e.strength, e.use, e.first_id, e.second_id) for e in extenders]
    return prefix + hashlib.blake2b(json.dumps(fields).encode(), digest_size=12).hexdigest()


def fresh_ids(taken: Collection[int]) -> Iterator[int]:
    """Yield vertex identifiers, 0 < id < ID_LIMIT, that are not in `taken`, always in the same order.

    They are scattered, so that interpolated values hardly ever equal another identifier.
    """
    taken = set(taken)
    for number in range(1, ID_LIMIT):
        vertex_id = _scattered(number)
        if vertex_id not in taken:
            yield vertex_id


def _scattered(number: int) -> int:
    """Permute 0 .. ID_LIMIT - 1, with 0 to 0 and neighbors far apart."""
    for factor in _FACTORS:
        number = (number ^ (number >> _SHIFT)) * factor % ID_LIMIT
    return number ^ (number >> _SHIFT)


def first_with(vertex_ids: np.ndarray, wanted: Sequence[int]) -> list[int]:
    """Return for every `wanted` identifier the lowest index that has it in `vertex_ids` (V,), -1 if none has.

    Duplicated geometry has the identifiers of the original, which comes first.
    """
    carriers = np.flatnonzero(np.isin(vertex_ids, list(wanted)) & (vertex_ids != 0))
    found, position = np.unique(vertex_ids[carriers], return_index=True)
    index = dict(zip(found.tolist(), carriers[position].tolist()))
    return [index.get(vertex_id, -1) for vertex_id in wanted]


def pairs_in_order(selected: Sequence[int], ordered: Sequence[int]) -> list[tuple[int, int]]:
    """Return the pairs 1-2, 3-4, ... of the `selected` vertices in the order in which they were selected.

    Args:
        selected: indices of all selected vertices.
        ordered: those of known order, the first selected one first. Two vertices need no order.

    Raises:
        SelectionError: the vertices form no pairs.
    """
    if len(selected) < 2:
        raise SelectionError(translate(texts.SELECT_PAIR))
    if len(selected) == 2:
        vertices = ordered if len(ordered) == 2 else selected
    elif len(ordered) < len(selected):
        raise SelectionError(texts.without_order(len(selected), len(ordered)))
    elif len(selected) % 2:
        raise SelectionError(texts.without_partner(len(selected)))
    else:
        vertices = ordered
    return list(zip(vertices[::2], vertices[1::2]))


def pairs_to_active(selected: Sequence[int], active: int | None) -> list[tuple[int, int]]:
    """Return the pairs of every other `selected` vertex and the `active` one.

    Raises:
        SelectionError: no vertex is active, or it is the only one selected.
    """
    if len(selected) < 2:
        raise SelectionError(translate(texts.SELECT_WITH_ACTIVE))
    if active is None:
        raise SelectionError(translate(texts.NO_ACTIVE_VERTEX))
    return [(vertex, active) for vertex in selected if vertex != active]


def unique_name(name: str, taken: Collection[str]) -> str:
    """Return `name`, or the first of name.001, name.002, ... that is not in `taken`, as Blender does."""
    if name not in taken:
        return name
    stem, _, number = name.rpartition(".")
    stem = stem if stem and number.isdigit() else name
    return next(new for new in (f"{stem}.{k:03d}" for k in range(1, len(taken) + 2)) if new not in taken)
