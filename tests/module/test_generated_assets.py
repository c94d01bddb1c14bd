# SPDX-License-Identifier: GPL-3.0-or-later
"""Small meshes like those of generators: each gets seams with which it unwraps without flips and overlaps."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.benchmarks import generated_assets

FACES = 2500


def without_area(vertices, triangles):
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return not np.linalg.norm(np.cross(b - a, c - a), axis=1).any()


def triangles_of_edges(triangles):
    sides = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    return np.unique(sides, axis=0, return_counts=True)[1]


def test_the_same_each_time():
    for one, other in zip(*(generated_assets.asset("soiled scan", 1000) for _ in range(2))):
        np.testing.assert_array_equal(one, other)


def test_a_grid_in_parts_has_the_same_surface(monkeypatch):
    """Parts meet without a gap: a vertex more or an edge less would change one of the counts."""

    def counts(mesh):
        vertices, triangles = mesh
        return len(vertices), len(triangles_of_edges(triangles)), len(triangles)

    whole = counts(generated_assets.isosurface(generated_assets.statue)(50))
    monkeypatch.setattr(generated_assets, "GRID_VALUES", 15 * 50 * 50)
    assert counts(generated_assets.isosurface(generated_assets.statue)(50)) == whole


# Of all kinds, and two of many handles that no map serves until their halves are apart: fallbacks serve neither.
@pytest.mark.parametrize(
    ("name", "faces"),
    [*((name, FACES) for name in generated_assets.ASSETS), ("noise", 20_000), ("gyroid shell", 12_000)],
)
def test_suggested_seams_unwrap_it(name, faces):
    vertices, triangles = generated_assets.asset(name, faces)
    mesh = vertices, np.arange(0, 3 * len(triangles) + 1, 3), triangles.ravel()
    result = sc.unwrap(*mesh, seam_edges=sc.suggest_seams(*mesh).seam_edges)
    assert np.isfinite(result.uv).all()
    for chart in result.charts:
        if chart.status == "failed":
            # Marching cubes leaves bodies of one point, welding faces on a line.
            assert without_area(vertices, triangles[chart.faces]), chart.message
        else:
            assert (chart.flipped, chart.overlapping) == (0, 0)


def test_double_faces_are_measured_once():
    triangles = np.array([[0, 1, 2], [2, 1, 3], [1, 2, 0], [3, 2, 1], [3, 2, 4]])
    assert generated_assets.without_doubles(triangles).tolist() == [0, 1, 4]
    # They belong to the islands of those that they double.
    assert generated_assets.in_process("soiled scan", 2500, "spectral")["islands"] < 40


def test_one_map_is_measured_in_a_process_of_its_own():
    found = generated_assets.in_process("blocks, 300", 1000, "spectral")
    assert found["faces"] == 3600
    assert found["qc"] >= 1
    assert found["failed"] == found["flipped"] == found["overlapping"] == 0
    assert found["islands"] >= 300
    assert 0 < found["gigabytes"] < 4


def test_what_goes_wrong_is_said():
    assert in_short(generated_assets.in_process("no such asset", 1000, "spectral")) == "exit code 1"
    assert generated_assets.in_process("blocks, 300", 1000, "spectral", seconds=0) == "no end after 0 s"


def in_short(found):
    return found.partition(":")[0]
