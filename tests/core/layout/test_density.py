# SPDX-License-Identifier: GPL-3.0-or-later
"""Charts at an equal texel density in the world, times their factors."""

import dataclasses

import numpy as np
import pytest
from spectral_unwrap.core.layout.density import at_equal_density, scaled_about_centers
from spectral_unwrap.core.mesh.density_factors import chart_factors

from tests.core.polygon_meshes import SQUARE, polygon_mesh


def squares(n=2, **others):
    """Unit squares, each a chart."""
    return polygon_mesh(np.tile(SQUARE, (n, 1)), **others)


def sides(meshes, charts=None):
    """The sides of the squares after scaling, relative to the first."""
    charts = charts or [np.repeat(np.arange(len(mesh.selected_faces)), 4) for mesh in meshes]
    uv = np.concatenate([mesh.vertices[:, :2] for mesh in meshes])
    scaled = at_equal_density(meshes, charts, uv)
    return np.ptp(scaled.reshape(-1, 4, 2), axis=1)[:, 0], scaled is uv


def test_objects_count_by_their_size_in_the_world():
    large = squares(world_metric=9.0 * np.eye(3))
    assert sides([squares(), large])[0] == pytest.approx([1.0, 1.0, 3.0, 3.0])
    # The mean over the area of an uneven scale: x by 4.
    uneven = squares(world_metric=np.diag([16.0, 1.0, 1.0]))
    assert sides([squares(), uneven])[0] == pytest.approx([1.0, 1.0, 2.0, 2.0])


def test_a_common_scale_changes_no_bit():
    large = squares(world_metric=9.0 * np.eye(3))
    assert sides([large, large])[1]
    assert sides([squares()])[1]


def test_factors_multiply_and_unusable_ones_are_1():
    mesh = squares(6, density_factors=np.array([0.0, 1.5, np.nan, -2.0, np.inf, 1e9], np.float32))
    assert sides([mesh])[0] == pytest.approx([1.0, 1.5, 1.0, 1.0, 1.0, 100.0])


def test_a_chart_of_several_factors_has_their_average():
    mesh = squares(2, density_factors=np.array([1.0, 2.0], np.float32))
    assert chart_factors(mesh, np.zeros(2, int), 1) == pytest.approx([1.5])
    mesh = dataclasses.replace(mesh, density_factors=np.full(2, 1.1, np.float32))
    assert chart_factors(mesh, np.zeros(2, int), 1)[0] == np.float32(1.1)


def test_corners_without_a_chart_stay():
    large = squares(world_metric=9.0 * np.eye(3))
    charts = [np.repeat([0, -1], 4), np.repeat([0, -1], 4)]
    assert sides([squares(), large], charts)[0].tolist() == [1.0, 1.0, 3.0, 1.0]


def test_islands_are_scaled_about_their_centers_and_others_keep_their_bits():
    uv = np.random.default_rng(0).random((12, 2))
    island = np.repeat([0, 1, -1], 4)
    scaled = scaled_about_centers(uv, island, np.array([2.0, 1.0]))
    np.testing.assert_array_equal(scaled[4:], uv[4:])
    middle, size = ([(part.max(axis=0) + sign * part.min(axis=0)) for part in (uv[:4], scaled[:4])] for sign in (1, -1))
    np.testing.assert_allclose(middle[0], middle[1])
    np.testing.assert_allclose(2.0 * size[0], size[1])
