# SPDX-License-Identifier: GPL-3.0-or-later
"""The edges on the mirror plane of an island, and blocks of faces inside islands."""

from dataclasses import replace

import numpy as np
import pytest
from spectral_unwrap.core.constraints import marks
from spectral_unwrap.core.constraints.mirror_axis import mirror_axes, mirrored_pairs, seams_alone_differ

from tests.core.constraints.test_equations import can, sheet
from tests.core.polygon_meshes import polygon_mesh

MIDDLE = {(4 * 4 + j, 4 * 4 + j + 1): marks.AXIS for j in range(3)}


def bent(mesh, turn=0.0):
    """Bend a sheet over 8 x 3 quads symmetrically about its middle column, turn it about z, and move it."""
    x, y, z = mesh.vertices.T
    points = np.c_[x, 0.2 * (x - 4) ** 2 + 0.1 * z**2, z]
    c, s = np.cos(turn), np.sin(turn)
    return replace(mesh, vertices=points @ [[c, s, 0], [-s, c, 0], [0, 0, 1]] + [3.0, -2.0, 1.0])


@pytest.mark.parametrize("turn", [0.0, 0.4])
def test_the_middle_of_a_bent_sheet_is_its_axis(turn):
    mesh = bent(sheet(8, 3), turn)
    assert mirror_axes(mesh, mesh.selected_faces) == MIDDLE


def test_a_sheet_modeled_by_hand_with_a_detail_on_one_side_still_has_one():
    mesh = bent(sheet(8, 3))
    vertices = mesh.vertices + 1e-5 * np.random.default_rng(1).normal(size=mesh.vertices.shape)
    vertices[0] += [0.0, 0.3, 0.0]
    assert mirror_axes(replace(mesh, vertices=vertices), mesh.selected_faces) == MIDDLE


def test_an_island_without_a_mirror_plane_has_no_axis():
    mesh = bent(sheet(8, 3))
    vertices = mesh.vertices.copy()
    vertices[:, 1] += 0.05 * vertices[:, 0] ** 3 + 0.2 * vertices[:, 0] * vertices[:, 2]
    assert mirror_axes(replace(mesh, vertices=vertices), mesh.selected_faces) == {}
    assert mirror_axes(mesh, np.zeros(24, dtype=bool)) == {}
    assert mirror_axes(replace(mesh, vertices=vertices * np.nan), mesh.selected_faces) == {}


def test_a_flat_sheet_is_not_mirrored_about_its_own_plane():
    mesh = sheet(8, 3)
    assert mirror_axes(mesh, mesh.selected_faces) == MIDDLE


def test_a_plane_between_the_vertices_is_marked_by_the_edges_that_it_crosses():
    mesh = sheet(7, 3)
    x, y, z = mesh.vertices.T
    curved = replace(mesh, vertices=np.c_[x, 0.2 * (x - 3.5) ** 2 + 0.1 * z**2, z])
    middle = {(3 * 4 + j, 4 * 4 + j): marks.CROSSING for j in range(4)}
    assert mirror_axes(curved, mesh.selected_faces) == middle
    # An edge of which only the middle lies on the plane crosses it aslant.
    slanted = curved.vertices + np.c_[0 * x, 0 * x, 0.3 * np.sign(x - 3.5)]
    assert mirror_axes(replace(curved, vertices=slanted), mesh.selected_faces) == {}


def test_an_edge_between_islands_is_marked_only_if_it_crosses_in_both():
    # A trapezoid above an edge, and below it a quad without a mirror plane.
    points = [[-1, 0, 0], [1, 0, 0], [2, 0, 1], [-2, 0, 1], [-0.5, 0, -1], [1.5, 0, -0.7]]
    mesh = polygon_mesh(np.array(points, dtype=float), [[0, 1, 2, 3], [1, 0, 4, 5]], [(0, 1)])
    upper, lower = {(2, 3): marks.CROSSING}, {(0, 1): marks.CROSSING}
    assert mirror_axes(mesh, mesh.selected_faces) == upper
    alone = replace(mesh, selected_faces=np.array([True, False]))
    assert mirror_axes(alone, alone.selected_faces) == {**upper, **lower}


def test_the_border_of_a_block_becomes_a_rectangle():
    chosen = np.zeros(24, dtype=bool)
    chosen[[4, 7]] = True
    assert len(marks.rectangles(sheet(8, 3), chosen, range(36))[0]) == 6


@pytest.mark.parametrize("seam", [0, 2])
def test_the_side_of_a_cylinder_is_mirrored_about_the_plane_of_its_seam(seam):
    mesh = can(8, seam)
    opposite = 2 * ((seam + 4) % 8)
    assert mirror_axes(mesh, np.arange(10) < 8) == {(opposite, opposite + 1): marks.AXIS}


@pytest.mark.parametrize("turn", [0.1, 1.2])
def test_planes_are_found_where_inertia_leaves_them_open(turn):
    mesh = can(8, 3)
    c, s = np.cos(turn), np.sin(turn)
    turned = replace(mesh, vertices=mesh.vertices @ [[c, s, 0], [-s, c, 0], [0, 0, 1]])
    assert mirror_axes(turned, np.arange(10) < 8) == {(14, 15): marks.AXIS}


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.2])
def test_an_island_whose_marks_lie_on_seams_hands_its_plane_to_the_islands_beside_it(turn):
    # A cone cut along an edge: its plane crosses the edge of the base opposite to it, which has a plane per vertex.
    angle = 2.0 * np.pi * np.arange(15) / 15.0 + turn
    points = [*np.c_[np.sin(angle), np.cos(angle), 0.0 * angle].tolist(), [0.0, 0.0, 2.0]]
    rim = [(k, (k + 1) % 15) for k in range(15)]
    faces = [*((b, a, 15) for a, b in rim), tuple(range(15))]
    mesh = polygon_mesh(points, faces, [*rim, (4, 15)])
    assert mirror_axes(mesh, mesh.selected_faces) == {(11, 12): marks.CROSSING}


def test_seams_on_one_side_alone_are_told_from_no_plane():
    mesh = bent(sheet(8, 3))
    assert not seams_alone_differ(mesh, mesh.selected_faces)
    slit = replace(mesh, seam_edges=np.array([[4, 5], [5, 6]], np.int32))
    assert mirror_axes(slit, mesh.selected_faces) == {}
    assert seams_alone_differ(slit, mesh.selected_faces)


def test_seams_that_part_a_mesh_into_islands_are_told_from_no_plane_too():
    # Parted aslant: neither part has a plane, though the whole does.
    aslant = np.array([(4 * i + j, 4 * i + j + 1) for i, j in ((2, 0), (4, 1), (6, 2))], np.int32)
    across = np.array([(4 * i + j, 4 * i + j + 4) for i, j in ((2, 1), (3, 1), (4, 2), (5, 2))], np.int32)
    mesh = bent(sheet(8, 3))
    parted = replace(mesh, seam_edges=np.concatenate([aslant, across]))
    assert mirror_axes(parted, mesh.selected_faces) == {}
    assert seams_alone_differ(parted, mesh.selected_faces)
    # Also for one of the two alone, but not for what is apart from them.
    assert seams_alone_differ(parted, np.arange(24) < 3)
    vertices = np.concatenate([mesh.vertices, [[20.0, 0, 0], [23.0, 0.1, 0], [21.0, 2.0, 0], [20.0, 1.0, 0.5]]])
    apart = replace(
        parted,
        vertices=vertices,
        face_offsets=np.append(mesh.face_offsets, 100).astype(np.int32),
        corner_vertices=np.append(mesh.corner_vertices, [36, 37, 38, 39]).astype(np.int32),
        selected_faces=np.ones(25, dtype=bool),
    )
    assert not seams_alone_differ(apart, np.arange(25) == 24)


def test_faces_may_touch_the_plane_with_three_corners():
    mesh = sheet(8, 3)
    # The vertices beside the lower end of the axis are one, on the plane: two quads touch it with a corner more.
    corner_vertices = mesh.corner_vertices.copy()
    beside = [3 * 4, 5 * 4]
    corner_vertices[np.isin(corner_vertices, beside)] = beside[0]
    vertices = bent(mesh).vertices.copy()
    vertices[beside[0]] = vertices[4 * 4] - [0.0, 0.5, 0.3]
    touching = replace(mesh, vertices=vertices, corner_vertices=corner_vertices)
    assert {(16, 17), (17, 18), (18, 19)} <= set(mirror_axes(touching, mesh.selected_faces))


def test_islands_that_mirror_each_other_are_pairs():
    mesh = bent(sheet(8, 3))
    vertices = mesh.vertices.copy()
    # Neither has a plane of its own; a third one has no image.
    vertices[:, 1] += 0.05 * vertices[:, 0] ** 3 + 0.2 * vertices[:, 0] * vertices[:, 2]
    both = np.concatenate([vertices + [10.0, 0, 0], (vertices + [10.0, 0, 0]) * [-1, 1, 1], vertices + [0, 30.0, 0]])
    corners = mesh.corner_vertices.reshape(-1, 4)
    three = replace(
        mesh,
        vertices=both,
        face_offsets=np.arange(0, 3 * 96 + 1, 4, dtype=np.int32),
        corner_vertices=np.concatenate([corners, corners[:, ::-1] + 36, corners + 72]).ravel().astype(np.int32),
        selected_faces=np.ones(72, dtype=bool),
    )
    assert mirror_axes(three, three.selected_faces) == {}
    (pair,) = mirrored_pairs(three, three.selected_faces)
    assert {vertex // 36 for edge in pair for vertex in edge} == {0, 1}
    # All inner edges of 8 x 3 quads, twice.
    assert len(pair) == 2 * (7 * 3 + 8 * 2)
    assert mirrored_pairs(three, np.arange(72) >= 24) == []
    assert mirrored_pairs(three, np.zeros(72, dtype=bool)) == []
    assert mirrored_pairs(replace(three, vertices=both * np.nan), three.selected_faces) == []
