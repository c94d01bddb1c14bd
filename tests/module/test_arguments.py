"""Bad arguments found by random calls (tests/fuzz): each is rejected by name, or has no effect."""

import math
from types import ModuleType

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

FAR_TOO_MANY = [2**31, 2**40]
SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])


def disk():
    vertices, triangles = meshes.bumpy_disk(60)
    return vertices, triangles.astype(np.int32)


def longer(array, n):
    """An array of n rows that takes the memory of one."""
    return np.broadcast_to(array[:1], (n, *array.shape[1:]))


@pytest.mark.parametrize("n", FAR_TOO_MANY)
@pytest.mark.parametrize("name", ["vertices", "faces"])
def test_more_rows_than_can_be_numbered(name, n):
    arguments = dict(zip(("vertices", "faces"), disk()))
    arguments[name] = longer(arguments[name], n)
    with pytest.raises(ValueError, match=f"{name} has {n} rows; at most .* Split the mesh"):
        sc.parameterize(**arguments)
    with pytest.raises(ValueError, match=f"{name} has {n} rows"):
        sc.Mesh(**arguments)


@pytest.mark.parametrize("n", FAR_TOO_MANY)
@pytest.mark.parametrize(
    "name", ["mesh", "faces", "corner_vertices", "seam_edges", "selected_faces", "fixed", "metric"]
)
def test_more_rows_of_a_polygon_mesh_than_can_be_numbered(name, n):
    vertices, triangles = disk()
    offsets, corners = meshes.polygons(triangles)
    arguments = {
        "mesh": vertices,
        "faces": offsets,
        "corner_vertices": corners,
        "seam_edges": triangles[:, :2],
        "selected_faces": np.ones(len(triangles), bool),
        "metric": np.tile(np.eye(3), (len(triangles), 1, 1)),
    }
    arguments[name] = longer(arguments.get(name, np.zeros(len(corners), bool)), n)
    with pytest.raises(ValueError, match=f"{name.replace('mesh', 'vertices')}.* has {n} rows; at most"):
        sc.unwrap(**arguments)


def test_triangles_whose_corners_are_more_than_can_be_numbered():
    vertices, triangles = disk()
    with pytest.raises(ValueError, match="faces has .* entries; at most"):
        sc.parameterize(vertices, longer(triangles, 2**27))


@pytest.mark.parametrize(
    ("extenders", "kind"),
    [
        (5, TypeError),
        (0.5, TypeError),
        (np.array(0.5), TypeError),
        (object(), TypeError),
        ([3], TypeError),
        ([(0, 1, 10**400)], ValueError),
        ([(0, 1)], ValueError),
    ],
)
def test_extenders_that_are_no_triples(extenders, kind):
    with pytest.raises(kind, match="vertex, vertex, strength"):
        sc.parameterize(*disk(), extenders=extenders)


def test_numbers_that_no_float_holds():
    vertices, triangles = disk()
    with pytest.raises(ValueError, match="pins must map"):
        sc.parameterize(vertices, triangles, method="lscm", pins={0: (10**400, 0)})
    with pytest.raises(ValueError, match="max_length"):
        sc.suggest_seams(vertices, *meshes.polygons(triangles), max_length=10**400)
    assert len(sc.suggest_seams(vertices, *meshes.polygons(triangles), max_length=math.inf).seam_edges) >= 0


def test_masked_values_are_not_taken_for_values():
    vertices, triangles = disk()
    masked = np.ma.masked_array(vertices, np.zeros(vertices.shape, bool))
    assert sc.parameterize(masked, triangles).message == ""
    masked[3, 0] = np.ma.masked
    with pytest.raises(ValueError, match="vertices has masked values"):
        sc.parameterize(masked, triangles)


def test_indices_that_change_after_the_call_do_no_harm():
    vertices, triangles = disk()
    offsets, corners = (array.astype(np.int32) for array in meshes.polygons(triangles))
    unwrapper = sc.Unwrapper(vertices, offsets, corners)
    expected = unwrapper.solve().uv
    corners[:] = 2**31 - 1
    offsets[:] = -5
    assert np.array_equal(unwrapper.solve().uv, expected)


def test_unaligned_and_byte_swapped_arrays_are_values_like_others():
    vertices, triangles = disk()
    expected = sc.parameterize(vertices, triangles).uv
    raw = np.zeros(vertices.nbytes + 1, np.uint8)
    unaligned = raw[1:].view(float).reshape(vertices.shape)
    unaligned[...] = vertices
    for same in (unaligned, vertices.astype(">f8"), np.asfortranarray(vertices)):
        assert np.array_equal(sc.parameterize(same, triangles.astype(">u8")).uv, expected)


@pytest.mark.parametrize("unit", [1e-99, 1e-50, 1e50, 1e98])
def test_every_unit_in_which_areas_are_doubles(unit):
    vertices, triangles = disk()
    expected = sc.parameterize(vertices, triangles, weights="inverse_area")
    solution = sc.parameterize(unit * vertices, triangles, weights="inverse_area")
    assert np.allclose(solution.uv / unit, expected.uv, atol=1e-9)
    assert np.isfinite(solution.eigenvalue)
    assert solution.eigenvalue > 0


@pytest.mark.parametrize("unit", [1e-300, 1e-160, 1e-110, 1e110, 1e155, 1e307])
def test_units_in_which_areas_or_eigenvalues_are_no_doubles(unit):
    vertices, triangles = disk()
    with pytest.raises(sc.InvalidMeshError, match="no extent that double precision can hold"):
        sc.parameterize(unit * vertices, triangles)
    (chart,) = sc.unwrap(unit * vertices, *meshes.polygons(triangles)).charts
    assert (chart.status, "rescale" in chart.message) == ("failed", True)


@pytest.mark.parametrize(("unit", "image_unit"), [(1e-300, 1), (1e-200, 1e200), (1e155, 1e-170), (1e307, 1e307)])
def test_distortion_is_measured_in_every_unit(unit, image_unit):
    vertices, triangles = disk()
    uv = sc.parameterize(vertices, triangles).uv
    expected = sc.distortion(vertices, triangles, uv)
    # A vertex that no triangle uses has no influence.
    scaled = sc.distortion(np.r_[unit * vertices, [[1e308] * 3]], triangles, np.r_[image_unit * uv, [[1e308, 0]]])
    assert np.allclose(scaled.qc, expected.qc)
    assert scaled.mean_qc == pytest.approx(expected.mean_qc)
    assert np.allclose(scaled.log2_scale - expected.log2_scale, math.log2(image_unit) - math.log2(unit))
    assert scaled.log2_scale_deviation == pytest.approx(expected.log2_scale_deviation)
    assert np.array_equal(scaled.flipped, expected.flipped)
    assert np.array_equal(scaled.overlapping, expected.overlapping)
    assert scaled.turning_number == expected.turning_number


@pytest.mark.parametrize("unit", [1e-300, 1e-160, 1e155, 1e307])
def test_metrics_are_found_in_every_unit(unit):
    vertices, triangles = disk()
    uv = vertices[:, :2] @ [[1, 0.3], [0, 2]]

    def shape(metric):
        return metric / np.sqrt(np.linalg.det(metric))[:, None, None]

    expected = shape(sc.metric_from_uv(vertices, triangles, uv))
    assert np.allclose(shape(sc.metric_from_uv(unit * vertices, triangles, uv / unit)), expected)
    assert np.allclose(
        sc.metric_from_direction(unit * vertices, triangles, [1, 0, 0], 2),
        sc.metric_from_direction(vertices, triangles, [1, 0, 0], 2),
    )


def test_equal_pins_that_rounding_sets_apart():
    # The mean of two equal denormal numbers is another one; found by libFuzzer.
    place = (-4.625, 4.02594e-310)
    with pytest.raises(sc.InvalidMeshError, match="same position"):
        sc.parameterize(*disk(), method="lscm", pins={0: place, 7: place})


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"vertices": np.zeros((4, 2))}, ValueError, "vertices must have the shape"),
        ({"vertices": np.zeros((4, 3), complex)}, TypeError, "real numbers"),
        ({"vertices": None}, TypeError, "vertices must be an array, not NoneType"),
        ({"faces": "faces.obj"}, TypeError, "faces must"),
        ({"vertices": [["a"] * 3] * 4}, TypeError, "real numbers"),
        ({"vertices": [[0, 0, 0], [1, 0]]}, ValueError, "vertices is not a regular array"),
        ({"faces": [[0, 1, 4]]}, ValueError, "has the vertex 4"),
        ({"faces": [[0, 1, -1]]}, ValueError, "between 0"),
        ({"faces": [[0, 1, 2**40]]}, ValueError, "between 0"),
        ({"faces": [[0.0, 1.0, 2.0]]}, TypeError, "integers"),
        ({"faces": np.arange(3)}, ValueError, "shape"),
        ({"faces": 3}, TypeError, "faces must be vertices"),
        ({"faces": ["abc", "def"]}, TypeError, "faces must hold integers"),
        ({"area_blend": True}, TypeError, "area_blend must be a number between 0 and 1, not True"),
        ({"constraints": sc.Constraints(vertical=5)}, TypeError, "vertical must be a sequence"),
        ({"constraints": sc.Constraints(slanted=[5])}, TypeError, "slanted must hold pairs"),
        ({"constraints": sc.Constraints(slanted=[([0, 1], "x")])}, TypeError, "angle"),
        ({"constraints": sc.Constraints(equations="x")}, TypeError, "equations must be an array"),
        ({"constraints": sc.Constraints(held=[["x", 0]])}, TypeError, "held must hold real numbers"),
        ({"extenders": [(0, 1, "2")]}, TypeError, "extenders must be"),
        ({"progress": 3}, TypeError, "progress must be callable"),
        ({"pins": [(0, (0, 0))]}, TypeError, "pins must map"),
        ({"pins": {0.5: (0, 0), 1: (1, 0)}}, TypeError, "pins must map"),
        ({"pins": {0: (0, 0, 0), 1: (1, 0)}}, ValueError, "pins must map"),
        ({"pins": {0: ("0", 0), 1: (1, 0)}}, TypeError, "pins must map"),
        ({"pins": {0: (0, 0), 9: (1, 0)}}, ValueError, "Vertex 9 is pinned"),
        ({"pins": {0: (0, 0), 1: (np.nan, 0)}}, ValueError, "not finite"),
        ({"pins": {0: (1, 1), 1: (1, 1)}}, ValueError, "same position"),
    ],
)
def test_bad_arguments_of_a_patch_are_named(arguments, kind, said):
    arguments = {"vertices": SQUARE, "faces": [[0, 1, 2], [0, 2, 3]], **arguments}
    with pytest.raises(kind, match=said):
        sc.parameterize(**arguments)


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"faces": []}, ValueError, "faces is empty"),
        ({"faces": [0], "corner_vertices": []}, ValueError, "no faces"),
        ({"faces": [0, 3]}, ValueError, "faces, as offsets, must rise"),
        ({"faces": [1, 4]}, ValueError, "faces, as offsets, must rise"),
        ({"faces": [0, 5, 4]}, ValueError, "faces, as offsets, must rise|between"),
        ({"corner_vertices": [0, 1, 2, 9]}, ValueError, "has the vertex 9"),
        ({"seam_edges": [[0, 9]]}, ValueError, "seam_edges has the vertex 9"),
        ({"seam_edges": [0, 1]}, ValueError, "seam_edges must have the shape"),
        ({"selected_faces": [True, False]}, ValueError, "selected_faces must be 1 booleans"),
        ({"selected_faces": [1]}, TypeError, "booleans"),
        ({"fixed": [True]}, ValueError, "fixed must be"),
        ({"fixed": np.ones(0, bool)}, ValueError, "fixed must be"),
    ],
)
def test_bad_arguments_of_a_polygon_mesh_are_named(arguments, kind, said):
    arguments = {"faces": [0, 4], "corner_vertices": [0, 1, 2, 3], **arguments}
    with pytest.raises(kind, match=said):
        sc.unwrap(SQUARE, **arguments)


@pytest.mark.parametrize("kind", [float, object, str, "M8[s]", [("x", "f8"), ("y", "i4")]])
def test_no_indices_are_none_whatever_their_type(kind):
    none = np.zeros(0, kind)
    result = sc.unwrap(SQUARE, [0, 4], np.arange(4), seam_edges=none.reshape(0, 2))
    assert result.charts[0].status == "solved"
    with pytest.raises(ValueError, match="The mesh has no faces"):
        sc.unwrap(SQUARE, [0], none)


@pytest.mark.parametrize(
    ("margin", "kind"), [("x", TypeError), (None, TypeError), (-1, ValueError), (np.nan, ValueError)]
)
def test_a_bad_margin_is_named(margin, kind):
    with pytest.raises(kind, match="margin must be a number of at least 0"):
        sc.pack(sc.unwrap(SQUARE, [[0, 1, 2, 3]]), margin=margin)


@pytest.mark.parametrize("sizes", [[[1.0, -1.0]], [[np.nan, 1.0]], [[np.inf, 1.0]], [[1.0, 2.0, 3.0]], [1.0, 2.0]])
def test_sizes_of_boxes_that_are_none(sizes):
    with pytest.raises(ValueError, match="sizes"):
        sc.hosts.pack_boxes(sizes)


def test_the_package_has_no_names_but_the_public_ones():
    names = {name for name, value in vars(sc).items() if not name.startswith("_") and not isinstance(value, ModuleType)}
    assert names == set(sc.__all__) - {"defaults", "hosts"}
