# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes of arguments during a call, or between the calls of an object, do not affect the call."""

import subprocess
import sys

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes

from .changing import (
    BY_NUMPY,
    CALLS,
    WITH_PROGRESS,
    WITHOUT_ARRAYS,
    assert_equal,
    cut,
    mapped,
    mesh,
    some_arguments,
    values,
    with_pins,
)


def test_every_public_function_is_here():
    public = [(module, name) for module in (sc, sc.hosts) for name in module.__all__ if name[0].islower()]
    functions = {name for module, name in public if callable(getattr(module, name))}
    assert functions - WITHOUT_ARRAYS <= set(CALLS)


@pytest.mark.parametrize("name", CALLS)
def test_no_memory_is_shared_with_the_caller(name, monkeypatch):
    received = []

    def spy(function):
        def call(*arguments, **keywords):
            received.extend(value for value in arguments if isinstance(value, np.ndarray))
            return function(*arguments, **keywords)

        return call

    for attribute in dir(sc._native):
        function = getattr(sc._native, attribute)
        if callable(function) and not (isinstance(function, type) and issubclass(function, BaseException)):
            monkeypatch.setattr(sc._native, attribute, spy(function))
    arguments = some_arguments()
    result = CALLS[name](arguments, None)
    assert received or name in BY_NUMPY
    for array in arguments.arrays():
        for other in [*received, *values(result)]:
            assert not np.shares_memory(array, other), array


@pytest.mark.parametrize("name", CALLS)
def test_changed_arguments_are_no_error(name):
    # Otherwise all calls but the first beside a thread that changes them would end before there is anything to harm.
    arguments = some_arguments()
    for _ in range(4):
        arguments.change()
        CALLS[name](arguments, None)


@pytest.mark.parametrize("name", WITH_PROGRESS)
def test_a_progress_function_that_changes_arguments_changes_nothing(name):
    expected = CALLS[name](some_arguments(), None)
    arguments = some_arguments()
    calls = []

    def change(fraction, phase):
        calls.append(fraction)
        arguments.change()

    assert_equal(CALLS[name](arguments, change), expected)
    assert calls


def test_objects_keep_what_they_were_made_of_until_their_last_solve():
    for make in (
        lambda a: sc.Unwrapper(mapped(a), **cut(a), **with_pins(a)),
        lambda a: sc.Unwrapper(*mesh(a), **cut(a), metric=a.metric),
        lambda a: sc.Solver(a.vertices, a.triangles, metric=a.triangle_metric),
    ):
        undisturbed = make(some_arguments())
        arguments = some_arguments()
        made = make(arguments)
        for _ in range(3):
            arguments.change()
            assert_equal(made.solve(), undisturbed.solve())


def test_flags_are_true_or_false_to_the_native_module():
    # Any byte but 0 is True to NumPy; a compiler takes it for 0 or 1, so that a sum of flags is no count of them.
    odd = np.frombuffer(bytes([0, 2, 1, 255] * 30 + [0]), np.bool_)
    arguments = some_arguments()
    assert len(odd) == len(arguments.selected_faces)
    plain = odd.view(np.uint8) != 0
    for call in (sc.hosts.face_triangles, sc.unwrap, sc.hosts.chart_of_face):
        assert_equal(call(*mesh(arguments), selected_faces=odd), call(*mesh(arguments), selected_faces=plain))
    found = meshes.defects(arguments.face_offsets, arguments.corner_vertices, arguments.corner_uv, selected_faces=odd)
    assert (found.island_of_face >= 0).tolist() == plain.tolist()


def test_another_thread_that_changes_arguments_does_no_harm():
    # In a process of its own, which it may end.
    ended = subprocess.run(
        [sys.executable, "-m", "tests.module.changing", "20"], capture_output=True, text=True, check=False
    )
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert ended.stdout.splitlines() == list(CALLS)
