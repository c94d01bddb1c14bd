# SPDX-License-Identifier: GPL-3.0-or-later
"""Means and percentiles over the surface."""

import numpy as np
import pytest
from spectral_conformal import _measuring as measuring


def test_the_next_corner_stays_in_the_face():
    assert measuring.next_corner(np.array([0, 3, 7])).tolist() == [1, 2, 0, 4, 5, 6, 3]
    assert measuring.next_corner(np.array([0, 0, 3, 3, 5, 5])).tolist() == [1, 2, 0, 4, 3]


def test_means_and_percentiles_count_area():
    values, area = np.array([3.0, 1.0, np.nan, 2.0]), np.array([1.0, 8.0, 50.0, 1.0])
    assert measuring.area_percentiles(values, area, (50.0, 85.0, 100.0)) == [1.0, 2.0, 3.0]
    assert measuring.area_mean(values[[0, 1, 3]], area[[0, 1, 3]]) == pytest.approx(1.3)


def test_without_area_nothing_is_known():
    values = np.array([1.0, 2.0])
    assert np.isnan(measuring.area_mean(values, np.zeros(2)))
    assert np.isnan(measuring.area_percentiles(values, np.zeros(2), (50.0, 98.0))).all()
    assert np.isnan(measuring.area_mean(values[:0], values[:0]))


def test_large_areas_do_not_overflow():
    assert measuring.area_mean(np.array([1e200, 3e200]), np.array([1e150, 1e150])) == pytest.approx(2e200)


def test_collapsed_islands_do_not_count_as_uneven():
    assert measuring.uneven(np.array([0.0, 2.0, np.inf, np.nan])).tolist() == [2.0]
