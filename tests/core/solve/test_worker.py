# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in a thread: its result, and dropped results."""

import threading
from dataclasses import replace

import numpy as np
import pytest
import spectral_conformal
from spectral_unwrap.core.solve.options import Options
from spectral_unwrap.core.solve.solution import solve
from spectral_unwrap.core.solve.worker import Worker

from tests.core.polygon_meshes import grid

PATIENCE = 60.0  # seconds until a test that hangs fails


def _grid(size):
    return grid(size, height=lambda x, _y: 0.1 * np.sin(x), uv=None)


def test_result_comes_from_another_thread():
    worker = Worker(lambda progress: threading.get_ident())
    assert worker.result() != threading.get_ident()
    assert worker.wait(0.0)
    assert not worker.is_wanted


def test_error_is_raised_where_the_result_is_asked_for():
    def fail(progress):
        raise ValueError("no result")

    worker = Worker(fail)
    assert worker.wait(PATIENCE)
    with pytest.raises(ValueError, match="no result"):
        worker.result()


def test_progress_can_be_read_while_the_work_goes_on():
    reported, read = threading.Event(), threading.Event()

    def work(progress):
        assert progress(0.25, "phase") is True
        reported.set()
        assert read.wait(PATIENCE)

    worker = Worker(work)
    assert reported.wait(PATIENCE)
    assert (worker.fraction, worker.phase) == (0.25, "phase")
    assert worker.is_wanted
    assert not worker.wait(0.01)
    read.set()
    assert worker.wait(PATIENCE)
    worker.result()


def test_cancel_returns_at_once_and_the_work_hears_it_at_its_next_report():
    cancelled, heard = threading.Event(), []

    def work(progress):
        assert cancelled.wait(PATIENCE)
        heard.append(progress(0.5, "phase"))
        raise RuntimeError("dropped")

    worker = Worker(work)
    worker.cancel()
    assert not worker.is_wanted
    assert not worker.wait(0.0)
    cancelled.set()
    assert worker.wait(PATIENCE)
    assert heard == [False]


def test_thread_keeps_the_program_alive():
    hold = threading.Event()
    before = set(threading.enumerate())
    worker = Worker(lambda progress: hold.wait(PATIENCE))
    (thread,) = set(threading.enumerate()) - before
    assert not thread.daemon
    hold.set()
    assert worker.wait(PATIENCE)


def test_solver_stops_when_the_worker_is_cancelled():
    mesh = _grid(200)
    reported, cancelled = threading.Event(), threading.Event()

    def work(progress):
        def wait_for_cancel(fraction, phase):
            reported.set()
            assert cancelled.wait(PATIENCE)
            return progress(fraction, phase)

        return solve(mesh, Options(), wait_for_cancel)

    worker = Worker(work)
    # The solver lets go of the interpreter: this thread runs on.
    assert reported.wait(PATIENCE)
    worker.cancel()
    cancelled.set()
    with pytest.raises(spectral_conformal.Cancelled):
        worker.result()


def test_meshes_are_equal_only_with_equal_arrays():
    mesh = _grid(2)
    assert mesh.equals(_grid(2))
    assert not mesh.equals(_grid(3))
    other = _grid(2)
    other.vertices[0, 2] = np.nan
    assert not mesh.equals(other)
    mesh.vertices[0, 2] = np.nan
    assert mesh.equals(other)
    other.selected_faces[1] = False
    assert not mesh.equals(other)


def test_equal_meshes_have_equal_pushes():
    pushed, same, weaker = (replace(_grid(2), extenders=((0, 8, strength, 0.3),)) for strength in (1.0, 1.0, 0.5))
    assert pushed.equals(same)
    assert not pushed.equals(weaker)
    assert not pushed.equals(replace(same, extenders=((0, 8, 1.0, 0.2),)))
    assert not pushed.equals(replace(same, uv=np.zeros((16, 2))))
