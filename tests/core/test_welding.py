# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes whose faces have vertices of their own, against the same mesh with shared ones."""

import numpy as np
import pytest
from spectral_unwrap.core import welding
from spectral_unwrap.core.mesh import PolygonMesh
from spectral_unwrap.core.seam_suggestion import Cut, Suggestion


def polygon_mesh(points, faces, **rest):
    sizes = [len(face) for face in faces]
    return PolygonMesh(
        vertices=np.array(points, dtype=np.float64),
        face_offsets=np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32),
        corner_vertices=np.concatenate(faces).astype(np.int32),
        seam_edges=np.array(rest.pop("seam_edges", np.empty((0, 2))), dtype=np.int32),
        selected_faces=np.ones(len(faces), dtype=bool),
        **rest,
    )


def bumpy_grid(n):
    x, y = np.meshgrid(np.linspace(0.0, 1.0, n + 1), np.linspace(0.0, 1.0, n + 1))
    points = np.column_stack([x.ravel(), y.ravel(), 0.1 * np.sin(7.0 * x.ravel()) * np.cos(5.0 * y.ravel())])
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    return polygon_mesh(points, corner[:, None] + [0, 1, n + 2, n + 1])


def cube():
    points = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    return polygon_mesh(points, [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])


def taken_apart(mesh, noise=0.0):
    """Return the mesh with a vertex for every corner."""
    points = mesh.vertices[mesh.corner_vertices]
    points = points + noise * np.random.default_rng(3).uniform(-1.0, 1.0, points.shape)
    faces = np.split(np.arange(len(points)), mesh.face_offsets[1:-1])
    return polygon_mesh(points, faces)


def vertex_of(mesh, distance=1e-6):
    return welding.coincident_vertices(mesh.vertices, mesh.face_offsets, mesh.corner_vertices, distance)


@pytest.mark.parametrize("offset", [0.0, 1000.0])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e6])
def test_faces_with_vertices_of_their_own_become_the_mesh_that_they_were(scale, offset):
    whole = bumpy_grid(12)
    soup = taken_apart(whole)
    soup.vertices[:] = scale * (soup.vertices + offset)
    found = vertex_of(soup)[soup.corner_vertices]
    same_before = whole.corner_vertices[:, None] == whole.corner_vertices
    assert np.array_equal(found[:, None] == found, same_before)
    assert (found <= np.arange(len(found))).all()


def test_vertices_count_as_one_within_the_distance_only():
    size = np.linalg.norm(np.ptp(bumpy_grid(12).vertices, axis=0))
    near = vertex_of(taken_apart(bumpy_grid(12), 0.2e-4 * size), 1e-4)
    assert len(np.unique(near)) == 13 * 13
    far = vertex_of(taken_apart(bumpy_grid(12), 10e-4 * size), 1e-4)
    assert len(np.unique(far)) > 4 * 12 * 12 - 40


def test_shared_vertices_and_bodies_that_touch_stay_as_they_are():
    first, second = cube(), cube()
    both = polygon_mesh(
        np.concatenate([first.vertices, second.vertices + [2.0, 0.0, 0.0]]),
        [*np.split(first.corner_vertices, 6), *(np.split(second.corner_vertices + 8, 6))],
    )
    for mesh in (bumpy_grid(5), cube(), both):
        assert np.array_equal(vertex_of(mesh), np.arange(len(mesh.vertices)))


def test_corners_of_one_face_stay_apart():
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 0), (-1, 1, 0), (-1, 0, 0)]
    # A pentagon that comes back to its first corner, and a triangle beside it with that place, too.
    mesh = polygon_mesh(points, [[0, 1, 2, 3, 4], [4, 5, 6]])
    assert np.array_equal(vertex_of(mesh), np.arange(7))
    assert np.array_equal(vertex_of(polygon_mesh([(0, 0, 0)] * 3, [[0, 1, 2]])), np.arange(3))


def test_meshes_without_borders_or_faces():
    empty = PolygonMesh(
        np.zeros((2, 3)), np.zeros(1, np.int32), np.zeros(0, np.int32), np.zeros((0, 2), np.int32), np.zeros(0, bool)
    )
    assert vertex_of(empty).tolist() == [0, 1]
    assert welding.sharp_edges(empty, 0.5).shape == (0, 2)


def test_welded_mesh_has_seams_and_extenders_where_they_were():
    soup = taken_apart(cube())
    stands = vertex_of(soup)
    mesh = polygon_mesh(
        soup.vertices, np.split(soup.corner_vertices, 6), seam_edges=[(5, 6)], extenders=((1, 20, 0.5),)
    )
    found = welding.welded(mesh, stands)
    for edge, own in ((found.seam_edges[0], (5, 6)), (found.extenders[0][:2], (1, 20))):
        assert np.array_equal(mesh.vertices[list(edge)], mesh.vertices[list(own)])
        assert set(map(int, edge)) <= set(stands.tolist())
    assert found.extenders[0][2] == 0.5
    assert found.vertices is mesh.vertices
    assert len(np.unique(found.corner_vertices)) == 8


def test_edges_of_the_welded_mesh_are_those_of_all_faces_at_them():
    soup = taken_apart(cube())
    stands = vertex_of(soup)
    edge = welding.face_edges(soup.face_offsets, stands[soup.corner_vertices])[:1]
    found = welding.unwelded_edges(soup, stands, edge)
    assert found.shape == (2, 2)
    own = welding.face_edges(soup.face_offsets, soup.corner_vertices).tolist()
    assert all(pair in own for pair in found.tolist())
    ends = np.sort(soup.vertices[found].reshape(2, -1).round(6).reshape(2, 2, 3), axis=1)
    assert np.array_equal(ends[0], ends[1])
    assert welding.edges_length(soup.vertices, stands, found) == pytest.approx(2.0)
    assert welding.edges_length(soup.vertices, np.arange(24), found) == pytest.approx(4.0)


def test_cuts_of_welded_meshes_come_back_as_one_of_each_mesh(monkeypatch):
    soups = [taken_apart(cube()), cube()]
    stands = [vertex_of(soup) for soup in soups]
    edges = [welding.face_edges(each.face_offsets, own[each.corner_vertices]) for each, own in zip(soups, stands)]
    cuts = tuple(Cut(k, edges[k][i : i + 1], 2.0) for i in range(3) for k in (0, 1))
    searched = []
    search = welding.unwelded_edges
    monkeypatch.setattr(welding, "unwelded_edges", lambda mesh, *rest: searched.append(mesh) or search(mesh, *rest))
    found = welding.unwelded(Suggestion(cuts, ("", "refused")), soups, stands)
    # A large mesh has thousands of cuts, and each search goes through the whole mesh.
    assert len(searched) == 2
    assert [(cut.mesh, cut.length) for cut in found.cuts] == [(0, 6.0), (1, 6.0)]
    assert found.errors == ("", "refused")
    for k in (0, 1):
        parts = [search(soups[k], stands[k], cut.edges) for cut in cuts if cut.mesh == k]
        assert np.array_equal(found.edges(k), np.unique(np.concatenate(parts), axis=0))


@pytest.mark.parametrize("degrees", [1e-3, 29.0, 31.0, 120.0, 179.0])
def test_sharp_edges_are_those_whose_faces_are_turned_so_much(degrees):
    angle = np.radians(degrees)
    far = np.array([1e3, -1e3, 1e3])
    points = far + [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (-np.cos(angle), 0, np.sin(angle)), (0, 0, 0)]
    points[5] = points[4] + [0, 1, 0]
    mesh = polygon_mesh(points, [[0, 1, 2, 3], [4, 0, 3, 5]])
    tolerance = 1e-9  # of places a thousand times as far away as the faces are large
    assert welding.sharp_edges(mesh, angle - tolerance).tolist() == [[0, 3]]
    assert welding.sharp_edges(mesh, angle + tolerance).tolist() == []


def test_all_edges_of_a_cube_are_sharp_and_none_of_three_faces():
    assert len(welding.sharp_edges(cube(), np.radians(89.9))) == 12
    assert len(welding.sharp_edges(cube(), np.radians(90.1))) == 0
    points = [(0, 0, 0), (0, 1, 0), (1, 0, 0), (-1, 0, 0.5), (0, 0, 1)]
    assert len(welding.sharp_edges(polygon_mesh(points, [[0, 1, 2], [0, 1, 3], [0, 1, 4]]), 0.1)) == 0
