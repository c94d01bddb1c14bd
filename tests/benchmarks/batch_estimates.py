# SPDX-License-Identifier: GPL-3.0-or-later
"""What the batch's estimates are made of: processor seconds and memory of assets of several sizes, and a fit.

    build/venv/bin/python -m tests.benchmarks.batch_estimates [--faces N ...] [--names NAME ...]

Each asset is unwrapped in a process of its own with one thread, with the batch's defaults and with its map kept. The
numbers of `spectral_conformal.batch.estimate` are near the fits that this prints: seconds = a sqrt(F) + b F of F faces,
with the least ratio to the farthest asset, and bytes = base + m F such that no asset needs more.
"""

import argparse
import itertools
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from tests.benchmarks import generated_assets
from tests.module import batch_assets

NAMES = ("grid", "torus", "blobs, 600", "shaken scan", "welded primitives")
FACES = (1_000, 10_000, 100_000)
SETTINGS = {"suggest": {}, "sharp": {"seams": "sharp"}, "kept": {"unwrap": False, "seams": "keep"}}
# The clock of a phase is the processor's, which other work on the machine does not change.
PROGRAM = """
import json, sys, time
time.perf_counter = time.process_time
from spectral_conformal._threads import limit_threads
from spectral_conformal.batch import settings, task
limit_threads(1)
source, folder, target, values = sys.argv[1:]
wanted = settings.from_values(json.loads(values)).as_json()
report = task.run(task.Request("a.obj", source, folder, target, wanted))
print(json.dumps([report["status"], report["seconds"], report["peak_memory"], report.get("totals", {}).get("faces")]))
"""


def mesh(name, faces):
    side = round(faces**0.5)
    if name == "grid":
        return batch_assets.grid(side, 0.3, 1)
    if name == "torus":
        return batch_assets.torus(side, side)
    return generated_assets.asset(name, faces)


def measured(source, folder, kind):
    target = folder / f"{kind}.obj"
    words = [sys.executable, "-c", PROGRAM, str(source), str(folder), str(target), json.dumps(SETTINGS[kind])]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    return (target, *json.loads(done.stdout.splitlines()[-1]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faces", type=int, nargs="+", default=FACES)
    parser.add_argument("--names", nargs="+", default=NAMES)
    given = parser.parse_args()
    rows = {kind: [] for kind in SETTINGS}
    for name in given.names:
        for wanted in given.faces:
            with tempfile.TemporaryDirectory() as place:
                folder = Path(place)
                source = folder / "a.obj"
                batch_assets.write_obj(source, *mesh(name, wanted))
                for kind in SETTINGS:
                    target, status, seconds, peak, faces = measured(source, folder, kind)
                    if kind == "suggest":
                        source = target
                    print(f"{name}, {faces} faces, {kind}: {status}, {seconds['total']:.2f} s, {peak / 2**20:.0f} MiB")
                    phases = {phase: round(value, 3) for phase, value in seconds.items()}
                    print(f"  {phases}", flush=True)
                    if faces:
                        rows[kind].append((faces, seconds["total"], peak))
    for kind, found in rows.items():
        faces, seconds, peak = np.array(found, float).T
        fits = itertools.product(np.geomspace(1e-4, 0.1, 120), np.geomspace(1e-6, 1e-3, 120))
        ratio = lambda fit: np.abs(np.log(seconds / (fit[0] * faces**0.5 + fit[1] * faces))).max()  # noqa: B023, E731
        root, linear = min(fits, key=ratio)
        print(f"{kind}: {root:.2g} sqrt(F) + {linear:.2g} F s, at most {np.exp(ratio((root, linear))):.1f} times off; ")
        for base in (128, 200):
            print(f"  {base} MiB + {((peak - base * 2**20) / faces).max():.0f} F bytes")


if __name__ == "__main__":
    main()
