# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes in a square."""

import numpy as np
import pytest
import spectral_conformal as sc


def test_boxes_lie_apart_in_the_square():
    sizes = np.random.default_rng(1).uniform(0.1, 1.0, (200, 2))
    corners, side = sc.hosts.pack_boxes(sizes)
    low, high = corners, corners + sizes
    apart = np.maximum(low[:, None] - high, low - high[:, None]).max(axis=2)
    assert (apart[~np.eye(len(sizes), dtype=bool)] > -1e-12).all()
    assert low.min() >= 0.0
    assert high.max() <= side
    assert sizes.prod(axis=1).sum() > 0.97 * side**2


def test_no_boxes():
    corners, side = sc.hosts.pack_boxes(np.empty((0, 2)))
    assert corners.shape == (0, 2)
    assert side == 0.0


@pytest.mark.parametrize("sizes", [[[1.0, -1.0]], [[np.nan, 1.0]], [[np.inf, 1.0]], [[1.0, 2.0, 3.0]], [1.0, 2.0]])
def test_sizes_that_are_none(sizes):
    with pytest.raises(ValueError, match="sizes"):
        sc.hosts.pack_boxes(sizes)
