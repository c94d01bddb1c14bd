# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces with maps in many pieces, whose islands are joined: counts, distortion, fill, processor time.

build/venv/bin/python -m tests.benchmarks.merged_islands [--faces 100000] [--islands 6000] [--qc-limit 1.01]
    [--mesh FILE.obj ...] [--keep] [surface ...]

Without names: a bumpy sphere, which is smooth; others with noise; and a gyroid, which is bent everywhere.
The mean QC of as many compact pieces, cut without regard to distortion, shows what noise costs any such map; so does
that of a twin without the noise, which is cut at the same edges.
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

from tests.benchmarks import documents, generated_assets
from tests.module.scans import borders, bumpy_sphere, fragments

SMOOTH, SHAKEN, SCAN = "bumpy sphere", "shaken sphere", "shaken scan"
SURFACES = (SMOOTH, SHAKEN, SCAN, "cut gyroid", "terrain", "torn terrain")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("surfaces", nargs="*", metavar="surface", help=f"{SMOOTH}, {SHAKEN}, or of generated_assets.py")
    parser.add_argument("--faces", type=int, default=100_000)
    parser.add_argument("--islands", type=int, default=6000)
    parser.add_argument("--qc-limit", type=float, default=defaults.UNATTENDED_SEAMS.qc_limit)
    parser.add_argument("--keep", action="store_true", help="put the table into the documents")
    parser.add_argument("--mesh", type=Path, nargs="*", default=[], help="OBJ files")
    arguments = parser.parse_args()
    titles = (
        "surface",
        "faces",
        "islands",
        "mean QC",
        "of as many pieces",
        "of these islands without noise",
        "QC of the worst",
        "fill",
        "flipped or overlapping",
        "processor, s",
    )
    code = (*documents.SEAMS, "native/python/spectral_conformal/_island_merging.py")
    table = documents.Table("merged-islands", titles, code)
    for name, points, faces, clean in _meshes(arguments):
        start = borders(faces, fragments(points, faces, min(arguments.islands, len(faces))))
        _row(table, name, points, faces, start, arguments.qc_limit, clean)
        if clean is not None:
            _row(table, f"{name} without noise", clean, faces, start, arguments.qc_limit)
    if arguments.keep:
        documents.keep(table)


def _row(
    table: documents.Table,
    name: str,
    points: np.ndarray,
    faces: np.ndarray,
    start: np.ndarray,
    qc_limit: float,
    clean: np.ndarray | None = None,
) -> None:
    """Merge the islands between the `start` edges, and add their row; `clean` are the points without noise."""
    begin = time.process_time()
    merged = sc.suggest_seams(points, faces, start_edges=start, qc_limit=qc_limit)
    seconds = time.process_time() - begin
    both = [measured(sc.Mesh(points, faces).with_seams(start.astype(np.int32))), measured(merged)]
    count, qc, *cells = (" to ".join(pair) for pair in zip(*both, strict=True))
    pieces = borders(faces, fragments(points, faces, int(both[1][0].replace(",", ""))))
    of_pieces = measured(sc.Mesh(points, faces).with_seams(pieces.astype(np.int32)))[1]
    twin = "" if clean is None else measured(sc.Mesh(clean, faces).with_seams(merged.seam_edges))[1]
    table.row(name, f"{len(faces):,}", count, qc, of_pieces, twin, *cells, f"{seconds:.0f}")


def _meshes(arguments: argparse.Namespace) -> Iterator[tuple[str, np.ndarray, np.ndarray, np.ndarray | None]]:
    """Yield names, points and faces, and the points without noise of a surface with some."""
    for name in arguments.surfaces or ([] if arguments.mesh else SURFACES):
        clean = None
        if name == SMOOTH:
            points, faces = bumpy_sphere(round((arguments.faces / 6) ** 0.5))
        elif name == SHAKEN:
            clean, quads = bumpy_sphere(round((arguments.faces / 12) ** 0.5))
            triangles = np.r_[quads[:, :3], quads[:, [0, 2, 3]]]
            points, faces = generated_assets.shaken((clean, triangles), 0.15, 1)
        elif name == SCAN:
            clean, triangles = generated_assets.of_size(generated_assets.scan, arguments.faces)
            points, faces = generated_assets.shaken_scan((clean, triangles))
        else:
            points, faces = generated_assets.asset(name, arguments.faces)
        yield name, points, faces, clean
    for path in arguments.mesh:
        lines = [line.split() for line in path.read_text().splitlines()]
        points = np.array([line[1:4] for line in lines if line[:1] == ["v"]], float)
        corners = [[int(corner.split("/")[0]) - 1 for corner in line[1:]] for line in lines if line[:1] == ["f"]]
        yield path.stem, points, np.array(corners), None


def measured(mesh: sc.Mesh) -> tuple[str, str, str, str, str]:
    """Return the islands of the map at a mesh's seams, their mean and worst QC, fill, and defective faces."""
    result = sc.unwrap(mesh, options=defaults.MAPS, fold_free=True)
    charts, offsets = result.charts, mesh.face_offsets
    chart, corners = result.chart_of_face.astype(np.int64), np.arange(len(result.uv))
    qc, area = charts.column("mean_qc"), charts.column("area")
    qc, counted = np.nan_to_num(qc), np.where(np.isfinite(qc), area, 0.0)
    flat = measuring._face_areas(np.c_[result.uv, np.zeros(len(corners))], corners, offsets)
    fill = measuring._fill(result.uv, flat, chart, offsets, len(charts))

    def mean(values: np.ndarray) -> float:
        return float(np.average(values, weights=counted))

    defects = sum(int(charts.column(what).sum()) for what in ("flipped", "overlapping"))
    return f"{len(charts):,}", f"{mean(qc):.3f}", f"{qc.max():.3f}", f"{mean(fill):.2f}", f"{defects}"


if __name__ == "__main__":
    main()
