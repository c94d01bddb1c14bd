# SPDX-License-Identifier: GPL-3.0-or-later
"""From polygon meshes to placed maps, with the real solver."""

import sys
from dataclasses import replace

import numpy as np
import pytest
import spectral_conformal
from spectral_unwrap.core import native
from spectral_unwrap.core.layout.placement import place
from spectral_unwrap.core.solve import solution as solving
from spectral_unwrap.core.solve.options import Options, Settings
from spectral_unwrap.core.solve.solution import find_too_small_faces, solve, solve_all
from spectral_unwrap.core.words import texts

from tests.core.polygon_meshes import grid, polygon_mesh

CUBE_VERTICES = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
CUBE_FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def separated_cube(**options):
    return polygon_mesh(
        CUBE_VERTICES, CUBE_FACES, [(face[i - 1], face[i]) for face in CUBE_FACES for i in range(4)], **options
    )


def test_corners_know_their_face():
    mesh = polygon_mesh(CUBE_VERTICES, [CUBE_FACES[0], CUBE_FACES[1][:3]])
    assert mesh.face_of_corner().tolist() == [0, 0, 0, 0, 1, 1, 1]


def test_every_selected_face_of_a_separated_cube_is_a_chart():
    mesh = separated_cube(selected=[True, False, True, True, False, True])
    solution = solve(mesh, Options())
    assert [chart.status for chart in solution.charts] == ["solved"] * 4
    assert sorted(set(solution.chart_of_corner.reshape(6, 4)[mesh.selected_faces].ravel())) == [0, 1, 2, 3]
    np.testing.assert_array_equal(solution.solved_corners.reshape(6, 4).all(axis=1), mesh.selected_faces)


def test_failed_chart_has_no_solved_corners():
    solution = solve(polygon_mesh(CUBE_VERTICES, CUBE_FACES), Options())
    assert not solution.solved_corners.any()
    assert [chart.status for chart in solution.charts] == ["failed"]
    assert solution.charts[0].message


def test_mesh_that_is_no_mesh_is_an_error_of_that_mesh():
    solution = solve(polygon_mesh(CUBE_VERTICES[:7], CUBE_FACES), Options())
    assert "vertex 7" in solution.error
    assert not solution.solved_corners.any()
    assert solution.uv.shape == (24, 2)


def test_cancelling_raises():
    with pytest.raises(spectral_conformal.Cancelled):
        solve(separated_cube(), Options(), progress=lambda _fraction, _phase: False)


def test_charts_of_all_meshes_are_placed_together_to_one_scale():
    meshes = [separated_cube(), separated_cube()]
    meshes[1].vertices[:] *= 0.5
    solutions = [solve(mesh, Options()) for mesh in meshes]
    faces = np.concatenate(place(meshes, solutions, Settings()).uv).reshape(12, 4, 2)
    sides = np.linalg.norm(faces[:, 1] - faces[:, 0], axis=1)
    np.testing.assert_allclose(sides[:6], sides[0])
    np.testing.assert_allclose(sides[6:], sides[0] / 2.0)
    low, high = faces.min(axis=1), faces.max(axis=1)
    for i in range(12):
        for j in range(i):
            assert (np.minimum(high[i], high[j]) < np.maximum(low[i], low[j])).any()


def test_kept_in_place_chart_by_chart():
    former = np.random.default_rng(0).random((24, 2))
    former[:4] = 0.0
    mesh = separated_cube(uv=former)
    placement = place([mesh], [solve(mesh, Options())], Settings(keep_in_place=True))
    assert placement.without_bounds == 1
    new, old = placement.uv[0].reshape(6, 4, 2)[1:], former.reshape(6, 4, 2)[1:]
    center = (new.min(axis=1) + new.max(axis=1)) / 2.0
    np.testing.assert_allclose(center, (old.min(axis=1) + old.max(axis=1)) / 2.0)
    room = np.ptp(old, axis=1).min(axis=1)
    np.testing.assert_allclose(np.ptp(new, axis=1).max(axis=1), room)


@pytest.fixture
def broken_bundle(tmp_path, monkeypatch):
    """Put a spectral_conformal that does not load beside the add-on's other parts."""
    (tmp_path / "spectral_conformal.py").write_text("import _compiled_for_another_platform")
    package = sys.modules["spectral_unwrap"]
    monkeypatch.setattr(package, "__path__", [*package.__path__, str(tmp_path)])
    native._name.cache_clear()
    yield
    native._name.cache_clear()


def test_missing_module_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "spectral_conformal", None)
    with pytest.raises(native.NativeModuleError, match="install the Spectral Unwrap package for this platform"):
        native.spectral_conformal()


def test_broken_bundled_module_is_not_passed_over(broken_bundle):
    with pytest.raises(native.NativeModuleError, match="_compiled_for_another_platform"):
        native.spectral_conformal()


def test_pin_that_is_no_place_is_none_beside_one_that_is():
    former = np.random.default_rng(0).random((24, 2))
    former[1] = np.nan
    pinned = np.zeros(24, dtype=bool)
    pinned[:2] = True
    mesh = replace(separated_cube(uv=former), pinned_corners=pinned)
    (uv,) = place([mesh], [solve(mesh, Options())], Settings()).uv
    assert np.isfinite(uv).all()
    np.testing.assert_allclose(uv[0], former[0])


def test_faces_that_single_precision_merges_are_those_that_shrink():
    # Squares in a row, each half as wide as the last.
    left = np.cumsum([0.0] + [0.5**k for k in range(30)])
    vertices = [(x, y, 0.0) for x in left for y in (0.0, 0.5 ** np.searchsorted(left, x))]
    faces = [(2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1) for k in range(30)]
    mesh = polygon_mesh(vertices, faces)
    solution = solve(mesh, Options())
    assert solution.charts[0].status == "solved"
    # As small in 3D, they lose nothing.
    assert solution.too_small_faces == 0
    even = polygon_mesh([(k // 2, k % 2, 0.0) for k in range(62)], faces)
    assert solve(even, Options()).too_small_faces == 0
    small = np.count_nonzero(0.5 ** np.arange(30) < 2.0**-21 * np.ptp(solution.uv, axis=0).max())
    found = find_too_small_faces(even, solution.uv, solution.chart_of_corner)
    assert abs(len(found) - small) <= 2
    assert small > 5
    np.testing.assert_array_equal(np.sort(found), np.arange(30 - len(found), 30))
    # Faces of no chart are none, and those of another chart have that one's size.
    chart = np.where(np.arange(120) < 60, -1, np.where(np.arange(120) < 88, 0, 1))
    np.testing.assert_array_equal(find_too_small_faces(even, solution.uv, chart), [])


def finger(rings):
    """A tube, closed at its end, of six faces a ring: its conformal map shrinks from ring to ring."""
    angles = np.arange(6) * np.pi / 3.0
    vertices = [(np.cos(a), np.sin(a), float(r)) for r in range(rings) for a in angles] + [(0.0, 0.0, rings - 0.5)]
    faces = [
        (6 * r + k, 6 * r + (k + 1) % 6, 6 * r + 6 + (k + 1) % 6, 6 * r + 6 + k)
        for r in range(rings - 1)
        for k in range(6)
    ]
    top = 6 * rings
    return polygon_mesh(vertices, faces + [(top - 6 + k, top - 6 + (k + 1) % 6, top) for k in range(6)])


def test_faces_that_single_precision_merges_are_counted_for_their_mesh():
    alone = solve(finger(20), Options())
    assert 6 <= alone.too_small_faces < len(alone.failed_islands)
    counts = [s.too_small_faces for s in solve_all([separated_cube(), finger(20), separated_cube()], Options())]
    assert counts == [0, alone.too_small_faces, 0]


def curved_patch(seed, **options):
    """A patch of 5 x 4 vertices, unlike that of another seed."""
    heights = np.random.default_rng(seed).random(20)
    return grid(4, 3, lambda _x, _y: heights, **{"uv": None, **options})


def degenerate(mesh, faces):
    """The mesh with some faces collapsed to edges, so that no chart can have them."""
    corners = mesh.corner_vertices.reshape(-1, 4).copy()
    corners[faces, 2:] = corners[faces, :2]
    return replace(mesh, corner_vertices=corners.ravel())


def batch():
    """Meshes of every kind that a batch can have, and among them some that cannot be joined."""
    uv = np.random.default_rng(5).random((48, 2))
    pins = np.arange(48) < 2
    not_finite = curved_patch(6)
    not_finite.vertices[3] = np.nan
    return [
        *(curved_patch(0), separated_cube(), polygon_mesh(CUBE_VERTICES, CUBE_FACES)),
        degenerate(curved_patch(1), [0]),
        curved_patch(2, selected=[k % 3 > 0 for k in range(12)]),
        replace(curved_patch(3, uv=uv), pinned_corners=pins, aspect=2.0),
        curved_patch(4, uv=uv),
        degenerate(separated_cube(), [2, 3]),
        replace(curved_patch(5), extenders=((0, 19, 5.0, 1.0), (0, 1, 0.5, 1.0))),
        *(curved_patch(12), not_finite, curved_patch(7), curved_patch(8, seams=[(6, 7), (7, 8)])),
        replace(curved_patch(9), stretch_direction=np.array([1.0, 0.0, 0.0])),
        *(curved_patch(10), degenerate(curved_patch(11), [4, 5])),
    ]


def assert_same(together, alone):
    np.testing.assert_array_equal(together.uv, alone.uv)
    np.testing.assert_array_equal(together.chart_of_corner, alone.chart_of_corner)
    np.testing.assert_array_equal(together.failed_islands, alone.failed_islands)
    assert (together.error, together.unused_extenders) == (alone.error, alone.unused_extenders)
    assert together.too_small_faces == alone.too_small_faces
    assert len(together.charts) == len(alone.charts)
    for chart, other in zip(together.charts, alone.charts):
        for name, value in vars(other).items():
            np.testing.assert_array_equal(getattr(chart, name), value, err_msg=name)


@pytest.mark.parametrize("options", [Options(), Options(soft_pins=10.0, polish="off"), Options(stretch=2.0)])
def test_meshes_of_a_batch_are_solved_as_if_alone(options):
    meshes = batch()
    for solution, mesh in zip(solve_all(meshes, options), meshes):
        assert_same(solution, solve(mesh, options))


def test_a_batch_calls_the_solver_once_but_for_meshes_with_constraints(monkeypatch):
    calls = []
    unwrap = spectral_conformal.unwrap

    def spy(mesh, **options):
        calls.append(len(mesh.vertices))
        return unwrap(mesh, **options)

    monkeypatch.setattr(spectral_conformal, "unwrap", spy)
    solve_all([curved_patch(k) for k in range(30)], Options())
    assert calls == [600]
    calls.clear()
    solve_all(batch(), Options())
    # What stands between two meshes with constraints, or with a vertex that is no place, goes together.
    assert calls == [20 + 8 + 8 + 20 + 20, 20, 20 + 8, 20, 20, 20, 20 + 20 + 20 + 20 + 20]


def test_a_refused_mesh_leaves_the_others_of_its_batch():
    refused = polygon_mesh(CUBE_VERTICES[:7], CUBE_FACES)
    first, second, third = solve_all([separated_cube(), refused, curved_patch(0)], Options())
    assert "vertex 7" in second.error
    assert_same(first, solve(separated_cube(), Options()))
    assert_same(third, solve(curved_patch(0), Options()))


def with_memory_for(n_vertices, monkeypatch):
    """Let the solver run out of memory if it gets more vertices than this."""
    unwrap = spectral_conformal.unwrap

    def limited(mesh, **options):
        if len(mesh.vertices) > n_vertices:
            raise MemoryError
        return unwrap(mesh, **options)

    monkeypatch.setattr(spectral_conformal, "unwrap", limited)


@pytest.mark.parametrize("constraints", [{}, {"extenders": ((0, 1, 0.5, 1.0),)}])
def test_a_mesh_too_large_for_the_memory_fails_alone(constraints, monkeypatch):
    # With constraints none is joined with others.
    meshes = [replace(mesh, **constraints) for mesh in (separated_cube(), curved_patch(0), separated_cube())]
    alone = solve(meshes[0], Options())
    with_memory_for(len(CUBE_VERTICES), monkeypatch)
    reported = []
    first, second, third = solve_all(meshes, Options(), lambda fraction, _phase: reported.append(fraction))
    assert_same(first, alone)
    assert_same(third, alone)
    assert second.error == texts.TOO_LITTLE_MEMORY_FOR_MESH
    assert not second.solved_corners.any()
    assert len(second.charts) == 0
    assert max(reported) == reported[-1] == pytest.approx(1.0)


def test_no_memory_for_any_mesh_is_that_error(monkeypatch):
    with_memory_for(0, monkeypatch)
    with pytest.raises(MemoryError):
        solve_all([separated_cube(), curved_patch(0)], Options())


def test_no_memory_for_all_in_one_mesh_is_no_error(monkeypatch):
    meshes = [curved_patch(k) for k in range(3)]
    alone = [solve(mesh, Options()) for mesh in meshes]
    with_memory_for(len(meshes[0].vertices), monkeypatch)
    for solution, expected in zip(solve_all(meshes, Options()), alone):
        assert_same(solution, expected)


def test_the_solver_gets_no_more_at_once_than_the_limit(monkeypatch):
    monkeypatch.setattr(solving, "_MAX_JOINED_CORNERS", 100)
    meshes = [curved_patch(k) for k in range(5)]
    reported = []
    solutions = solve_all(meshes, Options(), lambda fraction, _phase: reported.append(fraction))
    for solution, mesh in zip(solutions, meshes):
        assert_same(solution, solve(mesh, Options()))
    assert min(reported) == reported[0] == 0.0
    assert max(reported) == reported[-1] == pytest.approx(1.0)
