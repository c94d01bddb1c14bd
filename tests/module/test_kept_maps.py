# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps kept from one unwrap to the next: the same results, and only changed islands are solved."""

import threading

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

SIDE = 17  # vertices; seams along rows and columns of it make islands of 4 x 4 faces


def grid():
    """A bumpy grid of quads, and the seams that cut it into 16 islands."""
    vertices, quads = meshes.saddle_quads(SIDE)
    number = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
    rows = number[4:-1:4]
    columns = number[:, 4:-1:4].T
    seams = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in [*rows, *columns]])
    return (vertices, *meshes.polygons(quads)), seams


def record(chart):
    return {name: value for name, value in vars(chart).items() if name != "reused"}


def check_same(found, expected):
    np.testing.assert_array_equal(found.uv, expected.uv)
    np.testing.assert_array_equal(found.solved_corners, expected.solved_corners)
    np.testing.assert_array_equal(found.chart_of_face, expected.chart_of_face)
    for mine, theirs in zip(found.charts, expected.charts):
        np.testing.assert_equal(record(mine), record(theirs))
    assert len(found.charts) == len(expected.charts)


def n_reused(result):
    return sum(chart.reused for chart in result.charts)


def test_the_same_again_is_not_solved_again():
    mesh, seams = grid()
    kept = sc.hosts.KeptMaps()
    plain = sc.unwrap(*mesh, seam_edges=seams)
    first = sc.unwrap(*mesh, seam_edges=seams, kept_maps=kept)
    again = sc.unwrap(*mesh, seam_edges=seams, kept_maps=kept)
    assert [n_reused(each) for each in (plain, first, again)] == [0, 0, 16]
    assert len(kept) == 16
    check_same(first, plain)
    check_same(again, plain)
    assert "factorization" not in again.timings


def test_an_island_without_area_is_a_point_again_where_another_has_a_map():
    vertices = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (5, 0, 0), (6, 0, 0), (8, 0, 0.0)])
    face_offsets, corners = [0, 3, 6], np.arange(6)
    kept = sc.hosts.KeptMaps()
    for selected in ([False, True], [True, True], [True, True], [False, True]):
        given = {"selected_faces": np.array(selected)}
        expected = sc.unwrap(vertices, face_offsets, corners, **given)
        check_same(sc.unwrap(vertices, face_offsets, corners, **given, kept_maps=kept), expected)
        assert expected.solved_corners.tolist() == [all(selected)] * 6
    assert len(kept) == 1


def test_after_a_seam_changed_only_the_islands_at_it_are_solved():
    mesh, seams = grid()
    kept = sc.hosts.KeptMaps()
    sc.unwrap(*mesh, seam_edges=seams, kept_maps=kept)
    # The last seam edge parts two islands.
    fewer = sc.unwrap(*mesh, seam_edges=seams[:-1], kept_maps=kept)
    check_same(fewer, sc.unwrap(*mesh, seam_edges=seams[:-1]))
    assert len(fewer.charts) == 15
    assert n_reused(fewer) == 14
    assert n_reused(sc.unwrap(*mesh, seam_edges=seams, kept_maps=kept)) == 16


def test_charts_that_fail_fail_again_with_the_same_message():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    mesh = vertices, *meshes.polygons(np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))
    kept = sc.hosts.KeptMaps()
    first, again = (sc.unwrap(*mesh, kept_maps=kept) for _ in range(2))
    assert first.charts[0].status == again.charts[0].status == "failed"
    assert again.charts[0].reused
    check_same(again, first)


def test_they_take_the_memory_that_is_allowed_and_are_cleared():
    mesh, seams = grid()
    kept = sc.hosts.KeptMaps(max_megabytes=0)
    sc.unwrap(*mesh, seam_edges=seams, kept_maps=kept)
    assert len(kept) == 0
    kept = sc.hosts.KeptMaps(max_megabytes=2)
    sc.unwrap(*mesh, seam_edges=seams, kept_maps=kept)
    assert len(kept) == 16
    kept.clear()
    assert len(kept) == 0
    assert n_reused(sc.unwrap(*mesh, seam_edges=seams, kept_maps=kept)) == 0


def test_a_call_that_was_cancelled_is_gone_on_with():
    vertices, quads = meshes.saddle_quads(150)
    large = vertices, *meshes.polygons(quads)
    far = vertices + [10.0, 0.0, 0.0]
    joined = (
        np.concatenate([vertices, far]),
        np.concatenate([large[1], large[1][1:] + large[1][-1]]),
        np.concatenate([large[2], large[2] + len(vertices)]),
    )
    kept = sc.hosts.KeptMaps()
    with pytest.raises(sc.Cancelled):
        sc.unwrap(*joined, kept_maps=kept, progress=lambda fraction, _phase: fraction < 0.7)
    assert len(kept) == 1
    result = sc.unwrap(*joined, kept_maps=kept)
    assert [chart.reused for chart in result.charts] == [True, False]
    check_same(result, sc.unwrap(*joined))


def test_calls_from_within_and_from_other_threads_do_without():
    mesh, seams = grid()
    plain = sc.unwrap(*mesh, seam_edges=seams)
    kept = sc.hosts.KeptMaps()
    found = []

    def progress(_fraction, _phase):
        if not found:
            found.append(sc.unwrap(*mesh, seam_edges=seams, kept_maps=kept))
            kept.clear()
            len(kept)
        return True

    found.append(sc.unwrap(*mesh, seam_edges=seams, kept_maps=kept, progress=progress))
    many = []
    for _ in range(2):
        call = threading.Thread(target=lambda: found.append(sc.unwrap(*mesh, seam_edges=seams, kept_maps=kept)))
        many.append(call)
    for thread in many:
        thread.start()
    for thread in many:
        thread.join()
    assert len(found) == 4
    for each in found:
        check_same(each, plain)


def test_bad_arguments_are_named():
    mesh, _ = grid()
    with pytest.raises(TypeError, match="kept_maps must be a KeptMaps or None, not dict"):
        sc.unwrap(*mesh, kept_maps={})
    with pytest.raises(ValueError, match="max_megabytes must be a whole number"):
        sc.hosts.KeptMaps(max_megabytes=-1)
