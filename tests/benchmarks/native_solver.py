"""Time and memory of `parameterize` compared with one bare CHOLMOD analyze and factorize of the same matrix.

    build/venv/bin/python -m tests.benchmarks.native_solver [sizes ...]

A size is the number of vertices of a random bumpy disk (default 50000 150000 500000), or the path of an OBJ file. Each
size runs in its own process, and its figures are the best of several rounds. CHOLMOD calls the module's BLAS, with as
many threads as the module has or with one, whichever is faster. The other functions here measure the
module for the table (`build/venv/bin/python -m tests.benchmarks`).
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse
import spectral_conformal as sc

from tests.benchmarks import bare_cholmod, documents, generated, peers, runs
from tests.benchmarks.generated import Mesh
from tests.module import meshes as test_meshes
from tests.module import reference

# The tolerance of the operator Adjust Extender while the mouse moves.
ADJUST_TOLERANCE = 1e-4
# Of a matrix that is singular without it.
SHIFT = 1e-9
FEW_ROUNDS_FROM = 300_000
NO_BARE = "the module has no CHOLMOD"


def _rounds(n_vertices: int) -> int:
    return 3 if n_vertices < FEW_ROUNDS_FROM else 2


def _best(call: Callable[[], Any], rounds: int) -> tuple[float, Any]:
    """Return the seconds of the fastest of several calls, and what it returned."""
    found = []
    for _ in range(rounds):
        start = time.perf_counter()
        result = call()
        found.append((time.perf_counter() - start, result))
    return min(found, key=lambda each: each[0])


def _one_patch(meshes: Sequence[Mesh]) -> tuple[np.ndarray, np.ndarray]:
    (mesh,) = meshes
    return mesh.vertices, mesh.triangles()


def _shifted_energy(vertices: np.ndarray, triangles: np.ndarray) -> scipy.sparse.csc_matrix:
    matrix = reference.conformal_energy_matrix(vertices, triangles)
    return matrix + SHIFT * scipy.sparse.identity(len(vertices), format="csc")


def parameterize(meshes: Sequence[Mesh]) -> runs.Figures:
    """`parameterize` and bare CHOLMOD, of one patch."""
    vertices, triangles = _one_patch(meshes)
    before = runs.peak_megabytes()
    seconds, solution = _best(lambda: sc.parameterize(vertices, triangles), _rounds(len(vertices)))
    figures = {
        "vertices": len(vertices),
        "seconds": seconds,
        "phases": solution.timings,
        "solves": solution.iterations,
        "turning_number": solution.turning_number,
        "peak_megabytes": runs.peak_megabytes(),
        "peak_megabytes_before": before,
    }
    if not bare_cholmod.LIBRARY:
        return {**figures, "no_bare": NO_BARE}
    # As many as the module uses, or one, where the matrices are too small for several.
    shifted, counts = _shifted_energy(vertices, triangles), {1, os.cpu_count() or 1}
    bare = {n: _least(lambda n=n: bare_cholmod.seconds_to_factor(shifted, n), len(vertices)) for n in counts}
    best = min(bare, key=lambda n: sum(bare[n]))
    on = {"bare_threads": best, "threads": max(counts), "blas": bare_cholmod.blas()}
    return {**figures, "bare_analyze": bare[best][0], "bare_factorize": bare[best][1], **on}


def _least(call: Callable[[], tuple[float, float]], n_vertices: int) -> tuple[float, float]:
    return min((call() for _ in range(_rounds(n_vertices))), key=sum)


def unwrap(meshes: Sequence[Mesh]) -> runs.Figures:
    """`unwrap` beside `parameterize`, of one patch."""
    (mesh,) = meshes
    triangles = mesh.triangles()
    rounds = _rounds(len(mesh.vertices))
    single, _ = _best(lambda: sc.parameterize(mesh.vertices, triangles), rounds)
    whole, _ = _best(lambda: sc.unwrap(*mesh), rounds)
    return {"vertices": len(mesh.vertices), "unwrap": whole, "parameterize": single}


def unwrap_all(meshes: Sequence[Mesh]) -> runs.Figures:
    """`unwrap` of all meshes as one, with any number of islands."""
    whole = generated.joined(meshes)
    seconds, _ = _best(lambda: sc.unwrap(*whole), _rounds(len(whole.vertices)))
    return {"vertices": len(whole.vertices), "seconds": seconds}


def busy(meshes: Sequence[Mesh]) -> runs.Figures:
    """`parameterize` while other processes keep all cores busy, and while they are idle."""
    vertices, triangles = _one_patch(meshes)
    processes = os.cpu_count() or 1
    idle = _median(lambda: sc.parameterize(vertices, triangles))
    with _busy_cores(processes):
        slowed = _median(lambda: sc.parameterize(vertices, triangles))
    return {"vertices": len(vertices), "idle": idle, "busy": slowed, "processes": processes}


def _median(call: Callable[[], Any]) -> float:
    """Return the seconds of a call, the median of three: the best one would have met little other load."""
    return statistics.median(_best(call, 1)[0] for _ in range(3))


@contextmanager
def _busy_cores(count: int):
    processes = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.wait()


def extender_change(n: int) -> runs.Figures:
    """Update the map for a new strength of an extender with the kept factor, beside bare back-substitutions."""
    vertices, triangles = test_meshes.bumpy_disk(n)
    solver = sc.Solver(vertices, triangles)
    middle = len(vertices) // 2
    solver.solve(extenders=[(0, middle, 1.0)], tolerance=ADJUST_TOLERANCE)
    seconds, solves = [], []
    for strength in np.linspace(1.0, 3.0, 41)[1:]:
        start = time.perf_counter()
        solves.append(solver.solve(extenders=[(0, middle, float(strength))], tolerance=ADJUST_TOLERANCE).iterations)
        seconds.append(time.perf_counter() - start)
    figures = {
        "vertices": len(vertices),
        "seconds": statistics.median(seconds),
        "solves": statistics.median(solves),
    }
    if not bare_cholmod.LIBRARY:
        return {**figures, "no_bare": NO_BARE}
    return {**figures, "back_substitution": bare_cholmod.seconds_to_solve(_shifted_energy(vertices, triangles))}


def seam_change(meshes: Sequence[Mesh], parts: int) -> runs.Figures:
    """`unwrap` again with kept maps after one edge more has become a seam, beside the whole solve; of a grid.

    Seams cut the grid into `parts` times `parts` islands; the one that grows ends in the first.
    """
    (mesh,) = meshes
    side = round(len(mesh.vertices) ** 0.5)
    number = np.arange(side * side).reshape(side, side)
    inner = [k * side // parts for k in range(1, parts)]
    lines = [*number[inner], *number[:, inner].T, number[side // (2 * parts), : side // (2 * parts)]]
    seams = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])
    whole, again = [], []
    for _ in range(_rounds(len(mesh.vertices))):
        start = time.perf_counter()
        sc.unwrap(*mesh, seam_edges=seams)
        whole.append(time.perf_counter() - start)
        kept = sc.hosts.KeptMaps()
        sc.unwrap(*mesh, seam_edges=seams[:-1], kept_maps=kept)
        start = time.perf_counter()
        sc.unwrap(*mesh, seam_edges=seams, kept_maps=kept)
        again.append(time.perf_counter() - start)
    return {"vertices": len(mesh.vertices), "whole": min(whole), "again": min(again)}


def batch(name: str, faces: int) -> runs.Figures:
    """The batch on one generated mesh."""
    from tests.benchmarks import batch_cost

    return batch_cost.one_asset(name, faces)


def peer(meshes: Sequence[Mesh], name: str, program: str | None = None) -> runs.Figures:
    """Another program, of one patch or, by xatlas alone, of several."""
    mesh = generated.joined(meshes)
    return {"vertices": len(mesh.vertices), **peers.measure(name, mesh.vertices, mesh.triangles(), program)}


def main() -> None:
    """Print the table of `parameterize` beside bare CHOLMOD."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sizes", nargs="*", default=["50000", "150000", "500000"])
    options = parser.parse_args()
    titles = (
        "vertices",
        "`parameterize`, s",
        "threads",
        "bare CHOLMOD, s",
        "its threads",
        "ratio",
        "peak, GB",
        "solves",
    )
    table = documents.Table("native-solver", titles, documents.SOLVING)
    for case in options.sizes:
        disk = [generated.polygons(*test_meshes.bumpy_disk(int(case)))] if case.isdigit() else None
        found = runs.run("native_solver", "parameterize", {}, disk or [generated.read(Path(case))])
        bare = found["bare_analyze"] + found["bare_factorize"]
        cells = (f"{found['seconds']:.2f}", found["threads"], f"{bare:.2f}", found["bare_threads"])
        ratio, peak = f"{found['seconds'] / bare:.2f}", f"{found['peak_megabytes'] / 1e3:.2f}"
        table.row(f"{found['vertices']:,}", *cells, ratio, peak, found["solves"])


if __name__ == "__main__":
    if runs.is_measuring():
        runs.answer(parameterize, unwrap, unwrap_all, busy, extender_change, seam_change, batch, peer)
    else:
        main()
