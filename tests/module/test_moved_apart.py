# SPDX-License-Identifier: GPL-3.0-or-later
"""With `fold_free`, overlapping parts of a map without folds are moved apart by descent."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

COVERED = [meshes.rough_grid(8, 1.0, 8, 0.1), meshes.rough_grid(8, 1.0, 12, 0.2), meshes.rough_grid(10, 1.0, 10, 0.2)]


@pytest.mark.parametrize("mesh", COVERED)
def test_parts_come_apart_at_some_cost(mesh):
    plain = sc.parameterize(*mesh, polish=True)
    before = sc.distortion(*mesh, plain.uv)
    assert before.overlapping.any()
    assert not before.flipped.any()
    apart = sc.parameterize(*mesh, polish=True, fold_free=True)
    after = sc.distortion(*mesh, apart.uv)
    assert not after.overlapping.any()
    assert not after.flipped.any()
    assert abs(apart.turning_number) == 1
    assert apart.eigenvalue_of == "map"
    assert apart.mean_qc_before == pytest.approx(before.mean_qc)
    assert after.mean_qc < 1.1 * before.mean_qc
    assert apart.message.startswith("Parts that covered each other moved apart; angles are off by ")
    (chart,) = sc.unwrap(mesh[0], *meshes.polygons(mesh[1]), polish=True, fold_free=True).charts
    assert (chart.overlapping, chart.flipped) == (0, 0)


@pytest.mark.parametrize(
    ("mesh", "fallback"),
    [(meshes.rough_grid(8, 2.0, 8, 0.1), "unfolded"), (meshes.rough_grid(10, 2.0, 6, 0.2), "tutte_embedding")],
)
def test_what_stands_in_for_a_refused_map_says_so_still(mesh, fallback):
    refused = sc.parameterize(*mesh, fallbacks=True)
    apart = sc.parameterize(*mesh, fallbacks=True, fold_free=True)
    assert "moved apart" in apart.message
    assert not sc.distortion(*mesh, apart.uv).overlapping.any()
    assert refused.fallback == apart.fallback == fallback
    assert apart.is_embedding == (fallback == "tutte_embedding")
    assert apart.unfolded == refused.unfolded > 0
    assert apart.mean_qc_before == refused.mean_qc_before


@pytest.mark.parametrize("turns", [1.5, 3.0])
def test_parts_that_cannot_be_pulled_apart_come_apart_in_an_embedding(turns):
    vertices, quads = meshes.spiral_ramp(turns)
    mesh = vertices, meshes.triangles_of(quads)
    plain = sc.parameterize(*mesh)
    before = sc.distortion(*mesh, plain.uv)
    assert before.overlapping.mean() > 0.3
    assert not before.flipped.any()
    apart = sc.parameterize(*mesh, fold_free=True)
    after = sc.distortion(*mesh, apart.uv)
    assert not after.overlapping.any()
    assert not after.flipped.any()
    assert abs(apart.turning_number) == 1
    # A spiral that grows outward keeps angles, despite all its turns.
    assert after.mean_qc < 1.1
    assert apart.is_embedding
    assert apart.message.startswith("Parts that covered each other came apart in an embedding, relaxed without ")
    assert apart.mean_qc_before == pytest.approx(before.mean_qc)
    assert apart.eigenvalue_of == "map"
    assert apart.fallback == "tutte_embedding"


def test_with_pins_parts_stay_where_they_are_and_are_told():
    vertices, faces = meshes.spiral_ramp(1.5)
    mesh = (vertices, *meshes.polygons(faces))
    plain = sc.unwrap(*mesh)
    first, last = 0, len(mesh[2]) - 1
    pins = {int(mesh[2][corner]): plain.uv[corner] for corner in (first, (first + last) // 2, last)}
    (held,) = sc.unwrap(*mesh, pins=pins, fold_free=True).charts
    assert held.status == "solved"
    assert held.overlapping > 0.3 * len(held.faces)
    assert "came apart" not in held.message


@pytest.mark.parametrize("quads", [1000, 10000])
def test_long_ribbons_come_apart_in_shape(quads):
    # Three turns around an axis, each quad a square.
    turn = 6 * np.pi * np.arange(quads + 1) / quads
    radius = np.array([[0.0, 1.0]]) + quads / (6 * np.pi)
    x, y = radius * np.cos(turn)[:, None], radius * np.sin(turn)[:, None]
    vertices = np.stack([x, y, np.repeat(turn[:, None], 2, axis=1)], axis=2).reshape(-1, 3)
    first = 2 * np.arange(quads)
    triangles = np.r_[np.c_[first, first + 1, first + 3], np.c_[first, first + 3, first + 2]]
    assert sc.distortion(vertices, triangles, sc.parameterize(vertices, triangles).uv).overlapping.any()
    apart = sc.parameterize(vertices, triangles, fold_free=True)
    after = sc.distortion(vertices, triangles, apart.uv)
    assert not after.overlapping.any()
    assert not after.flipped.any()
    assert after.mean_qc < 1.1
