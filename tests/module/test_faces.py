# SPDX-License-Identifier: GPL-3.0-or-later
"""The forms of faces and maps: those of igl, xatlas and Blender."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

CUBE = np.array([[x, y, z] for x in (0.0, 1) for y in (0.0, 1) for z in (0.0, 1)])
QUADS = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def mixed():
    """A pyramid without its base, beside a quad: polygons of several kinds."""
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1], [2, 0, 0], [2, 1, 0]])
    return vertices, [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 5, 6, 2]]


def forms(faces):
    """The same faces in every accepted form, as positional arguments."""
    offsets = np.concatenate([[0], np.cumsum([len(face) for face in faces])])
    yield (offsets, np.concatenate(faces))
    yield (faces,)
    yield ([tuple(face) for face in faces],)
    yield ([np.array(face) for face in faces],)
    if len({len(face) for face in faces}) == 1:
        yield (np.array(faces, np.uint32),)


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [(CUBE, QUADS), mixed(), tuple(part.tolist() if part.dtype == int else part for part in meshes.bumpy_disk(60))],
)
def test_every_form_gives_the_same(vertices, faces):
    offsets, *rest = forms(faces)
    expected = sc.unwrap(vertices, *offsets)
    seams = sc.suggest_seams(vertices, *offsets).seam_edges
    defects = sc.map_defects(expected)
    for form in rest:
        found = sc.unwrap(vertices, *form)
        assert np.array_equal(found.uv, expected.uv)
        assert np.array_equal(found.face_offsets, offsets[0])
        assert np.array_equal(found.corner_vertices, offsets[1])
        assert np.array_equal(sc.Unwrapper(vertices, *form).solve().uv, expected.uv)
        assert np.array_equal(sc.suggest_seams(vertices, *form).seam_edges, seams)
        assert np.array_equal(sc.map_defects(found).flipped, defects.flipped)
        measured = sc.face_distortion(meshes.mesh(vertices, *form, uv=expected.uv))
        assert np.array_equal(measured.qc, sc.face_distortion(expected).qc)


@pytest.mark.parametrize("closed", [False, True])
def test_xatlas_form(closed):
    vertices, faces = (CUBE, np.array(QUADS)) if closed else meshes.bumpy_disk(200)
    result = sc.unwrap(sc.suggest_seams(vertices, faces) if closed else sc.Mesh(vertices, faces))
    assert all(chart.status == "solved" for chart in result.charts)
    vmapping, split, uvs = sc.pack(result).split_vertices()
    assert split.shape == faces.shape
    assert np.array_equal(vmapping[split], faces)
    assert len(np.unique(split)) == len(vmapping) == len(uvs)
    assert (len(vmapping) > len(vertices)) == closed
    assert uvs.min() >= 0.0
    assert uvs.max() <= 1.0
    # The map is that of the corners, at another size and place.
    assert meshes.similarity_deviation(uvs[split].reshape(-1, 2), sc.pack(result).uv) < 1e-12
    assert np.isfinite(sc.distortion(vertices[vmapping], split[:, :3], uvs).mean_qc)


def test_split_polygons_are_a_list():
    vertices, faces = mixed()
    result = sc.unwrap(vertices, faces, seam_edges=[(1, 4), (1, 2)])
    vmapping, split, uvs = result.split_vertices()
    assert [len(face) for face in split] == [len(face) for face in faces]
    for face, copies in zip(faces, split):
        assert np.array_equal(vmapping[copies], face)
    assert np.array_equal(uvs[np.concatenate(split)], result.uv)
    assert len({tuple(row) for row in np.c_[vmapping, uvs]}) == len(vmapping)


def test_charts_are_packed_apart():
    # Each face a chart about the origin, so that equal corners lie on each other.
    every = [(a, b) for face in QUADS for a, b in zip(face, face[1:] + face[:1])]
    result = sc.unwrap(CUBE, QUADS, seam_edges=every, selected_faces=[True] * 5 + [False])
    packed = sc.pack(result, texture_size=100, margin=10)
    assert np.array_equal(packed.islands, result.chart_of_face)
    assert packed.islands.tolist() == [0, 1, 2, 3, 4, -1]
    assert packed.stack.tolist() == [0, 1, 2, 3, 4]
    assert not sc.map_defects(packed, selected_faces=packed.islands >= 0, between_islands=True).overlapping.any()
    corners = np.repeat(result.chart_of_face >= 0, 4)
    assert np.array_equal(packed.uv[~corners], result.uv[~corners])
    assert packed.uv[corners].min() >= 0.1 - 1e-4
    assert packed.uv[corners].max() <= 0.9 + 1e-4


@pytest.mark.parametrize(
    ("faces", "kind", "said"),
    [
        (5, TypeError, "faces must be vertices"),
        ([0, 4], TypeError, "faces must be vertices"),
        (np.array([0, 4]), ValueError, r"faces must have the shape \(F, n\)"),
        (np.zeros((1, 2, 3), int), ValueError, r"faces must have the shape \(F, n\)"),
        ([[0.0, 1.0, 2.0]], TypeError, "faces must hold integers"),
        ([[0, 1, 2], [0, 1.5, 2, 3]], TypeError, "faces must hold integers"),
        ([[0, 1, 2], [0, 1, 2, 99]], ValueError, "faces has the vertex 99"),
        ([[0, 1, 2], [0, 1, 2, -1]], ValueError, "faces must lie between 0"),
        ([["a", "b", "c"]], TypeError, "faces must hold integers"),
        ([[[0], [1], [2]], [0, 1, 2, 3]], TypeError, "Each of faces must be a list of vertex indices"),
        ([], ValueError, "no faces"),
        (np.zeros((0, 3), int), ValueError, "no faces"),
        ([[0, 1, 2], 3], TypeError, "faces must be vertices"),
    ],
)
def test_faces_of_no_form_are_named(faces, kind, said):
    with pytest.raises(kind, match=said):
        sc.unwrap(CUBE, faces)


def test_faces_without_corners_stop_no_others():
    result = sc.unwrap(CUBE, [[0, 1, 3, 2], [], [4, 5]])
    assert [chart.status for chart in result.charts] == ["solved", "failed"]
    assert result.chart_of_face.tolist() == [0, 1, 1]
    assert [len(face) for face in result.split_vertices().faces] == [4, 0, 2]
    assert [chart.status for chart in sc.unwrap(CUBE, [[], []]).charts] == ["failed"]
