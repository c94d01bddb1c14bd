"""The real meshes beside the project, where they exist. Everything they show is also tested on own meshes."""

from pathlib import Path

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

SHARED = Path(__file__).resolve().parents[3] / "shared" / "meshes" / "real"

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not SHARED.is_dir(), reason="no meshes beside the project"),
]


# Their conformal maps wind around 2 to 33 times, or have folds that leave no room.
@pytest.mark.parametrize("name", ["cycloidal_trimesh", "plate_holes_trimesh", "sword_quaddom", "tower_holes_8k"])
def test_real_mesh_is_embedded_where_its_conformal_map_is_none(name):
    vertices, faces = meshes.read_obj(SHARED / f"{name}.obj")
    solution = sc.parameterize(vertices, faces, fold_free=True)
    assert (solution.is_embedding, solution.fallback) == (True, "tutte_embedding")
    assert solution.turning_number == 1
    assert not sc.distortion(vertices, faces, solution.uv).flipped.any()


# Chosen for their kinds: many holes, strong shrinkage, a scan, developable to the file's digits, one loop, eleven.
@pytest.mark.parametrize(
    ("name", "mean_qc"),
    [
        ("tower_holes", 1.040),
        ("hand_oded", 1.061),
        ("skull", 1.034),
        ("maze_bff", 1 + 1e-7),
        ("cowhead_bff", 1.059),
        ("beetle_bff", 1.0045),
    ],
)
def test_real_mesh_has_low_distortion_and_no_flips(name, mean_qc):
    vertices, faces = meshes.read_obj(SHARED / f"{name}.obj")
    for weights, boundary in (("uniform", "length"), ("inverse_area", "vertex")):
        solution = sc.parameterize(vertices, np.array(faces), weights=weights, boundary=boundary)
        measured = sc.distortion(vertices, np.array(faces), solution.uv)
        assert (solution.turning_number, solution.message, measured.flipped.sum()) == (1, "", 0)
        assert measured.mean_qc < mean_qc


@pytest.mark.parametrize("name", ["cowhead_bff", "spothead_bff", "goathead", "demosthenes", "face_bff"])
def test_the_area_blend_halves_the_spread_of_the_scale_on_heads(name):
    vertices, faces = meshes.read_obj(SHARED / f"{name}.obj")
    spread = {}
    for amount in (0.0, 1.0):
        solution = sc.parameterize(vertices, faces, area_blend=amount)
        measured = sc.distortion(vertices, faces, solution.uv)
        spread[amount] = measured.log2_scale_deviation
    assert spread[1.0] < 0.5 * spread[0.0]
    assert not measured.flipped.any()
