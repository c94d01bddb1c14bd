# SPDX-License-Identifier: GPL-3.0-or-later
"""The shortest seams at a bound on the energy of even maps, beside OptCuts' on the same meshes.

    build/venv/bin/python -m tests.benchmarks.shortest_seams [mesh ...] [--priced]

Needs ../shared/meshes/optcuts: meshes, and the lengths, energies and processor times of OptCuts (Li et al. 2018), which
counts length alone. With --priced, seams are those that an artist would want: sharp edges and straight seams count
less, and distortion more. Prints one line per mesh, then the ratios of all.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np
import spectral_conformal

from tests.benchmarks.map_measures import Measures, measure

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "meshes" / "optcuts"
ENERGY = 4.1
"""OptCuts' bound on the mean symmetric Dirichlet energy."""


def suggested(mesh: tuple[np.ndarray, np.ndarray, np.ndarray], *, priced: bool) -> tuple[Measures, float]:
    """Measure the even, fold-free map of a mesh along suggested seams; and the processor time of the suggestion."""
    start = time.process_time()
    seams = spectral_conformal.suggest_seams(
        *mesh, energy_limit=ENERGY, area_blend=1.0, qc_limit=100.0, scale_limit=100.0, shortest=not priced
    ).seam_edges
    seconds = time.process_time() - start
    result = spectral_conformal.unwrap(*mesh, seam_edges=seams, area_blend=1.0, fold_free=True)
    span = 2.0 * max(np.ptp(result.uv, axis=0).max(), 1e-12)
    apart = np.repeat(result.chart_of_face, np.diff(mesh[1])) * span
    return measure(*mesh, result.uv + np.c_[apart, np.zeros(len(apart))]), seconds


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="*", metavar="mesh", help="names of OptCuts' meshes; all by default")
    parser.add_argument("--priced", action="store_true", help="seams as an artist wants them")
    options = parser.parse_args()
    if not FOLDER.is_dir():
        print(f"No meshes: {FOLDER} is missing.")
        return 1
    lengths = json.loads((FOLDER / "lengths.json").read_text())
    ratios, shares, energies = [], [], []
    print("| mesh | vertices | length | OptCuts | ratio | energy | islands | flipped, overlapping | s | share |")
    print("|---" * 10 + "|")
    for name in options.meshes or sorted(lengths, key=lambda name: lengths[name]["optcuts"]["vertices"]):
        theirs = lengths[name]["optcuts"]
        with np.load(FOLDER / f"{name}.npz") as arrays:
            mesh = tuple(arrays[key] for key in ("vertices", "face_offsets", "corner_vertices"))
        found, seconds = suggested(mesh, priced=options.priced)
        ratios.append(found.length / theirs["length"])
        shares.append(seconds / theirs["cpu_s"])
        energies.append(found.energy)
        print(
            f"| {name} | {len(mesh[0])} | {found.length:.3f} | {theirs['length']:.3f} | {ratios[-1]:.3f} "
            f"| {found.energy:.3f} | {found.islands} | {found.flipped}, {found.overlapping} "
            f"| {seconds:.2f} | {shares[-1]:.3f} |",
            flush=True,
        )
    print(
        f"\nOf {len(ratios)}: length over OptCuts' median {np.median(ratios):.3f}, mean {np.mean(ratios):.3f}, "
        f"largest {max(ratios):.3f}, shorter on {sum(ratio < 1 for ratio in ratios)}; "
        f"processor time over OptCuts' median {np.median(shares):.3f}, mean {np.mean(shares):.3f}; "
        f"energy mean {np.mean(energies):.3f}, largest {max(energies):.3f}."
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
