"""Spectral Unwrap compared with Blender's Unwrap on scenes of every kind, in the same run.

    build/venv/bin/python -m tests.benchmarks.operator_scenes [scene ...] [--blender NAME] [--profile] [--json FILE]

Without scenes, runs all but the largest. `--blender` takes the names that the tests take, and may be repeated. Each
scene runs in its own process. The operators alternate after every second round, and the best round of each is reported.
Peak memory is that of the process, including Blender, after our first call. `--profile` adds our time by function, from
one more call under the profiler, which overstates small functions.
"""

from __future__ import annotations

import argparse
import cProfile
import importlib
import json
import pstats
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tests.benchmarks import runs
from tests.benchmarks.generated import Mesh, Scene

# Small scenes are repeated until this many seconds have passed, or this often.
SECONDS, MIN_ROUNDS, MAX_ROUNDS = 8.0, 2, 26
# Each operator runs this often in a row. The first round gets its memory from the system, which on a virtual machine
# takes as long as the solve, and loses it again while the other operator runs.
IN_A_ROW = 2
MOST_FUNCTIONS = 28
METHODS = ("CONFORMAL", "ANGLE_BASED", "MINIMUM_STRETCH")

SCENES = {
    "grid-36": Scene(6),
    "grid-529": Scene(23),
    "grid-44k": Scene(210),
    "grid-134k": Scene(366),
    "grid-535k": Scene(731),
    "grid-1M": Scene(1000),
    "scan-44k": Scene(210, is_sampled=True, noise=0.15),
    "scan-134k": Scene(366, is_sampled=True, noise=0.15),
    "scan-535k": Scene(731, is_sampled=True, noise=0.15),
    "islands-1000": Scene(8, islands=1000),
    "islands-6": Scene(60, islands=6),
    "objects-500": Scene(8, objects=500),
    "objects-10": Scene(8, objects=10, islands=100),
    "among-10000": Scene(8, bystanders=10_000),
}
LARGE = ("grid-134k", "grid-535k", "grid-1M", "scan-134k", "scan-535k")


def operators(
    meshes: Sequence[Mesh],
    methods: Sequence[str] = ("CONFORMAL",),
    seconds: float = SECONDS,
    is_profiled: bool = False,
    bystanders: int = 0,
) -> runs.Figures:
    """Run our operator and Blender's with the `methods` in this Blender, with further objects in the file."""
    import bpy  # first: it puts Blender's own modules on the path

    # The first call loads the native module.
    _make(bpy, Scene(3).meshes())
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    _make(bpy, meshes, bystanders)
    phases = _Phases()
    # Without them each call solves everything.
    session = importlib.import_module("spectral_unwrap.session")
    kept_maps = importlib.import_module("spectral_unwrap.session.kept_maps")
    memory_before = runs.peak_megabytes()
    ours: list[tuple[float, float, dict[str, float], dict[str, float]]] = []
    others: dict[str, list[tuple[float, float]]] = {method: [] for method in _known(bpy, methods)}
    start = time.perf_counter()
    while len(ours) < MIN_ROUNDS or (time.perf_counter() - start < seconds and len(ours) < MAX_ROUNDS):
        for _ in range(IN_A_ROW):
            session.drop(kept_maps.KeptMaps)
            phases.begin()
            elapsed, processor = _seconds(bpy.ops.uv.spectral_unwrap)
            if not ours:
                memory = runs.peak_megabytes()
            ours.append((elapsed, processor, phases.end(elapsed), phases.native()))
        for method, rounds in others.items():
            rounds += [_seconds(bpy.ops.uv.unwrap, method=method) for _ in range(IN_A_ROW)]
    best, _, parts, native = min(ours, key=lambda each: each[0])
    # As when a margin is adjusted.
    unchanged = min(_seconds(bpy.ops.uv.spectral_unwrap)[0] for _ in range(min(3, len(ours))))
    # What Blender keeps after every operator that a user calls, for Undo.
    bpy.ops.ed.undo_push(message="before")
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    parts["undo"] = _seconds(bpy.ops.ed.undo_push, message="after")[0]
    result = {
        "blender": bpy.app.version_string,
        "vertices": sum(len(mesh.vertices) for mesh in meshes),
        "rounds": len(ours),
        "seconds": best,
        "unchanged": unchanged,
        "processor_seconds": min(processor for _, processor, _, _ in ours),
        "python_seconds": min(elapsed - parts["native"] for elapsed, _, parts, _ in ours),
        "methods": {method: min(rounds)[0] for method, rounds in others.items()},
        "methods_processor": {method: min(each[1] for each in rounds) for method, rounds in others.items()},
        "peak_megabytes": memory,
        "megabytes_more": memory - memory_before,
        "phases": parts,
        "native_phases": native,
    }
    if is_profiled:
        session.drop(kept_maps.KeptMaps)
        result["profile"] = _profile(bpy.ops.uv.spectral_unwrap)
    return result


class _NativeStopwatch(runs.Stopwatch):
    """Also keeps the seconds that the compiled function reports."""

    phases: dict[str, float]

    def __call__(self, *arguments: object, **keywords: object) -> object:
        result = super().__call__(*arguments, **keywords)
        for phase, seconds in result["timings"].items():
            self.phases[phase] = self.phases.get(phase, 0.0) + seconds
        return result


class _Phases:
    """Stopwatches around the steps of the operator, none of which calls another."""

    def __init__(self) -> None:
        steps = importlib.import_module("spectral_unwrap.unwrapping.steps")
        compiled = importlib.import_module("spectral_unwrap.core.native").spectral_conformal()._native
        self._watches = {
            "read": runs.Stopwatch(steps, "read"),
            "native": _NativeStopwatch(compiled, "unwrap"),
            "place": runs.Stopwatch(steps, "place"),
            "write": runs.Stopwatch(importlib.import_module("spectral_unwrap.edit_mesh.write"), "write_uv"),
        }

    def begin(self) -> None:
        for watch in self._watches.values():
            watch.seconds = 0.0
        self._watches["native"].phases = {}

    def end(self, elapsed: float) -> dict[str, float]:
        """Return the seconds of the steps since `begin`, and of all else in the `elapsed` ones."""
        seconds = {name: watch.seconds for name, watch in self._watches.items()}
        return {**seconds, "rest": elapsed - sum(seconds.values())}

    def native(self) -> dict[str, float]:
        """Return the seconds of the native phases since `begin`, summed over threads."""
        return dict(self._watches["native"].phases)


def _known(bpy: Any, methods: Sequence[str]) -> list[str]:  # noqa: ANN401 - a module that only Blender has
    known = bpy.ops.uv.unwrap.get_rna_type().properties["method"].enum_items.keys()
    return [method for method in methods if method in known]


def _make(bpy: Any, meshes: Sequence[Mesh], bystanders: int = 0) -> None:  # noqa: ANN401
    import addon_utils

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.enable("spectral_unwrap")
    shared = bpy.data.meshes.new("Bystander")
    for _ in range(bystanders):
        bpy.context.collection.objects.link(bpy.data.objects.new("Bystander", shared))
    for given in meshes:
        mesh = mesh_of(bpy, given)
        new = bpy.data.objects.new("Object", mesh)
        bpy.context.collection.objects.link(new)
        new.select_set(True)
        bpy.context.view_layer.objects.active = new
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")


def mesh_of(bpy: Any, given: Mesh) -> Any:  # noqa: ANN401
    """Return a mesh of Blender's, with a UV map."""
    mesh = bpy.data.meshes.new("Mesh")
    mesh.vertices.add(len(given.vertices))
    mesh.vertices.foreach_set("co", given.vertices.ravel())
    mesh.loops.add(len(given.corner_vertices))
    mesh.loops.foreach_set("vertex_index", given.corner_vertices)
    mesh.polygons.add(len(given.face_offsets) - 1)
    mesh.polygons.foreach_set("loop_start", given.face_offsets[:-1])
    if bpy.app.version < (4, 1, 0):
        mesh.polygons.foreach_set("loop_total", np.diff(given.face_offsets))
    mesh.update(calc_edges=True)
    mesh.uv_layers.new(name="UVMap")
    return mesh


def _seconds(operator: Callable[..., set[str]], **options: str) -> tuple[float, float]:
    start, processor_start = time.perf_counter(), time.process_time()
    assert operator(**options) == {"FINISHED"}
    return time.perf_counter() - start, time.process_time() - processor_start


def _profile(operator: Callable[..., set[str]]) -> list[dict[str, Any]]:
    """Return the functions in which a call spends most of its time, each with the seconds in it and in it alone."""
    profile = cProfile.Profile()
    profile.runcall(operator)
    rows = [
        {"where": _place(file, name), "calls": calls, "own": own, "total": total}
        for (file, _, name), (_, calls, own, total, _) in pstats.Stats(profile).stats.items()
    ]
    most = MOST_FUNCTIONS
    return sorted(rows, key=lambda row: -row["total"])[:most] + sorted(rows, key=lambda row: -row["own"])[:most]


def _place(file: str, name: str) -> str:
    return name if file == "~" else f"{'/'.join(Path(file).parts[-2:])}: {name}"


def pins(meshes: Sequence[Mesh], moves: int = 6) -> runs.Figures:
    """Move a pin of an unwrapped mesh as live unwrapping does; return the seconds of the first map and of the later."""
    import bpy  # first: it puts Blender's own modules on the path
    import bmesh  # isort: skip

    _make(bpy, meshes)
    assert bpy.ops.uv.spectral_unwrap() == {"FINISHED"}
    reading = importlib.import_module("spectral_unwrap.edit_mesh.read")
    live = importlib.import_module("spectral_unwrap.live.pins")
    options = importlib.import_module("spectral_unwrap.core.solve.options").Options()
    bpy.ops.mesh.select_all(action="DESELECT")
    bm = bmesh.from_edit_mesh(bpy.context.object.data)
    layer = bm.loops.layers.uv.active
    bm.verts.ensure_lookup_table()
    count = len(bm.verts)
    held = [bm.verts[k] for k in np.linspace(0, count - 1, 6).astype(int)]
    for vertex in held:
        for loop in vertex.link_loops:
            loop[layer].pin_uv = True
    edit_mesh = reading.read_mesh(bpy.context.object, reading.Reading(all_visible=True))
    followed = live.PinnedMap(edit_mesh.mesh, edit_mesh.polygons, edit_mesh.polygons, None)
    seconds = []
    for move in range(moves):
        moved = held[2]
        place = moved.link_loops[0][layer].uv + type(moved.link_loops[0][layer].uv)((0.01, 0.004 * move))
        for loop in moved.link_loops:
            loop[layer].uv = place
        start = time.perf_counter()
        outcome = followed.follow(options, use_sync_selection=True, is_resting=True)
        seconds.append(time.perf_counter() - start)
        assert outcome is live.Followed.WRITTEN, outcome
    faces = sum(len(mesh.face_offsets) - 1 for mesh in meshes)
    return {"faces": faces, "first": seconds[0], "later": float(np.median(seconds[1:])), "moves": seconds}


def suggested_seams(subdivisions: int) -> runs.Figures:
    """Suggest seams for Suzanne; return the seconds."""
    import bpy  # noqa: F401 - first: it puts Blender's own modules on the path
    import spectral_conformal

    from tests.blender.inside import seam_measures

    mesh = seam_measures.arrays(seam_measures.monkey(subdivisions))
    start = time.perf_counter()
    seams = spectral_conformal.suggest_seams(*mesh).seam_edges
    return {"vertices": len(mesh[0]), "seconds": time.perf_counter() - start, "seam_edges": len(seams)}


def options_of(scene: Scene, options: Mapping[str, object]) -> runs.Figures:
    """Return the arguments with which `operators` measures a scene."""
    return {**options, "bystanders": scene.bystanders}


def run(scene: Scene, blender: str = runs.BLENDER, **options: object) -> runs.Figures:
    """Measure a scene in a process of its own."""
    return runs.run("operator_scenes", "operators", options_of(scene, options), scene.meshes(), blender)


def _print(name: str, figures: runs.Figures) -> None:
    methods = ", ".join(f"{method} {seconds:.4f}" for method, seconds in figures["methods"].items())
    print(
        f"| {figures['blender']} | {name} | {figures['vertices']} | {figures['seconds']:.4f} | {methods} "
        f"| {figures['python_seconds']:.4f} | {figures['processor_seconds']:.4f} "
        f"| {figures['peak_megabytes']:.0f} | {figures['megabytes_more']:.0f} |",
        flush=True,
    )
    for row in figures.get("profile", ()):
        print(f"    {row['total']:9.4f} {row['own']:9.4f} {row['calls']:8}  {row['where']}")


def main() -> None:
    """Measure the scenes named on the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="scene", help=f"of {', '.join(SCENES)}")
    parser.add_argument("--blender", action="append", help=f"default {runs.BLENDER}")
    parser.add_argument("--profile", action="store_true", help="where our time goes, by function")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    options = parser.parse_args()
    unknown = set(options.scenes) - set(SCENES)
    if unknown:
        parser.error(f"no scene {', '.join(sorted(unknown))}")
    print("| Blender | scene | vertices | spectral, s | Blender's, s | Python, s | processor, s | peak MB | MB more |")
    print("|---|---|---|---|---|---|---|---|---|")
    results = []
    for blender in options.blender or [runs.BLENDER]:
        for name in options.scenes or [name for name in SCENES if name not in LARGE]:
            results.append({"scene": name, **run(SCENES[name], blender, is_profiled=options.profile)})
            _print(name, results[-1])
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    runs.answer(operators, pins, suggested_seams) if runs.is_measuring() else main()
