# SPDX-License-Identifier: GPL-3.0-or-later
"""The tangent frames of a map, for normals that textures give."""

import numpy as np
import pytest
import spectral_conformal as sc

SQUARE = np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]])
TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]])
UP = np.tile([0.0, 0, 1], (4, 1))


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.5])
@pytest.mark.parametrize("side", [1, -1])
def test_the_tangent_points_where_u_grows(angle, side):
    cos, sin = np.cos(angle), np.sin(angle)
    uv = SQUARE[:, :2] @ np.array([[cos, -sin], [sin, cos]]) * (1, side)
    found = sc.tangents(SQUARE, TRIANGLES, uv, UP)
    assert found == pytest.approx(np.tile([cos, sin, 0, side], (4, 1)))


def test_it_lies_across_the_normal_and_has_length_one():
    rng = np.random.default_rng(1)
    normals = rng.normal(size=(4, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    found = sc.tangents(SQUARE, TRIANGLES, SQUARE[:, :2], normals)
    assert np.linalg.norm(found[:, :3], axis=1) == pytest.approx(1)
    assert (found[:, :3] * normals).sum(axis=1) == pytest.approx(0, abs=1e-12)


def test_larger_angles_count_more():
    """At the first corner a right angle, and half of one on a slope with another direction."""
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, -1, 0]])
    uv = np.array([[0.0, 0], [1, 0], [0, 1], [1, 0]])
    right = sc.tangents(vertices, [[0, 1, 2]], uv, UP)[0]
    both = sc.tangents(vertices, [[0, 1, 2], [0, 3, 1]], uv + [[0, 0], [0, 0], [0, 0], [0.5, -1]], UP)[0]
    assert right == pytest.approx([1, 0, 0, 1])
    other = sc.tangents(vertices, [[0, 3, 1]], uv + [[0, 0], [0, 0], [0, 0], [0.5, -1]], UP)[0]
    expected = 2 * right[:3] + other[:3]
    assert both[:3] == pytest.approx(expected / np.linalg.norm(expected))


def test_without_a_direction_there_is_one_across_the_normal():
    found = sc.tangents(SQUARE, TRIANGLES, np.zeros((4, 2)), UP)
    assert found[:, 2] == pytest.approx(0)
    assert np.linalg.norm(found[:, :3], axis=1) == pytest.approx(1)
    assert sc.tangents(np.zeros((0, 3)), np.zeros((0, 3), int), np.zeros((0, 2)), np.zeros((0, 3))).shape == (0, 4)


def test_wrong_arguments_are_named():
    with pytest.raises(ValueError, match="normals has 3 rows, but there are 4 vertices"):
        sc.tangents(SQUARE, TRIANGLES, SQUARE[:, :2], UP[1:])
    with pytest.raises(ValueError, match="uv has 3 rows"):
        sc.tangents(SQUARE, TRIANGLES, SQUARE[1:, :2], UP)
