# SPDX-License-Identifier: GPL-3.0-or-later
"""How many faces a map stretches beyond the limit of the warning."""

from types import SimpleNamespace

import numpy as np
import pytest
from spectral_unwrap.core.measure.summary import strain
from spectral_unwrap.core.mesh.polygon_mesh import PolygonMesh
from spectral_unwrap.core.solve.solution import Solution


def squares(widths, selected=None, max_qc=None, status="solved"):
    """Separate unit squares in one chart, whose image has the given widths and height 1."""
    n, unit = len(widths), np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    flat = np.concatenate([unit] * n)
    mesh = PolygonMesh(
        np.column_stack([flat, np.zeros(4 * n)]),
        np.arange(0, 4 * n + 1, 4),
        np.arange(4 * n),
        np.empty((0, 2), np.int32),
        np.ones(n, bool) if selected is None else np.array(selected),
    )
    charts = (SimpleNamespace(status=status, max_qc=max(widths) if max_qc is None else max_qc),)
    chart = np.full(4 * n, 0 if status == "solved" else -1)
    return mesh, Solution(np.concatenate([unit * (width, 1.0) for width in widths]), chart, charts, np.full(n, -1))


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
