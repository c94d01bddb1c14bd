# SPDX-License-Identifier: GPL-3.0-or-later
"""The two measures of quality."""

from types import SimpleNamespace

import numpy as np
import pytest
from spectral_unwrap.core.measure import quality
from spectral_unwrap.core.solve.solution import Solution

from tests.core.polygon_meshes import SQUARE, polygon_mesh


def squares(sizes, image_sizes, selected=None, solved=None, mean_qc=1.0):
    """Separate squares in space, and a map of them; one chart."""
    n = len(sizes)
    flat = np.concatenate([size * SQUARE for size in sizes])
    # Upright, so that no coordinate is left out by chance.
    mesh = polygon_mesh(np.column_stack([flat[:, 0], np.full(len(flat), 3.0), flat[:, 1]]), selected=selected)
    chart = np.repeat(np.where(np.ones(n, bool) if solved is None else solved, 0, -1), 4)
    charts = (SimpleNamespace(status="solved", mean_qc=mean_qc, area=1.0),)
    uv = np.concatenate([size * SQUARE for size in image_sizes])
    return mesh, Solution(uv, chart, charts, np.full(n, -1))


def measure(*pairs, factor=2.0):
    meshes, solutions = zip(*pairs)
    return quality.measure(meshes, solutions, factor)


def test_isometric_map_is_even():
    quality = measure(squares([1.0, 2.0], [1.0, 2.0]))
    assert (quality.even, quality.mean_qc) == (1.0, 1.0)


@pytest.mark.parametrize(("factor", "even"), [(1.4, 0.9), (1.6, 1.0)])
def test_scale_is_compared_with_the_median_by_area(factor, even):
    # Nine tenths of the area have the scale 1, one tenth has 1.5.
    quality = measure(squares([3.0, 1.0], [3.0, 1.5]), factor=factor)
    assert quality.even == pytest.approx(even)


def test_smaller_and_larger_count_alike():
    assert measure(squares([3.0, 1.0, 1.0], [3.0, 0.4, 2.5])).even == pytest.approx(9.0 / 11.0)


def test_the_median_is_that_of_all_meshes():
    assert measure(squares([3.0], [3.0]), squares([1.0], [5.0])).even == pytest.approx(0.9)


def test_faces_without_solution_are_not_even():
    assert measure(squares([1.0, 1.0], [1.0, 1.0], solved=[True, False])).even == pytest.approx(0.5)
    assert measure(squares([1.0, 1.0], [1.0, 1.0], solved=[False, False])).even == 0.0


def test_faces_that_are_not_selected_do_not_count():
    assert measure(squares([1.0, 9.0], [1.0, 90.0], selected=[True, False])).even == 1.0


def test_faces_without_finite_area_do_not_count():
    assert measure(squares([1.0, np.nan], [1.0, 1.0])).even == 1.0
    assert measure(squares([1.0, 1e200], [1.0, 1.0])).even == 1.0


def test_mean_qc_is_weighted_by_area():
    first, second = squares([1.0], [1.0], mean_qc=1.1), squares([1.0], [1.0], mean_qc=1.4)
    second[1].charts[0].area = 2.0
    assert measure(first, second).mean_qc == pytest.approx(1.3)
    failed = squares([1.0], [1.0], solved=[False])
    failed[1].charts[0].status = "failed"
    assert np.isnan(measure(failed).mean_qc)
