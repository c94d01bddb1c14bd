"""Long work calls the progress function in proportion to the work, and can be canceled at every call."""

import time

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

# Steps of work, in place of the 40 ms after which a progress function is called: what a small mesh then shows of its
# phases, a large one shows of their parts.
INTERVAL = 400

# Seconds in which an AMD Zen at 2 GHz, the slowest machine of ours, sorts so many numbers while it is idle.
SORTED, SECONDS = 1_000_000, 0.12

CASES = {
    "uniform": {},
    "inverse_area": {"weights": "inverse_area"},
    "area": {"method": "area"},
    "lscm": {"method": "lscm"},
    "polish": {"polish": True},
    "fold_free": {"fold_free": True},
    "area_blend": {"area_blend": 0.5},
}


@pytest.fixture(autouse=True)
def heard_often():
    # In one thread the number of calls is always the same: while a thread waits for another it calls by the clock.
    sc.limit_threads(1)
    before = sc._native.exchange_poll_interval(INTERVAL)
    yield
    sc._native.exchange_poll_interval(before)
    sc.limit_threads(0)


def _calls(n, options):
    vertices, triangles = meshes.bumpy_disk(n)
    calls = []
    sc.unwrap(vertices, *meshes.polygons(triangles), progress=lambda *call: calls.append(call), **options)
    return calls


def _slowness():
    """Return how much longer work takes now than there: other tests share the processor's caches and units."""
    numbers = np.random.default_rng(0).random(SORTED)
    begin = time.thread_time()
    np.sort(numbers)
    return max(1.0, (time.thread_time() - begin) / SECONDS)


@pytest.mark.parametrize("case", CASES)
def test_calls_are_made_in_proportion_to_the_work(case):
    def heard(n):
        often = len(_calls(n, CASES[case]))
        sc._native.exchange_poll_interval(10**18)
        reports = len(_calls(n, CASES[case]))
        sc._native.exchange_poll_interval(INTERVAL)
        return often - reports

    few, many = heard(1500), heard(6000)
    assert few > 10
    # Four times the work, but for the number of solves, which "area" needs a third fewer of on the larger mesh.
    assert many > 2 * few


def test_every_phase_is_heard_several_times_and_the_fraction_never_falls():
    calls = _calls(6000, {"polish": True})
    fractions = [fraction for fraction, _ in calls]
    assert fractions == sorted(fractions)
    phases = [phase for _, phase in calls]
    for phase in ("charts", "ordering", "factorization", "eigenproblem", "polish"):
        assert phases.count(phase) > 5
    assert "" not in phases


def test_a_solve_cancelled_at_any_call_leaves_the_solver_as_it_was():
    vertices, triangles = meshes.bumpy_disk(1500)
    mesh = (vertices, *meshes.polygons(triangles))
    expected = sc.unwrap(*mesh).uv
    calls = []
    sc.Unwrapper(*mesh).solve(progress=lambda *call: calls.append(call))
    for k in np.linspace(0, len(calls) - 1, 25).astype(int):
        unwrapper = sc.Unwrapper(*mesh)
        left = [k]

        def listen(fraction, phase, left=left):
            left[0] -= 1
            return left[0] >= 0

        with pytest.raises(sc.Cancelled):
            unwrapper.solve(progress=listen)
        # No call is made after the one that cancelled.
        assert left[0] == -1
        assert np.array_equal(unwrapper.solve().uv, expected)


def test_the_charts_of_a_single_patch_are_heard():
    calls = []
    sc.parameterize(*meshes.bumpy_disk(6000), progress=lambda *call: calls.append(call))
    assert [phase for _, phase in calls].count("charts") > 5


SILENCE_CASES = [
    *CASES,
    "metric",
    # Maps that are refused, tried again, and embedded.
    pytest.param("embedding", marks=pytest.mark.slow),
]


@pytest.mark.parametrize("case", SILENCE_CASES)
def test_no_silence_at_a_million_vertices_is_longer_than_a_third_of_a_second(case):
    """By the processor time between calls, at a scale of 1 to 25. Waiting for another thread takes none.

    Other processes lengthen silences as they lengthen all work, but hardly those of a phase in each of several runs.
    """
    # Calls of libraries are heard while another thread makes them.
    sc.limit_threads(2)
    cores = sc._native.pretend_cores(2)
    n = 40_000
    vertices, triangles = meshes.bumpy_disk(n)
    options = dict(CASES.get(case, {}))
    if case == "metric":
        options["metric"] = np.broadcast_to(np.diag([1.0, 2.0, 1.0]), (len(triangles), 3, 3))
    if case == "embedding":
        options["weights"] = "inverse_area"
        near = np.arange(n // 2, n // 2 + 40, 2)
        vertices[near] = vertices[near + 1] + 1e-9 * (vertices[near] - vertices[near + 1])
    sc._native.exchange_poll_interval(5 * INTERVAL)
    limit = (1 / 3 - 0.04) * n / 1e6  # besides the 40 ms
    longest = {}
    try:
        for _ in range(5):
            calls = []
            slowness = _slowness()
            sc.unwrap(
                vertices,
                *meshes.polygons(triangles),
                progress=lambda _, phase, calls=calls: calls.append((time.thread_time(), phase)),
                **options,
            )
            silences = np.diff([at for at, _ in calls]) / max(slowness, _slowness())
            phases = np.array([phase for _, phase in calls[:-1]])
            of_run = {phase: silences[phases == phase].max() for phase in set(phases)}
            longest = {phase: min(silence, longest.get(phase, np.inf)) for phase, silence in of_run.items()}
            if max(longest.values()) < limit:
                break
    finally:
        sc._native.pretend_cores(cores)
    assert max(longest.values()) < limit, longest


def _calls_of_search(n):
    vertices, faces = meshes.spindle(n)
    calls = []
    sc.suggest_seams(vertices, *meshes.polygons(faces), progress=lambda *call: calls.append(call))
    return [phase for _, phase in calls]


def test_the_search_for_seams_is_heard_in_proportion_to_the_work():
    # On a coarser spindle the search tries more cuts for its size.
    few, many = _calls_of_search(2000), _calls_of_search(8000)
    for phase in ("charts", "seams"):
        assert many.count(phase) > 2.5 * few.count(phase) > 20


@pytest.mark.parametrize("function", [sc.pack, sc.relax, sc.suggest_seams])
def test_a_million_vertices_are_prepared_without_half_a_second_of_silence(function, monkeypatch):
    """Likewise, from the call on; a cancel at any of these calls ends it."""
    n = 40_000
    # Normals are computed by parts of a fixed size.
    monkeypatch.setattr(sc._sharp_edges, "_PART", sc._sharp_edges._PART * n // 1_000_000)
    vertices, triangles = meshes.bumpy_disk(n)
    mesh = sc.Mesh(vertices, triangles, vertices[triangles][:, :, :2])
    longest = np.inf
    for _ in range(10):
        slowness = _slowness()
        for number in (1, 2, 3, 4, 5, 100):
            calls = [time.thread_time()]

            def listen(fraction, phase, calls=calls, number=number):
                calls.append(time.thread_time())
                return len(calls) <= number

            with pytest.raises(sc.Cancelled, match="canceled by the caller"):
                function(mesh, progress=listen)
            assert len(calls) == number + 1
        longest = min(longest, np.diff(calls).max() / max(slowness, _slowness()))
        if longest < 0.5 * n / 1e6:
            break
    assert longest < 0.5 * n / 1e6
