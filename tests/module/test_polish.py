# SPDX-License-Identifier: GPL-3.0-or-later
"""Polish: from the eigenvector to a lower mean QC, and to even sizes."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes


@pytest.fixture(params=["angles", "balanced"])
def polish(request):
    return request.param


def test_no_mesh_gets_worse(polish):
    improved = 0
    for seed in range(12):
        mesh = meshes.rough_grid(12, 0.3 + 0.15 * seed, seed)
        try:
            plain = sc.parameterize(*mesh, fallbacks=False)
        except sc.SolveError:
            continue
        polished = sc.parameterize(*mesh, fallbacks=False, polish=polish)
        before, after = sc.distortion(*mesh, plain.uv), sc.distortion(*mesh, polished.uv)
        assert after.mean_qc <= before.mean_qc
        assert after.flipped.sum() <= before.flipped.sum()
        improved += after.mean_qc < before.mean_qc
    assert improved >= 6


@pytest.mark.parametrize(
    "given",
    [
        {"pins": {3: (0, 0), 700: (1, 0), 200: (0, 1)}, "method": "lscm"},
        {"method": "lscm"},
        {"method": "fiedler"},
    ],
    ids=lambda given: "-".join(given),
)
def test_another_method_is_not_polished(given):
    mesh = meshes.bumpy_disk(1500, holes=3)
    plain, polished = sc.parameterize(*mesh, **given), sc.parameterize(*mesh, **given, polish=True)
    assert polished.polish_steps == 0
    np.testing.assert_array_equal(polished.uv, plain.uv)


@pytest.mark.parametrize(("limbs", "seed", "is_polished"), [(8, 11, False), (6, 5, True)])
def test_no_island_covers_itself_that_did_not_before(limbs, seed, is_polished, polish):
    # Without regard to the border, faces cover others; of the first body even a quarter of the way there.
    body = meshes.limbs(1200, limbs, seed)
    # With a price of QC, the search has one stage: few, long seams, and one island however long.
    limits = {"scale_limit": 3, "energy_limit": 9, "qc_limit": 1.6, "qc_gain": 1.0}
    seams = sc.suggest_seams(*body, style="hard", longest_side=np.inf, **limits).seam_edges
    plain, polished = (sc.unwrap(*body, seam_edges=seams, polish=each).charts for each in ("off", polish))
    assert sum(chart.overlapping for chart in plain) == 0
    assert sum(chart.overlapping for chart in polished) == 0
    # Two triangles are flat in any map of theirs.
    assert all((chart.polish_steps > 0) == is_polished for chart in polished if len(chart.faces) > 2)
