"""How much of the module's functions is parallel: seconds with one thread and with two, part by part.

    build/venv/bin/python -m tests.benchmarks.threads [task ...] [--scale S] [--keep]

By Amdahl's law a part that takes t1 and t2 seconds is serial for 2 t2 - t1 of them; with the serial share s of the
whole, 16 cores are at most 1 / (s + (1 - s) / 16) times as fast as one. The parts are the phases that a call reports,
of which those are named whose serial seconds exceed a tenth of the call. Use a machine with two idle cores. Each task
runs in its own process, by turns with one thread and with two; the best round counts. Seconds of the processor show
how much work the second thread adds.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import spectral_conformal as sc

from tests.benchmarks import documents, generated, packing, runs
from tests.benchmarks.generated import Mesh, Scene
from tests.module import meshes

CORES, ROUNDS = 16, 3
# Of the time, above which a serial part is named.
LARGE = 0.1
STEPS = 20


@dataclass
class Call:
    """One call: its seconds by the clock and of the processor, and those of its phases by the clock."""

    seconds: float
    processor: float
    phases: dict[str, float] = field(default_factory=dict)


class _Watch:
    """A progress function that times phases: each lasts from its first report to that of the next."""

    def __init__(self) -> None:
        self._start = time.perf_counter(), time.process_time()
        self._phases: dict[str, float] = {}
        self._current, self._since = "", self._start[0]

    def __call__(self, _fraction: float, phase: str) -> None:
        if phase != self._current:
            self._turn(phase)

    def _turn(self, phase: str) -> None:
        now = time.perf_counter()
        name = self._current or "before the first report"
        self._phases[name] = self._phases.get(name, 0.0) + now - self._since
        self._current, self._since = phase, now

    def end(self) -> Call:
        self._turn("")
        now = time.perf_counter(), time.process_time()
        return Call(now[0] - self._start[0], now[1] - self._start[1], self._phases)


def _timed(work: Callable[[_Watch], Any]) -> Call:
    watch = _Watch()
    work(watch)
    return watch.end()


def _unwrap(mesh: Mesh) -> Call:
    return _timed(lambda watch: sc.unwrap(*mesh, progress=watch))


def _unwrap_patch(mesh: Mesh) -> Call:
    found: list[sc.Unwrap] = []
    call = _timed(lambda _watch: found.append(sc.unwrap(*mesh)))
    # With several charts these are sums over threads.
    timings = found[0].timings
    return Call(call.seconds, call.processor, {**timings, "Python": call.seconds - sum(timings.values())})


def _suggest(mesh: Mesh) -> Call:
    return _timed(lambda watch: sc.suggest_seams(*mesh, progress=watch).seam_edges)


def _relax(mesh: Mesh) -> Call:
    triangles = mesh.triangles()
    uv = sc.parameterize(mesh.vertices, triangles).uv
    return _timed(lambda watch: meshes.relax(mesh.vertices, triangles, uv, sizes=1.0, progress=watch))


def _pack(steps: int) -> Callable[[Mesh], Call]:
    def packed(map_of: Mesh) -> Call:
        flat, triangles = map_of.vertices[:, :2], map_of.triangles()
        if not steps:
            return _timed(lambda watch: sc.Packer(meshes.flat(flat, triangles), progress=watch, keep_stacks=False))
        packer = sc.Packer(meshes.flat(flat, triangles), keep_stacks=False)
        return _timed(lambda watch: packer.step(steps, progress=watch))

    return packed


@dataclass(frozen=True)
class Task:
    """A function, the code that it measures, and its mesh by the scale of the number of vertices."""

    call: Callable[[Mesh], Call]
    mesh: Callable[[float], Mesh]


def _scene(scene: Scene) -> Callable[[float], Mesh]:
    return lambda scale: generated.joined(scene.scaled(scale).meshes())


def _islands(scale: float) -> Mesh:
    uv, triangles = packing.joined(packing.islands("mixed", max(4, round(1_000 * scale))))
    return generated.polygons(np.column_stack([uv, np.zeros(len(uv))]), triangles)


def _limbs(scale: float) -> Mesh:

    vertices, offsets, corners = meshes.limbs(max(400, round(40_000 * scale)), 16, 6)
    return Mesh(vertices, offsets, corners)


TASKS = {
    "`unwrap`, one patch of 134k": Task(_unwrap_patch, _scene(Scene(366, is_triangulated=True))),
    "`unwrap`, 1,000 islands of 64": Task(_unwrap, _scene(Scene(8, islands=1_000))),
    "`pack`, first packing of 1,000 islands": Task(_pack(0), _islands),
    f"`pack`, {STEPS} further steps": Task(_pack(STEPS), _islands),
    "`suggest_seams`, a body of 40k": Task(_suggest, _limbs),
    "`relax`, one patch of 44k": Task(_relax, _scene(Scene(210, is_triangulated=True))),
}


def task(meshes: Sequence[Mesh], name: str) -> runs.Figures:
    """Run a task by turns with one thread and with two; return the best calls."""
    (mesh,) = meshes
    calls: dict[int, list[Call]] = {1: [], 2: []}
    for _ in range(ROUNDS):
        for threads, found in calls.items():
            sc.limit_threads(threads)
            found.append(TASKS[name].call(mesh))
    best = {threads: min(found, key=lambda call: call.seconds) for threads, found in calls.items()}
    return {str(threads): vars(call) for threads, call in best.items()}


def serial_share(one: float, two: float) -> float:
    """Return which share of the `one` seconds is serial, if two threads take `two`."""
    return min(1.0, max(0.0, 2.0 * two / one - 1.0)) if one > 0.0 else 0.0


def bound(share: float, cores: int = CORES) -> float:
    """Return how many times as fast as one core that many are at most (Amdahl 1967)."""
    return 1.0 / (share + (1.0 - share) / cores)


def serial_parts(one: Call, two: Call) -> dict[str, float]:
    """Return the phases whose serial seconds exceed a tenth of the call, with this share of it, the largest first."""
    shares = {
        phase: seconds * serial_share(seconds, two.phases.get(phase, 0.0)) / one.seconds
        for phase, seconds in one.phases.items()
    }
    return {phase: share for phase, share in sorted(shares.items(), key=lambda each: -each[1]) if share > LARGE}


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tasks", nargs="*", metavar="task", help=f"whose name begins so, of {'; '.join(TASKS)}")
    parser.add_argument("--scale", type=float, default=1.0, help="of all numbers of vertices")
    parser.add_argument("--keep", action="store_true", help="put the table into the documents")
    options = parser.parse_args()
    titles = ("function", "1 thread, s (processor)", "2 threads, s (processor)", "serial", f"bound for {CORES} cores")
    code = (*documents.SEAMS, *documents.PACKING, *documents.RELAXING)
    table = documents.Table("threads", (*titles, "serial parts above a tenth"), code)
    for name, each in TASKS.items():
        if options.tasks and not any(name.replace("`", "").startswith(given) for given in options.tasks):
            continue
        found = runs.run("threads", "task", {"name": name}, [each.mesh(options.scale)])
        one, two = (Call(**found[threads]) for threads in ("1", "2"))
        share = serial_share(one.seconds, two.seconds)
        cells = (f"{call.seconds:.3f} ({call.processor:.3f})" for call in (one, two))
        parts = ", ".join(f"{phase} {100 * part:.0f} %" for phase, part in serial_parts(one, two).items())
        table.row(name, *cells, f"{100 * share:.0f} %", f"{bound(share):.1f} times", parts or "none")
    if options.keep:
        documents.keep(table)


if __name__ == "__main__":
    runs.answer(task) if runs.is_measuring() else main()
