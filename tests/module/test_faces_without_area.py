# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces without area lie inside the islands of their neighbors, in files of the batch."""

import numpy as np
import pytest
from spectral_conformal import Options
from spectral_conformal.assets import AssetMesh, UvMap
from spectral_conformal.assets.report import Measurement
from spectral_conformal.assets.unwrapping import Cutting, Layout, cut, laid_out, share_of_boxes, unwrapped
from spectral_conformal.batch import task

GRID = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (1, 1, 0), (2, 1, 0)]
QUADS = [(0, 1, 4, 3), (1, 2, 5, 4)]
# Name: more vertices, more faces, and where their corners must be, as positions in the grid.
CASES = {
    "at another vertex": ([(2, 1, 0)], [(4, 5, 6)], [(1, 1), (2, 1), (2, 1)]),
    "a chain": ([(2, 0.5, 0), (2, 0.5, 0), (2, 0.25, 0)], [(2, 6, 5), (6, 7, 5), (7, 8, 2), (8, 6, 7)], None),
    "beyond an edge": ([(2, 3, 0)], [(2, 5, 6)], None),
    "an index twice": ([], [(1, 1, 4), (3, 4, 4)], [(1, 0), (1, 0), (1, 1), (0, 1), (1, 1), (1, 1)]),
    "two neighbors": ([(1, 2, 0), (0, 2, 0)], [(4, 3, 3), (3, 4, 6, 7)], None),
}


def mapped(name):
    points, faces, _ = CASES[name]
    corners = np.concatenate([*QUADS, *faces])
    mesh = AssetMesh(np.array([*GRID, *points], float), np.cumsum([0, 4, 4, *map(len, faces)]), corners)
    result = unwrapped(cut(mesh, Cutting()), Options())
    return mesh, result, laid_out([mesh], [result], Layout())[0]


@pytest.mark.parametrize("name", CASES)
def test_faces_without_area_lie_inside_their_island(name):
    mesh, result, found = mapped(name)
    assert found.mapped.all() and result.charts.column("status").tolist() == ["solved"]
    # The map is similar to the flat mesh.
    of_quads = found.uv[:8]
    scale = np.linalg.norm(of_quads[1] - of_quads[0])
    assert abs(np.linalg.norm(of_quads[2] - of_quads[0]) - scale * 2**0.5) < 1e-9
    low, high = of_quads.min(axis=0) - 1e-9, of_quads.max(axis=0) + 1e-9
    if name != "two neighbors":
        assert (found.uv >= low).all() and (found.uv <= high).all()
    expected = CASES[name][2]
    if expected:
        origin, along = of_quads[0], (of_quads[1] - of_quads[0], of_quads[3] - of_quads[0])
        places = [origin + x * along[0] + y * along[1] for x, y in expected]
        assert np.abs(found.uv[8:] - places).max() < 1e-9
    assert share_of_boxes([mesh], [result], [found]) > 0.4


# A triangle as a quad, a polygon that ends where it began, both, and one that also has a corner thrice.
REPEATING = [(1, 2, 5, 5), (1, 2, 5, 4, 1), (1, 1, 2, 5, 4, 1), (2, 5, 4, 4, 4, 1, 1)]


@pytest.mark.parametrize("seams", ["keep", "suggest"])
@pytest.mark.parametrize("face", REPEATING, ids=str)
def test_a_repeated_corner_changes_nothing(face, seams):
    found = []
    for own in (face, tuple(dict.fromkeys(face))):
        corners = np.concatenate([QUADS[0], own])
        mesh = AssetMesh(np.array(GRID, float), np.array([0, 4, 4 + len(own)]), corners)
        result = unwrapped(cut(mesh, Cutting(seams)), Options())
        uv = laid_out([mesh], [result], Layout())[0].uv
        found.append(dict(zip(corners.tolist(), uv.tolist())))
    assert found[0] == found[1]
    assert Measurement([mesh.with_map(UvMap(uv, np.ones(2, bool)))]).report().collapsed == 0


def test_a_map_that_is_unusable_is_a_failure(tmp_path, monkeypatch):
    source = tmp_path / "a.obj"
    source.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in GRID) + "f 1 2 5 4\nf 2 3 6 5\n")
    monkeypatch.setattr(task, "share_of_boxes", lambda *_: 0.9 * task.LEAST_SHARE)
    report = task.run(task.Request("a.obj", str(source), str(tmp_path), str(tmp_path / "new.obj"), {}))
    assert report["status"] == "failed" and "cover 9.0e-05 of their bounding boxes" in report["failure"]["message"]
    assert not (tmp_path / "new.obj").exists()
