# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes in a square, with a margin between them and to its border."""

import numpy as np
import pytest
from spectral_unwrap.core.errors import ReadableError
from spectral_unwrap.core.layout.packing import pack

SIZES = np.random.default_rng(0).uniform(0.2, 1.0, (40, 2))


def spaces(corners, size, side):
    """The least space between two boxes, and that between a box and the border."""
    low, high = corners, corners + size
    apart = np.maximum(low[:, None] - high, low - high[:, None]).max(axis=2)
    np.fill_diagonal(apart, np.inf)
    return apart.min(), min(low.min(), (side - high).min())


@pytest.mark.parametrize("margin", [0.0, 0.001, 0.02])
def test_every_box_has_its_margin(margin):
    corners, side = pack(SIZES, margin)
    between, border = spaces(corners, SIZES, side)
    assert border == pytest.approx(margin * side, rel=2e-3, abs=1e-12)
    assert between >= margin * side * (1.0 - 2e-3) - 1e-12


def test_one_box_fills_the_tile_but_for_the_margin():
    corners, side = pack(np.array([[2.0, 1.0]]), 0.1)
    assert side == pytest.approx(2.5, rel=1e-2)
    np.testing.assert_allclose(corners, 0.1 * side, rtol=1e-2)


@pytest.mark.parametrize("margin", [0.5, 0.99, 50.0])
def test_margins_that_leave_no_room_leave_finite_places(margin):
    corners, side = pack(SIZES, margin)
    assert np.isfinite(corners).all()
    assert np.isfinite(side)


def test_boxes_without_extent():
    corners, side = pack(np.zeros((3, 2)), 0.01)
    assert (corners == 0.0).all()
    assert side == 0.0


@pytest.mark.parametrize("margin", [np.nan, np.inf])
def test_a_margin_must_be_a_number(margin):
    with pytest.raises(ReadableError, match="The margin must be a number"):
        pack(SIZES, margin)
