"""Spectral Unwrap beside Blender's own Unwrap (CONFORMAL) on scenes of every kind, in the same run.

    build/venv/bin/python -m tests.benchmarks.operator_scenes [scene ...] [--blender NAME] [--phases] [--json FILE]

Without scenes all but the largest are run. `--blender` takes the names that the tests take, and may be repeated. Each
scene runs in a process of its own; both operators take turns, and the best of their rounds counts. The peak memory is
that of the process after our first call, without Blender's. `--phases` adds a table of where our time goes, from a
further call under the profiler, which makes small functions look larger than they are.
"""

from __future__ import annotations

import argparse
import cProfile
import importlib
import json
import pstats
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
BLENDER = "bpy-5.0.1"
MARK = "operator_scenes: "
# Small scenes are repeated until this many seconds have passed, or this often.
SECONDS, MAX_ROUNDS = 8.0, 25
PHASES = 28


@dataclass(frozen=True)
class Scene:
    """`objects` meshes of `islands` bumpy grids each, `side` vertices along a side of every grid, all in edit mode."""

    objects: int
    islands: int
    side: int
    is_default: bool = True

    @property
    def n_vertices(self) -> int:
        """Number of vertices of all meshes."""
        return self.objects * self.islands * self.side**2


SCENES = {
    "grid-36": Scene(1, 1, 6),
    "grid-529": Scene(1, 1, 23),
    "grid-44k": Scene(1, 1, 210),
    "grid-134k": Scene(1, 1, 366, is_default=False),
    "grid-535k": Scene(1, 1, 731, is_default=False),
    "islands-1000": Scene(1, 1000, 8),
    "islands-6": Scene(1, 6, 60),
    "objects-500": Scene(500, 1, 8),
    "objects-10": Scene(10, 100, 8),
}


def mesh_arrays(scene: Scene, number: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices (V, 3) and the quads (F, 4) of one mesh of the scene; islands differ in height and size."""
    side = scene.side
    y, x = np.divmod(np.arange(side**2), side)
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).reshape(-1, 1)
    quads = corner + np.array([0, 1, side + 1, side])
    plane = np.stack([x, y], axis=1) / (side - 1)
    height = 0.3 * np.sin(7.0 * plane[:, 0]) * np.cos(5.0 * plane[:, 1])
    vertices = []
    for island in range(scene.islands):
        scale = 1.0 + (number * scene.islands + island) % 17 / 17.0
        place = np.array([island % 32, island // 32]) * 3.0
        vertices.append(np.column_stack([plane * scale + place, height * scale * (1.0 + island % 5 / 5.0)]))
    faces = np.concatenate([quads + island * side**2 for island in range(scene.islands)])
    return np.concatenate(vertices), faces


def measure(scene: Scene, show_phases: bool) -> dict[str, Any]:
    """Run both operators in this Blender; return the figures."""
    import bpy  # first: it puts Blender's own modules on the path
    import addon_utils  # isort: skip

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.enable("spectral_unwrap")
    # The first call loads the native module.
    _make(bpy, Scene(1, 1, 3))
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.enable("spectral_unwrap")
    _make(bpy, scene)
    native = _timed_native()
    ours: list[tuple[float, float, float]] = []
    conformal: list[tuple[float, float]] = []
    memory_before = _peak_megabytes()
    start = time.perf_counter()
    while not ours or (time.perf_counter() - start < SECONDS and len(ours) < MAX_ROUNDS):
        native.seconds = 0.0
        ours.append((*_seconds(bpy.ops.uv.spectral_unwrap), native.seconds))
        if len(ours) == 1:
            memory = _peak_megabytes()
        conformal.append(_seconds(bpy.ops.uv.unwrap, method="CONFORMAL"))
    seconds, _, in_native = min(ours)
    result = {
        "blender": bpy.app.version_string,
        "vertices": scene.n_vertices,
        "rounds": len(ours),
        "seconds": seconds,
        "conformal_seconds": min(conformal)[0],
        "ratio": min(conformal)[0] / seconds,
        "native_seconds": in_native,
        "python_seconds": min(total - inside for total, _, inside in ours),
        "processor_seconds": min(processor for _, processor, _ in ours),
        "conformal_processor_seconds": min(processor for _, processor in conformal),
        "peak_megabytes": memory,
        "megabytes_more": memory - memory_before,
    }
    if show_phases:
        result["phases"] = _phases(bpy.ops.uv.spectral_unwrap)
    return result


def _make(bpy: Any, scene: Scene) -> None:  # noqa: ANN401 - a module that only Blender has
    for number in range(scene.objects):
        vertices, faces = mesh_arrays(scene, number)
        mesh = bpy.data.meshes.new("Mesh")
        mesh.vertices.add(len(vertices))
        mesh.vertices.foreach_set("co", vertices.ravel())
        mesh.loops.add(faces.size)
        mesh.loops.foreach_set("vertex_index", faces.ravel())
        mesh.polygons.add(len(faces))
        mesh.polygons.foreach_set("loop_start", np.arange(0, faces.size, 4))
        if bpy.app.version < (4, 1, 0):
            mesh.polygons.foreach_set("loop_total", np.full(len(faces), 4))
        mesh.update(calc_edges=True)
        mesh.uv_layers.new(name="UVMap")
        new = bpy.data.objects.new("Object", mesh)
        bpy.context.collection.objects.link(new)
        new.select_set(True)
        bpy.context.view_layer.objects.active = new
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")


@dataclass
class _Timed:
    """A function that adds up the seconds spent in it."""

    function: Callable[..., Any]
    seconds: float = 0.0

    def __call__(self, *arguments: object) -> object:
        start = time.perf_counter()
        try:
            return self.function(*arguments)
        finally:
            self.seconds += time.perf_counter() - start


def _timed_native() -> _Timed:
    """Put a stopwatch round the compiled function that unwraps."""
    compiled = importlib.import_module("spectral_unwrap.core.native").spectral_conformal()._native
    compiled.unwrap = _Timed(compiled.unwrap)
    return compiled.unwrap


def _seconds(operator: Callable[..., set[str]], **options: str) -> tuple[float, float]:
    start, processor_start = time.perf_counter(), time.process_time()
    assert operator(**options) == {"FINISHED"}
    return time.perf_counter() - start, time.process_time() - processor_start


def _phases(operator: Callable[..., set[str]]) -> list[dict[str, Any]]:
    """Return the functions in which a call spends most of its time, each with the seconds in it and in it alone."""
    profile = cProfile.Profile()
    profile.runcall(operator)
    rows = [
        {"where": _place(file, name), "calls": calls, "own": own, "total": total}
        for (file, _, name), (_, calls, own, total, _) in pstats.Stats(profile).stats.items()
    ]
    return sorted(rows, key=lambda row: -row["total"])[:PHASES] + sorted(rows, key=lambda row: -row["own"])[:PHASES]


def _place(file: str, name: str) -> str:
    return name if file == "~" else f"{'/'.join(Path(file).parts[-2:])}: {name}"


def _peak_megabytes() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


def run(name: str, blender_name: str, show_phases: bool) -> dict[str, Any]:
    """Measure a scene in a process of its own."""
    from tests.blender import blenders

    blender = next(b for b in (*blenders.all_blenders(), *blenders.further_blenders()) if b.name == blender_name)
    with tempfile.TemporaryDirectory() as folder:
        environment = blender.make_profile(Path(folder))
        command = blender.script_command(Path(__file__))
        arguments = [*([] if blender.python else ["--"]), "--inside", name, *(["--phases"] if show_phases else [])]
        done = subprocess.run([*command, *arguments], env=environment, cwd=ROOT, capture_output=True, text=True)
    found = [line for line in done.stdout.splitlines() if line.startswith(MARK)]
    if not found:
        raise RuntimeError(f"{name} in {blender_name} ended with {done.returncode}:\n{done.stdout}\n{done.stderr}")
    return {"scene": name, **json.loads(found[0].removeprefix(MARK))}


def _print(figures: dict[str, Any]) -> None:
    print(
        f"{figures['blender']:8} {figures['scene']:13} {figures['vertices']:8,} {figures['seconds']:9.4f} "
        f"{figures['conformal_seconds']:10.4f} {figures['ratio']:6.2f} {figures['native_seconds']:9.4f} "
        f"{figures['python_seconds']:9.4f} {figures['processor_seconds']:9.4f} "
        f"{figures['peak_megabytes']:8.0f} {figures['megabytes_more']:6.0f}",
        flush=True,
    )
    for row in figures.get("phases", ()):
        print(f"    {row['total']:9.4f} {row['own']:9.4f} {row['calls']:8}  {row['where']}")


def main() -> None:
    """Measure the scenes named on the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="scene", help=f"of {', '.join(SCENES)}")
    parser.add_argument("--blender", action="append", help=f"default {BLENDER}")
    parser.add_argument("--phases", action="store_true", help="where our time goes")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    options = parser.parse_args()
    unknown = set(options.scenes) - set(SCENES)
    if unknown:
        parser.error(f"no scene {', '.join(sorted(unknown))}")
    print("Blender  scene         vertices    ours, s CONFORMAL, s ratio native, s Python, s processor peak, MB more")
    results = []
    for blender in options.blender or [BLENDER]:
        for name in options.scenes or [name for name, scene in SCENES.items() if scene.is_default]:
            results.append(run(name, blender, options.phases))
            _print(results[-1])
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")


def inside() -> None:
    """Measure one scene in the Blender that runs this file."""
    arguments = sys.argv[sys.argv.index("--inside") + 1 :]
    print(f"\n{MARK}{json.dumps(measure(SCENES[arguments[0]], '--phases' in arguments))}", flush=True)


if __name__ == "__main__":
    if "--inside" in sys.argv:
        inside()
    else:
        main()
