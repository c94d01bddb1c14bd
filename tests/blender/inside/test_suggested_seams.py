# SPDX-License-Identifier: GPL-3.0-or-later
"""Suggested seams on Suzanne, with Blender's Smart UV Project as the yardstick of their length."""

import sys

import numpy as np
import pytest

from tests.blender.inside import seam_measures


@pytest.fixture
def native():
    (core,) = [module for name, module in sys.modules.items() if name.endswith("spectral_unwrap.core.native")]
    return core.spectral_conformal()


@pytest.mark.parametrize("levels", [0, 1])
def test_suzanne_is_hardly_distorted_by_fewer_seams_than_smart_project_makes(native, levels):
    suzanne = seam_measures.monkey(levels)
    mesh = seam_measures.arrays(suzanne)
    seams = native.suggest_seams(*mesh)
    measured = seam_measures.measure(native, mesh, seams)
    assert measured.unsolved == 0
    assert measured.mean_qc <= 1.1  # the default limit; sizes count as well
    assert measured.within >= 0.95
    assert seam_measures.length(mesh[0], seams) <= 1.5 * seam_measures.smart_project_border(suzanne)


def test_suzanne_gets_symmetric_seams(native):
    vertices, offsets, corners = seam_measures.arrays(seam_measures.monkey(1))
    seams = native.suggest_seams(vertices, offsets, corners)
    distance = np.linalg.norm(vertices[:, None] * [-1, 1, 1] - vertices[None], axis=2)
    image = distance.argmin(axis=1)
    assert distance.min(axis=1).max() < 1e-4
    mirrored = {tuple(sorted(edge)) for edge in image[seams].tolist()}
    assert mirrored == {tuple(edge) for edge in seams.tolist()}


def test_half_of_the_length_is_better_than_none(native):
    mesh = seam_measures.arrays(seam_measures.monkey(1))
    whole = seam_measures.length(mesh[0], native.suggest_seams(*mesh))
    limited = native.suggest_seams(*mesh, max_length=whole / 2)
    assert 0 < seam_measures.length(mesh[0], limited) <= whole / 2
    before, after = (seam_measures.measure(native, mesh, seams) for seams in (limited[:0], limited))
    assert after.within > before.within
