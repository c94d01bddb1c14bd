# SPDX-License-Identifier: GPL-3.0-or-later
"""The charts of a mesh before a solve: those of `unwrap`."""

import numpy as np
import pytest
from spectral_conformal import unwrap
from spectral_conformal.hosts import chart_of_face


def grid(columns=3, rows=2, extra=()):
    """Positions, offsets and corners of a grid of squares, and further faces on its vertices."""
    y, x = np.divmod(np.arange((columns + 1) * (rows + 1)), columns + 1)
    vertices = np.stack([x, y, 0.1 * x * y], axis=1).astype(float)
    first = [(columns + 1) * r + c for r in range(rows) for c in range(columns)]
    faces = [*((i, i + 1, i + columns + 2, i + columns + 1) for i in first), *extra]
    return vertices, np.cumsum([0, *map(len, faces)]), np.concatenate(faces)


CASES = {
    "plain": ({}, ()),
    "seam": ({"seam_edges": [(1, 5), (5, 9)]}, ()),
    "selection": ({"selected_faces": [True, False, True, True, False, True]}, ()),
    "doubled face": ({"selected_faces": None}, [(0, 1, 5, 4)]),
    "fin": ({}, [(1, 5, 10)]),
}


@pytest.mark.parametrize("name", CASES)
def test_charts_are_those_of_unwrap(name):
    options, extra = CASES[name]
    mesh = grid(extra=extra)
    np.testing.assert_array_equal(chart_of_face(*mesh, **options), unwrap(*mesh, **options).chart_of_face)


def test_faces_in_no_chart():
    mesh = grid(extra=[(0, 1, 1)])
    selected = [False] + 6 * [True]
    np.testing.assert_array_equal(chart_of_face(*mesh, selected_faces=selected), [-1, 0, 0, 0, 0, 0, -1])


def test_charts_are_numbered_from_zero():
    mesh = grid()
    found = chart_of_face(*mesh, seam_edges=[(2, 6), (6, 10)])
    np.testing.assert_array_equal(found, [0, 0, 1, 0, 0, 1])
    assert found.dtype == np.int32


def test_arrays_that_are_no_mesh_are_refused():
    vertices, offsets, corners = grid()
    with pytest.raises(ValueError, match="12 vertices"):
        chart_of_face(vertices, offsets, corners + 7)
