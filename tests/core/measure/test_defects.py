# SPDX-License-Identifier: GPL-3.0-or-later
"""Defects of the UV maps of several meshes, found together and assigned to each."""

import numpy as np
from spectral_unwrap.core.measure import defects

from tests.core.polygon_meshes import grid


def strip(n, uv_offset=0.0):
    """n quads in a row, mapped as they lie, moved along u."""
    mesh = grid(n, 1)
    mesh.uv[:, 0] += uv_offset
    return mesh


def test_no_meshes_have_no_defects():
    assert defects.find([], between_islands=True) == []


def test_defects_are_those_of_each_mesh():
    first, second = strip(3), strip(5, uv_offset=10.0)
    second.uv[16:] = second.uv[16:] * [-1.0, 1.0] + [28.0, 0.0]  # the last quad folded over
    one, other = defects.find([first, second], between_islands=False)
    assert not one.chosen(True, True).any()
    assert other.flipped.tolist() == [False, False, False, False, True]
    assert other.overlapping.tolist() == [False, False, False, True, True]
    assert other.chosen(True, False).tolist() == other.flipped.tolist()
    assert other.chosen(False, True).tolist() == other.overlapping.tolist()


def test_islands_of_different_meshes_overlap_when_asked():
    meshes = [strip(3), strip(2, uv_offset=2.5)]
    assert not any(found.overlapping.any() for found in defects.find(meshes, between_islands=False))
    one, other = defects.find(meshes, between_islands=True)
    assert one.overlapping.tolist() == [False, False, True]
    assert other.overlapping.tolist() == [True, False]


def test_faces_without_finite_uvs_are_told_and_the_others_are_looked_at():
    mesh = strip(4)
    mesh.uv[1] = np.nan
    mesh.uv[14] = np.inf
    mesh.selected_faces[3] = False
    (found,) = defects.find([mesh], between_islands=True)
    assert found.not_finite.tolist() == [True, False, False, False]
    assert found.chosen(False, False).tolist() == found.not_finite.tolist()
    assert not found.flipped.any()
    assert not found.overlapping.any()
