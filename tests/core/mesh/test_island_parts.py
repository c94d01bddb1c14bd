# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners that faces share with the rest of their island, and where the present map is cut."""

import numpy as np
from spectral_unwrap.core.mesh.island_parts import map_cuts, shared_corners

from tests.core.polygon_meshes import grid


def chosen(mesh, *faces):
    return np.isin(np.arange(len(mesh.selected_faces)), faces)


def shared_vertices(mesh, faces):
    shared = shared_corners(mesh, faces)
    assert not shared[~faces[mesh.face_of_corner()]].any()
    return sorted(set(mesh.corner_vertices[shared].tolist()))


def test_a_block_shares_the_corners_on_its_inner_border():
    mesh = grid(4)
    # The lower left quarter: vertices 2, 7, 12, 11 and 10 touch other faces.
    assert shared_vertices(mesh, chosen(mesh, 0, 1, 4, 5)) == [2, 7, 10, 11, 12]
    assert shared_vertices(mesh, np.ones(16, dtype=bool)) == []


def test_faces_across_a_cut_of_the_map_share_nothing():
    mesh = grid(2)
    # The right column moves away: the map is cut along vertices 1, 4, 7.
    mesh.uv[chosen(mesh, 1, 3)[mesh.face_of_corner()]] += (5.0, 0.0)
    assert shared_vertices(mesh, chosen(mesh, 0, 2)) == []
    assert shared_vertices(mesh, chosen(mesh, 0)) == [3, 4]
    assert map_cuts(mesh, np.ones(4, dtype=bool)).tolist() == [[1, 4], [4, 7]]
    assert map_cuts(mesh, chosen(mesh, 0, 2)).tolist() == []


def test_seams_part_what_lies_together():
    mesh = grid(2, seams=[(1, 4), (7, 4)])
    assert shared_vertices(mesh, chosen(mesh, 0, 2)) == []


def test_faces_round_the_end_of_a_seam_share_its_vertex():
    mesh = grid(2, seams=[(1, 4)])
    # From face 0 to face 1 around vertex 4 there is a way through faces 2 and 3, three edges long.
    assert shared_vertices(mesh, chosen(mesh, 0, 2, 3)) == [4, 5]


def test_a_slit_is_cut_up_to_its_tip():
    mesh = grid(2)
    at_1 = (mesh.corner_vertices == 1) & (mesh.face_of_corner() == 1)
    mesh.uv[at_1] += (0.2, 0.0)
    assert map_cuts(mesh, np.ones(4, dtype=bool)).tolist() == [[1, 4]]
    assert shared_vertices(mesh, chosen(mesh, 0)) == [3, 4]
