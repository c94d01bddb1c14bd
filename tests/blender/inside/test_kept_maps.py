# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that have not changed since the last unwrap are not solved again, and lie as if they were."""

import importlib

import bpy
import numpy as np

from tests.blender.inside import digest, scenes

core_options = importlib.import_module("spectral_unwrap.core.solve.options")
session = importlib.import_module("spectral_unwrap.session")
kept_maps = importlib.import_module("spectral_unwrap.session.kept_maps")
steps = importlib.import_module("spectral_unwrap.unwrapping.steps")

ROWS, COLUMNS = 9, 10  # faces


def prepare():
    """A grid with a seam down the middle: two islands."""
    grid = scenes.bumpy_grid(COLUMNS, ROWS, seams=[(r * 11 + 5, r * 11 + 16) for r in range(ROWS)])
    scenes.edit(grid)
    return grid


def reused():
    """Solve what is selected, as the operator does; return which islands were not solved."""
    settings = core_options.Settings()
    (solution,) = steps.solve_and_place(steps.read(bpy.context, settings), settings).solutions
    return [chart.reused for chart in solution.charts]


def mark(grid, vertices):
    bm = scenes.edit_mesh(grid)
    for edge in bm.edges:
        if {vertex.index for vertex in edge.verts} == set(vertices):
            edge.seam = True


def test_only_what_has_changed_is_solved():
    grid = prepare()
    assert reused() == [False, False]
    assert reused() == [True, True]
    mark(grid, (0 * 11 + 1, 1 * 11 + 1))
    assert reused() == [False, True]
    scenes.edit_mesh(grid).verts.ensure_lookup_table()
    scenes.edit_mesh(grid).verts[-1].co.z += 0.1
    assert reused() == [True, False]


def test_another_margin_solves_nothing_and_the_map_is_the_same():
    grid = prepare()
    expected = {}
    for margin in (1.0, 50.0):
        session.drop(kept_maps.KeptMaps)
        bpy.ops.uv.spectral_unwrap(margin=margin)
        expected[margin] = digest.active_uv(grid.data)
    assert reused() == [True, True]
    for margin, uv in expected.items():
        bpy.ops.uv.spectral_unwrap(margin=margin)
        assert np.array_equal(digest.active_uv(grid.data), uv)
