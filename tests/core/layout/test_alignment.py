# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands turn so that edges or an axis of the mesh are upright."""

import numpy as np
import pytest
from spectral_unwrap.core.layout.alignment import aligned, angle_of_axis, angle_of_sides, islands_of_corners

from tests.core.polygon_meshes import SQUARE, polygon_mesh


def test_sides_of_a_square_turn_it_back_whatever_their_order_and_sense():
    sides = np.array([1, 2j, -1, -2j, 3])
    for lean in (-0.7, -0.2, 0.0, 0.5, 0.78):
        assert angle_of_sides(sides * np.exp(1j * lean)) == pytest.approx(-lean)
    # Diagonals are outnumbered by the sides of the quads.
    assert angle_of_sides(np.array([1, 1j, 1, 1j, 1 + 1j])) == 0.0
    assert angle_of_sides(np.zeros(3, dtype=complex)) == 0.0


def test_heights_grow_upward():
    uv = np.random.default_rng(0).normal(size=(40, 2))
    for angle in (0.3, 2.0, -3.0):
        up = np.array([np.cos(angle), np.sin(angle)])
        assert np.exp(1j * angle_of_axis(uv, 5 + uv @ up)) == pytest.approx(np.exp(1j * (np.pi / 2 - angle)))
    assert angle_of_axis(uv, np.full(40, 7.0)) == 0.0


def test_only_islands_of_the_edges_move_and_squares_of_the_image_stay_squares():
    turned = SQUARE @ [[0.8, 0.6], [-0.6, 0.8]]
    mesh = polygon_mesh(np.r_[SQUARE, SQUARE + 5], uv=np.r_[turned, turned + 3] / [2.0, 1.0], aspect=2.0)
    uv, moved = aligned(mesh, islands_of_corners(mesh), [(4, 5)], None)
    assert moved.tolist() == [False] * 4 + [True] * 4
    assert np.array_equal(uv[:4], mesh.uv[:4])
    square = uv[4:] * [2.0, 1.0]
    assert np.abs(np.diff(square, axis=0)).round(9).tolist() == [[1, 0], [0, 1], [1, 0]]
