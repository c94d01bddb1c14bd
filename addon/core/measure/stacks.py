# SPDX-License-Identifier: GPL-3.0-or-later
"""Stacks: equal or mirrored islands of a map that lie on each other to share their texture."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..mesh.density_factors import chart_sums
from ..mesh.group_bounds import face_group_bounds
from .map_view import MapView


@dataclass(frozen=True)
class Stacks:
    """The stacks of several maps.

    Attributes:
        of_face: for each map the stack of every face, (F,) int: numbered from 0 over all maps by their first island, -1
            for islands alone and faces without one.
        count: number of stacks.
        islands: number of islands in stacks.
        fill: area of the islands, each stack once, over that of the UV tiles in which they are; None for no islands.
        tiles: number of these tiles.
    """

    of_face: list[np.ndarray]
    count: int
    islands: int
    fill: float | None
    tiles: int


def stacks(views: Sequence[MapView], tolerance: float) -> Stacks:
    """Find the stacks of several maps.

    Islands are a stack if their bounding boxes and the roots of their areas in the map agree within a `tolerance`, in
    UV tiles; half turns and mirroring change neither.
    """
    measured = [_measures(view) for view in views]
    counts = [len(part) for part in measured]
    values = np.concatenate(measured)
    group = close_rows(values, tolerance)
    _, first, index, members = np.unique(group, return_index=True, return_inverse=True, return_counts=True)
    is_stack = members > 1
    # Stacks in the order of their first islands.
    number = np.full(len(members), -1)
    order = np.flatnonzero(is_stack)[np.argsort(first[is_stack], kind="stable")]
    number[order] = np.arange(len(order))
    of_island = np.split(number[index.ravel()], np.cumsum(counts)[:-1])
    # The last entry is that of faces without an island.
    found = [np.append(part, -1)[view.island_of_face] for part, view in zip(of_island, views)]
    lies = values[first]
    lies = lies[np.isfinite(lies).all(axis=1)]
    tiles = np.unique(np.floor(0.5 * (lies[:, :2] + lies[:, 2:4])), axis=0)
    fill = float((lies[:, 4] ** 2).sum() / len(tiles)) if len(tiles) else None
    return Stacks(found, len(order), int(members[is_stack].sum()), fill, len(tiles))


def _measures(view: MapView) -> np.ndarray:
    """Return the bounding box and the root of the area of every island in the map, (K, 5); NaN for none."""
    island = view.island_of_face
    count = int(island.max(initial=-1)) + 1
    box_low, box_high = face_group_bounds([view.mesh], [island], count)
    area = chart_sums(view.area * np.exp2(2.0 * view.log2_scale), island, count)
    return np.column_stack([box_low, box_high, np.sqrt(area)])


def close_rows(values: np.ndarray, tolerance: float) -> np.ndarray:
    """Group rows (K, n) that agree within a tolerance, directly or through others; return the groups, (K,).

    A row that is not finite agrees with none.
    """
    group = np.zeros(len(values), dtype=int)
    for column in values.T:
        order = np.lexsort((column, group))
        with np.errstate(invalid="ignore"):
            differs = (np.diff(group[order]) > 0) | ~(np.diff(column[order]) <= tolerance)
        group[order] = np.concatenate([[0], np.cumsum(differs)])[: len(order)]
    return group
