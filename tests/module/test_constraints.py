# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear constraints: met exactly, at the least conformal energy, and rejected if they contradict each other."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes, reference
from tests.module.meshes import triangles_of


def sheet(columns, rows, shape):
    """Quads, counterclockwise, over the parameters s and t in [0, 1]; vertex (i, j) is i * (rows + 1) + j."""
    points, quads = meshes.unit_square(columns + 1, rows + 1)
    return shape(*points.T), quads


def patch(columns, rows, shape):
    """The triangles of a sheet."""
    points, quads = sheet(columns, rows, shape)
    return points, triangles_of(quads)


def corners_of(columns, rows):
    last = columns * (rows + 1)
    return [0, last, last + rows, rows]


def quartered(vertices, quads):
    """Triangles that mirror each other if the quads do: a vertex in the middle of each."""
    middle = len(vertices) + np.arange(len(quads))
    triangles = np.concatenate([np.c_[quads[:, k], quads[:, (k + 1) % 4], middle] for k in range(4)])
    return np.r_[vertices, vertices[quads].mean(axis=1)], triangles


def wave(s, t):
    return np.c_[2 * s, t, 0.3 * np.sin(4 * s + 2 * t)]


def arch(s, t):
    """Symmetric about s = 1/2."""
    x = s - 0.5
    return np.c_[2 * x, t, 0.8 * t * np.cos(3 * x) - x**2]


def sector(angle, ratio):
    """Part of a flat ring; its conformal rectangle has the modulus angle / log(ratio)."""

    def shape(s, t):
        radius, turn = 1 + (ratio - 1) * t, angle * (1 - s)
        return np.c_[radius * np.cos(turn), radius * np.sin(turn), 0 * s]

    return shape


def size(uv):
    return np.ptp(uv, axis=0).max()


def test_what_the_free_map_meets_already_changes_nothing():
    vertices, triangles = quartered(*sheet(12, 8, arch))
    mirror = {tuple(np.round(v * [-1, 1, 1], 9) + 0.0): k for k, v in enumerate(vertices)}
    pairs = [(k, mirror[tuple(np.round(v, 9) + 0.0)]) for k, v in enumerate(vertices)]
    free = sc.parameterize(vertices, triangles)
    held = sc.parameterize(vertices, triangles, constraints=sc.Constraints(mirrored=pairs))
    assert held.eigenvalue == pytest.approx(free.eigenvalue, rel=1e-9)
    assert meshes.similarity_deviation(free.uv, held.uv) < 1e-9
    u, v = held.uv.T
    one, two = np.array(pairs).T
    assert np.array_equal(u[one], -u[two]) and np.array_equal(v[one], v[two])


def hill(middle, height, width):
    return lambda s, t: np.c_[s, t, height * np.exp(-((s - middle) ** 2 + (t - 0.5) ** 2) / (2 * width**2))]


# With their own metrics, the first is pinched (log2_scale_deviation 0.48), and the second winds around twice.
@pytest.mark.parametrize(("shape", "spread"), [((0.57, 0.5, 0.2), 0.35), ((0.57, 0.3, 0.12), 0.25)])
def test_the_cost_of_symmetry_is_shared_by_both_halves_and_pinches_neither(shape, spread):
    vertices, triangles = quartered(*sheet(16, 16, hill(*shape)))
    flat = quartered(*sheet(16, 16, hill(0.5, 0.0, 1.0)))[0][:, :2]
    index = {tuple(np.round(p, 9)): k for k, p in enumerate(flat)}
    image = np.array([index[tuple(np.round([1 - s, t], 9))] for s, t in flat])
    constraints = sc.Constraints(mirrored=[(k, int(j)) for k, j in enumerate(image) if k <= j])
    solver = sc.Solver(vertices, triangles)
    free = solver.solve().uv
    found = solver.solve(constraints=constraints)
    assert np.array_equal(solver.solve().uv, free)
    assert np.array_equal(sc.parameterize(vertices, triangles, constraints=constraints).uv, found.uv)
    # The ratio of the singular values between a triangle and its mirror image, K_1 K_2 of any mirrored map at least.
    corners = vertices[np.stack([triangles, image[triangles]])]
    sides = np.moveaxis(corners[:, :, 1:] - corners[:, :, :1], 2, 3)
    one, other = np.moveaxis(sides, 2, 3) @ sides
    eigenvalues = np.sort(np.linalg.eigvals(np.linalg.solve(one, other)).real, axis=1)
    least = np.average((eigenvalues[:, 1] / eigenvalues[:, 0]) ** 0.25, weights=np.sqrt(np.linalg.det(one)))
    distortion = sc.distortion(vertices, triangles, found.uv)
    assert 1.05 < least <= distortion.mean_qc < 1.01 * least
    assert distortion.log2_scale_deviation < spread
    # Held maps have the same energy: between the border of this one it is again this one.
    border = meshes.border_of(triangles, len(vertices))
    held = sc.parameterize(vertices, triangles, constraints=constraints, fixed=border, uv=found.uv)
    assert np.abs(held.uv - found.uv).max() < 1e-9 * size(found.uv)


def test_a_rectangle_has_the_modulus_of_the_conformal_map():
    errors = []
    for n in (6, 12, 24):
        vertices, quads = sheet(2 * n, n, sector(1.5, 2.0))
        constraints = sc.Constraints.rectangle(quads, corners_of(2 * n, n))
        uv = sc.parameterize(vertices, triangles_of(quads), constraints=constraints).uv
        low, high = uv.min(axis=0), uv.max(axis=0)
        width, height = high - low
        errors.append(abs(width / height / (1.5 / np.log(2.0)) - 1))
        border = np.unique(
            np.concatenate([np.ravel(side) for side in (*constraints.horizontal, *constraints.vertical)])
        )
        assert np.min(np.abs(np.c_[uv[border] - low, uv[border] - high]), axis=1).max() <= 1e-12 * size(uv)
    # Second order in the length of the edges.
    assert errors[2] < 1e-3 and errors[2] < errors[1] / 3 < errors[0] / 9


def test_a_rectangle_is_bounded_by_any_polygons_wound_alike():
    _, quads = sheet(3, 2, wave)
    sides = sc.Constraints.rectangle(quads, [0, 9, 11, 2])
    assert [list(side) for side in sides.horizontal] == [[0, 3, 6, 9], [11, 8, 5, 2]]
    assert [list(side) for side in sides.vertical] == [[9, 10, 11], [2, 1, 0]]
    for corners, words in (
        ([0, 9, 2, 11], "in the order"),
        ([0, 9, 11, 4], "not on the border"),
    ):
        with pytest.raises(sc.InvalidMeshError, match=words):
            sc.Constraints.rectangle(quads, corners)
    with pytest.raises(ValueError, match="four different"):
        sc.Constraints.rectangle(quads, [0, 9, 9, 11])
    with pytest.raises(sc.InvalidMeshError, match="several borders"):
        sc.Constraints.rectangle(np.delete(sheet(3, 3, wave)[1], 4, axis=0), [0, 12, 15, 3])


def test_rows_and_columns_of_a_grid_are_straight():
    vertices, quads = sheet(9, 6, wave)
    result = sc.parameterize(vertices, triangles_of(quads), constraints=sc.Constraints.grid(quads))
    u, v = result.uv.reshape(10, 7, 2).transpose(2, 0, 1)
    if np.ptp(u, axis=1).max() > np.ptp(v, axis=1).max():
        u, v = v.T, u.T
    assert np.ptp(u, axis=1).max() <= 1e-12 * size(result.uv) and np.ptp(v, axis=0).max() <= 1e-12 * size(result.uv)
    assert not sc.distortion(vertices, triangles_of(quads), result.uv).flipped.any()


def test_a_strip_is_a_grid_wherever_its_quads_begin():
    vertices, quads = sheet(9, 1, wave)
    quads = np.array([np.roll(quad, k) for k, quad in enumerate(quads)])
    result = sc.parameterize(vertices, triangles_of(quads), constraints=sc.Constraints.grid(quads))
    across = result.uv[0::2] - result.uv[1::2]
    assert (np.abs(across).min(axis=1) == 0).all()


def test_a_grid_has_four_quads_at_its_inner_vertices():
    quads = [[0, 1, 2, 3], [0, 3, 4, 5], [0, 5, 6, 1]]
    with pytest.raises(sc.InvalidMeshError, match="in a row and in a column"):
        sc.Constraints.grid(quads)
    with pytest.raises(ValueError, match=r"\(Q, 4\)"):
        sc.Constraints.grid([[0, 1, 2]])


def test_what_contradicts_itself_is_named():
    vertices, triangles = patch(6, 4, wave)
    with pytest.raises(sc.InvalidMeshError, match="vertices (5 and 10|10 and 5) of one edge"):
        sc.parameterize(vertices, triangles, constraints=sc.Constraints(horizontal=[[5, 10]], vertical=[[10, 5]]))
    with pytest.raises(sc.InvalidMeshError, match="all corners of the triangle"):
        sc.parameterize(vertices, triangles, constraints=sc.Constraints(vertical=[[0, 5, 6]]))
    with pytest.raises(sc.InvalidMeshError, match="one edge"):
        # Both ends on the axis, and level.
        pairs = [(5, 5), (10, 10)]
        sc.parameterize(vertices, triangles, constraints=sc.Constraints([[5, 10]], mirrored=pairs))
    with pytest.raises(sc.InvalidMeshError, match="one edge"):
        # Every coordinate is 0: nothing is left to choose.
        equations = [[(coordinate, 1)] + 3 * [(coordinate, 0)] for coordinate in range(2 * len(vertices))]
        sc.parameterize(vertices, triangles, constraints=sc.Constraints(equations=equations))


COLUMN, ROW = list(range(10)), [i * 10 for i in range(15)]
STRAIGHT = sc.Constraints(horizontal=[ROW], vertical=[COLUMN])


@pytest.mark.parametrize("options", [{}, {"polish": True}, {"fold_free": True}])
def test_fixed_vertices_hold_to_the_bit_and_constraints_hold_between_them(options):
    vertices, triangles = patch(14, 9, wave)
    free = sc.parameterize(vertices, triangles, constraints=STRAIGHT).uv
    uv = free * [1.3, 1.0] + [300.0, -7.0]
    fixed = [0, 5, 70, 130, 149]
    held = sc.parameterize(vertices, triangles, constraints=STRAIGHT, fixed=fixed, uv=uv, **options)
    assert (held.uv[fixed] == uv[fixed]).all()
    assert max(np.ptp(held.uv[ROW, 1]), np.ptp(held.uv[COLUMN, 0])) < 1e-12 * 300
    assert (held.method, held.steps) == ("lscm", ())
    assert (held.polish_steps > 0) == ("polish" in options)
    solver = sc.Solver(vertices, triangles)
    solver.solve(constraints=STRAIGHT, fixed=fixed, uv=free, **options)
    assert (solver.solve(constraints=STRAIGHT, fixed=fixed, uv=uv, **options).uv == held.uv).all()
    corners = triangles.ravel()
    by_corner = sc.Constraints(
        *([[int(np.flatnonzero(corners == v)[0]) for v in chain] for chain in chains] for chains in ([ROW], [COLUMN])),
        of="corners",
    )
    mesh = sc.Mesh(vertices, triangles, uv[triangles])
    for constraints in (by_corner, STRAIGHT):
        whole = sc.unwrap(mesh, constraints=constraints, fixed=np.isin(triangles, fixed), **options)
        assert (whole.uv == held.uv[corners]).all()
        assert whole.charts[0].method == "lscm"


def test_what_the_held_map_meets_anyway_changes_nothing():
    vertices, triangles = patch(14, 9, wave)
    # The least energy between the border of a map under constraints is that map.
    border = meshes.border_of(triangles, len(vertices))
    free = sc.parameterize(vertices, triangles, constraints=STRAIGHT).uv
    for target in (free, 3.0 * free + [5.0, 2.0]):
        held = sc.parameterize(vertices, triangles, constraints=STRAIGHT, fixed=border, uv=target)
        assert np.abs(held.uv - target).max() < 1e-9 * size(target)
    # All v of a held map, with its held vertices, leave its u.
    fixed = [0, 9, 75, 140]
    plain = sc.parameterize(vertices, triangles, fixed=fixed, uv=free * [1.3, 1.0])
    of_v = sc.Constraints(held=np.c_[2 * np.arange(len(vertices)) + 1, plain.uv[:, 1]])
    same = sc.parameterize(vertices, triangles, constraints=of_v, fixed=fixed, uv=free * [1.3, 1.0])
    assert np.abs(same.uv - plain.uv).max() < 1e-9 * size(plain.uv)
    assert (same.uv[:, 1] == plain.uv[:, 1]).all()


# With one position held, the springs alone give the size.
HELD = {"some": [0, 1, 40, 41, 77], "all of v": np.arange(1, 126, 2), "a vertex": [40, 41], "u and v": [7, 40]}


@pytest.mark.parametrize("held", HELD)
def test_soft_pins_are_springs_where_coordinates_are_held(held):
    vertices, quads = sheet(8, 6, wave)
    triangles, n = triangles_of(quads), len(vertices)
    uv = sc.parameterize(vertices, triangles).uv
    rows = np.array(HELD[held])
    given = uv.ravel()[rows] + 0.05 * np.sin(rows)
    pins = {9: uv[9] + [3.1, 0.2], 33: uv[33] + [2.8, -0.1], 60: uv[60] + [3.0, 0.3]}
    solver = sc.Solver(vertices, triangles)
    constraints = sc.Constraints(held=np.c_[rows, given])
    found = solver.solve(pins=pins, soft_pins=6.0, constraints=constraints)
    matrix = reference.conformal_energy_matrix(vertices, triangles).toarray()
    energy = np.empty((2 * n, 2 * n))
    energy[::2, ::2] = energy[1::2, 1::2] = matrix.real
    energy[1::2, ::2], energy[::2, 1::2] = matrix.imag, -matrix.imag
    springs = np.zeros(2 * n)
    target = np.zeros(2 * n)
    for vertex, position in pins.items():
        springs[[2 * vertex, 2 * vertex + 1]] = 6.0 / len(pins)
        target[[2 * vertex, 2 * vertex + 1]] = position
    free = np.setdiff1d(np.arange(2 * n), rows)
    x = np.zeros(2 * n)
    x[rows] = given
    total = energy + np.diag(springs)
    right = springs * target - total @ x
    x[free] = np.linalg.solve(total[np.ix_(free, free)], right[free])
    assert np.abs(found.uv.ravel() - x).max() < 1e-9
    assert (found.uv.ravel()[rows] == given).all()
    assert found.polish_steps == 0
    # Moved targets cost a solve on the kept factor.
    moved = {vertex: np.add(position, [0.5, 0.0]) for vertex, position in pins.items()}
    work = sc._native.counted_work(lambda: solver.solve(pins=moved, soft_pins=6.0, constraints=constraints))
    assert (work["analyses"], work["factorizations"]) == (0, 0)
    stronger = solver.solve(pins=pins, soft_pins=1e3, constraints=constraints).uv
    far = [max(abs(uv[v, 0] - pins[v][0]) for v in pins) for uv in (found.uv, stronger)]
    assert far[1] < 0.1 * far[0]


@pytest.mark.parametrize("pins", [None, {0: (5.0, 0.0)}])
def test_of_several_values_of_one_coordinate_the_first_holds_and_the_others_are_counted(pins):
    vertices, triangles = patch(14, 9, wave)
    kept = [(1, 0.0), (2 * 149, 3.0), (2 * 149 + 1, 2.0)]
    for first, second in ((1.0, 2.0), (2.0, 1.0)):
        held = sc.Constraints(held=[(0, first), (0, second), (0, second), *kept])
        found = sc.parameterize(vertices, triangles, constraints=held, pins=pins)
        # A pin comes before all of them.
        alone = sc.Constraints(held=[(0, first if pins is None else 5.0), *kept])
        np.testing.assert_allclose(found.uv, sc.parameterize(vertices, triangles, constraints=alone).uv, atol=1e-9)
        assert [(step.kind, step.count) for step in found.steps] == [("unmet_constraints", 2 if pins is None else 3)]


def test_constraints_that_held_vertices_contradict_are_left_out_and_counted():
    vertices, triangles = patch(14, 9, wave)
    free = sc.parameterize(vertices, triangles, constraints=STRAIGHT).uv
    uv = free.copy()
    uv[70] += [0.0, 0.2]
    found = sc.parameterize(vertices, triangles, constraints=STRAIGHT, fixed=[0, 70, 149], uv=uv)
    assert [step.kind for step in found.steps] == ["unmet_constraints"]
    assert found.steps[0].count == 1
    assert (found.uv[[0, 70, 149]] == uv[[0, 70, 149]]).all()
    assert np.ptp(found.uv[COLUMN, 0]) < 1e-12
    # The rounding of UVs in single precision contradicts nothing.
    rounded = free.astype(np.float32)
    assert not sc.parameterize(vertices, triangles, constraints=STRAIGHT, fixed=[0, 70, 149], uv=rounded).steps


def test_arguments_are_checked():
    vertices, triangles = patch(6, 4, wave)
    straight = sc.Constraints(vertical=[[0, 1, 2]])
    for changes, words in (
        ({"pins": {0: (0, 0), 9: (1, 1)}, "hole_rigidity": 0.1}, "a map that nothing holds"),
        ({"method": "lscm"}, "need the method 'spectral'"),
    ):
        with pytest.raises(sc.InvalidMeshError, match=words):
            sc.parameterize(vertices, triangles, constraints=straight, **changes)
    with pytest.raises(ValueError, match="vertical names vertex 99"):
        sc.parameterize(vertices, triangles, constraints=sc.Constraints(vertical=[[0, 99]]))
    for held, words in (([[0.0]], "shape"), ([[0.5, 1.0]], "whole"), ([[999, 1.0]], "coordinate that is not")):
        with pytest.raises(ValueError, match=words):
            sc.parameterize(vertices, triangles, constraints=sc.Constraints(held=held))
    with pytest.raises(TypeError, match="must be Constraints"):
        sc.parameterize(vertices, triangles, constraints=[[0, 1]])
    with pytest.raises(TypeError, match="lists of vertex indices"):
        sc.parameterize(vertices, triangles, constraints=sc.Constraints(vertical=[["a"]]))
    with pytest.raises(ValueError, match="pairs"):
        sc.parameterize(vertices, triangles, constraints=sc.Constraints(mirrored=[(1, 2, 3)]))
    assert np.array_equal(
        sc.parameterize(vertices, triangles, constraints=sc.Constraints(vertical=[[3]])).uv,
        sc.parameterize(vertices, triangles).uv,
    )


def test_soft_constraints_of_no_strength_change_nothing_and_solvers_keep_their_factor():
    vertices, triangles = patch(14, 9, wave)
    plain = sc.parameterize(vertices, triangles, constraints=STRAIGHT).uv
    solver = sc.Solver(vertices, triangles)
    extenders = [(0, 149, 2.0)]
    pushed = solver.solve(constraints=STRAIGHT, extenders=extenders)
    assert meshes.similarity_deviation(pushed.uv, plain) > 1e-3
    assert np.array_equal(solver.solve(constraints=STRAIGHT, extenders=[(0, 149, 0.0)]).uv, plain)
    done = sc._native.counted_work(lambda: solver.solve(constraints=STRAIGHT, extenders=extenders, tolerance=1e-4))
    assert (done["analyses"], done["factorizations"]) == (0, 0)
    # A pin moves the map, and two attract it.
    moved = sc.parameterize(vertices, triangles, constraints=STRAIGHT, pins={3: (7, 8)}, extenders=extenders)
    assert np.allclose(moved.uv - moved.uv[3], pushed.uv - pushed.uv[3], atol=1e-12) and (moved.uv[3] == [7, 8]).all()


def test_where_the_least_quotient_winds_the_map_nearest_to_the_free_one_is_taken():
    """On fine meshes other nearly conformal maps, which wind around, meet a row and a column at less energy."""
    vertices, triangles = patch(70, 39, wave)
    row, column = [i * 40 + 20 for i in range(71)], [35 * 40 + j for j in range(40)]
    crossing = sc.Constraints(horizontal=[row], vertical=[column])
    found = sc.parameterize(vertices, triangles, constraints=crossing, fallbacks=True)
    assert [step.kind for step in found.steps] == ["nearest_to_free"] and found.steps[0].count > 1
    assert max(np.ptp(found.uv[row, 1]), np.ptp(found.uv[column, 0])) < 1e-12 * size(found.uv)
    before = sc.distortion(vertices, triangles, found.uv)
    assert found.turning_number == 1 and not before.flipped.any() and before.mean_qc < 1.1
    polished = sc.parameterize(vertices, triangles, constraints=crossing, polish=True, fallbacks=True)
    assert sc.distortion(vertices, triangles, polished.uv).mean_qc < before.mean_qc
    with pytest.raises(sc.SolveError, match="winds around"):
        sc.parameterize(vertices, triangles, constraints=crossing)


def test_what_pulls_fold_under_straight_sides_is_refused_or_said():
    vertices, triangles = patch(20, 20, lambda s, t: np.c_[s, t, 0.6 * np.exp(-20 * ((s - 0.5) ** 2 + (t - 0.5) ** 2))])
    last = 20 * 21
    rectangle = sc.Constraints(
        horizontal=[np.arange(21) * 21, np.arange(21) * 21 + 20], vertical=[np.arange(21), last + np.arange(21)]
    )
    # Without straight sides the boundary would wind around three times.
    across = [(0, last + 20, -0.2)]
    said = r"folds over at \d{3} of its triangles: weaken or remove extenders"
    with pytest.raises(sc.SolveError, match=said) as caught:
        sc.parameterize(vertices, triangles, constraints=rectangle, extenders=across)
    assert caught.value.steps[-1].reason == "folded"
    pins = {8: (0.3, 2), 8 * 21: (2, 0.7), 12 * 21 + 15: (-1, 0)}
    pulled = {
        "extenders": {"constraints": rectangle, "extenders": [(200, 210, -5.0)]},
        "linear": {"constraints": rectangle, "pins": pins, "soft_pins": 10.0},
    }
    for constraint, options in pulled.items():
        found = sc.parameterize(vertices, triangles, **options)
        flipped = int(sc.distortion(vertices, triangles, found.uv).flipped.sum())
        assert flipped > 0, "choose a stronger pull"
        assert [(step.kind, step.count, step.constraint) for step in found.steps] == [("folds", flipped, constraint)]
        assert f"folds over at {flipped} of its triangles: " in found.message


def test_the_rigidity_of_holes_is_chosen_by_quality_as_without_constraints():
    vertices, triangles = meshes.bumpy_disk(600, holes=2)
    edge = triangles[5][:2].tolist()
    options = {"constraints": sc.Constraints(vertical=[edge])}
    free = sc.parameterize(vertices, triangles, **options)
    chosen = sc.parameterize(vertices, triangles, hole_rigidity="automatic", **options)
    alone = sc.parameterize(vertices, triangles, hole_rigidity="automatic")
    assert chosen.hole_rigidity == alone.hole_rigidity > 0.0
    qc = [sc.distortion(vertices, triangles, found.uv).mean_qc for found in (free, chosen)]
    assert qc[1] < qc[0]
    assert np.ptp(chosen.uv[edge, 0]) <= 1e-12 * size(chosen.uv)


def test_vertices_of_no_triangle_and_filled_holes():
    vertices, quads = sheet(8, 8, wave)
    quads = np.delete(quads, [27, 28, 35, 36], axis=0)
    vertices = np.r_[vertices, [[9.0, 9.0, 9.0]]]
    chain = list(range(9))
    for fill_holes in (False, True):
        result = sc.parameterize(
            vertices, triangles_of(quads), constraints=sc.Constraints(vertical=[chain]), fill_holes=fill_holes
        )
        assert np.ptp(result.uv[chain, 0]) <= 1e-12 * size(result.uv)


def test_result_does_not_depend_on_threads():
    vertices, quads = meshes.saddle_quads(60)
    chain = np.unique(quads.ravel())[:60].tolist()
    maps = []
    for threads in (1, 4):
        sc.limit_threads(threads)
        maps.append(sc.parameterize(vertices, triangles_of(quads), constraints=sc.Constraints(vertical=[chain])).uv)
    sc.limit_threads(0)
    assert np.array_equal(*maps)


def test_a_line_at_its_own_angle():
    vertices, quads = sheet(14, 9, wave)
    row = [i * 10 + 4 for i in range(15)]
    for angle in (0.0, 0.4, -1.3, np.pi / 2):
        uv = sc.parameterize(vertices, triangles_of(quads), constraints=sc.Constraints(slanted=[(row, angle)])).uv
        across = uv[row] @ [-np.sin(angle), np.cos(angle)]
        assert np.ptp(across) <= 1e-12 * size(uv)
    # One line leaves the map its rotation: its angle makes no difference to the shape.
    level = sc.parameterize(vertices, triangles_of(quads), constraints=sc.Constraints(horizontal=[row])).uv
    assert meshes.similarity_deviation(uv, level) < 1e-7
    with pytest.raises(ValueError, match="finite angle"):
        sc.parameterize(vertices, triangles_of(quads), constraints=sc.Constraints(slanted=[(row, np.nan)]))


def test_equations_of_ones_own():
    vertices, quads = sheet(9, 6, wave)
    # Columns of even width.
    even = [[(2 * 7 * (i - 1), 1), (2 * 7 * i, -2), (2 * 7 * (i + 1), 1), (0, 0)] for i in range(1, 9)]
    grid = sc.Constraints(
        horizontal=[[i * 7 + j for i in range(10)] for j in range(7)],
        vertical=[[i * 7 + j for j in range(7)] for i in range(10)],
    )
    result = sc.parameterize(vertices, triangles_of(quads), constraints=grid + sc.Constraints(equations=even))
    widths = np.diff(result.uv[::7, 0])
    assert np.ptp(widths) <= 1e-12 * size(result.uv) and widths.min() * widths.max() > 0
    for wrong in ([[(0, 1)]], [[(99999, 1)] * 4], [[(0.5, 1)] * 4], [[(0, np.inf)] * 4]):
        with pytest.raises(ValueError, match="equations"):
            sc.parameterize(vertices, triangles_of(quads), constraints=sc.Constraints(equations=wrong))


def test_unwrap_holds_constraints_on_corners_and_so_on_both_sides_of_a_seam():
    vertices, quads = sheet(12, 8, wave)
    seam = [(i * 9 + 4, (i + 1) * 9 + 4) for i in range(12)]
    corners = quads.ravel()
    following = np.roll(np.arange(len(corners)).reshape(-1, 4), -1, axis=1).ravel()
    on_seam = np.isin(
        np.sort(np.c_[corners, corners[following]], axis=1) @ [1000, 1], np.sort(seam, axis=1) @ [1000, 1]
    )
    chains = [[c, following[c]] for c in np.flatnonzero(on_seam).tolist()]
    assert len(chains) == 24
    kept = sc.hosts.KeptMaps()
    for _ in range(2):
        result = sc.unwrap(
            vertices,
            quads,
            seam_edges=seam,
            constraints=sc.Constraints(horizontal=chains, of="corners"),
            kept_maps=kept,
        )
        assert len(result.charts) == 2
        for chart in range(2):
            v = result.uv[[c for c in np.ravel(chains) if result.chart_of_face[c // 4] == chart], 1]
            assert len(v) == 24 and np.ptp(v) <= 1e-12 * size(result.uv)
    free = sc.unwrap(vertices, quads, seam_edges=seam, kept_maps=kept)
    assert np.ptp(free.uv[np.ravel(chains)[:2], 1]) > 0 and not any(chart.reused for chart in free.charts)
    again = sc.Unwrapper(
        vertices, quads, seam_edges=seam, constraints=sc.Constraints(horizontal=chains, of="corners")
    ).solve()
    assert np.array_equal(again.uv, result.uv)


def test_a_vertex_stands_for_its_one_uv_and_where_cuts_give_it_several_says_so():
    vertices, quads = sheet(12, 8, wave)
    seam = [(i * 9 + 4, (i + 1) * 9 + 4) for i in range(12)]
    chain = [2 * 9 + 1, 5 * 9 + 1, 9 * 9 + 2]
    corner = {int(v): c for c, v in enumerate(quads.ravel())}
    by_corner = sc.Constraints(horizontal=[[corner[v] for v in chain]], of="corners")
    by_vertex = sc.Constraints(horizontal=[chain])
    mesh = sc.Mesh(vertices, quads, seam_edges=seam)
    expected = sc.unwrap(mesh, constraints=by_corner)
    at = [corner[v] for v in chain]
    assert np.ptp(expected.uv[at, 1]) <= 1e-12 * size(expected.uv)
    for maps in (sc.unwrap, lambda *a, **k: sc.Unwrapper(*a, **k).solve()):
        assert np.array_equal(maps(mesh, constraints=by_vertex).uv, expected.uv)
    across = sc.Constraints(horizontal=[[2 * 9 + 4, 5 * 9 + 4]])
    for use in (lambda c: sc.unwrap(mesh, constraints=c), lambda c: sc.relax(expected, constraints=c)):
        with pytest.raises(ValueError, match="22 several UVs|Vertex 22 has several UVs"):
            use(across)
    # Outside the selection it has no effect, as a pin there.
    right = np.arange(len(quads)) % 8 >= 4
    free = sc.unwrap(mesh, selected_faces=right)
    assert np.array_equal(sc.unwrap(mesh, selected_faces=right, constraints=by_vertex).uv, free.uv)
    # A patch by itself has one UV per vertex, so that its corners stand for their vertices.
    triangles = triangles_of(quads)
    corner = {int(v): c for c, v in enumerate(triangles.ravel())}
    maps = [sc.parameterize(vertices, triangles, constraints=each).uv for each in (by_vertex, sc.Constraints(
        horizontal=[[corner[v] for v in chain]], of="corners"))]  # fmt: skip
    assert np.array_equal(*maps)
    with pytest.raises(ValueError, match="cannot be combined"):
        by_vertex + by_corner
    with pytest.raises(ValueError, match="of must be"):
        sc.Constraints(of="faces")


def test_a_chart_whose_constraints_contradict_each_other_fails_alone_and_names_the_edge():
    vertices, quads = sheet(6, 4, wave)
    both = np.r_[quads, quads + len(vertices)]
    vertices = np.r_[vertices, vertices + [0, 0, 5]]
    wrong = sc.Constraints(horizontal=[[100, 101]], vertical=[[100, 101]], of="corners")
    result = sc.unwrap(vertices, both, constraints=wrong)
    ends = both.ravel()[[100, 101]]
    assert [chart.status for chart in result.charts] == ["solved", "failed"]
    assert "one edge the same position" in result.charts[1].message
    assert all(str(end) in result.charts[1].message for end in ends)
