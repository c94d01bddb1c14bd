"""Quasi-conformal maps (section 4.3) and the blend from angles to areas."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes


def quasi_conformal_images(uv):
    """Smooth maps of the plane, applied to a map."""
    x, y = (uv / np.abs(uv).max()).T
    yield np.c_[1.7 * x + 0.3 * y, 0.6 * y]
    yield np.c_[x + 0.2 * np.sin(2 * y) + 0.1 * x * y, 1.5 * y + 0.2 * np.cos(2 * x)]
    yield np.c_[1.3 * np.sinh(x) * np.cos(0.6 * y), np.cosh(x) * np.sin(0.6 * y)]


@pytest.mark.parametrize("holes", [0, 3])
@pytest.mark.parametrize("weights", ["uniform", "inverse_area"])
def test_the_metric_of_a_map_gives_it_back(holes, weights):
    vertices, triangles = meshes.bumpy_disk(1500, holes)
    for image in quasi_conformal_images(sc.parameterize(vertices, triangles).uv):
        assert not sc.distortion(vertices, triangles, image).flipped.any()
        metric = sc.metric_from_uv(vertices, triangles, image)
        solution = sc.parameterize(vertices, triangles, metric=metric, weights=weights)
        assert meshes.similarity_deviation(solution.uv, image) < 1e-9
        # The scale of the tensors is without effect, and so is which corner of a triangle comes first.
        scales = np.random.default_rng(1).uniform(0.1, 10, len(triangles))
        scaled = sc.parameterize(vertices, triangles, metric=metric * scales[:, None, None], weights=weights)
        assert meshes.similarity_deviation(scaled.uv, image) < 1e-9
        turned = np.roll(triangles, 1, axis=1)
        again = sc.parameterize(vertices, turned, metric=sc.metric_from_uv(vertices, turned, image), weights=weights)
        assert meshes.similarity_deviation(again.uv, image) < 1e-9


def test_the_tensor_is_that_of_the_jacobian():
    vertices = np.array([[1.0, 2.0, 3.0], [4.0, 2.0, 3.0], [2.0, 2.0, 5.0]])
    uv = np.array([[0.0, 0.0], [6.0, 3.0], [1.0, 4.0]])
    # The first axis is x, the second z, so that J maps (3, 0) to (6, 3) and (1, 2) to (1, 4).
    jacobian = np.array([[6, 1], [3, 4]]) @ np.linalg.inv(np.array([[3, 1], [0, 2]]))
    metric = sc.metric_from_uv(vertices, [[0, 1, 2]], uv)
    np.testing.assert_allclose(metric, [jacobian.T @ jacobian], rtol=1e-14)


def test_a_direction_and_a_ratio_stretch_the_map():
    vertices, triangles = meshes.random_disk(400)
    direction = np.array([3.0, 4.0, 0.0])
    metric = sc.metric_from_direction(vertices, triangles, direction, 2.5)
    np.testing.assert_allclose(np.linalg.eigvalsh(metric), np.tile([1, 6.25], (len(triangles), 1)), rtol=1e-12)
    along = vertices[:, :2] @ [0.6, 0.8]
    across = vertices[:, :2] @ [-0.8, 0.6]
    solution = sc.parameterize(vertices, triangles, metric=metric)
    assert meshes.similarity_deviation(solution.uv, np.c_[2.5 * along, across]) < 1e-9
    # One direction and ratio per triangle, out of the plane too, and of any length.
    n = len(triangles)
    tilted = np.tile(direction, (n, 1)) * np.linspace(0.1, 10, n)[:, None] + [0, 0, 7.0]
    np.testing.assert_allclose(
        sc.metric_from_direction(vertices, triangles, tilted, np.full(n, 2.5)), metric, rtol=1e-9, atol=1e-9
    )
    np.testing.assert_array_equal(
        sc.metric_from_direction(vertices, triangles, [0, 0, 1], 2.5), np.tile(np.eye(2), (n, 1, 1))
    )


def test_unwrap_takes_the_area_blend_and_metrics_of_polygons():
    vertices, quads = meshes.bulge(31, 1.5)
    offsets, corners = meshes.polygons(quads)
    plain = sc.unwrap(vertices, offsets, corners)
    blended = sc.unwrap(vertices, offsets, corners, area_blend=1.0)
    assert blended.charts[0].flipped == 0
    assert blended.charts[0].mean_qc > plain.charts[0].mean_qc
    flat, flat_quads = meshes.bulge(9, 0.0)
    offsets, corners = meshes.polygons(flat_quads)
    stretched = np.tile(np.diag([9.0, 1.0, 1.0]), (len(flat_quads), 1, 1))
    result = sc.unwrap(flat, offsets, corners, metric=stretched)
    assert meshes.similarity_deviation(result.uv, flat[corners][:, :2] * [3, 1]) < 1e-9
    assert result.charts[0].mean_qc == pytest.approx(3.0)
    # Triangles may also have tensors in their planes.
    triangles = meshes.triangles_of(flat_quads)
    offsets, corners = meshes.polygons(triangles)
    metric = sc.metric_from_direction(flat, triangles, [1, 0, 0], 3.0)
    result = sc.unwrap(flat, offsets, corners, metric=metric)
    assert meshes.similarity_deviation(result.uv, flat[corners][:, :2] * [3, 1]) < 1e-9


@pytest.mark.parametrize(
    ("metric", "message"),
    [
        (np.zeros((3, 2, 2)), "not positive definite"),
        (np.tile(np.eye(2), (3, 1, 1)), "metric has 3 tensors"),
        (np.eye(2), "shape"),
        (np.full((3, 2, 2), np.nan), "not finite"),
        (np.tile([[1.0, 0.5], [0.0, 1.0]], (3, 1, 1)), "symmetric"),
        (np.tile([[1.0, 2.0], [2.0, 1.0]], (3, 1, 1)), "metric of triangle 0 is not positive definite"),
    ],
)
def test_bad_metrics_are_named(metric, message):
    vertices, triangles = meshes.bumpy_disk(100)
    with pytest.raises(ValueError, match=message):
        sc.parameterize(vertices, triangles, metric=metric)


def test_bad_input_of_the_helpers_is_named():
    vertices, triangles = meshes.bumpy_disk(100)
    uv = sc.parameterize(vertices, triangles).uv
    collapsed = uv.copy()
    collapsed[triangles[4]] = uv[triangles[4][0]]
    with pytest.raises(ValueError, match="has no area"):
        sc.metric_from_uv(vertices, triangles, collapsed)
    with pytest.raises(ValueError, match="uv has 3 rows"):
        sc.metric_from_uv(vertices, triangles, uv[:3])
    with pytest.raises(ValueError, match="directions must be finite and not zero"):
        sc.metric_from_direction(vertices, triangles, [0, 0, 0], 2.0)
    with pytest.raises(ValueError, match="ratios must lie between"):
        sc.metric_from_direction(vertices, triangles, [1, 0, 0], -2.0)
    with pytest.raises(ValueError, match="directions must have the shape"):
        sc.metric_from_direction(vertices, triangles, np.ones((5, 3)), 2.0)
    with pytest.raises(ValueError, match="amount must lie between 0 and 1"):
        sc.blend_metric(sc.metric_from_uv(vertices, triangles, uv), 2.0)
    with pytest.raises(ValueError, match=r"shape \(n, 3, 3\)"):
        sc.unwrap(*_quad(), metric=np.tile(np.eye(2), (1, 1, 1)))


def _quad():
    return np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float), [0, 4], [0, 1, 2, 3]
