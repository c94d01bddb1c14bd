# SPDX-License-Identifier: GPL-3.0-or-later
"""A short run of random calls of the module, and proof that the runner notices failures."""

import sys

import pytest

from tests.fuzz import cases, random_arguments, run

CASES = 4000
# By seed and number: what longer runs have found.
FOUND = [(2, 7526), (2, 7960), (54, 1223), (55, 4168), (55, 5147), (56, 704), (56, 6120), (56, 7513), (58, 3813)]


def test_random_calls():
    outcomes, findings = run.fuzz(seed=1, first=0, count=CASES)
    assert not findings, "\n".join(f"--seed 1 --case {number}\n{text}" for number, text in findings.items())
    assert sum(outcomes.values()) == CASES
    # Cases that all fail would show nothing.
    for target, share in cases.TARGETS.items():
        assert outcomes[f"{target}: solved"] > 0.2 * CASES * share / sum(cases.TARGETS.values()), outcomes


@pytest.mark.parametrize(("seed", "number"), FOUND)
def test_findings_of_longer_runs(seed, number):
    cases.Case(seed, number).run()


@pytest.mark.parametrize("target", cases.TARGETS)
def test_every_parameter_takes_part(target):
    function = getattr(cases.sc, target)
    for called in (function, function.solve) if hasattr(function, "solve") else (function,):
        missing = set(random_arguments.parameters_of(called)) - set(random_arguments.makers_of(called))
        assert not missing, f"add a line for {missing} to random_arguments"


def test_a_case_is_determined_by_its_seed():
    for number in range(30):
        first, second = (cases.Case(7, number) for _ in range(2))
        assert first.describe() == second.describe()
        assert cases.same(first.mesh.vertices, second.mesh.vertices)
    assert cases.Case(7, 0).describe() != cases.Case(8, 0).describe()


PRELUDE = """
import os, sys, time
from tests.fuzz import cases, run
number = []
made = cases.Case.__init__
def make(self, seed, case):
    number[:] = [case]
    made(self, seed, case)
cases.Case.__init__ = make
"""
MISBEHAVIOUR = {
    "crash": ("if number == [3]: os.abort()", "ended with -6"),
    "hang": ("run.SECONDS = run.SECONDS_PER_VERTEX = 1e-3; time.sleep(100 if number == [3] else 0)", "Timeout"),
    "wrong error": ("if number == [3]: raise TypeError('unexpected')", "TypeError: unexpected"),
    "warning": ("import warnings; number != [3] or warnings.warn('odd')", "odd"),
}


@pytest.mark.parametrize("kind", MISBEHAVIOUR)
def test_the_case_that_misbehaves_is_named_and_the_others_run(kind, monkeypatch):
    program, sign = MISBEHAVIOUR[kind]
    worker = (
        f"{PRELUDE}\nimport warnings; warnings.simplefilter('error')\n"
        f"run.SECONDS = 0.5 if {kind == 'hang'} else run.SECONDS\n"
        f"def misbehave(self):\n    {program}\n    return 'solved'\n"
        "cases.Case.run = misbehave\nsys.exit(run.main())\n"
    )
    monkeypatch.setattr(run, "WORKER", [sys.executable, "-c", worker])
    outcomes, findings = run.fuzz(seed=1, first=0, count=6)
    assert list(findings) == [3]
    assert sign in findings[3]
    assert sum(outcomes.values()) == 6


def test_results_are_compared_to_the_bit():
    solution = cases.sc.parameterize([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]], [[0, 1, 2]])
    other = cases.dataclasses.replace(solution, uv=solution.uv.copy(), timings={})
    assert cases.same(solution, other)
    other.uv[0, 0] = cases.np.nextafter(other.uv[0, 0], 1)
    assert not cases.same(solution, other)
