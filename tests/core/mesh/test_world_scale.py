# SPDX-License-Identifier: GPL-3.0-or-later
"""The area of faces in the world, by the object's metric and directly."""

import numpy as np
import pytest
from spectral_unwrap.core.mesh.world_scale import area_growth, area_vectors, is_uneven, metric_of

from tests.core.polygon_meshes import polygon_mesh


def triangles(n=20, **others):
    """Random triangles in space, far from the origin."""
    positions = np.random.default_rng(0).normal(size=(3 * n, 3)) + 100.0
    return polygon_mesh(positions, np.arange(3 * n).reshape(n, 3), **others)


def turn(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


@pytest.mark.parametrize("scale", [(3, 3, 3), (-2, 2, 2), (1, 2, 5), (1, 1, -4), (1, 1, 0)])
def test_growth_is_the_area_in_the_world_over_that_in_object_space(scale):
    linear = turn(0.4) @ np.diag(scale) @ turn(1.1)
    mesh = triangles(world_metric=metric_of(linear))
    moved = triangles()
    moved.vertices[:] = moved.vertices @ linear.T
    areas = [np.linalg.norm(area_vectors(each), axis=1) for each in (mesh, moved)]
    np.testing.assert_allclose(area_growth(mesh), areas[1] / areas[0], rtol=1e-6)
    assert is_uneven(mesh.world_metric) == (len(set(map(abs, scale))) > 1)


def test_rotations_and_rounding_have_no_metric():
    assert metric_of(turn(0.7).astype(np.float32)) is None
    assert metric_of(np.diag([-1.0, 1.0, 1.0, 1.0])) is None
    assert metric_of(np.full((3, 3), np.nan)) is None


def test_growth_without_a_surface_is_1():
    mesh = triangles(world_metric=np.zeros((3, 3)))
    assert (area_growth(mesh) == 1.0).all()
    flat = triangles(world_metric=np.diag([1.0, 4.0, 9.0]))
    flat.vertices[:] = flat.vertices[0]
    assert (area_growth(flat) == 1.0).all()
