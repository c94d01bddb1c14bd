# SPDX-License-Identifier: GPL-3.0-or-later
"""The texel density of islands: by textures, by scale, and made equal."""

import dataclasses

import numpy as np
import pytest
from spectral_unwrap.core.measure.island_density import of_islands
from spectral_unwrap.core.measure.map_view import MapView
from spectral_unwrap.core.measure.texels import Texels, texels_of

from tests.core.measure.test_map_view import grid


def densities(*arrays):
    return of_islands([MapView(each) for each in arrays], [each.selected_faces for each in arrays], Texels(1024))


def test_density_is_pixels_along_a_unit_in_the_world():
    mesh = grid(scale=(0.1, 0.1))
    assert densities(mesh).density == pytest.approx([102.4])
    assert densities(dataclasses.replace(mesh, world_metric=4.0 * np.eye(3))).density == pytest.approx([51.2])
    # Half of the surface has a texture of 2048, the rest none.
    sides = np.repeat([2048.0, 0.0], 8)
    mixed = densities(dataclasses.replace(mesh, texture_sides=sides)).density
    assert mixed == pytest.approx([(0.5 * 204.8**2 + 0.5 * 102.4**2) ** 0.5])


def test_equalizing_keeps_the_pixels_and_obeys_factors():
    head = grid(scale=(0.1, 0.1))
    body = dataclasses.replace(grid(8, scale=(0.3, 0.3)), world_metric=4.0 * np.eye(3))
    head = dataclasses.replace(head, density_factors=np.full(16, 1.5, np.float32))
    found = densities(head, body)
    after = found.density * found.equalizing_scales()
    assert after[0] / after[1] == pytest.approx(1.5)
    assert (found.area * after**2).sum() == pytest.approx((found.area * found.density**2).sum())
    assert (found.density * found.scales_to(512.0)) == pytest.approx([512.0, 512.0])


def test_islands_without_a_size_and_faces_not_chosen_do_not_count():
    mesh = grid()
    mesh.uv[:] = 0.0
    found = densities(mesh, grid())
    assert np.isnan(found.density[0])
    assert found.equalizing_scales() == pytest.approx([1.0, 1.0])
    none = of_islands([MapView(grid())], [np.zeros(16, bool)], Texels())
    assert len(none.density) == 0
    assert (none.island[0] == -1).all()
    assert np.isnan(none.mean())


def test_units_are_those_of_the_scene():
    assert texels_of(1024, "NONE", "METERS", 0.01) == Texels(1024)
    assert texels_of(1024, "METRIC", "CENTIMETERS", 1.0) == Texels(1024, 0.01, "cm")
    # A scene in centimeters: a unit is a hundredth of a meter.
    assert texels_of(1024, "METRIC", "ADAPTIVE", 0.01) == Texels(1024, pytest.approx(100.0), "m")
    assert texels_of(1024, "IMPERIAL", "INCHES", 1.0).symbol == "in"
    assert texels_of(1024, "IMPERIAL", "MILES", 1.0).symbol == "ft"
