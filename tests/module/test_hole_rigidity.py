# SPDX-License-Identifier: GPL-3.0-or-later
"""Hole rigidity is lowered to what a patch bears; "automatic" finds what lowers its distortion."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

HAT = meshes.torn_hat()
# Surfaces so rough that rigid holes fold the map.
ROUGH = [meshes.rough_grid(12, 1.0, seed, dropped=0.1) for seed in range(6)]


def measured(mesh, solution):
    return sc.distortion(*mesh, solution.uv)


@pytest.mark.parametrize("polish", [False, True])
@pytest.mark.parametrize("mesh", [HAT, *ROUGH, meshes.bumpy_disk(400, holes=3, seed=1)])
def test_automatic_is_never_worse_than_free_holes(mesh, polish):
    free = sc.parameterize(*mesh, fallbacks=True, polish=polish)
    chosen = sc.parameterize(*mesh, fallbacks=True, hole_rigidity="automatic", polish=polish)
    before, after = measured(mesh, free), measured(mesh, chosen)
    assert after.flipped.sum() <= before.flipped.sum()
    assert after.mean_qc <= before.mean_qc * (1 + 1e-7) or after.flipped.sum() < before.flipped.sum()
    if chosen.hole_rigidity == 0:
        assert meshes.similarity_deviation(chosen.uv, free.uv) < 1e-6


def test_automatic_opens_the_torn_hat():
    chosen = sc.parameterize(*HAT, hole_rigidity="automatic")
    assert chosen.hole_rigidity > 0
    assert measured(HAT, chosen).mean_qc < 1.07 < 1.13 < measured(HAT, sc.parameterize(*HAT)).mean_qc
    assert chosen.message == ""
    (chart,) = sc.unwrap(HAT[0], *meshes.polygons(HAT[1]), hole_rigidity="automatic").charts
    assert chart.hole_rigidity == chosen.hole_rigidity


@pytest.mark.parametrize(
    "acting",
    [
        {"extenders": [(3, 90, 1.0)]},
        {"metric": np.tile(np.diag([1.0, 2.0]), (len(HAT[1]), 1, 1))},
        {"area_blend": 0.5},
        {"pins": {0: (0.0, 0.0), 30: (1.0, 0.0), 60: (0.0, 1.0)}},
        {"pins": {0: (0.0, 0.0), 30: (1.0, 0.0), 60: (0.0, 1.0)}, "soft_pins": 1.0},
        {"method": "lscm"},
        {"method": "fiedler"},
    ],
    ids=lambda acting: " ".join(acting),
)
def test_automatic_leaves_free_what_something_else_shapes(acting):
    chosen = sc.parameterize(*HAT, hole_rigidity="automatic", **acting)
    assert chosen.hole_rigidity == 0
    assert np.array_equal(chosen.uv, sc.parameterize(*HAT, **acting).uv)


def test_a_patch_without_holes_is_not_concerned():
    mesh = meshes.bumpy_disk(200, 0, 1)
    plain = sc.parameterize(*mesh, fallbacks=True, polish=True)
    for rigidity in (1.0, "automatic"):
        solution = sc.parameterize(*mesh, fallbacks=True, hole_rigidity=rigidity, polish=True)
        assert (solution.hole_rigidity, solution.polish_steps) == (0, plain.polish_steps)
        assert np.array_equal(solution.uv, plain.uv)
