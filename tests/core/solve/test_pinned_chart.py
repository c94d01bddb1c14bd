# SPDX-License-Identifier: GPL-3.0-or-later
"""What a map costs that follows the mouse, by counts."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
import spectral_conformal
from spectral_unwrap.core.solve.pinned_chart import PinnedChart

from tests.core.polygon_meshes import grid

SIDE = 61
# Memory of a later map, in doubles per corner: the copy and the result of the module, two each, the numbers of the
# corners' vertices and charts, and the map at the free corners, twice.
MOST_DOUBLES = 10


@pytest.fixture(scope="module")
def followed():
    """A wavy sheet with six pins that has followed one movement, and a function that moves a pin on."""
    mesh = grid(SIDE - 1, height=lambda x, y: 4.0 * np.sin(0.1 * y) * np.cos(0.13 * x))
    corners, uv = mesh.corner_vertices, mesh.uv / SIDE
    pinned = np.isin(corners, np.linspace(0, SIDE**2 - 1, 6).astype(int))
    mesh = replace(mesh, uv=uv, pinned_corners=pinned)
    chart = PinnedChart(mesh, mesh.selected_faces, pinned, uv, polish="off")
    now, moved = uv.copy(), corners == corners[pinned][8]

    def move():
        now[moved] += 0.01
        return chart.map(now)

    assert move() is not None
    return chart, now, move


def test_a_later_map_is_that_of_a_fresh_chart(followed):
    chart, now, move = followed
    found = move()
    exact = spectral_conformal.Unwrapper(
        chart._mesh.with_map(now),
        fixed=chart._mesh.pinned_corners,
    )
    assert np.abs(found - exact.solve().uv[chart.free]).max() < 1e-9


@pytest.mark.skipif(
    "CHOLMOD" not in spectral_conformal.build_info()["factorization"], reason="the counts are those with CHOLMOD"
)
def test_a_later_map_takes_one_solve_with_the_kept_factor(followed):
    done = spectral_conformal._native.counted_work(followed[2])
    assert (done["analyses"], done["factorizations"], done["solves"]) == (0, 0, 2)


def test_a_later_map_passes_over_the_corners_a_few_times(followed):
    chart, now, move = followed
    tracemalloc.start()
    try:
        move()
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < MOST_DOUBLES * 8 * len(now)
