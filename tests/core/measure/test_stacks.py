# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that lie on each other, and the band around islands."""

import numpy as np
import pytest
from spectral_unwrap.core.drawing import island_band
from spectral_unwrap.core.measure.map_view import MapView
from spectral_unwrap.core.measure.stacks import stacks
from spectral_unwrap.core.measure.texels import Texels

from tests.core.polygon_meshes import polygon_mesh

SQUARE = np.array([(0.0, 0.0), (0.25, 0.0), (0.25, 0.125), (0.0, 0.125)])


def islands(*maps):
    """One quad per map, each an island of its own."""
    uv = np.concatenate(maps)
    return polygon_mesh(np.column_stack([uv, np.repeat(np.arange(len(maps)), 4)]), uv=uv)


def test_equal_and_mirrored_islands_on_each_other_are_stacks():
    mirrored, aside = SQUARE[[1, 0, 3, 2]], SQUARE + (0.5, 0.0)
    views = [MapView(islands(SQUARE, aside, mirrored)), MapView(islands(SQUARE + 1e-5, SQUARE * 0.5, aside + (0, 0.1)))]
    found = stacks(views, 1e-3)
    assert [each.tolist() for each in found.of_face] == [[0, -1, 0], [0, -1, -1]]
    assert (found.count, found.islands) == (1, 3)
    # Three islands as large as the first one, and one with a quarter of its area.
    assert found.fill == pytest.approx(3.25 * 0.25 * 0.125)
    apart = stacks([views[0], MapView(islands(SQUARE + (0.01, 1.0)))], 1e-3)
    assert [each.tolist() for each in apart.of_face] == [[0, -1, 0], [-1]]
    assert (apart.islands, apart.fill) == (2, pytest.approx(3 * 0.25 * 0.125 / 2))


def test_islands_without_uvs_are_in_no_stack():
    found = stacks([MapView(islands(np.full((4, 2), np.nan), np.full((4, 2), np.nan)))], 1e-3)
    assert found.of_face[0].tolist() == [-1, -1]
    assert (found.islands, found.fill) == (0, None)


def test_the_band_reaches_half_of_the_margin_in_pixels():
    view = MapView(islands(SQUARE, SQUARE + (0.5, 0.5)))
    band = view.border_band(16.0, Texels(256))
    np.testing.assert_allclose(band.min(axis=0), -8.0 / 256, atol=1e-6)
    np.testing.assert_allclose(band.max(axis=0), SQUARE.max(axis=0) + 0.5 + 8.0 / 256, atol=1e-6)


def test_edges_between_faces_of_an_island_are_no_border():
    point = np.array([0, 1, 2, 3, 1, 4, 5, 2])
    following = np.array([1, 2, 3, 0, 5, 6, 7, 4])
    counted = np.ones(8, dtype=bool)
    assert island_band.border(point, following, counted).tolist() == [0, 2, 3, 4, 5, 6]
    # Torn apart in the map.
    assert len(island_band.border(np.arange(8), following, counted)) == 8
    assert len(island_band.border(point, following, ~counted)) == 0
    uv = SQUARE
    assert island_band.triangles(uv[:0], uv[:0], np.empty((0, 2))).shape == (0, 2)
    assert np.isfinite(island_band.triangles(uv[:1], uv[:1], np.full((1, 2), 0.1))).all()
    assert pytest.approx(0.1) == np.abs(island_band.triangles(uv[:1], uv[:1], np.full((1, 2), 0.1))).max()
