# SPDX-License-Identifier: GPL-3.0-or-later
"""How many faces a map stretches beyond the limit of the warning."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from spectral_unwrap.core.measure.summary import strain as strain_of_charts
from spectral_unwrap.core.measure.summary import unevenness
from spectral_unwrap.core.solve.options import Options
from spectral_unwrap.core.solve.solution import Solution, charts_of, solve

from tests.core.polygon_meshes import SQUARE, polygon_mesh


def squares(widths, selected=None, max_qc=None, status="solved"):
    """Separate unit squares in one chart, whose image has the given widths and height 1."""
    n = len(widths)
    mesh = polygon_mesh(np.tile(SQUARE, (n, 1)), selected=selected)
    charts = (SimpleNamespace(status=status, max_qc=max(widths) if max_qc is None else max_qc),)
    chart = np.full(4 * n, 0 if status == "solved" else -1)
    return mesh, Solution(np.concatenate([SQUARE * (width, 1.0) for width in widths]), chart, charts, np.full(n, -1))


def strain(meshes, solutions):
    return strain_of_charts(meshes, solutions, charts_of(solutions))


def test_faces_beyond_twice_their_width_count():
    assert strain(*zip(squares([1.0, 1.9, 2.5, 4.0]))) == (2, pytest.approx(4.0))


def test_nothing_counts_below_the_limit():
    assert strain(*zip(squares([1.0, 1.9]))) == (0, 1.0)
    # A triangle of a quad may be beyond it while the face is not.
    assert strain(*zip(squares([1.0, 1.9], max_qc=2.1))) == (0, 1.0)


def test_meshes_add_up_and_others_do_not_count():
    refused = Solution(np.zeros((4, 2)), np.full(4, -1), (), np.zeros(1, int), error="refused")
    pairs = [
        squares([3.0, 5.0], selected=[True, False]),
        squares([7.0], status="failed"),
        squares([4.0, 1.0]),
        (squares([1.0])[0], refused),
    ]
    assert strain(*zip(*pairs)) == (2, pytest.approx(4.0))


def tube(rings, radius=1.0, sides=24):
    """A tube of quads, open at both ends; of its rings, one side apart."""
    angle = np.arange(sides) * (2.0 * np.pi / sides)
    ring = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(sides)])
    height = np.arange(rings)[:, None, None] * (2.0 * np.pi / sides)
    vertices = (ring + height * (0.0, 0.0, 1.0)).reshape(-1, 3)
    first = (np.arange(rings - 1)[:, None] * sides + np.arange(sides)).ravel()
    following = (np.arange(rings - 1)[:, None] * sides + (np.arange(sides) + 1) % sides).ravel()
    quads = np.column_stack([first, following, following + sides, first + sides])
    return polygon_mesh(vertices, quads)


def test_a_tube_that_becomes_a_ring_of_uneven_sizes_counts_until_a_seam_opens_it():
    # The scale of a ring is its radius, which grows with the length of the tube by its exponential.
    assert unevenness(charts_of([solve(tube(3), Options())])) == (0, 0.0)
    long = tube(9)
    charts, deviation = unevenness(charts_of([solve(long, Options())]))
    assert charts == 1
    assert deviation == pytest.approx(8 * 2.0 * np.pi / 24 / np.log(2.0) / 12.0**0.5, rel=0.05)
    opened = replace(long, seam_edges=np.arange(9 * 24, step=24)[np.array([[k, k + 1] for k in range(8)])])
    assert unevenness(charts_of([solve(opened, Options())])) == (0, 0.0)
