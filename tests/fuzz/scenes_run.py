#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random edit-mode scenes through the operators, in every Blender, in processes of their own.

Each scene is made from the seed of the run and its number alone, so that any one can be run again:

    build/venv/bin/python -m tests.fuzz.scenes_run --blender system --seed 6 --first 123 --count 1
"""

import argparse
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from tests.blender import blenders

SCRIPT = Path(__file__).with_name("scenes_inside.py")
SEED = 6
BATCH = 50
TAIL = 40


@dataclass
class Run:
    """What a run has found.

    Attributes:
        done: number of scenes that came to their end, without what must not happen.
        bad: number of the scene and what happened in it.
        slowest: the most seconds in operators for a scene's vertices: (seconds per vertex, number, seconds, vertices).
        calls: number of operators called.
    """

    done: int = 0
    bad: dict[int, str] = field(default_factory=dict)
    slowest: tuple[float, int, float, int] = (0.0, -1, 0.0, 0)
    calls: int = 0


def run(blender, seed, first, count, folder):
    """Run the scenes `first` to `first + count - 1` of a seed in one Blender; a crash costs one scene."""
    found, environment, end = Run(), profile(blender, folder), first + count
    while first < end:
        process = process_of(blender, seed, first, min(BATCH, end - first), environment)
        first = read(process.stdout, process.returncode, first, found)
    return found


def profile(blender, folder):
    """Return the environment of a Blender with the add-on."""
    return {**blender.make_profile(folder), "PYTHONFAULTHANDLER": "1"}


def process_of(blender, seed, first, count, environment):
    """Run a few scenes in one process and return it."""
    command = [*blender.script_command(SCRIPT), "--", *map(str, (seed, first, count))]
    return subprocess.run(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace"
    )


def read(output, code, first, found):
    """Add to `found` what a process wrote that ended with this code; return the first scene that it did not begin."""
    current, scene = first, []
    for line in output.splitlines():
        kind, number, rest = parse(line)
        if kind == "begin":
            current, scene = number, []
        elif kind == "call":
            found.calls += 1
        elif kind == "bad":
            found.bad[number] = "\n".join([*calls_in(scene), rest.replace(" | ", "\n")])
        elif kind == "end":
            ended(found, number, rest, scene)
        scene.append(line)
    if code:
        found.bad.setdefault(current, "\n".join([f"the process ended with code {code}:", *scene[-TAIL:]]))
    return current + 1


def parse(line):
    """Return (kind, number, rest) of a line of scenes_inside.py; an empty kind for any other."""
    if not line.startswith("@fuzz "):
        return "", -1, ""
    _, kind, number, *rest = line.split(" ", 3)
    return kind, int(number), " ".join(rest)


def ended(found, number, rest, scene):
    """Count a finished scene; an exception in a handler, which Blender only prints, is a finding, too."""
    seconds, vertices = rest.split()
    if number in found.bad:
        return
    if any("Traceback" in line for line in scene):
        found.bad[number] = "\n".join(scene[-TAIL:])
        return
    found.done += 1
    if int(vertices):
        found.slowest = max(found.slowest, (float(seconds) / int(vertices), number, float(seconds), int(vertices)))


def calls_in(scene):
    """Return the lines that say which operators were called."""
    return [line for line in scene if line.startswith("@fuzz call")]


def main():
    """Run the scenes in the Blenders that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    known = {blender.name: blender for blender in blenders.all_blenders()}
    parser.add_argument("--blender", choices=known, action="append", help="all when left out")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=500)
    options = parser.parse_args()
    is_bad = False
    for name in options.blender or known:
        with tempfile.TemporaryDirectory() as folder:
            found = run(known[name], options.seed, options.first, options.count, Path(folder))
        is_bad |= bool(found.bad)
        report(name, options.seed, found)
    return int(is_bad)


def report(name, seed, found):
    """Print what a run has found."""
    for number, text in found.bad.items():
        again = f"-m tests.fuzz.scenes_run --blender {name} --seed {seed} --first {number} --count 1"
        print(f"\n{text}\nAgain: build/venv/bin/python {again}")
    _, number, seconds, vertices = found.slowest
    print(
        f"{name}, seed {seed}: {found.done} scenes with {found.calls} calls are all right, {len(found.bad)} are not; "
        f"the slowest for its size: scene {number}, {seconds:.2f} s for {vertices} vertices",
        flush=True,
    )


if __name__ == "__main__":
    sys.exit(main())
