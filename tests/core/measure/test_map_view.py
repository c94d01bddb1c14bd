# SPDX-License-Identifier: GPL-3.0-or-later
"""What the overlay of the UV map shows, in numbers."""

import dataclasses

import numpy as np
import pytest
from spectral_unwrap.core import choices
from spectral_unwrap.core.measure.map_view import MapView, automatic_range, joined_density, joined_numbers
from spectral_unwrap.core.measure.texels import Texels
from spectral_unwrap.core.mesh.polygon_mesh import MAP, SURFACE
from spectral_unwrap.core.words import texts

from tests.core import polygon_meshes


def grid(n=4, scale=(1.0, 1.0)):
    """A flat grid of n x n unit squares; its map is the same, stretched."""
    mesh = polygon_meshes.grid(n)
    return changed(mesh, uv=mesh.uv * scale, uv_faces=np.ones(n * n, dtype=bool))


def changed(arrays, **fields):
    return dataclasses.replace(arrays, **fields)


def test_values_of_every_kind():
    view = MapView(grid(scale=(0.5, 0.25)))
    assert view.values(choices.LOOK_ANGLE) == pytest.approx(2.0)
    assert view.values(choices.LOOK_SIZE) == pytest.approx(0.0)
    assert view.values(choices.LOOK_DENSITY, Texels(1024)) == pytest.approx(1024 * 0.125**0.5)
    assert not view.values(choices.LOOK_DEFECTS).any()


def test_flipped_and_overlapping_faces_differ():
    arrays = grid()
    uv = arrays.uv.copy()
    uv[:4] = uv[[1, 0, 3, 2]]  # the first face the other way around, apart from the others
    uv[4:8] -= [100.0, 0.0]
    uv[8:12] -= [101.0, 0.0]  # the third on the second, as islands of their own
    view = MapView(changed(arrays, uv=uv))
    assert view.island_of_face[:3].tolist() == [0, 1, 2]
    assert not view.flipped.any()  # an island that is mirrored as a whole is not flipped
    folded = arrays.uv.copy()
    moved = (folded == [1.0, 1.0]).all(axis=1)
    folded[moved] = [3.5, 3.5]
    values = MapView(changed(arrays, uv=folded)).values(choices.LOOK_DEFECTS)
    assert set(values) == {0.0, 0.5, 1.0}


def test_buffers_are_those_of_the_visible_faces():
    arrays = grid()
    arrays.selected_faces[::2] = False
    arrays.uv_faces[:] = np.arange(16) == 3
    view = MapView(arrays)
    positions, (uv, values) = view.triangle_positions(), view.triangle_map(choices.LOOK_ANGLE)
    assert [buffer.shape for buffer in (positions, uv, values)] == [(48, 3), (48, 2), (48,)]
    assert {buffer.dtype for buffer in (positions, uv, values)} == {np.dtype(np.float32)}
    np.testing.assert_array_equal(positions[:, :2], uv)
    assert view.is_in_uv_editor().sum() == 2


def test_nothing_that_is_drawn_is_not_a_number():
    arrays = grid()
    arrays.uv[:4] = np.nan
    arrays.uv[4:8] = 0.0
    view = MapView(arrays)
    for kind in (choices.LOOK_ANGLE, choices.LOOK_SIZE, choices.LOOK_DENSITY, choices.LOOK_DEFECTS):
        assert np.isfinite(view.triangle_map(kind)[1]).all()
        assert np.isfinite(automatic_range([view], kind)).all()
    assert view.numbers().faces == 16


def test_numbers_of_the_map_and_of_an_island():
    arrays = grid(scale=(2.0, 1.0))
    arrays.uv[:32] = arrays.vertices[arrays.corner_vertices[:32], :2] - 50.0
    view = MapView(arrays)
    assert view.numbers().mean_qc == pytest.approx(1.5)
    assert view.numbers().max_qc == pytest.approx(2.0)
    assert view.numbers().log2_scale_deviation == pytest.approx(0.25)
    first = view.numbers([0])
    assert (first.faces, first.flipped, first.overlapping) == (8, 0, 0)
    assert first.mean_qc == pytest.approx(1.0)


def test_a_good_map_looks_good():
    view = MapView(grid())
    assert automatic_range([view], choices.LOOK_ANGLE) == pytest.approx((1.0, 1.2))
    assert automatic_range([view], choices.LOOK_SIZE) == pytest.approx((-0.25, 0.25))
    low, high = automatic_range([view], choices.LOOK_DENSITY, Texels(1024))
    assert low < 1024 < high


def test_range_follows_most_of_the_surface():
    arrays = grid(10, scale=(3.0, 1.0))
    arrays.uv[:4] *= [40.0, 1.0]
    assert automatic_range([MapView(arrays)], choices.LOOK_ANGLE)[1] == pytest.approx(3.0)


def test_equal_arrays_are_equal():
    one = grid()
    one.uv[0] = np.nan
    moved = changed(one, uv=one.uv + 1.0)
    assert one.equals(changed(one, uv=one.uv.copy()), MAP)
    assert one.equals(moved, SURFACE)
    assert not one.equals(moved, MAP)
    known = MapView(one)
    assert MapView(moved, before=known).triangles is known.triangles
    hidden = changed(one, selected_faces=~one.selected_faces)
    assert hidden.equals(one, MAP)
    assert not hidden.equals(one, SURFACE)
    assert not changed(one, vertices=one.vertices + 1.0).equals(one, SURFACE)


def test_legend_has_a_line_for_what_there_is():
    numbers = MapView(grid()).numbers()
    lines = texts.legend_numbers("Shown", numbers)
    assert lines == ("Shown: 16 faces", "Angles off 0.0 %, worst 0.0 %", "Sizes vary by 0.0 %")
    nothing = MapView(changed(grid(), uv=np.full((64, 2), np.nan))).numbers()
    assert texts.legend_numbers("Shown", nothing) == ("Shown: 16 faces, nothing to measure",)


def test_faces_are_found_by_a_place_of_the_map():
    arrays = grid()
    view = MapView(arrays)
    assert [view.face_at(place) for place in ((0.5, 0.5), (1.5, 0.25), (3.9, 3.9))] == [0, 1, 15]
    assert view.face_at((-0.1, 0.5)) == -1
    assert view.face_at((float("nan"), 0.5)) == -1
    shown = arrays.uv_faces.copy()
    shown[0] = False
    assert MapView(changed(arrays, uv_faces=shown)).face_at((0.5, 0.5)) == -1


def test_what_an_image_stretches_back_is_not_distorted():
    # On an image of twice the width.
    view = MapView(changed(grid(scale=(0.5, 1.0)), aspect=2.0))
    assert view.qc == pytest.approx(1.0)
    assert view.values(choices.LOOK_DENSITY, Texels(1024)) == pytest.approx(1024 * 0.5**0.5)
    assert not view.mesh.equals(changed(view.mesh, aspect=1.0), MAP)


def test_numbers_of_several_maps_are_weighed_by_their_surface():
    small, large = MapView(grid(2)), MapView(grid(4, scale=(2.0, 1.0)))
    joined = joined_numbers([small, large])
    assert joined.faces == 20
    assert joined.mean_qc == pytest.approx((4 * 1.0 + 16 * 2.0) / 20)
    assert joined_numbers([small]) == small.numbers()
    assert joined_density([small, large], Texels(8)) == pytest.approx(8 * ((4 * 1.0 + 16 * 2.0) / 20) ** 0.5)
    empty = MapView(changed(grid(), uv=np.full((64, 2), np.nan)))
    assert joined_density([small, empty], Texels(8)) == pytest.approx(small.mean_density(Texels(8)))
    assert np.isnan(joined_density([empty], Texels(8)))


@pytest.mark.parametrize(
    ("kind", "said"),
    [("ANGLE", "100 %"), ("SIZE", "0.0 %"), ("DENSITY", "11.3 px/m"), ("DEFECTS", "0 faces"), ("CHECKER", "")],
)
def test_the_sidebar_has_the_number_of_what_is_shown(kind, said):
    view = MapView(grid(scale=(2.0, 1.0)))
    assert texts.figure(kind, view.numbers(), view.mean_density(Texels(8)), "m") == said
