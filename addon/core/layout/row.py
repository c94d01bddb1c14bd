# SPDX-License-Identifier: GPL-3.0-or-later
"""Put the islands of existing maps into a row or a column, by size."""

from collections.abc import Sequence

import numpy as np

from ..measure import defects
from ..mesh.group_bounds import face_group_bounds
from ..mesh.polygon_mesh import PolygonMesh


def in_row(
    meshes: Sequence[PolygonMesh], chosen: Sequence[np.ndarray], axis: int, largest_first: bool, margin: Sequence[float]
) -> tuple[list[np.ndarray], list[np.ndarray], int]:
    """Move the islands with a chosen face side by side, from the lower left corner of their bounds on.

    Args:
        meshes: meshes with a map, whose selected faces are the visible ones.
        chosen: (F,) bool for each mesh.
        axis: 0 for a row along U, 1 for a column along V.
        largest_first: or last; what counts is the area of an island's bounding box.
        margin: between islands, along U and along V.

    Returns:
        The maps, (C, 2) each, the corners that move, (C,) bool each, and the number of islands.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    of_faces, count = defects.chosen_islands(meshes, chosen)
    low, high = face_group_bounds(meshes, of_faces, count)
    area = (high - low).prod(axis=1)
    order = np.argsort(-area if largest_first else area, kind="stable")
    shift = low.min(axis=0, initial=np.inf) - low
    steps = (high - low)[order, axis] + margin[axis]
    shift[order, axis] += np.cumsum(steps) - steps
    # Faces without a number stay.
    shift = np.append(shift, np.zeros((1, 2)), axis=0)
    of_corners = [part[mesh.face_of_corner()] for mesh, part in zip(meshes, of_faces)]
    maps = [mesh.uv + shift[part] for mesh, part in zip(meshes, of_corners)]
    return maps, [part >= 0 for part in of_corners], count
