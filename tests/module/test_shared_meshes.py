"""The hard and real meshes beside the project, where they exist. Everything they show is also tested on own meshes."""

import json
from pathlib import Path

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

SHARED = Path(__file__).resolve().parents[3] / "shared" / "meshes"


if (SHARED / "hard" / "hard.json").exists():
    HARD = json.loads((SHARED / "hard" / "hard.json").read_text())

    @pytest.mark.parametrize(("weights", "boundary"), [("uniform", "length"), ("inverse_area", "vertex")])
    @pytest.mark.parametrize("name", sorted(HARD))
    def test_hard_mesh_does_what_is_expected(name, weights, boundary):
        vertices, faces = meshes.read_obj(SHARED / "hard" / f"{name}.obj")
        expected = HARD[name]["expect"]
        if not faces:
            with pytest.raises(sc.InvalidMeshError, match="no faces"):
                sc.unwrap(vertices, [0], [])
            assert expected == "reject"
            return
        result = sc.unwrap(vertices, *meshes.polygons(faces), weights=weights, boundary=boundary)
        assert np.isfinite(result.uv).all()
        solved = [chart for chart in result.charts if chart.status == "solved"]
        assert all(chart.turning_number == 1 for chart in solved)
        # hard.json allows splitting for the fin; every other mesh to be rejected must be, with a reason.
        if expected == "reject" and name != "nonmanifold_fin":
            assert not solved
            assert all(chart.message for chart in result.charts)
        else:
            assert len(solved) == len(result.charts)
        if expected == "per_component":
            assert len(solved) == HARD[name]["components"]
        # The tube's two boundary loops are equally long, so one side of it has to shrink: one fold near its seam.
        allowed = 1 if expected == "solve_flips" or name == "tube_open" else 0
        assert sum(chart.flipped for chart in solved) <= allowed

    @pytest.mark.parametrize("name", sorted(HARD))
    def test_hard_mesh_is_fold_free_on_request(name):
        vertices, faces = meshes.read_obj(SHARED / "hard" / f"{name}.obj")
        if not faces:
            return
        offsets, corners = meshes.polygons(faces)
        result = sc.unwrap(vertices, offsets, corners, fold_free=True)
        for chart in result.charts:
            if chart.status == "solved":
                assert (chart.flipped, abs(chart.turning_number)) == (0, 1)
            else:
                assert HARD[name]["expect"] == "reject"

    # Their conformal maps wind around 2 to 33 times, or have folds that leave no room.
    @pytest.mark.slow
    @pytest.mark.parametrize("name", ["cycloidal_trimesh", "plate_holes_trimesh", "sword_quaddom", "tower_holes_8k"])
    def test_real_mesh_is_embedded_where_its_conformal_map_is_none(name):
        vertices, faces = meshes.read_obj(SHARED / "real" / f"{name}.obj")
        solution = sc.parameterize(vertices, faces, fold_free=True)
        assert (solution.is_embedding, solution.fallback) == (True, "tutte_embedding")
        assert solution.turning_number == 1
        assert not sc.distortion(vertices, faces, solution.uv).flipped.any()

    # Chosen for their kinds: many holes, strong shrinkage, a scan, developable to the file's digits, one loop, eleven.
    @pytest.mark.slow
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
        vertices, faces = meshes.read_obj(SHARED / "real" / f"{name}.obj")
        for weights, boundary in (("uniform", "length"), ("inverse_area", "vertex")):
            solution = sc.parameterize(vertices, np.array(faces), weights=weights, boundary=boundary)
            measured = sc.distortion(vertices, np.array(faces), solution.uv)
            assert (solution.turning_number, solution.message, measured.flipped.sum()) == (1, "", 0)
            assert measured.mean_qc < mean_qc

    @pytest.mark.slow
    @pytest.mark.parametrize("name", ["cowhead_bff", "spothead_bff", "goathead", "demosthenes", "face_bff"])
    def test_the_area_blend_halves_the_spread_of_the_scale_on_heads(name):
        vertices, faces = meshes.read_obj(SHARED / "real" / f"{name}.obj")
        spread = {}
        for amount in (0.0, 1.0):
            solution = sc.parameterize(vertices, faces, area_blend=amount)
            measured = sc.distortion(vertices, faces, solution.uv)
            spread[amount] = measured.log2_scale_deviation
        assert spread[1.0] < 0.5 * spread[0.0]
        assert not measured.flipped.any()
