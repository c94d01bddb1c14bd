# SPDX-License-Identifier: GPL-3.0-or-later
"""Build the libFuzzer targets and run them. Findings are kept in build/fuzz/ and can be repeated."""

from __future__ import annotations

import argparse
import os
import random
import subprocess
import sys
from pathlib import Path

from tests.native import flavors

TARGETS = ("fuzz_charts", "fuzz_solver")
FINDINGS = flavors.ROOT / "build" / "fuzz"
# All that the targets make of bytes needs no more.
MAX_LENGTH = 600
LIMITS = [f"-max_len={MAX_LENGTH}", "-len_control=0", "-timeout=60", "-rss_limit_mb=4096"]
SEEDS = 100


def build():
    """Build the targets; returns their folder."""
    return flavors.build("sanitized", *TARGETS) / "tests" / "fuzz"


def command(folder, target, runs, seed):
    """Return the command that runs a target on its corpus, which grows by inputs that reach new code."""
    corpus = FINDINGS / f"{target}_corpus"
    corpus.mkdir(parents=True, exist_ok=True)
    # From nothing, libFuzzer would stay with inputs of a few bytes for long.
    bytes_of = random.Random(seed)
    for number in range(SEEDS):
        (corpus / f"random_{number}").write_bytes(bytes_of.randbytes(bytes_of.randint(1, MAX_LENGTH)))
    options = [f"-runs={runs}", f"-seed={seed}", f"-artifact_prefix={FINDINGS}/{target}_", *LIMITS]
    return [str(folder / target), *options, str(corpus)]


def environ():
    """Return the environment: stacks for what UBSan sees, and one BLAS thread (there is a fuzzer for every core)."""
    return {**os.environ, "UBSAN_OPTIONS": "print_stacktrace=1", "OPENBLAS_NUM_THREADS": "1"}


def main():
    """Run all targets at once; return 1 if one has found something."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=100000, help="of each target")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--input", type=Path, help="run this finding of build/fuzz/ alone")
    options = parser.parse_args()
    folder = build()
    if options.input:
        target = next(target for target in TARGETS if options.input.name.startswith(target))
        return subprocess.run([folder / target, options.input], env=environ(), check=False).returncode
    processes = [
        subprocess.Popen(command(folder, target, options.runs, options.seed), env=environ()) for target in TARGETS
    ]
    return max(process.wait() != 0 for process in processes)


if __name__ == "__main__":
    sys.exit(main())
