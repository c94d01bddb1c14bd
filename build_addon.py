#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Set up, demonstrate, test, document and package Spectral Unwrap.

Runs with a bare Python 3.9 or newer on Debian and Ubuntu; everything built goes under build/.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from tools import batch, demo, environment, other_pythons, packaging, systems
from tools.cross import command as cross
from tools.site import command as site
from tools.steps import StepError


def parse(arguments: list[str] | None = None) -> argparse.Namespace:
    """Parse the command line; some commands pass unknown arguments on to the program that they run."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("demo", help="unwrap a mesh in Blender, measure and draw it under build/demo/")
    command.add_argument("mesh", nargs="?", type=Path, help=".obj, .ply, .stl or .blend; by default Suzanne")
    commands.add_parser("batch", help="unwrap many files: INPUTS... --out DIR; see its --help", add_help=False)
    command = commands.add_parser("test", help="run the tests; further arguments go to pytest", add_help=False)
    command.add_argument("--all", action="store_true", help="also what takes long, in every Blender")
    command.add_argument("--quick", action="store_true", help="only quick tests without Blender, in under two minutes")
    command = commands.add_parser(
        "fuzz", help="call the module at random; further arguments: --cases, --seed, --case", add_help=False
    )
    command.add_argument(
        "--native", action="store_true", help="libFuzzer on the C++ code instead; arguments: --runs, --seed, --input"
    )
    commands.add_parser("fuzz-scenes", help="call the operators in random scenes; see its --help", add_help=False)
    commands.add_parser("docs", help="build the documents and the module's reference as a site in build/site/")
    command = commands.add_parser("package", help="write the installable zips to build/packages/")
    command.add_argument(
        "--wheels", type=Path, metavar="FOLDER", help="use the self-contained wheels in this folder, for any platforms"
    )
    command.add_argument(
        "--platforms", nargs="+", metavar="NAME", help="compile for these systems, such as windows-x64, or for `all`; "
        "zips under build/cross/packages/"
    )  # fmt: skip
    options, rest = parser.parse_known_args(arguments)
    if rest and options.command not in {"batch", "test", "fuzz", "fuzz-scenes"}:
        parser.error(f"unrecognized arguments: {' '.join(rest)}")
    options.further_arguments = rest
    return options


def names(options: argparse.Namespace, blender: str) -> bool:
    """Return whether the arguments for pytest name this Blender."""
    return any(argument.removeprefix("--blender=") == blender for argument in options.further_arguments)


def main() -> int:
    """Run one command and return its exit code."""
    options = parse()
    try:
        if options.command == "demo":
            mesh = demo.check_mesh(options.mesh)
            environment.set_up("build", "bpy", "demo")
            return demo.run(mesh)
        if options.command == "batch":
            environment.set_up("build", "batch", "bpy")
            return batch.run(options.further_arguments)
        if options.command == "test":
            if options.quick:
                environment.set_up("build", "batch", "docs", "quick")
                return environment.run_pytest(["-m", environment.QUICK, *options.further_arguments])
            groups = ("build", "batch", "bpy", "demo", "docs", "package", "fuzz", "quick", "test")
            suites = [system.suite for system in systems.ALL if options.all or names(options, system.suite)]
            environment.set_up(*groups, *(["all"] if suites else []))
            if suites:
                other_pythons.set_up(suites)
            if cross.made():
                environment.set_up("cross", "wine", native=False)
            return environment.run_pytest([*(["--all"] if options.all else []), *options.further_arguments])
        if options.command == "fuzz":
            environment.set_up("build", "fuzz")
            return environment.run_fuzzing(options.further_arguments, native=options.native)
        if options.command == "fuzz-scenes":
            environment.set_up("build", "bpy", "quick", "test")
            return environment.run_python("-m", "tests.fuzz.scenes_run", *options.further_arguments)
        if options.command == "docs":
            # The reference reads the sources, so that nothing is compiled.
            environment.set_up("docs", native=False)
            return site.run()
        if options.platforms:
            return cross.run(options.platforms)
        if options.wheels:
            environment.set_up("bpy", "package", native=False)
            return packaging.run_with_wheels(options.wheels)
        environment.set_up("build", "bpy", "package")
        return packaging.run()
    except StepError as error:
        print(f"\n{error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("\nInterrupted; run the same command again to go on.", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
