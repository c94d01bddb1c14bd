# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes whose faces have vertices of their own, against the same mesh with shared ones."""

from dataclasses import replace

import numpy as np
import pytest
from spectral_conformal import Options
from spectral_conformal.assets import AssetMesh, welding
from spectral_conformal.assets.unwrapping import Cutting, cut, unwrapped


def polygon_mesh(points, faces):
    offsets = np.concatenate([[0], np.cumsum([len(face) for face in faces])])
    return AssetMesh(np.array(points, dtype=np.float64), offsets, np.concatenate(faces).astype(np.int64))


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


def sharp_edges(mesh, angle):
    return welding.sharp_edges(mesh, vertex_of(mesh), angle)


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


def test_corners_of_one_face_stay_apart_unless_they_follow_each_other():
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 0), (-1, 1, 0), (-1, 0, 0)]
    # A pentagon that comes back to its first corner, and a triangle beside it with that place, too.
    assert vertex_of(polygon_mesh(points, [[0, 1, 2, 3, 4], [4, 5, 6]])).tolist() == [0, 1, 2, 3, 0, 5, 6]
    # It crosses that place, or would keep two corners.
    assert vertex_of(polygon_mesh(points, [[0, 1, 2, 4, 3], [4, 5, 6]])).tolist() == [0, 1, 2, 3, 4, 5, 6]
    assert vertex_of(polygon_mesh(points, [[0, 1, 4], [4, 5, 6]])).tolist() == [0, 1, 2, 3, 4, 5, 6]
    assert np.array_equal(vertex_of(polygon_mesh([(0, 0, 0)] * 3, [[0, 1, 2]])), np.arange(3))


def test_quads_that_end_in_a_pole_are_as_its_triangles():
    n = 16
    angle = 2 * np.pi * np.arange(n) / n
    rings = [
        np.c_[r * np.cos(angle), r * np.sin(angle), np.full(n, z)] for r, z in ((1.0, 0.0), (0.5, 0.4), (0.0, 0.6))
    ]
    k, after = np.arange(n), np.roll(np.arange(n), -1)
    low = np.c_[k, after, n + after, n + k]
    # As programs round it: some of the quads cross themselves.
    rings[2] = rings[2] + np.random.default_rng(1).uniform(-1e-7, 1e-7, (n, 3))
    dome = polygon_mesh(np.concatenate(rings), [*low, *(low + n)])
    shared = polygon_mesh(np.concatenate(rings)[: 2 * n + 1], [*low, *np.c_[n + k, n + after, np.full(n, 2 * n)]])
    quads, triangles = (unwrapped(cut(each, Cutting("suggest")), Options()) for each in (dome, shared))
    assert len(quads.charts) == len(triangles.charts)
    assert np.abs(quads.charts.column("mean_qc") - triangles.charts.column("mean_qc")).max() < 1e-4
    assert quads.charts.column("max_qc").max() < 1.5


def test_borders_of_materials_are_edges_of_the_welded_mesh():
    for mesh in (cube(), taken_apart(cube())):
        material = np.array([0, 0, 0, 0, 0, 7])
        marked = replace(mesh, material_of_face=material)
        edges = welding.borders_between(marked, vertex_of(mesh), marked.material_of_face)
        last = vertex_of(mesh)[mesh.corner_vertices[-4:]]
        expected = np.sort(np.stack([last, np.roll(last, -1)], axis=1), axis=1)
        assert sorted(edges.tolist()) == sorted(expected.tolist())
        assert welding.borders_between(mesh, vertex_of(mesh), mesh.material_of_face).shape == (0, 2)


def test_meshes_without_borders_or_faces():
    empty = AssetMesh(np.zeros((2, 3)), np.zeros(1, np.int64), np.zeros(0, np.int64))
    assert vertex_of(empty).tolist() == [0, 1]
    assert sharp_edges(empty, 0.5).shape == (0, 2)


@pytest.mark.parametrize("degrees", [1e-3, 29.0, 31.0, 120.0, 179.0])
def test_sharp_edges_are_those_whose_faces_are_turned_so_much(degrees):
    angle = np.radians(degrees)
    far = np.array([1e3, -1e3, 1e3])
    points = far + [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (-np.cos(angle), 0, np.sin(angle)), (0, 0, 0)]
    points[5] = points[4] + [0, 1, 0]
    mesh = polygon_mesh(points, [[0, 1, 2, 3], [4, 0, 3, 5]])
    tolerance = 1e-9  # of places a thousand times as far away as the faces are large
    assert sharp_edges(mesh, angle - tolerance).tolist() == [[0, 3]]
    assert sharp_edges(mesh, angle + tolerance).tolist() == []


def test_all_edges_of_a_cube_are_sharp_and_none_of_three_faces():
    assert len(sharp_edges(cube(), np.radians(89.9))) == 12
    assert len(sharp_edges(cube(), np.radians(90.1))) == 0
    # Faces with vertices of their own have the edges of those that stand for them.
    assert len(sharp_edges(taken_apart(cube()), np.radians(89.9))) == 12
    points = [(0, 0, 0), (0, 1, 0), (1, 0, 0), (-1, 0, 0.5), (0, 0, 1)]
    assert len(sharp_edges(polygon_mesh(points, [[0, 1, 2], [0, 1, 3], [0, 1, 4]]), 0.1)) == 0


@pytest.mark.parametrize("seams", ["keep", "suggest", "sharp"])
def test_an_island_ends_with_its_object(seams):
    """Two objects of a file that touch, with the same UVs at the border."""
    mesh = taken_apart(bumpy_grid(2))
    mesh = replace(mesh, corner_uv=mesh.vertices[mesh.corner_vertices, :2])
    together = unwrapped(cut(mesh, Cutting(seams, sharp_angle=180.0)), Options())
    assert together.chart_of_face.tolist() == [0, 0, 0, 0]
    parts = replace(mesh, parts=("left", "right"), part_of_face=np.array([0, 1, 0, 1]))
    apart = unwrapped(cut(parts, Cutting(seams, sharp_angle=180.0)), Options())
    assert apart.chart_of_face.tolist() == [0, 1, 0, 1]
