import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes, reference


def test_affine_map_has_the_ratio_of_its_singular_values():
    flat, triangles = meshes.random_disk(300)
    vertices = flat @ meshes.random_rotation(2).T
    uv = flat[:, :2] @ np.array([[3.0, 1.0], [0.5, 2.0]])
    large, small = np.linalg.svd(np.array([[3.0, 1.0], [0.5, 2.0]]), compute_uv=False)
    measured = sc.distortion(vertices, triangles, uv)
    assert np.allclose(measured.qc, large / small)
    assert measured.mean_qc == pytest.approx(large / small)
    assert np.allclose(measured.log2_scale, np.log2(large * small) / 2)
    assert measured.log2_scale_deviation == pytest.approx(0, abs=1e-9)
    assert not measured.flipped.any()
    assert not measured.overlapping.any()
    assert measured.turning_number == 1


def test_agrees_with_singular_value_decomposition():
    vertices, triangles = meshes.bumpy_disk(1000, 4)
    uv = vertices[:, :2] + 0.1 * np.sin(5 * vertices[:, 1::-1])
    qc, area = reference.quasi_conformal_distortion(vertices, triangles, uv)
    measured = sc.distortion(vertices, triangles, uv)
    assert np.allclose(measured.qc, qc)
    assert measured.mean_qc == pytest.approx((qc * area).sum() / area.sum())
    assert measured.max_qc == pytest.approx(qc.max())
    assert measured.p95_qc == pytest.approx(np.percentile(qc, 95))
    assert measured.p99_qc == pytest.approx(np.percentile(qc, 99))
    mean = (measured.log2_scale * area).sum() / area.sum()
    variance = ((measured.log2_scale - mean) ** 2 * area).sum() / area.sum()
    assert measured.log2_scale_deviation == pytest.approx(np.sqrt(variance))


def test_flipped_triangle_is_found_whatever_the_winding():
    vertices, triangles = meshes.random_disk(200)
    inner = np.setdiff1d(np.arange(len(vertices)), reference.outer_loop(vertices, triangles))[0]
    uv = vertices[:, :2].copy()
    uv[inner] += 0.5
    expected = sc.distortion(vertices, triangles, uv).flipped
    corners = uv[triangles] @ [1, 1j]
    negative = ((corners[:, 1] - corners[:, 0]).conj() * (corners[:, 2] - corners[:, 0])).imag < 0
    assert negative.any()
    assert np.array_equal(expected, negative)
    mixed = triangles.copy()
    mixed[::3] = mixed[::3, ::-1]
    assert np.array_equal(sc.distortion(vertices, mixed, uv).flipped, negative)
    mirrored = sc.distortion(vertices, triangles, uv * [1, -1])
    assert np.array_equal(mirrored.flipped, negative)
    assert mirrored.turning_number == -1


def test_turning_number_of_a_map_that_winds_twice():
    vertices, triangles = meshes.random_disk(2000)
    z = (vertices[:, :2] @ [1, 1j]) ** 2
    measured = sc.distortion(vertices, triangles, np.c_[z.real, z.imag])
    assert measured.turning_number == 2
    assert measured.flipped.sum() <= 3  # what a count of flips does not see
    assert measured.overlapping.mean() > 0.9


def test_overlap_of_two_parts_that_share_nothing():
    vertices, quads = meshes.saddle_quads(12)
    triangles = np.r_[quads[:, :3], quads[:, [0, 2, 3]]]
    angle = 7 * vertices[:, 0]  # rolls the strip up past itself: 14 radians at radius 3 to 5
    uv = (4 + vertices[:, 1])[:, None] * np.c_[np.sin(angle), -np.cos(angle)]
    measured = sc.distortion(vertices, triangles, uv)
    assert not measured.flipped.any()
    assert measured.overlapping.mean() > 0.9
    angle = 3 * vertices[:, 0]
    uv = (4 + vertices[:, 1])[:, None] * np.c_[np.sin(angle), -np.cos(angle)]
    assert not sc.distortion(vertices, triangles, uv).overlapping.any()


def test_collapsed_and_degenerate_triangles():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [2, 0, 0.0]])
    triangles = [[0, 1, 2], [1, 3, 2], [1, 4, 0]]  # the last has no area in 3D
    measured = sc.distortion(vertices, triangles, [[0, 0], [1, 0], [0, 1], [1, 0], [2, 0]])
    assert measured.qc[0] == pytest.approx(1)
    assert np.isinf(measured.qc[1])
    assert measured.qc[2] == 1
    assert measured.log2_scale[2] == 0
    assert measured.max_qc == np.inf


def test_bad_arguments_are_named():
    vertices, triangles = meshes.random_disk(50)
    with pytest.raises(ValueError, match="uv has"):
        sc.distortion(vertices, triangles, np.zeros((3, 2)))
    with pytest.raises(ValueError, match="not finite"):
        sc.distortion(vertices, triangles, np.full((len(vertices), 2), np.nan))
    with pytest.raises(ValueError, match="vertices has values that are not finite"):
        sc.distortion(vertices * np.nan, triangles, vertices[:, :2])
    with pytest.raises(ValueError, match="shape"):
        sc.distortion(vertices, triangles, vertices)
