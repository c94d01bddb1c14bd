import copy
import pickle

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes, reference


def per_vertex(result, corners, n):
    """uv per mesh vertex, for meshes whose vertices have one copy each."""
    uv = np.full((n, 2), np.nan)
    uv[corners] = result.uv
    return uv


def test_triangle_mesh_equals_parameterize():
    vertices, triangles = meshes.bumpy_disk(700, 3)
    offsets, corners = meshes.polygons(triangles)
    result = sc.unwrap(vertices, offsets, corners)
    expected = sc.parameterize(vertices, triangles)
    (chart,) = result.charts
    assert np.array_equal(result.uv, expected.uv[corners])
    assert result.solved_corners.all()
    assert (result.chart_of_face == 0).all()
    assert (chart.status, chart.message, chart.turning_number, chart.flipped) == ("solved", "", 1, 0)
    assert chart.eigenvalue == expected.eigenvalue
    assert chart.n_vertices == len(vertices)
    measured = sc.distortion(vertices, triangles, expected.uv)
    assert chart.mean_qc == pytest.approx(measured.mean_qc)
    assert chart.max_qc == pytest.approx(measured.max_qc)


def test_the_worst_is_that_of_a_face_as_face_distortion_measures_it():
    # Of triangles, quads and pentagons; along a quad's diagonals the distortion differs.
    vertices, quads = meshes.saddle_quads(9)
    vertices[:, 2] += 0.3 * np.sin(7 * vertices[:, 0]) * np.cos(5 * vertices[:, 1])
    faces = [list(quad) for quad in quads]
    faces[3:4] = [faces[3][:3], [faces[3][0], *faces[3][2:]]]
    offsets, corners = meshes.polygons(faces)
    result = sc.unwrap(vertices, offsets, corners)
    (chart,) = result.charts
    measured = sc.face_distortion(sc.Mesh(vertices, offsets, result.uv, corner_vertices=corners))
    assert chart.max_qc == pytest.approx(measured.qc.max(), rel=1e-9)
    assert chart.mean_qc == pytest.approx(np.average(measured.qc, weights=measured.area), rel=1e-9)


def box():
    vertices = np.array([[x, y, z] for x in (0, 1.0) for y in (0, 2.0) for z in (0, 3.0)])
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return vertices, faces


def test_each_chart_has_its_box_and_area_in_the_map_and_each_corner_its_vertex():
    # A closed box fails, then a grid with a seam into it, a face with a duplicate, one without area, and a pinned one.
    vertices, faces = box()
    saddle, quads = meshes.saddle_quads(7)
    seam = np.array([[3, 10], [10, 17], [17, 24]]) + len(vertices)
    faces = [*faces, *(quads + len(vertices)).tolist()]
    more = np.array([[9, 9, 9], [10, 9, 9], [9, 10, 9.0]])
    vertices = np.r_[vertices, saddle]
    n = len(vertices)
    vertices = np.r_[vertices, more, more + 3, more + 5]
    vertices[n + 5] = 2 * vertices[n + 4] - vertices[n + 3]
    faces += [[n, n + 1, n + 2], [n + 2, n, n + 1], [n + 3, n + 4, n + 5], [n + 6, n + 7, n + 8]]
    offsets, corners = meshes.polygons(faces)
    result = sc.unwrap(vertices, offsets, corners, seam_edges=seam, pins={n + 6: (7.0, 8.0)})
    charts, first = result.charts, 0
    assert charts.column("status").tolist() == ["failed", *["solved"] * 4]
    of_corner = np.repeat(result.chart_of_face, np.diff(offsets))
    for number, chart in enumerate(charts):
        own = of_corner == number
        if chart.status == "failed":
            assert np.isnan([chart.image_area, chart.low_u, chart.low_v, chart.high_u, chart.high_v]).all()
            assert np.isnan([chart.mean_qc, chart.eigenvalue]).all()
            assert (result.vertex_of_corner[own] == -1).all()
            first += chart.n_vertices
            continue
        uv, vertex = result.uv[own], result.vertex_of_corner[own] - first
        assert chart.scale_deviation >= 0.0 or number == 3
        assert [chart.low_u, chart.low_v] == uv.min(axis=0).tolist()
        assert [chart.high_u, chart.high_v] == uv.max(axis=0).tolist()
        assert np.unique(vertex).tolist() == list(range(chart.n_vertices))
        points = np.empty((chart.n_vertices, 2))
        points[vertex] = uv
        assert np.array_equal(points[vertex], uv)
        first += chart.n_vertices
    u, v = result.uv.T
    shoelace = [
        0.5 * (u[a:b] * np.roll(v[a:b], -1) - v[a:b] * np.roll(u[a:b], -1)).sum() for a, b in zip(offsets, offsets[1:])
    ]
    area = np.bincount(result.chart_of_face, np.abs(shoelace), 5)
    area[2] /= 2.0
    np.testing.assert_allclose(charts.column("image_area")[1:], area[1:], rtol=1e-12, atol=1e-15)


def test_records_with_arrays_compare_by_identity():
    vertices, quads = meshes.saddle_quads(5)
    offsets, corners = meshes.polygons(quads)
    triangles = meshes.triangles_of(quads)

    def records():
        result = sc.unwrap(vertices, offsets, corners)
        uv = sc.parameterize(vertices, triangles).uv
        yield from (result, result.charts[0], result.split_vertices(), sc.parameterize(vertices, triangles))
        yield from (sc.distortion(vertices, triangles, uv), meshes.defects(offsets, corners, result.uv))
        yield from (
            sc.face_distortion(sc.Mesh(vertices, offsets, result.uv, corner_vertices=corners)),
            sc.pack(result),
        )
        yield from (result.with_uv(result.uv), sc.relax(result))

    for one, other in zip(records(), records()):
        assert one == one and one != other
        assert len({one, other, one}) == 2


def squares_and_a_line():
    """Return five squares, apart and ever larger, and a face of two vertices between them, as arguments of unwrap."""
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    vertices = np.concatenate([(1 + k) * square + (10 * k, 0, 0) for k in range(5)])
    return vertices, [0, 4, 8, 10, 14, 18, 22], [*range(8), 8, 9, *range(8, 20)]


def test_charts_are_a_sequence():
    charts = sc.unwrap(*squares_and_a_line()).charts
    assert len(charts) == 6
    assert [list(chart.faces) for chart in charts] == [[0], [1], [3], [4], [5], [2]]
    assert charts[-1].status == charts[5].status == "failed" and "fewer than three" in charts[-1].message
    with pytest.raises(IndexError):
        charts[6]
    for part, places in ((charts[1:3], [1, 2]), (charts[::-2], [5, 3, 1]), (charts[7:], [])):
        assert [list(chart.faces) for chart in part] == [list(charts[place].faces) for place in places]
        assert [chart.message for chart in part] == [charts[place].message for place in places]
        assert list(part.n_faces) == [1] * len(places)
        assert list(part.column("area")) == [charts[place].area for place in places]
        assert list(part.column("status")) == [charts[place].status for place in places]
    with pytest.raises(ValueError, match="no column 'faces'"):
        charts.column("faces")
    assert list(charts[::2].column("message")) == ["", "", ""] and charts.column("message")[5] == charts[5].message
    # An array of a record is its own.
    charts[0].faces[0] = 3
    assert list(charts[0].faces) == [0]


def test_charts_can_be_stored():
    charts = sc.unwrap(*squares_and_a_line()).charts
    for copied in (
        pickle.loads(pickle.dumps(charts)),
        copy.deepcopy(charts),
        pickle.loads(pickle.dumps(charts[::-1]))[::-1],
    ):
        assert [repr(chart) for chart in copied] == [repr(chart) for chart in charts]


def test_filled_holes_keep_their_shape_and_are_not_measured():
    vertices, triangles = meshes.bumpy_disk(1500, 3, seed=4)
    offsets, corners = meshes.polygons(triangles)
    (open_chart,) = sc.unwrap(vertices, offsets, corners).charts
    filled = sc.unwrap(vertices, offsets, corners, fill_holes=True)
    (chart,) = filled.charts
    assert (chart.status, chart.flipped, chart.n_vertices) == ("solved", 0, len(vertices))
    assert chart.area == pytest.approx(open_chart.area, rel=1e-14)
    uv = per_vertex(filled, corners, len(vertices))
    measured = sc.distortion(vertices, triangles, uv)
    assert chart.mean_qc == pytest.approx(measured.mean_qc)
    # The filling costs some of the patch's own energy.
    assert chart.eigenvalue > open_chart.eigenvalue
    assert uv.mean(0) == pytest.approx((0, 0), abs=1e-12)


def test_filled_holes_of_a_flat_patch_change_nothing():
    vertices, triangles = meshes.random_disk(1500, 4)
    uv = sc.parameterize(vertices, triangles, fill_holes=True).uv
    assert meshes.similarity_deviation(uv, vertices[:, :2]) < 1e-9


def test_charts_are_linear_in_the_number_of_faces():
    # Many small charts: nothing may be done per chart that looks at the whole mesh.
    n = 5000
    vertices = np.random.default_rng(0).random((3 * n, 3))
    result = sc.unwrap(vertices, np.arange(0, 3 * n + 1, 3), np.arange(3 * n))
    assert len(result.charts) == n
    assert all(chart.status == "solved" for chart in result.charts)
    assert max(chart.max_qc for chart in result.charts) - 1 < 1e-6  # the thinnest of the random triangles
    area = reference.gradients(vertices, np.arange(3 * n).reshape(n, 3))[2]
    corners = result.uv.reshape(n, 3, 2) @ [1, 1j]
    image = ((corners[:, 1] - corners[:, 0]).conj() * (corners[:, 2] - corners[:, 0])).imag / 2
    assert np.allclose(image, area)
