"""Seconds and memory of `parameterize` beside one bare CHOLMOD analyse + factorise of the same matrix, same process.

    build/venv/bin/python -m tests.benchmarks.native_solver [sizes ...]

Sizes are numbers of vertices of a random disk lifted to a bumpy surface (default 50000 150000 500000), or paths of OBJ
files of triangles. Each runs in a process of its own; the figures are the best of several rounds.
"""

from __future__ import annotations

import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import scipy.sparse
import spectral_conformal as sc

from tests.benchmarks import bare_cholmod
from tests.module import meshes, reference


def peak_gigabytes() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6


def measure(case: str) -> str:
    vertices, triangles = meshes.bumpy_disk(int(case)) if case.isdigit() else meshes.read_obj(Path(case))
    triangles = np.array(triangles)
    before = peak_gigabytes()
    rounds = 3 if len(vertices) < 300_000 else 2
    best = np.inf
    for _ in range(rounds):
        start = time.perf_counter()
        solution = sc.parameterize(vertices, triangles)
        if time.perf_counter() - start < best:
            best = time.perf_counter() - start
            phases = solution.timings
    memory = peak_gigabytes()
    matrix = reference.conformal_energy_matrix(vertices, triangles)
    shifted = matrix + 1e-9 * scipy.sparse.identity(len(vertices), format="csc")
    bare = min((bare_cholmod.seconds_to_factor(shifted) for _ in range(rounds)), key=sum)
    return (
        f"| {len(vertices)} | {best:.2f} | {bare[0]:.2f} + {bare[1]:.2f} | {best / sum(bare):.2f} "
        f"| {memory:.2f} ({before:.2f}) | {solution.iterations} | {solution.turning_number} | "
        + ", ".join(f"{name} {seconds:.2f}" for name, seconds in phases.items())
        + " |"
    )


def main() -> None:
    if sys.argv[1:2] == ["--one"]:
        print(measure(sys.argv[2]))
        return
    print(sc.build_info())
    print("| vertices | s | bare analyse + factorise, s | ratio | peak GB (before) | solves | turning | phases, s |")
    print("|---|---|---|---|---|---|---|---|", flush=True)
    for case in sys.argv[1:] or ["50000", "150000", "500000"]:
        subprocess.run([sys.executable, "-m", "tests.benchmarks.native_solver", "--one", case], check=True)


if __name__ == "__main__":
    main()
