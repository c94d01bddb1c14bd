# SPDX-License-Identifier: GPL-3.0-or-later
"""The cost of the batch.

    build/venv/bin/python -m tests.benchmarks.batch_cost [--assets N] [--jobs N] [--keep]
    build/venv/bin/python -m tests.benchmarks.batch_cost --million [NAME ...] [--faces N] [--keep]

The first form runs the batch over many generated assets, from small to large, and prints the cost per asset and that of
a million. The second runs it over PLY files of a million faces (generated_assets.py) or more, one at a time.
"""

import argparse
import json
import os
import resource
import tempfile
import time
from pathlib import Path

import numpy as np

from tests.benchmarks import documents, generated, generated_assets
from tests.module import batch_assets
from tools import batch

# The phases that are necessary without the batch, too.
DIRECT = ("read", "seams", "solve", "pack", "write")
SMALLEST, LARGEST = 100, 100_000
MILLION = ("blobs, 600", "shaken scan", "torn terrain", "welded primitives")
CODE = (*documents.SEAMS, *documents.PACKING, "native/python/spectral_conformal/assets")
CODE += ("native/python/spectral_conformal/batch",)


def write_assets(folder, count):
    """Write grids and tori from small to large, by a fixed seed, and the broken ones."""
    rng = np.random.default_rng(0)
    for k, faces in enumerate(np.exp(rng.uniform(np.log(SMALLEST), np.log(LARGEST), count))):
        side = round(faces**0.5)
        points, quads = batch_assets.torus(side, side) if k % 2 else batch_assets.grid(side, 0.3, k)
        batch_assets.write_obj(folder / f"{k:05}.obj", points, quads)
    batch_assets.write_broken(folder)


def one_asset(name, faces):
    """Run the batch on a mesh of generated_assets.py, with its defaults; return its figures."""
    with tempfile.TemporaryDirectory() as folder:
        given, made = Path(folder) / "asset.ply", Path(folder) / "out"
        generated.write_ply(given, *generated_assets.asset(name, faces))
        code = batch.run([str(given), "--out", str(made), "--jobs", "1", "--threads", str(os.cpu_count()), "--quiet"])
        (report,) = (json.loads(path.read_text()) for path in made.rglob("report.json"))
    if code:
        raise RuntimeError(f"The batch ended with {code}: {report}")
    return {
        "seconds": report["seconds"],
        "gigabytes": report["peak_memory"] / 2**30,
        "islands": len(report["islands"]),
        "mean_qc": report["totals"]["qc_mean"],
    }


def of_millions(names, faces):
    """Print the cost of large meshes; return the table."""
    table = documents.Table(
        "million-batch",
        (f"mesh of {faces:,} faces", "seams / solve / pack / all, s", "peak, GB", "islands", "mean QC"),
        CODE,
    )
    for name in names:
        found = one_asset(name, faces)
        seconds = [*(found["seconds"][phase] for phase in ("seams", "solve", "pack")), found["seconds"]["total"]]
        measures = (f"{found['gigabytes']:.1f}", f"{found['islands']:,}", f"{found['mean_qc']:.3f}")
        table.row(name, " / ".join(f"{each:.0f}" for each in seconds), *measures)
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--assets", type=int, default=200)
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--million", nargs="*", metavar="NAME", help=f"default: {'; '.join(MILLION)}")
    parser.add_argument("--faces", type=int, default=1_000_000, help="of each mesh of --million, about")
    parser.add_argument("--keep", action="store_true", help="put the table into the documents")
    options = parser.parse_args()
    if options.keep and options.faces != 1_000_000:
        parser.error("The documents have a table of a million faces alone.")
    table = of_assets(options) if options.million is None else of_millions(options.million or MILLION, options.faces)
    if options.keep:
        documents.keep(table)


def of_assets(options):
    """Print the cost of many assets; return the table."""
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
    print(f"{wall:.1f} s by the clock")
    print(f"{processor / len(reports):.3f} processor-seconds per asset, {1e3 * processor / faces:.4f} per 1,000 faces")
    names = dict.fromkeys(name for report in worked for name in report["seconds"])
    means = (f"{name} {sum(r['seconds'].get(name, 0.0) for r in worked) / len(worked):.3f}" for name in names)
    print(f"seconds per asset: {', '.join(means)}")
    titles = ("assets", "faces", "job-seconds per asset", "over reading, unwrapping and writing")
    table = documents.Table("batch-cost", (*titles, "largest peak of a worker", "a million"), CODE)
    per_asset = wall * options.jobs / len(reports)
    costs = (f"{per_asset:.2f}", f"{wall * options.jobs / direct:.2f} times")
    peak = f"{max(report['peak_memory'] for report in worked) / 2**20:.0f} MiB"
    table.row(
        f"{summary['assets']:,}", f"{faces / 1e6:.0f} million", *costs, peak, f"{per_asset * 1e6 / 3600:.0f} core-hours"
    )
    return table


if __name__ == "__main__":
    main()
