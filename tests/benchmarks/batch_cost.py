# SPDX-License-Identifier: GPL-3.0-or-later
"""The cost of the batch per asset, and for a million assets: `python -m tests.benchmarks.batch_cost --assets 200`."""

import argparse
import json
import os
import resource
import tempfile
import time
from pathlib import Path

import numpy as np

from tests.module import batch_assets
from tools import batch

# The phases that are necessary without the batch, too.
DIRECT = ("read", "seams", "solve", "pack", "write")
SMALLEST, LARGEST = 100, 100_000


def write_assets(folder, count):
    """Write grids and tori from small to large, by a fixed seed, and the broken ones."""
    rng = np.random.default_rng(0)
    for k, faces in enumerate(np.exp(rng.uniform(np.log(SMALLEST), np.log(LARGEST), count))):
        side = round(faces**0.5)
        points, quads = batch_assets.torus(side, side) if k % 2 else batch_assets.grid(side, 0.3, k)
        batch_assets.write_obj(folder / f"{k:05}.obj", points, quads)
    batch_assets.write_broken(folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--assets", type=int, default=200)
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "in").mkdir()
        write_assets(folder / "in", options.assets)
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        arguments = [folder / "in", "--out", folder / "out", "--jobs", options.jobs, "--quiet"]
        code = batch.run([str(word) for word in arguments])
        wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
        summary = json.loads((folder / "out" / "summary.json").read_text())
        reports = [json.loads(path.read_text()) for path in (folder / "out").rglob("report.json")]
    # The batch waits for its workers, including those that it ends, so all of them count.
    processor = sum(getattr(after, f) - getattr(before, f) for f in ("ru_utime", "ru_stime"))
    worked = [report for report in reports if report["status"] == "unwrapped"]
    direct = sum(report["seconds"][phase] for report in worked for phase in DIRECT)
    faces = sum(report["totals"]["faces"] for report in worked)
    print(f"{summary['assets']} assets, {faces} faces: {summary['status']}, exit code {code}, {options.jobs} jobs")
    print(f"{wall:.1f} s by the clock, {wall * options.jobs / len(reports):.3f} job-seconds per asset")
    print(f"{processor / len(reports):.3f} processor-seconds per asset, {1e3 * processor / faces:.4f} per 1,000 faces")
    print(f"{wall * options.jobs / direct:.3f} times reading, seams, solving, packing and writing alone")
    names = dict.fromkeys(name for report in worked for name in report["seconds"])
    means = (f"{name} {sum(r['seconds'].get(name, 0.0) for r in worked) / len(worked):.3f}" for name in names)
    print(f"seconds per asset: {', '.join(means)}")
    print(f"{max(report['peak_memory'] for report in worked) / 2**20:.0f} MiB at most in a worker")
    print(f"a million: {wall * options.jobs / len(reports) * 1e6 / 3600:.0f} core-hours")


if __name__ == "__main__":
    main()
