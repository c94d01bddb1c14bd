# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces with maps in many pieces, whose islands are joined: counts, distortion, fill, length, processor time.

build/venv/bin/python -m tests.benchmarks.merged_islands [--faces 100000] [--islands 6000] [--qc-limit 1.01]
    [--mesh FILE.obj ...] [surface ...]

Without names: a bumpy sphere, which is smooth; others with noise; and a gyroid, which is bent everywhere.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import spectral_conformal as sc
from spectral_conformal import _island_merging as measuring
from spectral_conformal import defaults

from tests.benchmarks import generated_assets
from tests.module.scans import borders, bumpy_sphere, fragments

SMOOTH, SHAKEN = "bumpy sphere", "shaken sphere"
SURFACES = (SMOOTH, SHAKEN, "shaken scan", "cut gyroid", "terrain", "torn terrain")


def main() -> None:
    """Print three lines for each surface."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("surfaces", nargs="*", metavar="surface", help=f"{SMOOTH}, {SHAKEN}, or of generated_assets.py")
    parser.add_argument("--faces", type=int, default=100_000)
    parser.add_argument("--islands", type=int, default=6000)
    parser.add_argument("--qc-limit", type=float, default=defaults.UNATTENDED_SEAMS.qc_limit)
    parser.add_argument("--mesh", type=Path, nargs="*", default=[], help="OBJ files")
    arguments = parser.parse_args()
    for name, points, faces in _meshes(arguments):
        start = borders(faces, fragments(points, faces, min(arguments.islands, len(faces))))
        begin = time.process_time()
        merged = sc.suggest_seams(points, faces, start_edges=start, qc_limit=arguments.qc_limit)
        seconds = time.process_time() - begin
        print(f"{name}: {len(faces):,} faces; joined in {seconds:.1f} s of processor time")
        tell("before", sc.Mesh(points, faces).with_seams(start.astype(np.int32)))
        tell("after", merged)


def _meshes(arguments: argparse.Namespace) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    for name in arguments.surfaces or ([] if arguments.mesh else SURFACES):
        if name == SMOOTH:
            yield name, *bumpy_sphere(round((arguments.faces / 6) ** 0.5))
        elif name == SHAKEN:
            points, quads = bumpy_sphere(round((arguments.faces / 12) ** 0.5))
            triangles = np.r_[quads[:, :3], quads[:, [0, 2, 3]]]
            yield name, *generated_assets.shaken((points, triangles), 0.15, 1)
        else:
            yield name, *generated_assets.asset(name, arguments.faces)
    for path in arguments.mesh:
        lines = [line.split() for line in path.read_text().splitlines()]
        points = np.array([line[1:4] for line in lines if line[:1] == ["v"]], float)
        corners = [[int(corner.split("/")[0]) - 1 for corner in line[1:]] for line in lines if line[:1] == ["f"]]
        yield path.stem, points, np.array(corners)


def tell(name: str, mesh: sc.Mesh) -> None:
    """Print the measures of the map at the seams of a mesh."""
    result = sc.unwrap(mesh, options=defaults.MAPS, fold_free=True)
    charts, offsets = result.charts, mesh.face_offsets
    chart, corners = result.chart_of_face.astype(np.int64), np.arange(len(result.uv))
    qc, area = charts.column("mean_qc"), charts.column("area")
    qc, counted = np.nan_to_num(qc), np.where(np.isfinite(qc), area, 0.0)
    on_surface = measuring._face_areas(mesh.vertices, mesh.corner_vertices, offsets)
    flat = measuring._face_areas(np.c_[result.uv, np.zeros(len(corners))], corners, offsets)
    used = chart >= 0
    spread = 2.0 ** measuring._spread(on_surface[used], flat[used], chart[used], len(charts))
    fill = measuring._fill(result.uv, flat, chart, offsets, len(charts))
    ends = mesh.vertices[mesh.seam_edges]
    length = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum() / area.sum() ** 0.5

    def mean(values: np.ndarray) -> float:
        return float(np.average(values, weights=counted))

    counts = {what: int(charts.column(what).sum()) for what in ("flipped", "overlapping")}
    print(
        f"  {name:7}{len(charts):6} islands, QC mean {mean(qc):.4f}, of the worst {qc.max():.3f}, sizes within "
        f"{mean(spread):.3f}, of the worst {spread.max():.2f}, fill {mean(fill):.2f}, {counts['flipped']} flipped, "
        f"{counts['overlapping']} overlapping, seams {length:.1f} roots of the area",
        flush=True,
    )


if __name__ == "__main__":
    main()
