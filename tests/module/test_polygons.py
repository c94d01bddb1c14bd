# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons whose outline touches or repeats itself: walls with windows, with vertices of their own or repeated ones."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import bridged, meshes


def unwrapped(vertices, corners):
    """The map of one polygon, and its chart."""
    result = sc.unwrap(vertices, [0, len(corners)], corners)
    assert len(result.charts) == 1 and result.solved_corners.all()
    return result.uv, result.charts[0]


def own_vertices(vertices, corners):
    return vertices[corners], np.arange(len(corners))


@pytest.mark.parametrize("vertices_of", ["own", "repeated"])
def test_walls_with_windows_are_flat_walls(vertices_of):
    for seed in range(100):
        rng = np.random.default_rng(seed)
        corners, points = bridged.random_wall(rng)
        vertices = bridged.in_space(rng, points)
        flat = points[corners]
        if seed % 2:
            corners, flat = corners[::-1], flat[::-1] * (1, -1)
        if vertices_of == "own":
            vertices, corners = own_vertices(vertices, corners)
        uv, chart = unwrapped(vertices, corners)
        assert meshes.similarity_deviation(uv, flat) < 1e-5
        assert chart.message == "" and chart.flipped == chart.overlapping == 0
        assert chart.area == pytest.approx(abs(bridged.area_of(flat)), rel=1e-5)
        distortion = sc.face_distortion(sc.Mesh(vertices, [0, len(corners)], uv, corner_vertices=corners))
        assert distortion.qc[0] == pytest.approx(1, abs=1e-4)
        defects = meshes.defects([0, len(corners)], corners, uv)
        assert not defects.flipped.any() and not defects.overlapping.any()


SQUARE = np.array([(0, 0), (4, 0), (4, 4), (0, 4)], float)
HOLE = np.array([(1, 1), (1, 2), (2, 2), (2, 1)], float)


def test_bent_walls_and_faces_in_their_windows():
    for seed in range(20):
        rng = np.random.default_rng(seed)
        corners, points = bridged.random_wall(rng)
        _, chart = unwrapped(bridged.in_space(rng, points, bend=0.3), corners)
        assert chart.flipped == 0 and "self-intersecting" not in chart.message
    # The pane shares the edges of the hole.
    points = np.concatenate([SQUARE, HOLE])
    wall, pane = [0, 4, 5, 6, 7, 4, 0, 1, 2, 3], [7, 6, 5, 4]
    vertices = np.column_stack([points, np.zeros(8)])
    result = sc.unwrap(vertices, [0, 10, 14], wall + pane)
    assert [list(chart.faces) for chart in result.charts] == [[0, 1]]
    assert meshes.similarity_deviation(result.uv, points[wall + pane]) < 1e-6


def test_seams_are_suggested_on_walls_with_windows():
    corners, points = bridged.random_wall(np.random.default_rng(3))
    lifted = np.column_stack([points, np.zeros(len(points))])
    assert len(sc.suggest_seams(lifted, [0, len(corners)], corners).seam_edges) == 0


def test_islands_without_area_are_points():
    square = np.column_stack([SQUARE, np.zeros(4)])
    line = [(9, 0, 0), (10, 0, 0), (12, 0, 0), (14, 0, 0)]
    vertices = np.concatenate([square, line, [(5, 5, 5)] * 3])
    result = sc.unwrap(vertices, [0, 4, 8, 11], np.arange(11))
    assert [chart.status for chart in result.charts] == ["solved"] * 3
    for face, corners in ((1, slice(4, 8)), (2, slice(8, 11))):
        assert result.charts[face].message == "The island has no area: its map is a point."
        assert result.charts[face].area == result.charts[face].eigenvalue == result.charts[face].residual == 0
        assert np.ptp(result.uv[corners], axis=0).max() == 0
    assert result.charts[0].message == ""
    pinned = sc.unwrap(vertices, [0, 4, 8, 11], np.arange(11), pins={8: (0.25, 0.5)})
    assert pinned.uv[8:].tolist() == [[0.25, 0.5]] * 3
