# SPDX-License-Identifier: GPL-3.0-or-later
"""The effect of a part solved in place on the rest of its island."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
from spectral_unwrap.core.solve.in_place import count_covered, with_axis_held
from spectral_unwrap.core.solve.options import Options, Settings

from tests.core.constraints.test_equations import sheet


def row_of_three():
    """Three quads in a row, of which the first is a part in place."""
    mesh = sheet(3, 1)
    uv = mesh.vertices[mesh.corner_vertices][:, [0, 2]]
    first = np.arange(12) < 4
    held = first & (mesh.corner_vertices >= 2)
    return replace(mesh, selected_faces=np.arange(3) == 0, uv=uv, pinned_corners=held, held_corners=held), first


def test_faces_of_the_rest_that_the_part_comes_to_cover_are_counted():
    mesh, first = row_of_three()
    solution = SimpleNamespace(solved_corners=first)
    assert count_covered([mesh], [solution], [mesh.uv]) == 0
    folded = np.where((first & ~mesh.held_corners)[:, None], mesh.uv + [2.5, 0.2], mesh.uv)
    assert count_covered([mesh], [solution], [folded]) == 2
    # What was covered before, or without a part, does not count.
    assert count_covered([replace(mesh, uv=folded)], [solution], [folded]) == 0
    assert count_covered([replace(mesh, held_corners=None)], [solution], [folded]) == 0


def test_the_axis_of_parts_is_held_where_only_the_other_moves():
    mesh, first = row_of_three()
    for blend, axis in (((1.0, 0.0), 1), ((0.0, 0.5), 0)):
        held = with_axis_held(mesh, Settings(blend=blend)).held_axis
        assert held.tolist() == np.where(first, axis, -1).tolist()
        # Whole islands likewise, but not where they have no extent to hold.
        whole = replace(mesh, selected_faces=np.ones(3, dtype=bool), held_corners=None)
        assert (with_axis_held(whole, Settings(blend=blend)).held_axis == axis).all()
        flat = replace(whole, uv=np.zeros((12, 2)))
        assert with_axis_held(flat, Settings(blend=blend)).held_axis is None
    for settings in (Settings(), Settings(blend=(0.0, 0.0)), Settings(Options(method="area"), blend=(1.0, 0.0))):
        assert with_axis_held(mesh, settings).held_axis is None
