# SPDX-License-Identifier: GPL-3.0-or-later
"""Walls with windows: their triangles beside those of Blender, and their maps."""

import importlib

import bmesh
import numpy as np

from tests.module import bridged

# The one that the add-on has.
sc = importlib.import_module("spectral_unwrap.core.native").spectral_conformal()


def _triangles_of_blender(vertices):
    """The triangles of one polygon with these vertices, (n, 3), as Blender cuts it."""
    mesh = bmesh.new()
    mesh.faces.new([mesh.verts.new(vertex) for vertex in vertices])
    mesh.normal_update()  # which it projects along
    mesh.verts.index_update()
    bmesh.ops.triangulate(mesh, faces=mesh.faces[:], ngon_method="EAR_CLIP")
    triangles = np.array([[vertex.index for vertex in face.verts] for face in mesh.faces])
    mesh.free()
    return triangles


def _areas(flat, triangles):
    a, b, c = (flat[triangles[:, k]] for k in range(3))
    return 0.5 * bridged.cross(b - a, c - a)


def _holders(points, flat, triangles):
    """In how many triangles each point lies, (N,)."""
    a, b, c = (flat[triangles[:, k]][None] for k in range(3))
    p = points[:, None]
    sides = [bridged.cross(end - start, p - start) for start, end in ((a, b), (b, c), (c, a))]
    return (np.min(sides, axis=0) > 0).sum(axis=1)


def _is_right(flat, triangles):
    areas, area = _areas(flat, triangles), bridged.area_of(flat)
    return areas.min() > -1e-5 and abs(areas.sum() - area) < 1e-5 * area


def test_a_thousand_walls_are_covered_as_by_blender():
    compared = 0
    for seed in range(1000):
        rng = np.random.default_rng(seed)
        corners, points = bridged.random_wall(rng)
        flat = points[corners]
        vertices = bridged.in_space(rng, points)[corners]
        own, _ = sc.hosts.face_triangles(vertices, [0, len(flat)], np.arange(len(flat)))
        assert len(own) == len(flat) - 2 and _is_right(flat, own)
        other = _triangles_of_blender(vertices)
        # Blender's ear clipping takes some corners at one place for each other, and has triangles turned over.
        if len(other) != len(own) or not _is_right(flat, other):
            continue
        compared += 1
        samples = rng.uniform(flat.min(axis=0), flat.max(axis=0), (50, 2))
        np.testing.assert_array_equal(_holders(samples, flat, own), _holders(samples, flat, other))

    assert compared > 700
