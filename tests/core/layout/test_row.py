# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands stand in a row, sorted by size, with the margin between them."""

import numpy as np
import pytest
from spectral_unwrap.core.layout.row import in_row

from tests.core.polygon_meshes import SQUARE, polygon_mesh


def squares(sides, places):
    """Return a mesh of squares of these sides, whose lower left corners are at these places in the map."""
    uv = np.concatenate([side * SQUARE + place for side, place in zip(sides, places)])
    return polygon_mesh(np.concatenate([SQUARE + 2 * k for k in range(len(sides))]), uv=uv)


def bounds(uv):
    islands = uv.reshape(-1, 4, 2)
    return islands.min(axis=1), islands.max(axis=1)


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("largest_first", [True, False])
def test_all_islands_of_all_meshes_are_in_one_row(axis, largest_first):
    meshes = [squares([0.1, 0.3], [(2.0, 3.0), (0.5, 0.25)]), squares([0.2, 0.4], [(0.5, 0.5), (1.0, 1.0)])]
    chosen = [np.array([True, True]), np.array([True, False])]
    maps, moved, count = in_row(meshes, chosen, axis, largest_first, (0.05, 0.02))
    assert count == 3
    assert [each.tolist() for each in moved] == [[True] * 8, [True] * 4 + [False] * 4]
    np.testing.assert_array_equal(maps[1][4:], meshes[1].uv[4:])
    low, high = bounds(np.concatenate([maps[0], maps[1][:4]]))
    sizes = (high - low)[:, axis]
    np.testing.assert_allclose(np.sort(sizes), [0.1, 0.2, 0.3])
    order = np.argsort(low[:, axis])
    np.testing.assert_allclose(sizes[order], [0.3, 0.2, 0.1] if largest_first else [0.1, 0.2, 0.3])
    np.testing.assert_allclose((low[order[1:]] - high[order[:-1]])[:, axis], (0.05, 0.02)[axis])
    # From the lower left corner of what was there on.
    np.testing.assert_allclose(low.min(axis=0), (0.5, 0.25))
    np.testing.assert_allclose(low[:, 1 - axis], (0.5, 0.25)[1 - axis])


def test_without_chosen_islands_nothing_moves():
    mesh = squares([0.1, 0.3], [(2.0, 3.0), (0.5, 0.25)])
    maps, moved, count = in_row([mesh], [np.zeros(2, dtype=bool)], 0, True, (0.1, 0.1))
    assert count == 0 and not moved[0].any()
    np.testing.assert_array_equal(maps[0], mesh.uv)
