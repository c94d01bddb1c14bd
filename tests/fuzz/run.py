# SPDX-License-Identifier: GPL-3.0-or-later
"""Call spectral_conformal with random meshes and options, in separate processes, and report failures.

Every case has a seed of its own, (seed, number): `build_addon.py fuzz --seed 1 --case 1234` repeats one, with all that
it says.
"""

from __future__ import annotations

import argparse
import collections
import contextlib
import faulthandler
import json
import os
import resource
import subprocess
import sys
import traceback
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

BATCH = 200
# A case that is still running then hangs: a thousand times what the slowest of its kind took on an idle machine.
SECONDS = 60.0
SECONDS_PER_VERTEX = 0.1
# More than any case needs; a far too long array then raises MemoryError instead of making the machine swap.
MEMORY = 8 * 1024**3
ROOT = Path(__file__).resolve().parents[2]
WORKER = [sys.executable, "-X", "faulthandler", "-m", "tests.fuzz.run"]


def work(seed, first, count):
    """Run cases, each announced by a line before and reported by one after."""
    # Imported here, so that the process that only starts others does not load the module that may crash.
    from tests.fuzz.cases import Case

    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    faulthandler.enable()
    for number in range(first, first + count):
        print(json.dumps({"begun": number}), flush=True)
        case = Case(seed, number)
        limit = SECONDS + SECONDS_PER_VERTEX * len(case.mesh.vertices)
        faulthandler.dump_traceback_later(limit, exit=True)
        try:
            outcome, finding = case.run(), None
        except BaseException:  # noqa: BLE001 - whatever comes out is the finding
            outcome, finding = "finding", f"{case.describe()}\n{traceback.format_exc()}"
        faulthandler.cancel_dump_traceback_later()
        kind = f"{case.target}: {outcome.split(':')[0]}"
        print(json.dumps({"ended": number, "outcome": kind, "finding": finding}), flush=True)


class Batch:
    """A range of cases; a process that dies is replaced by one for the cases behind."""

    def __init__(self, seed, first, count):
        self.seed = seed
        self.outcomes = collections.Counter()
        self.findings = {}
        end = first + count
        while first < end:
            first = self.run(first, end - first)

    def run(self, first, count):
        """Run cases in one process; returns the first one that was not begun."""
        command = [*WORKER, "--seed", self.seed, "--worker", first, count]
        process = subprocess.run(
            [str(word) for word in command], cwd=ROOT, capture_output=True, text=True, errors="replace"
        )
        begun = ended = first - 1
        for line in process.stdout.splitlines():
            # Last, a line that the process did not finish.
            with contextlib.suppress(ValueError):
                event = json.loads(line)
                begun = event.get("begun", begun)
                if "ended" in event:
                    ended = event["ended"]
                    self.outcomes[event["outcome"]] += 1
                    if event["finding"]:
                        self.findings[ended] = event["finding"]
        if process.returncode != 0:
            begun = max(begun, first)
            self.outcomes["crash or hang"] += 1
            self.findings[begun] = f"The process ended with {process.returncode}.\n{process.stderr[-4000:]}"
        elif ended < first + count - 1:
            raise RuntimeError(f"A worker has stopped after case {ended} without a reason.")
        return begun + 1


def fuzz(seed, first, count):
    """Run cases on all cores; returns (outcomes, findings by case)."""
    starts = range(first, first + count, BATCH)
    outcomes, findings = collections.Counter(), {}
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        batches = threads.map(lambda start: Batch(seed, start, min(BATCH, first + count - start)), starts)
        for done, batch in enumerate(batches, 1):
            outcomes += batch.outcomes
            findings.update(batch.findings)
            if done % 10 == 0 or done == len(starts):
                print(f"{sum(outcomes.values())} cases, {len(findings)} findings", flush=True)
    return outcomes, findings


def replay(seed, number):
    """Run one case in this process and show it."""
    from tests.fuzz.cases import Case

    faulthandler.enable()
    case = Case(seed, number)
    print(case.describe())
    print(case.run())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1, help="of the run; 1 when left out")
    parser.add_argument("--cases", type=int, default=10000)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--case", type=int, help="repeat this case alone")
    parser.add_argument("--worker", type=int, nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.worker:
        work(options.seed, *options.worker)
        return 0
    if options.case is not None:
        replay(options.seed, options.case)
        return 0
    outcomes, findings = fuzz(options.seed, options.first, options.cases)
    for kind, number in sorted(outcomes.items()):
        print(f"{number:7} {kind}")
    for number, text in sorted(findings.items()):
        print(f"\n--seed {options.seed} --case {number}\n{text}")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
