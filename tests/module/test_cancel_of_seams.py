# SPDX-License-Identifier: GPL-3.0-or-later
"""The search for seams of a large mesh ends soon after it is canceled, also while it looks for symmetry."""

import time

import numpy as np
import pytest
import spectral_conformal as sc

SIDE = 1000

pytestmark = pytest.mark.slow


def test_a_canceled_search_ends_soon():
    x, y = np.meshgrid(np.arange(SIDE + 1.0), np.arange(SIDE + 1.0), indexing="ij")
    z = 3.0 * np.sin(x / 40.0) * np.cos(y / 50.0)
    first = (np.arange(SIDE)[:, None] * (SIDE + 1) + np.arange(SIDE)).ravel()
    quads = np.c_[first, first + SIDE + 1, first + SIDE + 2, first + 1].astype(np.int32)
    vertices = np.c_[x.ravel(), y.ravel(), z.ravel()]
    mesh = sc.Mesh(vertices, np.arange(0, quads.size + 1, 4), corner_vertices=quads.ravel())
    for last in (8, 16, 24, 32):
        calls, canceled = 0, 0.0

        def progress(*_, last=last):
            nonlocal calls, canceled
            calls += 1
            canceled = time.process_time()
            return calls < last

        with pytest.raises(sc.Cancelled):
            sc.suggest_seams(mesh, progress=progress)
        # Of all threads, and what gives memory back; a search for symmetry that runs to its end takes 5 s.
        assert time.process_time() - canceled < 2.0, last
