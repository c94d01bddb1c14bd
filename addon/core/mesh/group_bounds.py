# SPDX-License-Identifier: GPL-3.0-or-later
"""The least and largest values of groups, such as the bounding boxes of islands."""

import math
from collections.abc import Sequence

import numpy as np

from .corner_groups import CornerGroups
from .polygon_mesh import PolygonMesh


def group_bounds(values: np.ndarray, group: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the least and the largest of the `values` (N, ...) of each of `count` groups, (count, ...) float64.

    `group` (N,) is the group of each value, -1 for none. A group without values has infinity and minus infinity.
    """
    groups = CornerGroups.of(group)
    low = np.full((count, *values.shape[1:]), np.inf)
    high = np.full_like(low, -np.inf)
    bounds = groups.bounds(values.reshape(len(values), math.prod(values.shape[1:])))
    low[groups.numbers], high[groups.numbers] = bounds.swapaxes(0, 1).reshape(2, len(groups), *values.shape[1:])
    return low, high


def face_group_bounds(
    meshes: Sequence[PolygonMesh], groups: Sequence[np.ndarray], count: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of the bounding boxes of groups of faces in the maps of `meshes`, (count, 2) each.

    `groups` has the group of every face, (F,) for each mesh, negative for none.
    """
    group, bounds = np.maximum(np.concatenate(groups), -1), [mesh.face_bounds(mesh.uv) for mesh in meshes]
    low, high = (np.concatenate(bound) for bound in zip(*bounds))
    return group_bounds(low, group, count)[0], group_bounds(high, group, count)[1]
