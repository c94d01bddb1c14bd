# SPDX-License-Identifier: GPL-3.0-or-later
"""Relaxing the maps of polygon meshes, with the real module."""

from dataclasses import replace

import numpy as np
import pytest
from spectral_unwrap.core.solve.progress import stepped
from spectral_unwrap.core.solve.relaxing import Relaxing, RelaxOptions

from tests.core.polygon_meshes import grid
from tests.module import meshes

N = 8


def hill(**fields):
    """A hill of N x N quads, mapped by its view from above."""
    mesh = grid(N, height=lambda x, y: 3.0 * np.exp(-((x - 4.0) ** 2 + (y - 4.4) ** 2) / 4.0))
    return replace(mesh, **{"uv": mesh.uv / N, **fields})


def part(rows, columns):
    chosen = np.zeros((N, N), dtype=bool)
    chosen[rows, columns] = True
    return chosen.ravel()


def relax(meshes, options, steps):
    return stepped(Relaxing(meshes, options), steps)


def moved(mesh, found):
    return (found.maps[0] != mesh.uv).any(axis=1)


def defects(mesh, uv):
    found = meshes.defects(mesh.face_offsets, mesh.corner_vertices, uv.astype(np.float32))
    return int(found.flipped.sum()), int(found.overlapping.sum())


def test_a_whole_island_relaxes_until_no_step_helps():
    mesh = hill()
    relaxing = relax([mesh], RelaxOptions(sizes=1.0), 1000)
    found = relaxing.now()
    assert not relaxing.step()
    assert 0.3 < found.gain < 1.0
    assert defects(mesh, found.maps[0]) == (0, 0)
    again = relax([replace(mesh, uv=found.maps[0])], RelaxOptions(sizes=1.0), 1000).now()
    assert again.gain < 0.01


def test_rounding_to_single_precision_is_no_distortion_to_lose():
    flat = hill().vertices * (1.0, 1.0, 0.0) + (0.1, 0.1, 0.0)
    mesh = hill(vertices=flat, uv=(hill().uv + 0.1 / N).astype(np.float32).astype(np.float64))
    assert relax([mesh], RelaxOptions(sizes=1.0), 20).now().gain == 0.0


def test_points_of_faces_that_are_not_selected_stay_to_the_bit():
    mesh = hill(selected_faces=part(slice(1, 6), slice(0, 5)))
    found = relax([mesh], RelaxOptions(), 100).now()
    face = mesh.face_of_corner()
    others = np.isin(mesh.corner_vertices, mesh.corner_vertices[~mesh.selected_faces[face]])
    np.testing.assert_array_equal(moved(mesh, found), ~others)


def test_a_cut_in_the_map_parts_what_is_held_from_what_moves():
    # The upper half lies apart in the map; no seam is marked.
    mesh = hill(selected_faces=part(slice(0, 4), slice(0, N)))
    mesh.uv[~mesh.selected_faces[mesh.face_of_corner()]] += 2.0
    found = relax([mesh], RelaxOptions(), 100).now()
    np.testing.assert_array_equal(moved(mesh, found), mesh.selected_faces[mesh.face_of_corner()])


def test_pins_and_a_held_border_stay():
    pinned = np.zeros(4 * N * N, dtype=bool)
    # One corner of a point pins it.
    corner = 4 * (3 * N + 3)
    pinned[corner] = True
    mesh = hill(pinned_corners=pinned)
    relaxing = relax([mesh], RelaxOptions(border="held"), 100)
    found = relaxing.now()
    x, y = (mesh.vertices[mesh.corner_vertices, k] for k in (0, 1))
    stays = (x == 0) | (x == N) | (y == 0) | (y == N) | (mesh.corner_vertices == mesh.corner_vertices[corner])
    np.testing.assert_array_equal(moved(mesh, found), ~stays)
    np.testing.assert_array_equal(relaxing.corners[0], ~stays)


def test_a_border_is_free_slides_along_itself_or_is_held():
    mesh = hill()
    free, slid, held = (
        relax([mesh], RelaxOptions(sizes=1.0, border=border), 200).now() for border in ("free", "sliding", "held")
    )
    assert held.gain + 0.01 < slid.gain < free.gain
    x, y = (mesh.vertices[mesh.corner_vertices, k] for k in (0, 1))
    assert not moved(mesh, slid)[np.isin(x, (0, N)) & np.isin(y, (0, N))].any()
    assert np.abs(slid.maps[0][x == 0, 0]).max() < 1e-9
    assert np.abs(slid.maps[0][x == 0] - mesh.uv[x == 0]).max() > 1e-3


def test_a_sliding_border_meets_the_equations_of_shapes_too():
    plain = hill(uv=hill().uv + 0.1)
    # The lower side is a row, and so is one inside.
    rows = [
        [(2 * corner + 1, 1.0), (2 * (corner + 1) + 1, -1.0), (0, 0.0), (0, 0.0)]
        for corner in (4 * np.arange(N), 4 * (3 * N + np.arange(N)))
        for corner in corner.tolist()
    ]
    slid, both = (
        relax([mesh], RelaxOptions(sizes=1.0, border="sliding"), 100).now()
        for mesh in (plain, replace(plain, equations=np.array(rows)))
    )
    assert 0.0 < both.gain < slid.gain and not both.meshes[0].has_unmet
    v = both.maps[0][:, 1].reshape(N, N, 4)
    for row, height in ((0, 0.1), (3, None)):
        on_row = v[row, :, :2]
        assert np.ptp(on_row) < 1e-9 and (height is None or abs(on_row[0, 0] - height) < 1e-9)


def test_a_part_does_not_grow_over_the_rest_of_its_island():
    arms = part(slice(0, N), [0, 1, 2, 5, 6, 7]) | part(slice(0, 2), slice(0, N))
    selected = part(slice(2, N), [0, 1, 2])
    whole = hill()
    corners = arms[whole.face_of_corner()]
    # Flat, with a hair between the arms of a U in the map, of which the selected one wants to be twice as wide.
    x, y = (whole.vertices[whole.corner_vertices[corners], k] for k in (0, 1))
    mesh = replace(
        whole,
        vertices=whole.vertices * (1.0, 1.0, 0.0),
        face_offsets=np.arange(0, corners.sum() + 1, 4, dtype=np.int32),
        corner_vertices=whole.corner_vertices[corners],
        selected_faces=selected[arms],
        uv=np.stack([np.interp(x, (0, 3, 5, 8), (0, 1.5, 1.6, 4.6)), y], axis=1) / N,
    )
    assert defects(mesh, mesh.uv) == (0, 0)
    found = relax([mesh], RelaxOptions(sizes=1.0), 200).now()
    assert moved(mesh, found).any()
    assert defects(mesh, found.maps[0]) == (0, 0)


def test_many_steps_are_single_steps_and_meshes_end_on_their_own():
    meshes = [hill(), hill(vertices=hill().vertices * (1.0, 1.0, 0.0))]
    relaxing = Relaxing(meshes, RelaxOptions())
    while relaxing.step(1):
        pass
    found = relax(meshes, RelaxOptions(), 1000).now()
    np.testing.assert_array_equal(relaxing.now().maps[0], found.maps[0])
    assert relaxing.now().steps == found.steps
    # The second is flat and has nothing to gain.
    np.testing.assert_allclose(found.maps[1], meshes[1].uv, atol=1e-9)


@pytest.mark.parametrize("mirrored", [False, True])
def test_unfolded_first(mirrored):
    mesh = hill()
    mesh.uv[:, 0] *= -1.0 if mirrored else 1.0
    middle = mesh.uv.mean(axis=0)
    inside = np.abs(mesh.uv - middle).max(axis=1) < 0.3
    mesh.uv[inside] = middle - (mesh.uv[inside] - middle) * (1.0, -1.0)
    assert sum(defects(mesh, mesh.uv)) > 0
    found = relax([mesh], RelaxOptions(fold_free=True), 200).now()
    assert defects(mesh, found.maps[0]) == (0, 0)
    np.testing.assert_allclose(found.maps[0].mean(axis=0), middle, atol=0.05)


def test_uvs_that_are_not_finite_stay_and_hold_nothing_else_up():
    mesh = hill()
    mesh.uv[0] = np.nan
    found = relax([mesh], RelaxOptions(), 50).now()
    np.testing.assert_array_equal(found.maps[0][:4], mesh.uv[:4])
    assert np.isfinite(found.maps[0][4:]).all()
    assert moved(mesh, found)[4:].any()


def test_the_aspect_of_the_image_counts():
    mesh = hill()
    found = relax([mesh], RelaxOptions(), 1000).now()
    wide = replace(mesh, aspect=4.0, uv=mesh.uv / (2.0, 0.5))
    found_wide = relax([wide], RelaxOptions(), 1000).now()
    np.testing.assert_allclose(found_wide.maps[0] * (2.0, 0.5), found.maps[0], atol=1e-9)


def test_nothing_to_move():
    mesh = hill(selected_faces=part(3, 3))
    relaxing = relax([mesh], RelaxOptions(), 10)
    found = relaxing.now()
    assert not relaxing.can_move
    np.testing.assert_array_equal(found.maps[0], mesh.uv)


def rows_of(corners, axis):
    """Equations that give all these corners the same coordinate."""
    equations = np.zeros((len(corners) - 1, 4, 2))
    equations[:, 0], equations[:, 1, 1] = np.stack([2 * corners[1:] + axis, np.ones(len(corners) - 1)], axis=1), -1.0
    equations[:, 1, 0] = 2 * corners[0] + axis
    return equations


def test_what_the_map_meets_is_kept_and_else_stays():
    mesh = hill()
    row = np.flatnonzero(np.isclose(mesh.uv[:, 1], 4 / N))
    straight = replace(mesh, equations=rows_of(row, 1))
    found = relax([straight], RelaxOptions(), 5).now()
    assert moved(mesh, found)[row].any()
    assert np.ptp(found.maps[0][row, 1].astype(np.float32)) == 0.0
    assert not found.meshes[0].has_unmet
    # In a turned map, it is not met.
    turned = replace(straight, uv=mesh.uv[:, ::-1] * (-1.0, 1.0))
    found = relax([turned], RelaxOptions(), 5).now()
    assert found.meshes[0].has_unmet
    assert not moved(turned, found)[row].any()
    assert moved(turned, found).any()


def test_mirrored_halves_stay_so_unless_they_are_torn_apart():
    mesh = hill()
    corners = np.arange(4 * N * N).reshape(N, N, 4)
    image = corners[:, ::-1][:, :, [1, 0, 3, 2]].ravel()
    equations = np.zeros((2 * image.size, 4, 2))
    equations[:, 0] = np.stack([np.arange(2 * image.size), np.ones(2 * image.size)], axis=1)
    equations[:, 1] = np.stack([(2 * image[:, None] + (0, 1)).ravel(), np.tile([1.0, -1.0], image.size)], axis=1)
    lopsided = mesh.vertices + mesh.vertices[:, [2]] * (0.3, 0.0, 0.0)
    mesh = replace(mesh, equations=equations, vertices=lopsided)
    found = relax([mesh], RelaxOptions(), 1000).now()
    np.testing.assert_allclose(found.maps[0][image] * (-1.0, 1.0) + (1.0, 0.0), found.maps[0], atol=1e-12)
    assert found.gain > 0.1
    assert not found.meshes[0].has_unmet
    torn = replace(mesh, uv=mesh.uv + np.isin(np.arange(4 * N * N), corners[:, : N // 2])[:, None])
    assert relax([torn], RelaxOptions(), 5).now().meshes[0].has_unmet
