# SPDX-License-Identifier: GPL-3.0-or-later
"""`Mesh`: what the four verbs take and return."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes, test_straighten
from tests.module.test_faces import CUBE, QUADS


def test_the_four_verbs_take_and_return_a_mesh_with_its_map():
    mesh = sc.Mesh(CUBE, QUADS)
    cut = sc.suggest_seams(mesh)
    assert len(cut.seam_edges) == 7
    assert np.array_equal(cut.seam_edges, sc.suggest_seams(CUBE, QUADS).seam_edges)
    mapped = sc.unwrap(cut)
    assert np.array_equal(mapped.uv, sc.unwrap(CUBE, QUADS, seam_edges=cut.seam_edges).uv)
    relaxed = sc.relax(mapped, sizes=1)
    packed = sc.pack(relaxed, texture_size=256, margin=2)
    for each in (cut, mapped, relaxed, packed):
        assert isinstance(each, sc.Mesh)
        assert np.array_equal(each.vertices, CUBE)
        assert np.array_equal(each.corner_vertices.reshape(-1, 4), QUADS)
        assert np.array_equal(each.seam_edges, cut.seam_edges)
    # A net of a cube is an isometry already, cut open along its seams.
    assert (relaxed.energy, relaxed.flipped) == (pytest.approx(4, abs=1e-9), 0)
    assert meshes.similarity_deviation(packed.uv, mapped.uv) < 1e-9
    assert sc.unwrap(packed).charts[0].status == "solved"


def test_a_map_is_by_corner_and_a_map_by_vertex_is_named():
    vertices, quads = meshes.saddle_quads(5)
    flat = vertices[:, :2]
    by_face = sc.Mesh(vertices, quads, flat[quads])
    assert by_face.uv.shape == (quads.size, 2)
    assert np.array_equal(by_face.uv, sc.Mesh(vertices, quads, flat[quads.ravel()]).uv)
    assert np.array_equal(by_face.split_vertices().uvs, flat)
    with pytest.raises(ValueError, match=r"one row per corner, not \(25, 2\); give uv\[F\]"):
        sc.Mesh(vertices, quads, flat)
    with pytest.raises(ValueError, match="uv must have the shape"):
        by_face.with_uv(flat[quads][:, :3])
    # A vertex in each corner: both are the same.
    assert np.array_equal(sc.Mesh(vertices[:3], [[2, 0, 1]], flat[:3]).uv, flat[:3])


def test_a_mesh_never_changes():
    vertices, quads = meshes.saddle_quads(5)
    uv = vertices[quads][..., :2].copy()
    mesh = sc.Mesh(vertices, quads, uv, seam_edges=quads[:2, :2])
    uv[:] = 7.0
    assert not (mesh.uv == 7.0).any()
    for array in (mesh.vertices, mesh.face_offsets, mesh.corner_vertices, mesh.uv, mesh.seam_edges, sc.unwrap(mesh).uv):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    with pytest.raises(AttributeError):
        mesh.uv = uv
    other = mesh.with_uv(uv)
    assert (other.uv == 7.0).all()
    assert other.vertices is mesh.vertices
    assert mesh.with_seams(None).seam_edges is None


def test_what_is_no_mesh_is_named():
    mesh = sc.Mesh(CUBE, QUADS)
    for function in (sc.unwrap, sc.suggest_seams, sc.hosts.chart_of_face):
        with pytest.raises(TypeError, match="A Mesh has its own faces"):
            function(mesh, QUADS)
        with pytest.raises(TypeError, match="mesh must be a Mesh, or vertices followed by faces"):
            function(CUBE)
    for function in (sc.pack, sc.relax, sc.map_defects, sc.face_distortion):
        with pytest.raises(ValueError, match="The mesh has no map; give uv"):
            function(mesh)
        with pytest.raises(TypeError, match=r"Mesh\(V, F, uv\[F\]\), not ndarray"):
            function(CUBE)


def test_seams_of_a_call_are_beside_those_of_the_mesh():
    vertices, quads = meshes.saddle_quads(7)
    own, further = ([(7 * i + k, 7 * (i + 1) + k) for i in range(6)] for k in (2, 4))
    mesh = sc.Mesh(vertices, quads, seam_edges=own)
    for seams, charts in ((None, 2), (further, 3)):
        found = sc.unwrap(mesh, seam_edges=seams)
        assert len(found.charts) == charts
        assert len(sc.unwrap(found).charts) == charts


def test_relax_holds_corners_where_a_seam_gives_a_vertex_two():
    vertices, quads = meshes.bulge(9, 1.0)
    side = 9
    seam = [(side * i + 4, side * (i + 1) + 4) for i in range(side - 1)]
    mesh = sc.unwrap(vertices, quads, seam_edges=seam)
    assert len(mesh.charts) == 2
    left = np.repeat(mesh.chart_of_face == 0, 4)
    relaxed = sc.relax(mesh, sizes=1, fixed=left)
    assert np.array_equal(relaxed.uv[left], mesh.uv[left])
    assert (relaxed.uv[~left] != mesh.uv[~left]).any()
    assert relaxed.energy < relaxed.energy_before


def test_relax_splits_polygons_as_they_lie_in_the_map():
    vertices, quads = meshes.bulge(7, 1.0)
    mesh = sc.unwrap(vertices, quads)
    corners, _ = sc.hosts.face_triangles(
        np.c_[mesh.uv, np.zeros(len(mesh.uv))], mesh.face_offsets, np.arange(len(mesh.uv))
    )
    triangles = sc.Mesh(vertices, mesh.corner_vertices[corners], mesh.uv[corners])
    found, expected = sc.relax(mesh, sizes=1), sc.relax(triangles, sizes=1)
    assert np.array_equal(found.uv[corners.ravel()], expected.uv)
    weights = np.where(np.arange(len(quads)) < 9, 50.0, 1.0)
    assert not np.array_equal(sc.relax(mesh, sizes=1, weights=weights).uv, found.uv)


def test_parameterize_takes_polygons():
    vertices, quads = meshes.saddle_quads(9)
    corners, _ = sc.hosts.face_triangles(vertices, quads)
    triangles = quads.ravel()[corners]
    expected = sc.parameterize(vertices, triangles)
    for faces in (quads, quads.tolist(), [*quads.tolist()[:-1], quads[-1][:3].tolist(), quads[-1][[0, 2, 3]].tolist()]):
        found = sc.parameterize(vertices, faces)
        assert meshes.similarity_deviation(found.uv, expected.uv) < 1e-6
        assert np.array_equal(sc.Solver(vertices, faces).solve().uv, found.uv)
    assert np.array_equal(sc.parameterize(vertices, quads).uv, expected.uv)
    with pytest.raises(ValueError, match="metric needs triangles; unwrap takes one"):
        sc.parameterize(vertices, quads, metric=np.tile(np.eye(2), (len(quads), 1, 1)))


def test_straighten_is_checked_where_constraints_are_given_and_arguments_once(monkeypatch):
    vertices, quads = meshes.saddle_quads(9)
    with pytest.raises(ValueError, match="straighten must be a share or 'auto', not 'never'"):
        sc.unwrap(vertices, quads, straighten="never", constraints=sc.Constraints(horizontal=[[0, 1]]))
    calls = []
    checked = sc._arguments.checked_metric
    monkeypatch.setattr(sc._arguments, "checked_metric", lambda *a: calls.append(1) or checked(*a))
    vertices, quads = test_straighten.sheet(0.01)
    solves = []
    solve = sc._native.unwrap
    monkeypatch.setattr(sc._native, "unwrap", lambda *a: solves.append(1) or solve(*a))
    sc.unwrap(vertices, quads, straighten=0.02, metric=np.tile(np.eye(3), (len(quads), 1, 1)))
    assert (len(solves), len(calls)) == (3, 1)
