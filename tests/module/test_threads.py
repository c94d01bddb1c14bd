"""Several threads solve at once, with solvers of their own and with one that they share."""

import contextlib
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

ROOT = Path(__file__).resolve().parents[2]
ROUNDS = 6


def in_threads(*tasks):
    """Run each task in its own thread, all at once; return their results."""
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


@pytest.mark.parametrize("kind", [sc.Solver, sc.Unwrapper])
def test_threads_that_share_a_solver_take_turns(kind):
    vertices, triangles = meshes.bumpy_disk(1500)
    mesh = (triangles,) if kind is sc.Solver else meshes.polygons(triangles)
    expected = kind(vertices, *mesh).solve().uv
    shared = kind(vertices, *mesh)
    found = in_threads(*(lambda: [shared.solve().uv for _ in range(ROUNDS)] for _ in range(3)))
    for uv in (uv for uvs in found for uv in uvs):
        assert np.array_equal(uv, expected)


def test_two_solves_at_once_equal_two_in_a_row():
    # Found out a serial OpenBLAS, whose buffers two threads overwrite for each other.
    cases = [meshes.bumpy_disk(5000, 2, seed=1), meshes.bumpy_disk(6000, 0, seed=2)]
    expected = [sc.parameterize(*case).uv for case in cases]
    found = in_threads(*(lambda case=case: [sc.parameterize(*case).uv for _ in range(10)] for case in cases))
    for uvs, uv in zip(found, expected):
        assert all(np.array_equal(other, uv) for other in uvs)


def test_the_solve_releases_the_interpreter_lock():
    vertices, triangles = meshes.bumpy_disk(30000)
    ticks = []
    worker = threading.Thread(target=lambda: sc.parameterize(vertices, triangles))
    worker.start()
    while worker.is_alive():
        ticks.append(time.perf_counter())
        time.sleep(0.001)
    # Holding the lock through factorization or solve would leave a handful of ticks.
    assert len(ticks) > 20


def test_a_solver_is_not_called_by_its_own_progress_function():
    solver = sc.Solver(*meshes.bumpy_disk(500))
    with pytest.raises(RuntimeError, match="waits for the progress function"):
        solver.solve(progress=lambda fraction, phase: solver.solve())
    assert solver.solve().turning_number == 1


# Two wait for each other, or three in a circle.
@pytest.mark.parametrize("number", [2, 3])
def test_solvers_whose_progress_functions_call_each_other_do_not_wait_forever(number):
    code = """if True:
        import sys, threading
        import spectral_conformal as sc
        from tests.module import meshes
        number = int(sys.argv[1])
        solvers = [sc.Solver(*meshes.bumpy_disk(500)) for _ in range(number)]
        all_at_work = threading.Barrier(number)
        outcomes = []

        def work(k):
            called = []

            def progress(fraction, phase):
                if not called:
                    called.append(phase)
                    all_at_work.wait()
                    solvers[(k + 1) % number].solve()

            try:
                outcomes.append(solvers[k].solve(progress=progress).turning_number)
            except RuntimeError as error:
                outcomes.append(str(error))

        threads = [threading.Thread(target=work, args=(k,)) for k in range(number)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        print(outcomes)
        """
    command = [sys.executable, "-c", code, str(number)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True, timeout=30)
    # One call is refused, which lets the others go on.
    assert done.stdout.count("waits for the progress function") == 1
    assert done.stdout.count("1") == number - 1


@pytest.mark.skipif(sys.version_info >= (3, 13), reason="its module for interpreters has another name")
def test_another_interpreter_of_the_process_is_refused_with_the_reason():
    code = (
        "import sys, _xxsubinterpreters as interpreters\n"
        "other = interpreters.create()\n"
        "interpreters.run_string(other, f'import sys; sys.path[:] = {sys.path}; import spectral_conformal')"
    )
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=30)
    assert "main interpreter" in done.stderr


@pytest.mark.slow
def test_result_does_not_depend_on_the_thread_count():
    code = (
        "import hashlib, spectral_conformal as sc; from tests.module import meshes\n"
        "solution = sc.parameterize(*meshes.bumpy_disk(120000, 3))\n"
        "print(hashlib.sha256(solution.uv.tobytes()).hexdigest(), solution.eigenvalue)"
    )
    outputs = set()
    for threads in ("1", "2", "5"):
        environ = {**os.environ, "OPENBLAS_NUM_THREADS": threads, "OMP_NUM_THREADS": threads}
        command = [sys.executable, "-c", code]
        outputs.add(subprocess.run(command, cwd=ROOT, env=environ, capture_output=True, check=True).stdout)
    assert len(outputs) == 1


def _most_threads(work):
    """Return how many threads the process has at most while it works, as Linux counts them, beyond those before."""

    def listed():
        found = set()
        for task in Path("/proc/self/task").iterdir():
            # One that has ended and was joined stays listed for a moment, without memory.
            with contextlib.suppress(OSError):
                if (task / "statm").read_text().split()[0] != "0":
                    found.add(task.name)
        return found

    def count():
        # A listing takes time, in which one thread may end and another begin. Those of two lived between these at once.
        return len(listed() & listed())

    done, most, before = threading.Event(), [0], count()

    def watch():
        while not done.is_set():
            most[0] = max(most[0], count())

    watcher = threading.Thread(target=watch)
    watcher.start()
    work()
    done.set()
    watcher.join()
    return most[0] - before - 1


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="counts threads by /proc")
def test_a_limit_of_threads_keeps_all_work_in_the_callers_and_changes_no_result():
    vertices, triangles = meshes.bumpy_disk(30000)
    uvs = []

    def solve():
        uvs.append(sc.unwrap(vertices, *meshes.polygons(triangles), polish=True).uv)

    assert sc.limit_threads(1) == 0
    try:
        assert _most_threads(solve) == 0
        assert in_threads(lambda: sc.limit_threads(0)) == [0]
    finally:
        assert sc.limit_threads(0) == 1
    solve()
    # Helpers live for milliseconds, and may be missed where other processes keep the cores busy.
    assert os.cpu_count() == 1 or any(_most_threads(solve) > 0 for _ in range(50))
    assert all(np.array_equal(uv, uvs[0]) for uv in uvs)


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="counts threads by /proc")
@pytest.mark.parametrize("cores", [3, 16])
def test_calls_within_calls_have_no_more_threads_than_there_are_cores(cores):
    # Islands are solved in several threads, each of which shares its factorization, its solves and what it measures.
    vertices, triangles = meshes.bumpy_disk(9500)
    islands = np.concatenate([vertices + [3 * k, 0, 0] for k in range(6)])
    faces = meshes.polygons(np.concatenate([triangles + len(vertices) * k for k in range(6)]))
    body = meshes.limbs(500, 8, 2)
    found = []

    def work():
        found.append((sc.unwrap(islands, *faces, polish=True).uv, sc.suggest_seams(*body).seam_edges))

    work()
    sc._native.pretend_cores(cores)
    try:
        assert _most_threads(work) < cores
        # Beside the two there are no more helpers than one of them may have alone.
        assert _most_threads(lambda: in_threads(work, work)) - 2 < cores
    finally:
        sc._native.pretend_cores(0)
    assert len(found) == 4
    for uv, seams in found[1:]:
        assert np.array_equal(uv, found[0][0])
        assert np.array_equal(seams, found[0][1])


def test_charts_and_measures_do_not_depend_on_the_number_of_threads():
    # Their triangles are found, and measured, in parts.
    points, quads = meshes.unit_square(150)
    vertices = np.c_[points, 0.2 * np.sin(7 * points.prod(axis=1))]
    found = []
    try:
        for threads in (1, 0):
            sc.limit_threads(threads)
            found.append(sc.unwrap(vertices, quads))
    finally:
        sc.limit_threads(0)
    one, all_threads = found
    assert np.array_equal(one.uv, all_threads.uv)
    for name in ("mean_qc", "max_qc", "scale_deviation", "flipped", "overlapping", "image_area"):
        assert np.array_equal(one.charts.column(name), all_threads.charts.column(name)), name


@pytest.mark.parametrize(
    ("threads", "kind"),
    [(-1, ValueError), (2**31, ValueError), (1.0, TypeError), (True, TypeError), ("2", TypeError), (None, TypeError)],
)
def test_a_limit_that_is_no_count_is_refused(threads, kind):
    with pytest.raises(kind, match="threads must be a whole number from 0 to 2147483647"):
        sc.limit_threads(threads)
    assert sc.limit_threads(0) == 0
