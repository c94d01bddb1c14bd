# SPDX-License-Identifier: GPL-3.0-or-later
"""Stacked charts that still have the same shape are stacked again."""

import numpy as np
import pytest
from spectral_unwrap.core.layout.kept_stacks import stacked_as_before

from tests.core.layout.test_shape_packing import squares

LOW = (0.2, 0.2, 0.5, 0.3)


def mesh_of(*boxes):
    """A mesh of one quad per box, each the former map of a chart of its own."""
    return squares(*boxes)


def kite(turn, size=1.0, is_mirrored=False):
    """A chart without symmetry, turned and scaled."""
    points = np.array([0.0, 3.0, 4.0 + 1.0j, 0.5 + 2.0j])
    points = np.exp(1j * turn) * size * (np.conj(points) if is_mirrored else points)
    return np.column_stack([points.real, points.imag])


CHARTS = np.repeat(np.arange(3), 4)


@pytest.mark.parametrize("is_mirrored", [False, True])
def test_they_are_laid_on_the_first_of_their_stack(is_mirrored):
    mesh = mesh_of(LOW, (0.6, 0.2, 0.9, 0.3), LOW)
    uv = np.concatenate([kite(0.0), kite(0.0), kite(1.0, 1.5, is_mirrored) + (7.0, 5.0)])
    found, lies_on = stacked_as_before(mesh, uv, CHARTS)
    assert lies_on.tolist() == [0] * 4 + [1] * 4 + [0] * 4
    np.testing.assert_allclose(found, np.concatenate([kite(0.0)] * 3), atol=1e-12)


def test_others_stay():
    uv = np.concatenate([kite(0.0), kite(0.0), kite(1.0)])
    untouched = (0.0, 0.0, 1.0, 1.0)
    for boxes in ((LOW, (0.6, 0.2, 0.9, 0.3), (0.2, 0.2, 0.5, 0.4)), (untouched,) * 3, ((np.nan,) * 4,) * 3):
        found, lies_on = stacked_as_before(mesh_of(*boxes), uv, CHARTS)
        assert found is uv and lies_on is CHARTS
    # Of another shape by now.
    other = np.concatenate([kite(0.0), kite(0.0), kite(0.0) * (1.0, 1.2)])
    assert stacked_as_before(mesh_of(LOW, (0.6, 0.2, 0.9, 0.3), LOW), other, CHARTS)[0] is other
    # More area than a tile has: these were never laid out.
    heap = mesh_of(LOW, LOW, (0.0, 0.0, 0.8, 0.9), (0.1, 0.1, 0.95, 0.95))
    four = np.concatenate([kite(0.0)] * 4)
    assert stacked_as_before(heap, four, np.repeat(np.arange(4), 4))[0] is four
    # None has a chart.
    assert stacked_as_before(mesh_of(LOW, LOW, LOW), uv, np.full(12, -1))[0] is uv
