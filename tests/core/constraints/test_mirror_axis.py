# SPDX-License-Identifier: GPL-3.0-or-later
"""The edges on the mirror plane of an island, and blocks of faces inside islands."""

from dataclasses import replace

import numpy as np
import pytest
from spectral_unwrap.core.constraints import marks
from spectral_unwrap.core.constraints.mirror_axis import mirror_axes

from tests.core.constraints.test_equations import can, sheet

MIDDLE = {(4 * 4 + j, 4 * 4 + j + 1): marks.AXIS for j in range(3)}


def bent(mesh, turn=0.0):
    """Bend a sheet over 8 x 3 quads symmetrically about its middle column, turn it about z, and move it."""
    x, y, z = mesh.vertices.T
    points = np.c_[x, 0.2 * (x - 4) ** 2 + 0.1 * z**2, z]
    c, s = np.cos(turn), np.sin(turn)
    return replace(mesh, vertices=points @ [[c, s, 0], [-s, c, 0], [0, 0, 1]] + [3.0, -2.0, 1.0])


@pytest.mark.parametrize("turn", [0.0, 0.4])
def test_the_middle_of_a_bent_sheet_is_its_axis(turn):
    mesh = bent(sheet(8, 3), turn)
    assert mirror_axes(mesh, mesh.selected_faces) == MIDDLE


def test_a_sheet_modeled_by_hand_with_a_detail_on_one_side_still_has_one():
    mesh = bent(sheet(8, 3))
    vertices = mesh.vertices + 1e-5 * np.random.default_rng(1).normal(size=mesh.vertices.shape)
    vertices[0] += [0.0, 0.3, 0.0]
    assert mirror_axes(replace(mesh, vertices=vertices), mesh.selected_faces) == MIDDLE


def test_an_island_without_a_mirror_plane_has_no_axis():
    mesh = bent(sheet(8, 3))
    vertices = mesh.vertices.copy()
    vertices[:, 1] += 0.05 * vertices[:, 0] ** 3 + 0.2 * vertices[:, 0] * vertices[:, 2]
    assert mirror_axes(replace(mesh, vertices=vertices), mesh.selected_faces) == {}
    assert mirror_axes(mesh, np.zeros(24, dtype=bool)) == {}
    assert mirror_axes(replace(mesh, vertices=vertices * np.nan), mesh.selected_faces) == {}


def test_a_flat_sheet_is_not_mirrored_about_its_own_plane():
    mesh = sheet(8, 3)
    assert mirror_axes(mesh, mesh.selected_faces) == MIDDLE


def test_the_border_of_a_block_becomes_a_rectangle():
    chosen = np.zeros(24, dtype=bool)
    chosen[[4, 7]] = True
    assert len(marks.rectangles(sheet(8, 3), chosen, range(36))[0]) == 6


@pytest.mark.parametrize("seam", [0, 2])
def test_the_side_of_a_cylinder_is_mirrored_about_the_plane_of_its_seam(seam):
    mesh = can(8, seam)
    opposite = 2 * ((seam + 4) % 8)
    assert mirror_axes(mesh, np.arange(10) < 8) == {(opposite, opposite + 1): marks.AXIS}
