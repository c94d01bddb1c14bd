# SPDX-License-Identifier: GPL-3.0-or-later
"""A call that is canceled, or raises, at any of its reports ends there and changes nothing."""

import copy
import time

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes


def two_patches():
    """A patch with holes and a smaller one, in one mesh."""
    vertices, triangles = meshes.bumpy_disk(600, holes=2, seed=1)
    more, other = meshes.bumpy_disk(300, seed=2)
    return np.vstack([vertices, more + 5.0]), [*triangles.tolist(), *(other + len(vertices)).tolist()]


def unwrap_arguments(**options):
    vertices, faces = two_patches()
    offsets, corners = meshes.polygons(faces)
    return sc.unwrap, {"mesh": vertices, "faces": offsets, "corner_vertices": corners, **options}


def patch_arguments(function, **options):
    vertices, triangles = meshes.bumpy_disk(600, holes=2, seed=1)
    return function, {"vertices": vertices, "faces": triangles, **options}


def folded_arguments(mesh):
    vertices, triangles = mesh
    return sc.parameterize, {"vertices": vertices, "faces": triangles, "fold_free": True}


def seams_arguments():
    vertices, quads = meshes.bulge(5, 2.0)
    offsets, corners = meshes.polygons(quads)
    return sc.suggest_seams, {"mesh": vertices, "faces": offsets, "corner_vertices": corners}


CALLS = {
    "unwrap": unwrap_arguments,
    "unwrap, inverse area, rigid holes": lambda: unwrap_arguments(weights="inverse_area", hole_rigidity=1.0),
    "unwrap, rigid holes chosen": lambda: unwrap_arguments(hole_rigidity="automatic"),
    "unwrap, area blend": lambda: unwrap_arguments(area_blend=0.5),
    "unwrap, filled holes": lambda: unwrap_arguments(fill_holes=True),
    "unwrap, polish": lambda: unwrap_arguments(polish=True),
    "parameterize": lambda: patch_arguments(sc.parameterize),
    "parameterize, fold-free in place": lambda: folded_arguments(meshes.rough_grid(14, 2.0, 3)),
    "parameterize, fold-free by an embedding": lambda: folded_arguments(meshes.floater(-3.0)),
    "parameterize, parts moved apart": lambda: folded_arguments(meshes.rough_grid(8, 1.0, 8, 0.1)),
    "parameterize, extender": lambda: patch_arguments(sc.parameterize, extenders=[(3, 141, 2.0)]),
    "parameterize, Fiedler": lambda: patch_arguments(sc.parameterize, method="fiedler"),
    "parameterize, area": lambda: patch_arguments(sc.parameterize, method="area"),
    "parameterize, LSCM": lambda: patch_arguments(sc.parameterize, method="lscm"),
    "Solver": lambda: patch_arguments(sc.Solver),
    "suggest seams": seams_arguments,
}


class Failure(Exception):
    """Raised in a report."""


class Stop:
    """A progress function that counts its calls, and at one of them cancels or raises."""

    def __init__(self, at=-1, error=None):
        self.at, self.error, self.calls = at, error, 0

    def __call__(self, fraction, phase):
        self.calls += 1
        if self.calls - 1 != self.at:
            return True
        if self.error is not None:
            raise self.error
        return False


def stopped(function, arguments, at, error):
    """Stop a call at its report number `at`; check that it has ended there and left its arguments alone."""
    before, stop = copy.deepcopy(arguments), Stop(at, error)
    if function is sc.suggest_seams:
        # Threads share its solves, of which only those of the caller's report: sometimes there are fewer.
        try:
            function(**arguments, progress=stop)
        except BaseException as raised:  # noqa: BLE001 - whatever it is, it is checked
            assert isinstance(raised, sc.Cancelled) if error is None else raised is error
            assert stop.calls == at + 1
        else:
            assert stop.calls <= at
    else:
        with pytest.raises(sc.Cancelled if error is None else type(error)) as raised:
            function(**arguments, progress=stop)
        assert error is None or raised.value is error
        assert stop.calls == at + 1
    for name, value in before.items():
        if isinstance(value, np.ndarray):
            np.testing.assert_array_equal(arguments[name], value)


# The numerics also throw RuntimeError: one raised here must not be taken for theirs.
ERRORS = {
    "cancelled": None,
    "raised": Failure(),
    "runtime error": RuntimeError("the caller's"),
    "memory error": MemoryError("the caller's"),
    "interrupted": KeyboardInterrupt(),
}


@pytest.mark.slow
@pytest.mark.parametrize("error", ERRORS.values(), ids=ERRORS)
@pytest.mark.parametrize("name", CALLS)
def test_stopped_at_every_report(name, error):
    function, arguments = CALLS[name]()
    counter = Stop()
    function(**arguments, progress=counter)
    assert counter.calls > 1
    for at in range(counter.calls):
        stopped(function, arguments, at, error)


def test_a_stopped_call_does_not_show_in_the_next_one():
    function, arguments = CALLS["unwrap"]()
    before, counter = function(**arguments), Stop()
    function(**arguments, progress=counter)
    for at in range(counter.calls):
        stopped(function, arguments, at, None)
        np.testing.assert_array_equal(function(**arguments).uv, before.uv)


@pytest.mark.parametrize("options", [{}, {"extenders": [(3, 141, 2.0)]}, {"hole_rigidity": 1.0}], ids=str)
@pytest.mark.parametrize("kind", [sc.Solver, sc.Unwrapper])
def test_stopped_at_every_report_a_kept_solver_solves_as_before(kind, options):
    _, arguments = patch_arguments(kind) if kind is sc.Solver else unwrap_arguments()
    counter = Stop()
    expected = kind(**arguments).solve(**options, progress=counter).uv
    for at in range(counter.calls):
        solver = kind(**arguments)
        with pytest.raises(sc.Cancelled):
            solver.solve(**options, progress=Stop(at))
        # The second solve may start from what the first one had.
        np.testing.assert_allclose(solver.solve(**options).uv, expected, atol=1e-9)


def test_only_false_cancels():
    vertices, triangles = meshes.bumpy_disk(200)
    for answer in (None, True, 0, "", [], np.zeros(2), np.bool_(True)):
        found = sc.parameterize(vertices, triangles, progress=lambda fraction, phase, answer=answer: answer)
        assert found.turning_number == 1
    for answer in (False, np.bool_(False)):
        with pytest.raises(sc.Cancelled):
            sc.parameterize(vertices, triangles, progress=lambda fraction, phase, answer=answer: answer)


def test_unwrap_tells_the_seconds_of_all_charts_by_phase():
    vertices, quads = meshes.saddle_quads(40)
    two = np.concatenate([vertices, vertices + 5.0]), *meshes.polygons(np.concatenate([quads, quads + len(vertices)]))
    start = time.perf_counter()
    timings = sc.unwrap(*two, polish=True).timings
    elapsed = time.perf_counter() - start
    names = ["charts", "assembly", "factorization", "eigenproblem", "polish", "placement", "quality"]
    assert sorted(timings) == sorted(names)
    assert min(timings.values()) > 0
    # Both charts may be solved at once.
    assert sum(timings.values()) < 2 * elapsed
    kept = sc.Unwrapper(*two).solve().timings
    assert {"assembly", "factorization", "eigenproblem", "placement", "quality"} <= set(kept)
