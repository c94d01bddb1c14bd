# SPDX-License-Identifier: GPL-3.0-or-later
"""A bumpy sphere with a map in many pieces, whose islands are joined: counts, distortion, length, processor time.

build/venv/bin/python -m tests.benchmarks.merged_islands [--side 130] [--islands 6000] [--qc-limit 1.01]
"""

from __future__ import annotations

import argparse
import time

import numpy as np
import spectral_conformal as sc
from spectral_conformal import defaults

from tests.module.scans import borders, bumpy_sphere, fragments


def main() -> None:
    """Print one line before and one after."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--side", type=int, default=130, help="quads along a side of the cube; 6 times its square")
    parser.add_argument("--islands", type=int, default=6000)
    parser.add_argument("--qc-limit", type=float, default=defaults.UNATTENDED_SEAMS.qc_limit)
    arguments = parser.parse_args()
    points, faces = bumpy_sphere(arguments.side)
    start = borders(faces, fragments(points, faces, arguments.islands))
    begin = time.process_time()
    merged = sc.suggest_seams(points, faces, start_edges=start, qc_limit=arguments.qc_limit)
    seconds = time.process_time() - begin
    print(f"{len(faces):,} faces; joined in {seconds:.1f} s of processor time")
    before = sc.Mesh(points, faces).with_seams(start.astype(np.int32))
    for name, mesh in (("before", before), ("after", merged)):
        tell(name, mesh, points)


def tell(name: str, mesh: sc.Mesh, points: np.ndarray) -> None:
    """Print the measures of the map at the seams of a mesh."""
    charts = sc.unwrap(mesh, options=defaults.MAPS).charts
    qc, area = charts.column("mean_qc"), charts.column("area")
    ends = points[mesh.seam_edges]
    length = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum() / area.sum() ** 0.5
    counts = {what: int(charts.column(what).sum()) for what in ("flipped", "overlapping")}
    print(
        f"{name:7}{len(charts):6} islands, QC mean {(qc * area).sum() / area.sum():.4f}, of the worst {qc.max():.4f}, "
        f"{counts['flipped']} flipped, {counts['overlapping']} overlapping, seams {length:.1f} roots of the area"
    )


if __name__ == "__main__":
    main()
