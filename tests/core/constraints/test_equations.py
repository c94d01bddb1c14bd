# SPDX-License-Identifier: GPL-3.0-or-later
"""Marked edges become equations on corners."""

from dataclasses import replace

import numpy as np
from spectral_unwrap.core.constraints import marks
from spectral_unwrap.core.constraints.equations import BY_LENGTH, EVEN, Marked, equations
from spectral_unwrap.core.words import texts

from tests.core.polygon_meshes import polygon_mesh


def sheet(columns, rows, seams=(), width=1.0):
    """A flat sheet of quads whose columns become wider; vertex (i, j) is i * (rows + 1) + j."""
    x, y = np.meshgrid(np.arange(columns + 1.0) ** width, np.arange(rows + 1.0), indexing="ij")
    first = (np.arange(columns)[:, None] * (rows + 1) + np.arange(rows)).ravel()
    quads = np.c_[first, first + rows + 1, first + rows + 2, first + 1]
    return polygon_mesh(np.c_[x.ravel(), 0 * x.ravel(), y.ravel()], quads, seams)


def on_corners(mesh, marked):
    return np.array([marked.get(tuple(edge), 0) for edge in marks.edges_of_corners(mesh).tolist()])


def residuals(found, uv):
    """Return the value of each equation for the UVs (C, 2) of corners."""
    x = uv.ravel()
    return (x[found[..., 0].astype(int)] * found[..., 1]).sum(axis=1)


def test_rows_and_columns_in_even_steps_are_met_by_an_even_grid_only():
    mesh = sheet(4, 3, width=1.5)
    marked = on_corners(mesh, marks.grids(mesh, mesh.selected_faces)[0])
    assert (marked > 0).all()
    place = mesh.vertices[mesh.corner_vertices][:, [0, 2]]
    even = np.stack(np.divmod(mesh.corner_vertices, 4), axis=1).astype(float)
    for spacing, meets, fails in ((EVEN, even, place), (BY_LENGTH, place, even)):
        found = equations(mesh, [Marked(marked, spacing=spacing)])
        assert np.abs(residuals(found, meets)).max() < 1e-12
        assert np.abs(residuals(found, fails)).max() > 0.1
        # Straight, but not spaced.
        assert np.abs(residuals(equations(mesh, [Marked(marked)]), fails)).max() < 1e-12


def test_halves_are_paired_face_by_face_up_to_seams():
    mesh = sheet(4, 3)
    axis = {(8 + j, 9 + j): marks.AXIS for j in range(3)}
    place = mesh.vertices[mesh.corner_vertices][:, [0, 2]] - [2.0, 0.0]
    found = equations(mesh, [Marked(on_corners(mesh, axis))])
    assert np.abs(residuals(found, place)).max() < 1e-12
    assert np.abs(residuals(found, place + [0.1, 0.0])).max() > 0.01
    assert set(np.unique(found[..., 0] // 2)) == set(range(48))
    # Without the column beyond the seam, and so without its image.
    cut = sheet(4, 3, seams=[(4 + j, 5 + j) for j in range(3)])
    found = equations(cut, [Marked(on_corners(cut, axis))])
    of_corner = np.unique((found[..., 0] // 2)[found[..., 1] != 0]).astype(int)
    assert set(np.unique(of_corner // 4)) == set(range(3, 9))


def test_halves_are_paired_outward_from_edges_that_the_axis_crosses():
    # The last face is a triangle, whose tip lies on the axis.
    mesh = sheet(5, 2)
    points = np.vstack([mesh.vertices, [[2.5, 0.0, 3.0]]])
    faces = [*mesh.corner_vertices.reshape(-1, 4).tolist(), [8, 11, 18]]
    mesh = polygon_mesh(points, faces)
    crossing = {(6 + j, 9 + j): marks.CROSSING for j in range(3)}
    place = mesh.vertices[mesh.corner_vertices][:, [0, 2]] - [2.5, 0.0]
    found = equations(mesh, [Marked(on_corners(mesh, crossing))])
    assert np.abs(residuals(found, place)).max() < 1e-12
    for corner in range(len(place)):
        moved = place.copy()
        moved[corner] += [0.1, 0.0]
        assert np.abs(residuals(found, moved)).max() > 0.05
    assert (np.abs(found[..., 1]).sum(axis=1) > 0.0).all()


def test_a_slanted_chain_is_met_at_its_angle():
    mesh = sheet(4, 3)
    chain = {(4 * i + 1, 4 * i + 5): marks.SLANTED for i in range(4)}
    found = equations(mesh, [Marked(on_corners(mesh, chain), angle=0.4)])
    turned = mesh.vertices[mesh.corner_vertices][:, [0, 2]] @ [[np.cos(0.4), np.sin(0.4)], [-np.sin(0.4), np.cos(0.4)]]
    assert np.abs(residuals(found, turned)).max() < 1e-12
    assert np.abs(residuals(found, turned[:, ::-1])).max() > 0.1


def test_chains_go_on_at_vertices_but_not_around_the_corner_of_a_face():
    mesh = sheet(4, 3)
    row, column = [(4 * i + 1, 4 * i + 5) for i in range(4)], [(8 + j, 9 + j) for j in range(3)]
    found = marks.chains(mesh, [*row, *column])
    assert sorted(map(sorted, found)) == sorted([sorted(row), sorted(column)])
    marked = marks.straight(mesh, [*row, *column], None)
    assert {marked[edge] for edge in row} == {marks.HORIZONTAL}
    assert {marked[edge] for edge in column} == {marks.VERTICAL}


def test_a_rectangle_finds_its_corners_also_where_a_seam_opens_a_tube():
    mesh = sheet(4, 3)
    everything = mesh.selected_faces
    marked = marks.rectangles(mesh, everything, [])[0]
    assert sorted(edge for edge, mark in marked.items() if mark == marks.HORIZONTAL) == sorted(
        (4 * i + j, 4 * i + 4 + j) for i in range(4) for j in (0, 3)
    )
    assert len(marked) == 14
    # A tube of eight columns around and two along.
    turn = np.arange(8) * np.pi / 4
    ring = np.c_[np.cos(turn), np.sin(turn)]
    vertices = np.concatenate([np.c_[ring, np.full(8, z)] for z in range(3)])
    quads = [
        [8 * z + k, 8 * z + (k + 1) % 8, 8 * z + 8 + (k + 1) % 8, 8 * z + 8 + k] for z in range(2) for k in range(8)
    ]
    tube = polygon_mesh(vertices, quads, [[0, 8], [8, 16]])
    marked = marks.rectangles(tube, tube.selected_faces, [])[0]
    assert {edge for edge, mark in marked.items() if mark == marks.VERTICAL} == {(0, 8), (8, 16)}
    assert len(marked) == 18
    marked, refused = marks.rectangles(polygon_mesh(vertices, quads), tube.selected_faces, [])
    assert not marked and (refused.part == 0).all()
    assert refused.reasons == (texts.NO_RECTANGLE,)


def test_faces_around_an_odd_vertex_make_no_grid():
    mesh = polygon_mesh(np.eye(7, 3), [[0, 1, 2, 3], [0, 3, 4, 5], [0, 5, 6, 1]])
    marked, refused = marks.grids(mesh, mesh.selected_faces)
    assert not marked and (refused.part == 0).all()
    assert refused.reasons == (texts.NO_GRID,)


def test_a_seam_cannot_lie_in_two_directions():
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    points = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    mesh = polygon_mesh(points, quads, [(i, i + axis) for axis in (1, 2, 4) for i in range(8) if not i & axis])
    marked, refused = marks.rectangles(mesh, mesh.selected_faces, [])
    assert len(marked) == 12 and np.count_nonzero(refused.part >= 0) == 2
    assert refused.reasons == (texts.TWO_DIRECTIONS,)


def can(sides, seam=0):
    """A cylinder of quads with two caps, cut along its rims and one column; vertex 2 i + j on rim j."""
    i = np.arange(sides)
    angle = 2.0 * np.pi * i / sides
    quads = np.stack([2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1], axis=1) % (2 * sides)
    rims = [(2 * k + j, (2 * k + 2 + j) % (2 * sides)) for k in range(sides) for j in (0, 1)]
    points = np.repeat(np.c_[np.cos(angle), np.sin(angle), 0 * angle], 2, axis=0)
    points[1::2, 2] = 1.0
    return polygon_mesh(points, [*quads, 2 * i[::-1], 2 * i + 1], [*rims, (2 * seam, 2 * seam + 1)])


def test_caps_stay_free_if_the_side_becomes_a_grid_or_rectangle():
    mesh = can(8)
    side = np.arange(10) < 8
    for marked in (marks.grids(mesh, side)[0], marks.rectangles(mesh, side, [])[0]):
        found = equations(mesh, [Marked(on_corners(mesh, marked))])
        bound = (found[..., 0] // 2)[found[..., 1] != 0]
        assert bound.max() < 32
        assert set(bound.astype(int)) >= {0, 1, 2, 3}
    # Also alone; but not if both sides are caps, whose contradiction is reported.
    rims = on_corners(mesh, {tuple(sorted(edge)): marks.HORIZONTAL for edge in mesh.seam_edges[:-1].tolist()})
    assert equations(replace(mesh, selected_faces=~side), [Marked(rims)])[:, :2, 0].max() < 2 * 32
    lens = replace(mesh, face_offsets=np.array([0, 8, 16]), corner_vertices=np.append(np.arange(8), np.arange(8)[::-1]))
    lens = replace(lens, selected_faces=side[:2], seam_edges=marks.edges_of_corners(lens)[:8])
    assert len(equations(lens, [Marked(np.full(16, marks.HORIZONTAL))])) == 16
