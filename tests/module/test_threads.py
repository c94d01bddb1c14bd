"""Several threads solve at once, with solvers of their own and with one that they share."""

import threading

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

ROUNDS = 6


def in_threads(*tasks):
    """Run each task in a thread of its own, all begun together; returns what they return."""
    results = [None] * len(tasks)
    begin = threading.Barrier(len(tasks))

    def work(k):
        begin.wait()
        results[k] = tasks[k]()

    threads = [threading.Thread(target=work, args=(k,)) for k in range(len(tasks))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return results


@pytest.mark.parametrize("backend", ["cholmod", "eigen"])
def test_solvers_of_two_threads_give_what_they_give_alone(backend):
    disks = [meshes.bumpy_disk(2500, 4, seed) for seed in (1, 2)]
    extenders = [(3, 900, 0.5)]

    def solve(vertices, triangles):
        solver = sc.Solver(vertices, triangles, factorization=backend)
        maps = [
            solver.solve(extenders=extenders if k % 2 else None, hole_rigidity=0.1 * (k % 3)) for k in range(ROUNDS)
        ]
        result = sc.unwrap(vertices, *meshes.polygons(triangles), factorization=backend)
        return np.concatenate([*(m.uv for m in maps), result.uv])

    alone = [solve(*disk) for disk in disks]
    together = in_threads(*(lambda disk=disk: solve(*disk) for disk in disks))
    for expected, found in zip(alone, together):
        assert np.array_equal(expected, found)


@pytest.mark.parametrize("kind", [sc.Solver, sc.Unwrapper])
def test_threads_that_share_a_solver_take_turns(kind):
    vertices, triangles = meshes.bumpy_disk(1500)
    mesh = (triangles,) if kind is sc.Solver else meshes.polygons(triangles)
    expected = kind(vertices, *mesh).solve().uv
    shared = kind(vertices, *mesh)
    found = in_threads(*(lambda: [shared.solve().uv for _ in range(ROUNDS)] for _ in range(3)))
    for uv in (uv for uvs in found for uv in uvs):
        assert np.array_equal(uv, expected)


def test_other_threads_run_while_one_solves():
    vertices, triangles = meshes.bumpy_disk(20000)
    inside = threading.Event()
    go_on = threading.Event()

    def listen(fraction, phase):
        if phase == "factorization":
            inside.set()
            # Waits for the other thread, which needs the GIL to get there.
            assert go_on.wait(60)
        return True

    thread = threading.Thread(target=lambda: sc.parameterize(vertices, triangles, progress=listen))
    thread.start()
    assert inside.wait(60)
    small, faces = meshes.bumpy_disk(50)
    assert sc.parameterize(small, faces).turning_number == 1
    go_on.set()
    thread.join()


@pytest.mark.parametrize("backend", ["cholmod", "eigen"])
def test_a_solve_cancelled_from_another_thread_leaves_the_solver_as_it_was(backend):
    vertices, triangles = meshes.bumpy_disk(4000)
    offsets, corners = meshes.polygons(triangles)
    expected = sc.unwrap(vertices, offsets, corners, factorization=backend).uv
    unwrapper = sc.Unwrapper(vertices, offsets, corners, factorization=backend)
    for phase_to_stop in ("ordering", "factorization", "eigenproblem"):
        stop = threading.Event()
        reached = threading.Event()

        def listen(fraction, phase, reached=reached, stop=stop, phase_to_stop=phase_to_stop):
            if phase == phase_to_stop:
                reached.set()
                stop.wait(60)
            return not stop.is_set()

        def solve(listen=listen):
            with pytest.raises(sc.Cancelled):
                unwrapper.solve(progress=listen)
            return "cancelled"

        def cancel(reached=reached, stop=stop):
            reached.wait(60)
            stop.set()

        assert in_threads(solve, cancel)[0] == "cancelled"
    assert np.array_equal(unwrapper.solve().uv, expected)
