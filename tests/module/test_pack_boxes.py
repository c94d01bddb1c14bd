# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes in a square, with a margin between them and to its border."""

import numpy as np
import pytest
from spectral_conformal.hosts import pack_boxes

SIZES = np.random.default_rng(0).uniform(0.2, 1.0, (40, 2))


@pytest.mark.parametrize("quick", [False, True])
@pytest.mark.parametrize("margin", [0.0, 0.001, 0.02, (0.02, 0.005)])
def test_every_box_has_its_margin(margin, quick):
    corners, side = pack_boxes(SIZES, margin=margin, quick=quick)
    wanted = side * np.broadcast_to(margin, 2) * (1.0 - 1e-9) - 1e-12
    low, high = corners, corners + SIZES
    apart = (np.maximum(low[:, None] - high, low - high[:, None]) - wanted).max(axis=2)
    np.fill_diagonal(apart, 0.0)
    assert apart.min() >= 0.0
    assert (low >= wanted).all()
    assert (side - high >= wanted).all()


def test_one_box_fills_the_square_but_for_the_margin():
    corners, side = pack_boxes([[2.0, 1.0]], margin=0.1)
    assert side == pytest.approx(2.5, rel=1e-2)
    np.testing.assert_allclose(corners, 0.1 * side, rtol=1e-2)


def test_boxes_without_extent_lie_the_margin_apart():
    corners, side = pack_boxes(np.zeros((3, 2)), margin=0.01)
    assert side == pytest.approx(1.0, rel=2e-3)
    assert np.ptp(corners, axis=0).max() >= 0.01 * side * (1.0 - 2e-3)
    assert pack_boxes(np.zeros((3, 2)))[1] == 0.0


@pytest.mark.parametrize("margin", [0.5, 0.99, 50.0])
def test_a_margin_without_room_is_refused(margin):
    with pytest.raises(ValueError, match="leaves no room"):
        pack_boxes(SIZES, margin=margin)


@pytest.mark.parametrize("margin", [np.nan, np.inf, -0.1])
def test_a_margin_must_be_a_number(margin):
    with pytest.raises(ValueError, match="margin must be finite and not negative"):
        pack_boxes(SIZES, margin=margin)
