# SPDX-License-Identifier: GPL-3.0-or-later
"""The map of a polygon mesh, face by face, and the triangles to draw it by."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes


def saddle(n=12):
    vertices, quads = meshes.saddle_quads(n)
    return vertices, *meshes.polygons(quads)


def test_single_precision_is_read_as_it_is():
    mesh = saddle()
    uv = (mesh[0][mesh[2]][:, :2] * [1.0, 2.0]).astype(np.float32)
    uv[5] = np.nan
    single, double = (
        sc.face_distortion(sc.Mesh(mesh[0], mesh[1], uv, corner_vertices=mesh[2])),
        sc.face_distortion(sc.Mesh(mesh[0], mesh[1], uv.astype(np.float64), corner_vertices=mesh[2])),
    )
    for name in ("qc", "log2_scale", "area", "image_area"):
        np.testing.assert_array_equal(getattr(single, name), getattr(double, name))


def test_triangles_cover_the_selected_faces_in_their_order():
    vertices, offsets, corners = saddle()
    selected = np.arange(len(offsets) - 1) % 3 > 0
    triangles, face = sc.hosts.face_triangles(vertices, offsets, corners, selected_faces=selected)
    assert triangles.shape == (2 * selected.sum(), 3)
    assert np.array_equal(face, np.repeat(np.flatnonzero(selected), 2))
    assert np.array_equal(triangles // 4, np.repeat(face, 3).reshape(-1, 3))


def test_what_is_no_mesh_is_refused():
    vertices, offsets, corners = saddle()
    with pytest.raises(ValueError, match="one row per corner"):
        sc.face_distortion(sc.Mesh(vertices, offsets, np.zeros((3, 2)), corner_vertices=corners))
    with pytest.raises(ValueError, match="corner_vertices"):
        sc.hosts.face_triangles(vertices[:5], offsets, corners)
    with pytest.raises(sc.InvalidMeshError, match="no faces"):
        sc.hosts.face_triangles(vertices, [0], [])
