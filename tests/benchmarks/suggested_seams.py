"""Suggested seams compared with xatlas and Blender's Smart UV Project on the same meshes.

    build/venv/bin/python -m tests.benchmarks.suggested_seams [file.obj or folder ...] [--keep]
    build/venv/bin/python -m tests.benchmarks.suggested_seams limbs [--keep]     # nine bodies with many limbs

Runs in the environment's `bpy`; xatlas is skipped if not installed (pip install xatlas). The default meshes are Suzanne
at three resolutions, boxes, a creature and, if present, the closed meshes beside the project. Prints one line per mesh
and method, then a table of islands / length / energy, with the means of each method over all meshes.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from dataclasses import astuple
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import spectral_conformal

from tests.benchmarks import documents
from tests.benchmarks.map_measures import Measures, measure
from tests.blender.inside import seam_measures
from tests.module import meshes
from tests.module.test_suggest_seams import box, closed_creature

try:
    import xatlas
except ImportError:
    xatlas = None

SHARED = Path(__file__).resolve().parents[3] / "shared" / "meshes" / "real"
# Vertices, limbs, seed.
LIMBS = (
    *((4000, 16, 6), (4000, 16, 5), (3000, 14, 3), (2500, 12, 1), (3500, 20, 2)),
    *((4500, 18, 4), (3200, 16, 7), (4000, 12, 8), (3000, 20, 9)),
)
Arrays = tuple[np.ndarray, np.ndarray, np.ndarray]


def solid_of(name: str, mesh: Arrays) -> bpy.types.Object:
    vertices, offsets, corners = mesh
    data = bpy.data.meshes.new(name)
    data.from_pydata(vertices.tolist(), [], [face.tolist() for face in np.split(corners, offsets[1:-1])])
    solid = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(solid)
    return solid


def loaded(path: Path) -> Arrays:
    vertices, faces = meshes.read_obj(path)
    return vertices, *meshes.polygons(faces)


def spectral(mesh: Arrays, **maps: Any) -> tuple[Arrays, np.ndarray, float]:
    """Suggested seams, unwrapped; islands that fail are points."""
    start = time.process_time()
    seams = spectral_conformal.suggest_seams(*mesh, **maps).seam_edges
    seconds = time.process_time() - start
    result = spectral_conformal.unwrap(*mesh, seam_edges=seams, fold_free=bool(maps), **maps)
    span = 2.0 * max(np.ptp(result.uv, axis=0).max(), 1e-12)
    apart = result.uv + np.c_[np.repeat(result.chart_of_face, np.diff(mesh[1])), np.zeros(len(result.uv))] * span
    return mesh, apart, seconds


def even(mesh: Arrays) -> tuple[Arrays, np.ndarray, float]:
    """Seams for maps with even sizes."""
    return spectral(mesh, area_blend=1.0)


def by_xatlas(mesh: Arrays) -> tuple[Arrays, np.ndarray, float]:
    """Triangulated, because xatlas takes nothing else."""
    vertices, offsets, corners = mesh
    fans = [corners[[a, a + k, a + k + 1]] for a, b in zip(offsets[:-1], offsets[1:]) for k in range(1, b - a - 1)]
    start = time.process_time()
    _, indices, uv = xatlas.parametrize(vertices.astype(np.float32), np.array(fans, np.uint32))
    seconds = time.process_time() - start
    # Its UVs are fractions of an atlas that need not be square.
    atlas = xatlas.Atlas()
    atlas.add_mesh(vertices.astype(np.float32), np.array(fans, np.uint32))
    atlas.generate()
    uv = uv * [atlas.width, atlas.height]
    return (vertices, *meshes.polygons(fans)), uv[indices.ravel()].astype(float), seconds


def smart_project(mesh: Arrays) -> tuple[Arrays, np.ndarray, float]:
    """Blender's Smart UV Project with its default settings."""
    solid = solid_of("solid", mesh)
    start = time.process_time()
    seam_measures.smart_project_border(solid)
    seconds = time.process_time() - start
    uv = np.empty(2 * len(mesh[2]), np.float32)
    solid.data.uv_layers.active.uv.foreach_get("vector", uv)
    bpy.data.objects.remove(solid)
    return mesh, uv.reshape(-1, 2).astype(float), seconds


METHODS: dict[str, Callable[[Arrays], tuple[Arrays, np.ndarray, float]]] = {
    "suggested": spectral,
    "even": even,
    **({"xatlas": by_xatlas} if xatlas else {}),
    "Smart UV Project": smart_project,
}


def cases(arguments: list[str]) -> Iterator[tuple[str, Arrays]]:
    if arguments == ["limbs"]:
        for body in LIMBS:
            yield "{} vertices, {} limbs, seed {}".format(*body), meshes.limbs(*body)
        return
    for argument in map(Path, arguments):
        for path in sorted(argument.rglob("*.obj")) if argument.is_dir() else [argument]:
            yield path.stem, loaded(path)
    if arguments:
        return
    for levels in range(3):
        yield f"Suzanne, {levels} subdivisions", seam_measures.arrays(seam_measures.monkey(levels))
    yield "cube", box((1, 1, 1), 1)
    yield "fine cube", box((1, 1, 1), 8)
    yield "plank", box((3, 1, 0.3), 6)
    yield "creature", closed_creature(16)
    for path in sorted(SHARED.glob("*closed*.obj")):
        yield path.stem, loaded(path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="*", metavar="file.obj, folder or `limbs`")
    parser.add_argument("--keep", action="store_true", help="put the table into the documents")
    options = parser.parse_args()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    print(
        f"Blender {bpy.app.version_string}. Length of the seams over the root of the area; energy: symmetric Dirichlet."
    )
    print(
        "\n| mesh | vertices | method | islands | length | energy | flipped | overlapping | seconds |\n"
        + 9 * "|---"
        + "|"
    )
    totals: dict[str, list[tuple[Measures, float]]] = {name: [] for name in METHODS}
    rows = []
    for name, mesh in cases(options.meshes):
        rows.append([name, f"{len(mesh[0]):,}"])
        for method, unwrapped in METHODS.items():
            (vertices, offsets, corners), uv, seconds = unwrapped(mesh)
            found = measure(vertices, offsets, corners, uv)
            totals[method].append((found, seconds))
            rows[-1].append(f"{found.islands} / {found.length:.1f} / {found.energy:.2f}")
            print(
                f"| {name} | {len(vertices)} | {method} | {found.islands} | {found.length:.2f} | {found.energy:.3f} "
                f"| {found.flipped} | {found.overlapping} | {seconds:.2f} |",
                flush=True,
            )
    name = "limbs" if options.meshes == ["limbs"] else "suggested-seams"
    table = documents.Table(name, ("mesh", "vertices", *METHODS), documents.SEAMS)
    for row in rows:
        table.row(*row)
    means = {method: np.mean([astuple(found) for found, _ in results], axis=0) for method, results in totals.items()}
    table.row(f"mean of {len(rows)}", "", *(f"{m[0]:.1f} / {m[1]:.1f} / {m[2]:.2f}" for m in means.values()))
    table.row("processor, s", "", *(f"{np.mean([s for _, s in results]):.2f}" for results in totals.values()))
    if options.keep:
        documents.keep(table)


if __name__ == "__main__":
    main()
