# SPDX-License-Identifier: GPL-3.0-or-later
"""Suggested seams on Suzanne, with Blender's Smart UV Project as the yardstick of their length."""

import sys

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
    seams = native.suggest_seams(*mesh).seam_edges
    measured = seam_measures.measure(native, mesh, seams)
    assert measured.unsolved == 0
    assert measured.mean_qc <= 1.1  # the default limit; sizes count as well
    assert measured.within >= 0.95
    assert seam_measures.length(mesh[0], seams) <= 1.5 * seam_measures.smart_project_border(suzanne)
