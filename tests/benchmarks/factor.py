# SPDX-License-Identifier: GPL-3.0-or-later
"""The module's factorization compared with bare CHOLMOD's (METIS or AMD, its default), for the same conformal energy.

    build/venv/bin/python -m tests.benchmarks.factor [--keep]

Run it from the project's folder, on idle cores. The meshes are grids, and disks of scattered vertices in random order.
Each runs with one thread and with one per core, on the same BLAS; each time is the best of three.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Callable

import numpy as np

from tests.benchmarks import documents

SIZES = (44_000, 134_000, 535_000)
ROUNDS = 3


def grid(n: int) -> tuple[np.ndarray, np.ndarray]:
    """A saddle of triangulated quads, numbered row by row."""
    from tests.module import meshes

    vertices, quads = meshes.saddle_quads(round(n**0.5))
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def scattered(n: int) -> tuple[np.ndarray, np.ndarray]:
    """A disk of scattered vertices in no order."""
    from tests.module import meshes

    return meshes.bumpy_disk(n)


KINDS: dict[str, Callable[[int], tuple[np.ndarray, np.ndarray]]] = {"grid": grid, "scattered": scattered}


def measure(kind: str, n: int, threads: int) -> tuple[int, float, float]:
    """Return the number of vertices, and the seconds of the module and of bare CHOLMOD."""
    import spectral_conformal as sc

    from tests.benchmarks import bare_cholmod
    from tests.benchmarks.native_solver import _shifted_energy

    vertices, triangles = KINDS[kind](n)
    sc.limit_threads(threads)
    own = min(sc.parameterize(vertices, triangles).timings["factorization"] for _ in range(ROUNDS))
    matrix = _shifted_energy(vertices, triangles)
    bare = min(sum(bare_cholmod.seconds_to_factor(matrix, threads)) for _ in range(ROUNDS))
    return len(vertices), own, bare


def main() -> int:
    """Print the table, each row from a process of its own."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keep", action="store_true", help="put the table into the documents")
    options = parser.parse_args()
    titles = ("mesh", "vertices", "threads", "module, s", "bare CHOLMOD, s", "ratio")
    table = documents.Table("factor", titles, documents.SOLVING)
    for kind in KINDS:
        for n in SIZES:
            for threads in sorted({1, os.cpu_count() or 1}):
                call = f"factor.measure({kind!r}, {n}, {threads})"
                code = f"import json; from tests.benchmarks import factor; print(json.dumps({call}))"
                said = subprocess.run([sys.executable, "-c", code], check=True, stdout=subprocess.PIPE, text=True)
                vertices, own, bare = json.loads(said.stdout)
                table.row(kind, f"{vertices:,}", threads, f"{own:.3f}", f"{bare:.3f}", f"{own / bare:.2f}")
    if options.keep:
        documents.keep(table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
