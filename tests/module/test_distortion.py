import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes, reference


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
