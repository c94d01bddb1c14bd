# SPDX-License-Identifier: GPL-3.0-or-later
"""A call gives the same map, bit for bit, whatever its Solver or Unwrapper solved before."""

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

DISK = meshes.bumpy_disk(400)
MESHES = {
    "disk": (DISK, {}),
    "polished": (DISK, {"polish": True}),
    "holes": (meshes.bumpy_disk(900, holes=3), {"polish": True}),
    "blended": (DISK, {"area_blend": 0.5}),
    "fallback": (meshes.rough_grid(10, 4.0, 6), {"polish": True}),
    "embedding": (meshes.rough_grid(8, 3.0, 2), {"fold_free": True}),
}


def calls_of(vertices):
    """Return options of solves of this mesh, all of which have a map, a fallback or the same error."""
    ends = (0, len(vertices) // 2)
    pins = {0: (0.0, 0.0), len(vertices) // 3: (1.0, 0.2), len(vertices) - 1: (0.3, 1.0)}
    return [
        {},
        {"extenders": [(*ends, 1.0)]},
        {"extenders": [(*ends, 1.05)]},
        {"extenders": [(*ends, -0.05)]},
        {"extenders": [(*ends, 30.0), (1, 2, 0.5)], "hole_rigidity": 1.0},
        {"hole_rigidity": 1.0},
        {"hole_rigidity": "automatic"},
        {"pins": pins, "soft_pins": 1.0},
        {"pins": pins},
        {"method": "lscm"},
        {"method": "fiedler"},
        {"method": "area"},
        {"fallbacks": False},
    ]


def solved(solve, call):
    """Return the result of a call in comparable form."""
    try:
        solution = solve(**call)
    except (sc.SolveError, sc.InvalidMeshError) as error:
        return str(error)
    records = getattr(solution, "charts", [solution])
    return [solution.uv.tobytes(), *((each.attempts, each.iterations, each.polish_steps) for each in records)]


@pytest.mark.parametrize("name", MESHES)
def test_a_solver_gives_what_a_fresh_one_gives(name):
    mesh, options = MESHES[name]
    calls = calls_of(mesh[0])
    fresh = [solved(sc.Solver(*mesh, **options).solve, call) for call in calls]
    solver = sc.Solver(*mesh, **options)
    order = np.random.default_rng(1).permutation(np.repeat(np.arange(len(calls)), 3))
    for k in order:
        assert solved(solver.solve, calls[k]) == fresh[k], calls[k]
        if k % 2:
            # A draft starts from the last map, and leaves no trace.
            solved(solver.solve, {"extenders": [(0, 5, 0.1 * k)], "tolerance": 1e-4})


@pytest.mark.parametrize("name", ["disk", "holes"])
def test_an_unwrapper_gives_what_a_fresh_one_gives(name):
    (vertices, triangles), options = MESHES[name]
    mesh = (vertices, *meshes.polygons(triangles))
    ends = (0, len(vertices) // 2)
    calls = [{}, {"extenders": [(*ends, 1.0)]}, {"extenders": [(*ends, 2.0)]}, {"hole_rigidity": 1.0}]
    fresh = [solved(sc.Unwrapper(*mesh, **options).solve, call) for call in calls]
    unwrapper = sc.Unwrapper(*mesh, **options)
    for k in (0, 1, 0, 2, 1, 3, 0, 3, 2):
        assert solved(unwrapper.solve, calls[k]) == fresh[k]
        solved(unwrapper.solve, {"extenders": [(*ends, 0.5 + k)], "tolerance": 1e-4})


def test_a_draft_agrees_to_its_tolerance():
    solver = sc.Solver(*DISK)
    for strength in (1.0, 1.1, 1.3, 0.2, -0.05, 5.0):
        call = {"extenders": [(0, 200, strength)]}
        draft = solver.solve(**call, tolerance=1e-4)
        assert meshes.similarity_deviation(draft.uv, sc.parameterize(*DISK, **call).uv) < 1e-3


def test_a_second_attempt_has_the_order_and_the_memory_of_the_first():
    mesh, _ = MESHES["fallback"]
    solver = sc.Solver(*mesh, fallbacks=False)

    def attempt():
        with pytest.raises(sc.SolveError, match="2 attempts"):
            solver.solve()

    for factorizations in (1, 2):  # the first is there already
        done = sc._native.counted_work(attempt)
        assert (done["analyses"], done["factorizations"]) == (0, factorizations)


def test_a_factor_that_fallbacks_do_not_need_is_given_back():
    mesh, _ = MESHES["fallback"]
    solver = sc.Solver(*mesh, fallbacks=True)
    first, second = (sc._native.counted_work(solver.solve) for _ in range(2))
    assert solver.solve().fallback is not None
    assert second["analyses"] == first["analyses"] + 1
