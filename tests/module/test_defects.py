import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes


def test_agrees_with_distortion_on_triangles():
    vertices, triangles = meshes.random_disk(300)
    uv = vertices[:, :2] + np.random.default_rng(0).normal(scale=0.015, size=(len(vertices), 2))
    uv[:, 0] *= -1.0
    measured = sc.distortion(vertices, triangles, uv)
    offsets, corners = meshes.polygons(triangles)
    defects = meshes.defects(offsets, corners, uv[corners])
    assert 0 < measured.flipped.sum() < len(triangles) / 4
    assert np.array_equal(defects.flipped, measured.flipped)
    assert np.array_equal(defects.overlapping, measured.overlapping)


def test_a_clean_unwrap_has_none_also_in_single_precision():
    vertices, quads = meshes.saddle_quads(40)
    offsets, corners = meshes.polygons(quads)
    uv = sc.unwrap(vertices, offsets, corners).uv
    for precision in (np.float64, np.float32):
        defects = meshes.defects(offsets, corners, uv.astype(precision), between_islands=True)
        assert not defects.flipped.any()
        assert not defects.overlapping.any()


def mixed_polygons(rng):
    """Triangles, quads and pentagons of a grid with a noisy map, as a list of corner lists and (V, 2) images."""
    n = 9
    faces = []
    for a, b, c, d in meshes.grid_quads(n, n).tolist():
        kind = rng.integers(3)
        if kind == 0:
            faces += [[a, b, c], [a, c, d]]
        else:
            faces.append([a, b, c, d])
    # Pentagons: triangles merged with the quads before them, where they share an edge.
    for i in range(len(faces) - 2, -1, -1):
        quad, triangle = faces[i], faces[i + 1]
        shared = [v for v in quad if v in triangle]
        if len(quad) == 4 and len(triangle) == 3 and len(shared) == 2:
            (apex,) = set(triangle) - set(shared)
            at = next(k for k in range(4) if {quad[k], quad[(k + 1) % 4]} == set(shared))
            faces[i : i + 2] = [quad[: at + 1] + [apex] + quad[at + 1 :]]
    vertices = np.stack(np.meshgrid(np.arange(n), np.arange(n), indexing="ij"), axis=-1).reshape(-1, 2)
    return faces, vertices + rng.normal(scale=0.35, size=vertices.shape)


@pytest.mark.parametrize("seed", range(20))
def test_order_winding_and_mirroring_do_not_matter(seed):
    rng = np.random.default_rng(seed)
    faces, image = mixed_polygons(rng)
    assert {len(face) for face in faces} == {3, 4, 5}
    offsets, corners = meshes.polygons(faces)
    for between in (False, True):
        expected = meshes.defects(offsets, corners, image[corners], between_islands=between)
        assert 0 < expected.flipped.sum() < len(faces) / 2
        assert (expected.overlapping | ~expected.flipped).sum() > 0.8 * len(faces)
        order = rng.permutation(len(faces))
        changed = [list(np.roll(faces[i], rng.integers(5)))[:: rng.choice([-1, 1])] for i in order]
        offsets_changed, corners_changed = meshes.polygons(changed)
        uv = 2.0 * image[corners_changed] * [-1.0, 1.0]
        found = meshes.defects(offsets_changed, corners_changed, uv, between_islands=between)
        assert np.array_equal(found.flipped, expected.flipped[order])
        assert np.array_equal(found.overlapping, expected.overlapping[order])


@pytest.mark.parametrize("seed", range(30))
def test_arbitrary_arrays_are_answered_or_refused(seed):
    rng = np.random.default_rng(seed)
    sizes = rng.integers(0, 8, size=rng.integers(1, 60))
    offsets = np.r_[0, np.cumsum(sizes)]
    corners = rng.integers(0, rng.integers(1, 30), size=offsets[-1])
    scale = 10.0 ** rng.integers(-300, 300) if seed % 3 else 1.0
    uv = scale * rng.integers(-3, 4, size=(len(corners), 2)).astype(float)
    defects = meshes.defects(offsets, corners, uv, between_islands=bool(seed % 2))
    assert defects.flipped.shape == defects.overlapping.shape == sizes.shape
    assert not defects.overlapping[sizes < 3].any()
    if len(corners):
        uv[rng.integers(len(corners))] = rng.choice([np.nan, np.inf, -np.inf])
        with pytest.raises(sc.InvalidMeshError, match="is not finite"):
            meshes.defects(offsets, corners, uv)


@pytest.mark.parametrize(
    ("arguments", "kind", "said"),
    [
        ({"uv": [[0, 0], [1, 0], [np.nan, 1]]}, ValueError, r"corner 2 \(face 0\) is not finite"),
        ({"uv": [[0, 0], [1, 0]]}, ValueError, r"one row per corner, not \(2, 2\)"),
        ({"uv": [0, 1, 2]}, ValueError, "uv must have the shape"),
        ({"uv": None}, ValueError, "The mesh has no map"),
        ({"faces": []}, ValueError, "faces is empty"),
        ({"faces": [0, 2]}, ValueError, "faces, as offsets, must rise"),
        ({"corner_vertices": [0, 1, -2]}, ValueError, "corner_vertices must lie between"),
        ({"corner_vertices": [0, 1, 2**31 - 1]}, ValueError, "has the vertex 2147483647"),
        ({"corner_vertices": [0, 1, 2**31]}, ValueError, "corner_vertices must lie between"),
        ({"selected_faces": [True, False]}, ValueError, "selected_faces must be 1 booleans"),
        ({"between_islands": 1}, TypeError, "between_islands must be"),
    ],
)
def test_bad_arguments_are_named(arguments, kind, said):
    good = {"faces": [0, 3], "corner_vertices": [0, 1, 2], "uv": [[0, 0], [1, 0], [0, 1]]}
    given = {**good, **arguments}
    options = {name: given.pop(name) for name in set(given) - set(good)}
    with pytest.raises(kind, match=said):
        sc.map_defects(sc.Mesh(np.zeros((3, 3)), **given), **options)
