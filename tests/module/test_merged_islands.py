# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams to begin with, taken back while distortion allows: the islands of a fragmented map joined."""

import numpy as np
import pytest
import spectral_conformal as sc
from spectral_conformal import _island_merging
from spectral_conformal._measuring import edges_between
from spectral_conformal.assets import AssetMesh
from spectral_conformal.assets.unwrapping import Cutting, cut
from spectral_conformal.batch.settings import from_values

from tests.benchmarks import generated_assets
from tests.module import meshes
from tests.module.scans import borders, bumpy_sphere, fragments


def sheet(n):
    """A flat grid of quads."""
    points, quads = meshes.unit_square(n + 1)
    return np.c_[np.rint(n * points), np.zeros(len(points))], quads


def measures(mesh, **options):
    found = sc.unwrap(mesh, **options).charts
    return {name: found.column(name) for name in ("status", "mean_qc", "flipped", "overlapping", "area")}


def test_a_sphere_in_many_pieces_gets_few_islands():
    points, faces = bumpy_sphere(24)
    start = borders(faces, fragments(points, faces, 300))
    merged = sc.suggest_seams(points, faces, start_edges=start, qc_limit=1.03)
    found = measures(merged)
    assert len(found["status"]) < 12
    assert set(found["status"]) == {"solved"}
    assert found["mean_qc"].max() < 1.03
    assert not found["flipped"].any()
    assert not found["overlapping"].any()
    # Nothing else is cut.
    known = set(map(tuple, np.sort(start, axis=1).tolist()))
    assert set(map(tuple, merged.seam_edges.tolist())) < known
    assert len(merged.seam_edges) < 0.3 * len(start)


def test_lower_limits_leave_more_islands():
    points, faces = bumpy_sphere(16)
    start = borders(faces, fragments(points, faces, 200))
    before = measures(sc.Mesh(points, faces).with_seams(start.astype(np.int32)))
    counts = []
    for qc_limit, scale_limit in ((1.1, 2.0), (1.003, 2.0), (1.1, 1.02)):
        limits = {"qc_limit": qc_limit, "scale_limit": scale_limit}
        found = measures(sc.suggest_seams(points, faces, start_edges=start, **limits))
        counts.append(len(found["status"]))
        assert found["mean_qc"].max() < max(qc_limit, before["mean_qc"].max() + 1e-9)
    assert counts[0] < 6
    assert counts[1] > 2 * counts[0]
    assert counts[2] > 2 * counts[0]


def test_a_flat_sheet_becomes_one_island():
    points, faces = sheet(12)
    merged = sc.suggest_seams(points, faces, start_edges=borders(faces, fragments(points, faces, 40)))
    assert len(merged.seam_edges) == 0


def test_a_cube_unfolds():
    """Five of its twelve edges join the six faces; the other seven stay, since it is closed."""
    points, faces = cube()
    merged = sc.suggest_seams(points, faces, start_edges=borders(faces, np.arange(6)))
    assert len(merged.seam_edges) == 7
    assert measures(merged)["mean_qc"].tolist() == pytest.approx([1.0])


def cube():
    points = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    return points, np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])


def test_islands_that_meet_at_two_borders_join_at_the_longer_one():
    """Two half tubes, one border twice as long as the other: joined at both, they would be closed to a ring."""
    angles = np.linspace(0, 2 * np.pi, 17)[:-1]
    rows = [np.c_[np.cos(angles), np.sin(angles), np.full(16, z)] for z in range(5)]
    faces = [
        (16 * z + k, 16 * z + (k + 1) % 16, 16 * (z + 1) + (k + 1) % 16, 16 * (z + 1) + k)
        for z in range(4)
        for k in range(16)
    ]
    points, faces = np.concatenate(rows), np.array(faces)
    half = (np.arange(len(faces)) % 16 >= 8).astype(int)
    start = borders(faces, half)
    merged = sc.suggest_seams(points, faces, start_edges=start)
    assert len(merged.seam_edges) == 4
    assert measures(merged)["mean_qc"].tolist() == pytest.approx([1.0])


def test_islands_that_would_cover_themselves_stay_apart():
    """A flat ramp that winds twice around an axis: without distortion, but its turns lie on each other."""
    angles = np.linspace(0, 4 * np.pi, 65)
    inner, outer = (np.c_[r * np.cos(angles), r * np.sin(angles), 1e-4 * angles] for r in (1.0, 2.0))
    k = np.arange(64)
    points, faces = np.concatenate([inner, outer]), np.c_[k, k + 65, k + 66, k + 1]
    merged = sc.suggest_seams(points, faces, start_edges=borders(faces, k // 4))
    found = measures(merged)
    assert 2 <= len(found["status"]) <= 4
    assert not found["overlapping"].any()
    # Its distortion is not what keeps them apart.
    assert measures(sc.Mesh(points, faces))["mean_qc"].max() < 1.01


def test_seams_of_the_mesh_and_borders_of_the_selection_stay():
    points, faces = sheet(8)
    start = borders(faces, fragments(points, faces, 20))
    kept = borders(faces, (np.arange(len(faces)) // 8 >= 4).astype(int))
    merged = sc.suggest_seams(points, faces, seam_edges=kept, start_edges=np.concatenate([start, kept]))
    assert len(measures(merged)["status"]) == 2
    assert set(map(tuple, kept.tolist())) <= set(map(tuple, np.sort(merged.seam_edges, axis=1).tolist()))
    assert len(np.unique(merged.seam_edges, axis=0)) == len(merged.seam_edges)
    selected = np.arange(len(faces)) < 32
    merged = sc.suggest_seams(points, faces, start_edges=start, selected_faces=selected)
    assert len(measures(merged, selected_faces=selected)["status"]) == 1
    outside = edges_between(
        fragments(points, faces, 20)[~selected], np.arange(33) * 4, faces[~selected].ravel(), len(points)
    )
    assert set(map(tuple, outside.tolist())) <= set(map(tuple, merged.seam_edges.tolist()))


def test_an_island_that_is_worse_than_the_limit_is_not_made_worse():
    """A closed sphere cut in two has more distortion than allowed; what its halves are made of does not grow."""
    points, faces = bumpy_sphere(8)
    start = borders(faces, (points[faces].mean(axis=1)[:, 0] > 0).astype(int))
    before = measures(sc.Mesh(points, faces).with_seams(start.astype(np.int32)))
    merged = sc.suggest_seams(points, faces, start_edges=start, qc_limit=1.0, scale_limit=1.0)
    assert len(measures(merged)["status"]) == len(before["status"]) == 2


@pytest.mark.parametrize("scale", [1e-200, 1e200])
def test_scale_does_not_matter(scale):
    points, faces = bumpy_sphere(8)
    start = borders(faces, fragments(points, faces, 30))
    expected = sc.suggest_seams(points, faces, start_edges=start).seam_edges
    np.testing.assert_array_equal(sc.suggest_seams(scale * points, faces, start_edges=start).seam_edges, expected)


def test_positions_that_are_no_numbers_leave_the_other_islands():
    points, faces = sheet(12)
    piece = fragments(points, faces, 40)
    points[0] = np.nan
    merged = sc.suggest_seams(points, faces, start_edges=borders(faces, piece))
    status = measures(merged)["status"].tolist()
    assert sorted(status) == ["failed", "solved"]


def test_progress_and_cancel():
    points, faces = bumpy_sphere(12)
    start = borders(faces, fragments(points, faces, 60))
    heard = []
    sc.suggest_seams(points, faces, start_edges=start, progress=lambda fraction, phase: heard.append(fraction))
    assert heard == sorted(heard)
    assert 0.0 <= heard[0] < 0.1
    assert 0.5 < heard[-1] <= 1.0
    with pytest.raises(sc.Cancelled):
        sc.suggest_seams(points, faces, start_edges=start, progress=lambda fraction, phase: fraction < 0.3)


def test_the_result_is_the_same_with_any_number_of_threads():
    points, faces = bumpy_sphere(12)
    start = borders(faces, fragments(points, faces, 60))
    found = []
    for threads in (1, 2):
        sc.limit_threads(threads)
        found.append(sc.suggest_seams(points, faces, start_edges=start).seam_edges)
    sc.limit_threads(0)
    np.testing.assert_array_equal(*found)


def test_a_corner_repeated_in_a_face_is_no_edge():
    points, quads = sheet(1)
    faces = [[*quads[0], quads[0][-1]]]
    found = sc.suggest_seams(points, faces, start_edges=[(quads[0][-1], quads[0][-1]), quads[0][:2]])
    assert found.seam_edges.tolist() == [sorted(quads[0][:2].tolist())]


def test_wrong_edges_are_refused():
    with pytest.raises(ValueError, match="start_edges"):
        sc.suggest_seams(*sheet(2), start_edges=[(0, 99)])
    assert len(sc.suggest_seams(*sheet(2), start_edges=np.zeros((0, 2), int)).seam_edges) == 0
    assert len(sc.suggest_seams(*sheet(2), start_edges=[(0, 8), (3, 3)]).seam_edges) == 0


def test_merge_of_the_batch_begins_with_the_map():
    points, faces = bumpy_sphere(12)
    label = fragments(points, faces, 60)
    offsets, corners = np.arange(len(faces) + 1) * 4, faces.ravel()
    uv = np.repeat(label, 4)[:, None] + points[corners][:, :2]
    found = cut(AssetMesh(points, offsets, corners, uv), Cutting("merge"))
    islands = measures(sc.Mesh(points, faces).with_seams(found.seam_edges.astype(np.int32)))
    assert len(islands["status"]) < 10
    assert found.message == ""
    assert "no UV map" in cut(AssetMesh(points, offsets, corners), Cutting("merge")).message


def test_shapes_that_pack_badly_stay_apart():
    """A flat frame in many pieces: joined without distortion, to corners with long legs that fill little."""
    points, faces = sheet(24)
    middle = points[faces].mean(axis=1)[:, :2]
    faces = faces[(np.abs(middle - 12) > 9).any(axis=1)]
    start = borders(faces, fragments(points, faces, 40))
    merged = sc.suggest_seams(points, faces, start_edges=start)
    found = sc.unwrap(merged)
    places = [found.uv.reshape(-1, 4, 2)[found.chart_of_face == chart] for chart in range(len(found.charts))]
    assert len(places) < 10
    for chart in places:
        first = chart[0]
        quad = np.linalg.norm(first[1] - first[0]) * np.linalg.norm(first[2] - first[1])
        assert len(chart) * quad >= 0.5 * smallest_rectangle(chart.reshape(-1, 2))


def smallest_rectangle(points):
    """Return the area of the smallest of many rectangles around points."""
    angles = np.linspace(0, np.pi / 2, 1000)
    along = points @ np.array([np.cos(angles), np.sin(angles)])
    across = points @ np.array([-np.sin(angles), np.cos(angles)])
    return (np.ptp(along, axis=0) * np.ptp(across, axis=0)).min()


@pytest.mark.parametrize("fault", ["flipped", "on each other", "in several tiles"])
def test_faults_of_the_old_map_do_not_matter(fault):
    """Islands are unwrapped anew, so only their borders count."""
    points, faces = bumpy_sphere(12)
    label = np.repeat(fragments(points, faces, 60), 4)
    offsets, corners = np.arange(len(faces) + 1) * 4, faces.ravel()
    uv = points[corners][:, :2]
    expected = cut(AssetMesh(points, offsets, corners, uv + 10.0 * label[:, None]), Cutting("merge")).seam_edges
    if fault == "flipped":
        uv = uv * np.c_[np.where(label % 2, 1.0, -1.0), np.ones(len(uv))] + 10.0 * label[:, None]
    elif fault == "on each other":
        uv = uv + 1e-3 * label[:, None]
    else:
        uv = 0.1 * uv + np.c_[label % 5 + 0.5, 0.1 + 0.001 * label]
    found = cut(AssetMesh(points, offsets, corners, uv), Cutting("merge"))
    np.testing.assert_array_equal(found.seam_edges, expected)


def test_a_map_that_is_good_already_stays():
    points, faces = bumpy_sphere(12)
    label = fragments(points, faces, 60)
    once = sc.suggest_seams(points, faces, start_edges=borders(faces, label)).seam_edges
    twice = sc.suggest_seams(points, faces, start_edges=once).seam_edges
    np.testing.assert_array_equal(once, twice)


def test_every_face_may_be_an_island():
    points, faces = bumpy_sphere(12)
    found = measures(sc.suggest_seams(points, faces, start_edges=borders(faces, np.arange(len(faces))), qc_limit=1.03))
    assert len(found["status"]) < 12
    assert not found["flipped"].any()
    assert not found["overlapping"].any()


def test_islands_of_several_materials_join_unless_each_has_a_texture():
    points, faces = sheet(12)
    offsets, corners = np.arange(len(faces) + 1) * 4, faces.ravel()
    uv = points[corners][:, :2] + 100.0 * np.repeat(fragments(points, faces, 40), 4)[:, None]
    material = (points[faces].mean(axis=1)[:, 0] > 6).astype(int)
    mesh = AssetMesh(points, offsets, corners, uv, material_of_face=material)
    assert len(cut(mesh, Cutting("merge")).seam_edges) == 0
    apart = cut(mesh, Cutting("merge", between_materials=True)).seam_edges
    assert set(map(tuple, np.sort(apart, axis=1).tolist())) == set(map(tuple, borders(faces, material).tolist()))


def test_noise_does_not_keep_islands_apart():
    """Each piece is distorted beyond the limit already, and larger ones have more vertices that ask for it."""
    points, quads = bumpy_sphere(24)
    points, faces = generated_assets.shaken((points, np.r_[quads[:, :3], quads[:, [0, 2, 3]]]), 0.2, 1)
    start = borders(faces, fragments(points, faces, 400))
    before = measures(sc.Mesh(points, faces).with_seams(start.astype(np.int32)), options=sc.defaults.MAPS)
    merged = sc.suggest_seams(points, faces, start_edges=start, qc_limit=1.01)
    after = measures(merged, options=sc.defaults.MAPS, fold_free=True)
    assert (before["mean_qc"] * before["area"]).sum() / before["area"].sum() > 1.02
    assert len(after["status"]) < 40
    assert not after["flipped"].any()
    assert not after["overlapping"].any()
    mean = (after["mean_qc"] * after["area"]).sum() / after["area"].sum()
    assert mean < (before["mean_qc"] * before["area"]).sum() / before["area"].sum() + 0.07


def test_few_folds_are_unfolded_once(monkeypatch):
    """To unfold takes several times as long as the map itself; a large island would be unfolded with every round."""
    points, faces = generated_assets.asset("torn terrain", 20000)
    start = borders(faces, fragments(points, faces, 1200))
    unfolded = []
    solved = _island_merging._Merging._solved

    def counted(self, n, of_face, fold_free):
        unfolded.append(fold_free * int((of_face >= 0).sum()))
        return solved(self, n, of_face, fold_free)

    monkeypatch.setattr(_island_merging._Merging, "_solved", counted)
    merged = sc.suggest_seams(points, faces, start_edges=start)
    assert len(measures(merged)["status"]) < 40
    # All at the end, and small ones that fold in many of their faces before.
    assert 0 < sum(unfolded) < 1.5 * len(faces)
    found = measures(merged, options=sc.defaults.MAPS, fold_free=True)
    assert not found["flipped"].any() and not found["overlapping"].any()


@pytest.mark.parametrize("rate", [0.0, 1.0])
def test_what_exceeds_limits_once_unfolded_is_taken_apart(rate, monkeypatch):
    """If all may fold until the end, the turns of a ramp join, which cannot be unfolded."""
    monkeypatch.setattr(_island_merging, "_FEW_FOLDED", rate)
    test_islands_that_would_cover_themselves_stay_apart()
    test_a_sphere_in_many_pieces_gets_few_islands()
    test_seams_of_the_mesh_and_borders_of_the_selection_stay()


def test_sharp_corners_are_no_noise():
    """Those of a box lie at borders, so that unrolling them would distort what was not distorted."""
    points, faces = cube()
    merged = sc.suggest_seams(points, faces, start_edges=borders(faces, np.arange(6)), qc_limit=1.01)
    assert measures(merged)["mean_qc"].max() == pytest.approx(1.0)


def test_batch_maps_joined_islands_without_folds():
    assert from_values({"seams": "merge"}).maps.fold_free
    assert not from_values({"seams": "suggest"}).maps.fold_free
