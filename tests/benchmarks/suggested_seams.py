"""What suggested seams cost and bring, beside the island borders of Blender's Smart UV Project on the same mesh.

    build/venv/bin/python -m tests.benchmarks.suggested_seams [file.obj ...]

Runs in the environment's `bpy`. Suzanne in four resolutions, and, where the meshes beside the project exist, Spot, a
hand and others, which are closed: without seams nothing of them can be unwrapped.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import bpy
import numpy as np
import spectral_conformal

from tests.blender.inside import seam_measures
from tests.module import meshes

SHARED = Path(__file__).resolve().parents[3] / "shared" / "meshes" / "real"
CLOSED = ("spot_closed", "spot_quads_closed", "hand_oded_closed", "fish_quads_closed", "sword_quaddom_closed")


def load(path: Path) -> bpy.types.Object:
    vertices, faces = meshes.read_obj(path)
    mesh = bpy.data.meshes.new(path.stem)
    mesh.from_pydata(vertices.tolist(), [], faces)
    loaded = bpy.data.objects.new(path.stem, mesh)
    bpy.context.collection.objects.link(loaded)
    return loaded


def report(name: str, solid: bpy.types.Object) -> None:
    mesh = seam_measures.arrays(solid)
    start = time.perf_counter()
    seams = spectral_conformal.suggest_seams(*mesh)
    seconds = time.perf_counter() - start
    before = seam_measures.measure(spectral_conformal, mesh, np.zeros((0, 2), int))
    after = seam_measures.measure(spectral_conformal, mesh, seams)
    none = "none" if before.unsolved else f"{before.mean_qc:.4f}, {100 * before.within:.1f}"
    ratio = seam_measures.length(mesh[0], seams) / seam_measures.smart_project_border(solid)
    print(
        f"| {name} | {len(mesh[0])} | {none} | {after.mean_qc:.4f} | {100 * after.within:.1f} | {ratio:.2f} "
        f"| {after.islands} | {after.unsolved} | {seconds:.1f} |",
        flush=True,
    )


def main() -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    print(f"Blender {bpy.app.version_string}. The share of the area is that within a factor 2 of the median scale.\n")
    print(
        "| mesh | vertices | without: mean QC, area % | mean QC | area % | seams / Smart UV borders | islands", end=" "
    )
    print("| unsolved | seconds |\n|---|---|---|---|---|---|---|---|---|")
    paths = [Path(name) for name in sys.argv[1:]]
    if not paths:
        for levels in range(4):
            report(f"Suzanne, {levels} subdivisions", seam_measures.monkey(levels))
        paths = [path for name in CLOSED if (path := SHARED / f"{name}.obj").exists()]
    for path in paths:
        report(path.stem, load(path))


if __name__ == "__main__":
    main()
