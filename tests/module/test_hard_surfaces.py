# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams of hard surfaces are those an artist would keep: along sharp edges, none across a flat face."""

import numpy as np
import pytest
import spectral_conformal as sc

from .hard_surfaces import HARD_SURFACES, bent_pipe, beveled_cylinder, torus


def across_flat_faces(vertices, faces, seams):
    """Return the length of the seams between faces of one plane, within a degree."""
    normals = {}
    for face in faces:
        corners = vertices[face]
        normal = np.cross(corners - corners[0], np.roll(corners, -1, axis=0) - corners[0]).sum(axis=0)
        for a, b in zip(face, [*face[1:], face[0]]):
            normals.setdefault(frozenset((a, b)), []).append(normal / np.linalg.norm(normal))
    flat = [edge for edge in seams.tolist() if np.dot(*normals[frozenset(edge)]) > np.cos(np.radians(1))]
    return sum(np.linalg.norm(vertices[a] - vertices[b]) for a, b in flat)


@pytest.mark.parametrize("name", HARD_SURFACES)
def test_seams_that_an_artist_would_keep(name):
    model = HARD_SURFACES[name]
    vertices, faces = model.make()
    seams = sc.suggest_seams(vertices, faces).seam_edges
    charts = sc.unwrap(vertices, faces, seam_edges=seams).charts
    assert len(charts) in model.islands, model.reason
    assert across_flat_faces(vertices, faces, seams) == 0
    assert all((chart.status, chart.flipped, chart.overlapping) == ("solved", 0, 0) for chart in charts)
    area = np.array([chart.area for chart in charts])
    assert np.average([chart.mean_qc for chart in charts], weights=area) < 1.01
    # The chamfer of the bolt stays with the shaft, and the corners of round bevels, which are curved both ways, with
    # the top: a hundredth of the area each.
    assert max(chart.max_qc for chart in charts) < (1.13 if name in ("bolt", "rounded block") else 1.1)


def straight_share(faces, seams):
    """Return the share of the seams' vertices, regular ones of quads, at which a seam goes straight on."""
    beside, at_vertex = {}, {}
    for f, face in enumerate(faces):
        for a, b in zip(face, [*face[1:], face[0]]):
            beside.setdefault(frozenset((a, b)), set()).add(f)
    for edge in beside:
        for v in edge:
            at_vertex.setdefault(v, []).append(edge)
    cut = {frozenset(edge) for edge in seams.tolist()}
    pairs = [[e for e in at_vertex[v] if e in cut] for v in at_vertex if len(at_vertex[v]) == 4]
    straight = [not beside[pair[0]] & beside[pair[1]] for pair in pairs if len(pair) == 2]
    return np.mean(straight)


TORI = [(32, 16, 0.25), (32, 16, 0.33), (32, 16, 0.4), (12, 8, 0.4), (24, 8, 0.2), (12, 6, 0.3)]


@pytest.mark.parametrize("size", TORI, ids=str)
def test_a_torus_is_cut_along_two_circles(size):
    vertices, faces = torus(*size)
    seams = sc.suggest_seams(vertices, faces).seam_edges
    assert len(sc.unwrap(vertices, faces, seam_edges=seams).charts) == 2
    assert straight_share(faces, seams) > 0.97


BEVELED = {
    "usual": {},
    "16 around": {"around": 16},
    "48 around": {"around": 48},
    "flat": {"height": 0.5},
    "tall": {"height": 6},
    "narrow bevel": {"bevel": 0.02},
    "chamfer": {"segments": 1},
    "wide bevel": {"bevel": 0.25},
    "round bevel": {"segments": 4},
    "wide, round bevel": {"bevel": 0.25, "segments": 4},
    "fans": {"fans": True},
    "tapered": {"height": 1.3, "bevel": 0.06, "top": 0.5},
}


@pytest.mark.parametrize("name", BEVELED)
def test_the_caps_of_a_beveled_cylinder_come_off_whole(name):
    vertices, faces = beveled_cylinder(**BEVELED[name])
    seams = sc.suggest_seams(vertices, faces).seam_edges
    charts = sc.unwrap(vertices, faces, seam_edges=seams).charts
    # The flat one's wall is twice as long as the side of a sheet of its area.
    assert len(charts) == (4 if name == "flat" else 3)
    height = vertices[:, 2].round(6)
    around = [edge for edge in seams.tolist() if height[edge[0]] == height[edge[1]]]
    _, cut = np.unique([height[edge[0]] for edge in around], return_counts=True)
    assert cut.tolist() == [BEVELED[name].get("around", 32)] * 2
    assert max(chart.max_qc for chart in charts) < 1.12


@pytest.mark.parametrize("size", [{}, {"around": 24, "wall": 0.05, "straight": 8, "bend": 12}], ids=["low", "dense"])
def test_a_bent_pipe_with_walls_is_cut_along_its_loops(size):
    vertices, faces = bent_pipe(**size)
    seams = sc.suggest_seams(vertices, faces).seam_edges
    charts = sc.unwrap(vertices, faces, seam_edges=seams).charts
    assert len(charts) <= 4
    assert straight_share(faces, seams) > 0.97


def hose(n, around, bend):
    """A tube without walls, 8 times as long as around, along an arc of `bend` radians: (vertices, faces)."""
    length = 16 * np.pi
    t, angle = np.meshgrid(np.arange(n + 1) / n, 2 * np.pi * np.arange(around) / around, indexing="ij")
    radius = length / bend + np.cos(angle)
    vertices = np.stack([radius * np.cos(bend * t), radius * np.sin(bend * t), np.sin(angle)], axis=-1).reshape(-1, 3)
    k = np.arange((n + 1) * around).reshape(n + 1, around)
    low, high = k[:-1], k[1:]
    return vertices, np.stack([low, high, np.roll(high, -1, 1), np.roll(low, -1, 1)], axis=-1).reshape(-1, 4).tolist()


@pytest.mark.parametrize(
    ("mesh", "more", "fills"),
    [(HARD_SURFACES["gear"].make(), 2, (0.15, 0.5)), (hose(64, 8, 0.8), 2, (0.14, 0.3))],
    ids=["gear", "hose"],
)
def test_strips_longer_than_the_sheet_are_parted(mesh, more, fills):
    islands, found, lengths = [], [], []
    for side in (np.inf, sc.SeamOptions().longest_side):
        cut = sc.suggest_seams(*mesh, longest_side=side)
        unwrapped = sc.unwrap(cut)
        islands.append(len(unwrapped.charts))
        found.append(sc.pack(unwrapped).fill)
        lengths.append(len(cut.seam_edges))
    assert islands[0] < islands[1] <= islands[0] + more
    assert found[0] < fills[0]
    assert found[1] > fills[1]
    assert lengths[1] < 1.3 * lengths[0]


@pytest.mark.parametrize("name", ["box", "chair", "pipe", "bolt", "block"])
def test_what_is_no_strip_stays_whole(name):
    mesh = HARD_SURFACES[name].make()
    free, priced = (sc.suggest_seams(*mesh, longest_side=side).seam_edges for side in (np.inf, 1.75))
    assert np.array_equal(free, priced)


def test_numbering_makes_no_difference():
    vertices, faces = HARD_SURFACES["rounded block"].make()
    seams = {frozenset(edge) for edge in sc.suggest_seams(vertices, faces).seam_edges.tolist()}
    rng = np.random.default_rng(3)
    order, face_order = rng.permutation(len(vertices)), rng.permutation(len(faces))
    image = np.argsort(order)
    again = sc.suggest_seams(vertices[order], [np.roll(image[faces[f]], f) for f in face_order]).seam_edges
    assert {frozenset(order[list(edge)].tolist()) for edge in again.tolist()} == seams


def test_a_stricter_limit_leaves_no_more_distortion():
    vertices, faces = HARD_SURFACES["bolt"].make()
    worst = []
    for limit in (4.5, 4.1, 4.01):
        seams = sc.suggest_seams(vertices, faces, energy_limit=limit).seam_edges
        worst.append(max(chart.max_qc for chart in sc.unwrap(vertices, faces, seam_edges=seams).charts))
    assert worst == sorted(worst, reverse=True)


def test_edges_that_are_to_be_kept_out_of_sight_or_avoided_are_dearer():
    vertices, faces = HARD_SURFACES["tube"].make()
    away = np.where(vertices[:, 0] > 0, -1.0, 1.0)
    seams = sc.suggest_seams(vertices, faces, vertex_preference=away).seam_edges
    lengthwise = [edge for edge in seams.tolist() if np.ptp(vertices[edge, 2]) > 1]
    assert lengthwise
    assert (vertices[np.concatenate(lengthwise), 0] <= 1e-9).all()
