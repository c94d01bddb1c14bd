"""Native updates of a map while an extender's strength changes, beside one back-substitution of bare CHOLMOD.

    build/venv/bin/python -m tests.benchmarks.live_control [sizes ...]

Sizes are numbers of vertices of a random disk lifted to a bumpy surface (default 10000 50000). The update is
`Solver.solve` at the tolerance that the operator Adjust Extender uses while the mouse moves.
"""

from __future__ import annotations

import statistics
import sys
import time

import numpy as np
import scipy.sparse
import spectral_conformal as sc

from tests.benchmarks import bare_cholmod
from tests.module import meshes, reference

TOLERANCE = 1e-4


def measure(size: int) -> str:
    vertices, triangles = meshes.bumpy_disk(size)
    n = len(vertices)
    solver = sc.Solver(vertices, triangles)
    solver.solve(extenders=[(0, n // 2, 1.0)], tolerance=TOLERANCE)
    seconds, solves = [], []
    for strength in np.linspace(1.0, 3.0, 41)[1:]:
        start = time.perf_counter()
        solves.append(solver.solve(extenders=[(0, n // 2, float(strength))], tolerance=TOLERANCE).iterations)
        seconds.append(time.perf_counter() - start)
    update = statistics.median(seconds)
    matrix = reference.conformal_energy_matrix(vertices, triangles)
    bare = bare_cholmod.seconds_to_solve(matrix + 1e-9 * scipy.sparse.identity(n, format="csc"))
    return (
        f"| {n} | {1000 * update:.1f} | {1 / update:.0f} | {1000 * bare:.1f} | {update / bare:.1f} "
        f"| {statistics.median(solves):.0f} |"
    )


def main() -> None:
    print("| vertices | update, ms | updates a second | bare back-substitution, ms | ratio | solves |")
    print("|---|---|---|---|---|---|", flush=True)
    for size in sys.argv[1:] or ["10000", "50000"]:
        print(measure(int(size)), flush=True)


if __name__ == "__main__":
    main()
