"""All measurements of speed: on generated meshes, on your own meshes and beside other programs.

    build/venv/bin/python -m tests.benchmarks [table] [meshes] [growth] [--json FILE] [--plot FILE.svg] [...]

table   all speed figures with their goals (`--row NAME` selects some), and the time per phase: read, native by phase,
        place and pack, write, undo
meshes  seconds on meshes of every kind, or on OBJ files (`--mesh FILE`): the module, igl.lscm, xatlas and BFF if
        installed, our operator and Blender's methods
growth  seconds against vertices, for our operator and Blender's methods; `--plot` draws them (matplotlib)

Runs all three if none is named. Use an idle machine. For a quick trial, `--scale 0.01` shrinks all meshes to a
hundredth of their size. BFF is the program of Boundary First Flattening (Sawhney and Crane 2017), called as `PROGRAM
in.obj out.obj`. xatlas and libigl are Python packages: `build/venv/bin/python -m pip install xatlas`.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import spectral_conformal

from tests.benchmarks import figures, generated, operator_scenes, peers, plot, runs
from tests.benchmarks.runs import Figures, NotMeasured

PARTS = ("table", "meshes", "growth")
VERTICES_OF_KINDS = 20_000
GROWTH = (1_000, 4_000, 16_000, 44_100, 134_000, 535_000)
OURS = "spectral"
PHASES = ("read", "native", "place", "write", "rest", "undo")


class Report:
    """The measurements, printed at once and kept for the file."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self.kept: dict[str, Any] = {}
        self.failures = 0

    def head(self, *titles: str) -> None:
        """Print the head of a table."""
        print(f"\n| {' | '.join(titles)} |\n{'|---' * len(titles)}|", flush=True)

    def row(self, *cells: object) -> None:
        """Print a row."""
        print(f"| {' | '.join(map(str, cells))} |", flush=True)

    def attempt(self, measure: Any) -> tuple[Figures | float | None, str]:  # noqa: ANN401 - any call without arguments
        """Return what a measurement returns, or None and why there is nothing."""
        try:
            return measure(), ""
        except NotMeasured as reason:
            return None, str(reason)
        except RuntimeError as error:
            self.failures += 1
            print(error, file=sys.stderr, flush=True)
            return None, f"failed: {str(error).splitlines()[-1]}"


def table(report: Report, measured: figures.Measured, rows: Sequence[figures.Row]) -> None:
    """Measure the rows, then print where the time went."""
    report.kept["table"] = []
    report.head("what", "case", "figure", "reach", "reached")
    for row in rows:
        for case, reach in row.reach.items():
            value, reason = report.attempt(lambda row=row, case=case: row.figure(measured, case))
            sign = "at least" if row.is_more_better else "at most"
            # What is within reach is so at full size.
            is_reached = None if value is None or measured.scale != 1.0 else row.is_reached(case, value)
            found = reason if value is None else f"{value:.3g} {row.unit}".rstrip()
            answer = {None: "", True: "yes", False: "no"}[is_reached]
            report.row(row.what, case, found, f"{sign} {reach:g}", answer)
            entry = {"row": row.name, "what": row.what, "case": case, "unit": row.unit, "figure": value}
            entry |= {"reach": reach, "is_more_better": row.is_more_better, "is_reached": is_reached, "reason": reason}
            report.kept["table"].append(entry)
    report.kept["measurements"] = measured.all
    _phases(report, measured)


def _phases(report: Report, measured: figures.Measured) -> None:
    """Print where the time went, in seconds, for the measured scenes and sizes."""
    scenes = {key: found for key, found in measured.all.items() if key.startswith("operators: ")}
    if scenes:
        report.head("operator, s", "vertices", *PHASES)
    for key, found in scenes.items():
        seconds = (f"{found['phases'][phase]:.4f}" for phase in PHASES)
        report.row(key.removeprefix("operators: "), found["vertices"], *seconds)
    _native_phases(report, "native, operator, s", scenes, "operators: ", "native_phases")
    native = {key: found for key, found in measured.all.items() if key.startswith("parameterize: ")}
    _native_phases(report, "native, `parameterize`, s", native, "parameterize: ", "phases")


def _native_phases(report: Report, title: str, measured: dict[str, Figures], prefix: str, key: str) -> None:
    names = list(dict.fromkeys(name for found in measured.values() for name in found[key]))
    if measured:
        report.head(title, "vertices", *names)
    for what, found in measured.items():
        seconds = (f"{found[key].get(name, 0.0):.4f}" for name in names)
        report.row(what.removeprefix(prefix), found["vertices"], *seconds)


def meshes(report: Report, options: argparse.Namespace) -> None:
    """Measure everything on meshes of every kind, or on the given files."""
    if options.mesh:
        scenes = {path.name: [generated.read(path)] for path in options.mesh}
    else:
        made = generated.kinds(max(64, round(VERTICES_OF_KINDS * options.scale)))
        scenes = {name: scene.meshes() for name, scene in made.items()}
    methods = operator_scenes.METHODS
    others = (peers.LIBIGL, peers.XATLAS, peers.BFF)
    report.kept["meshes"] = []
    report.head("mesh, s", "vertices", "`unwrap`", *others, f"operator in {options.blender}", *methods)
    for name, given in scenes.items():
        is_one_patch = "many" not in name
        cells = {"unwrap": report.attempt(lambda given=given: runs.run("native_solver", "unwrap_all", {}, given))}
        for peer in others:
            program = options.bff if peer == peers.BFF else None
            # All others take one patch.
            if is_one_patch or peer == peers.XATLAS:
                arguments = {"name": peer, "program": program}
                cells[peer] = report.attempt(
                    lambda given=given, arguments=arguments: runs.run("native_solver", "peer", arguments, given)
                )
            else:
                cells[peer] = None, "one patch only"
        in_blender = {"methods": methods, "seconds": options.seconds}
        found, reason = report.attempt(
            lambda given=given, arguments=in_blender: runs.run(
                "operator_scenes", "operators", arguments, given, options.blender
            )
        )
        cells[OURS] = found, reason
        for method in methods:
            seconds = found["methods"].get(method) if found else None
            cells[method] = (None, reason or "not in this Blender") if seconds is None else ({"seconds": seconds}, "")
        entry: dict[str, Any] = {"mesh": name, "vertices": sum(len(mesh.vertices) for mesh in given)}
        entry["seconds"] = {key: cell["seconds"] for key, (cell, _) in cells.items() if cell and "seconds" in cell}
        entry["reasons"] = {
            key: reason or cell["reason"] for key, (cell, reason) in cells.items() if key not in entry["seconds"]
        }
        report.kept["meshes"].append(entry)
        texts = (f"{entry['seconds'][key]:.4f}" if key in entry["seconds"] else entry["reasons"][key] for key in cells)
        report.row(name, entry["vertices"], *texts)


def growth(report: Report, options: argparse.Namespace) -> None:
    """Measure our operator and Blender's on growing grids; plot seconds against vertices."""
    curves: dict[str, list[tuple[int, float]]] = {OURS: [], **{method: [] for method in operator_scenes.METHODS}}
    report.kept["growth"] = curves
    report.head("vertices, s", *curves)
    for n in options.sizes or [round(n * options.scale) for n in GROWTH]:
        side = max(4, round(n**0.5))
        methods = [method for method in operator_scenes.METHODS if _may_take(curves[method], side**2, options.limit)]
        arguments = {"methods": methods, "seconds": options.seconds}
        given = generated.Scene(side).meshes()
        found, reason = report.attempt(
            lambda given=given, arguments=arguments: runs.run(
                "operator_scenes", "operators", arguments, given, options.blender
            )
        )
        if not found:
            report.row(side**2, reason, *[""] * len(operator_scenes.METHODS))
            continue
        seconds = {OURS: found["seconds"], **found["methods"]}
        for name, each in seconds.items():
            curves[name].append((found["vertices"], each))
        report.row(found["vertices"], *(f"{seconds[name]:.4f}" if name in seconds else "" for name in curves))
    if options.plot:
        title = f"Unwrap of one patch, Blender {options.blender}"
        plot.seconds_against_vertices(options.plot, title, {name: points for name, points in curves.items() if points})


def _may_take(points: Sequence[tuple[int, float]], n: int, limit: float) -> bool:
    """Return whether a method probably takes less than `limit` seconds, given its last ones; they grow as V^1.5."""
    return not points or points[-1][1] * (n / points[-1][0]) ** 1.5 < limit


def machine() -> dict[str, Any]:
    """Return what the figures belong to."""
    return {
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0],
        "system": platform.platform(),
        "python": platform.python_version(),
        "module": spectral_conformal.build_info(),
    }


def main(words: Sequence[str] | None = None) -> int:
    """Measure what the command line names; return 1 if a measurement failed."""
    parser = argparse.ArgumentParser(
        prog="tests.benchmarks", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    names = [row.name for row in figures.ROWS]
    parser.add_argument("parts", nargs="*", metavar="part", help=", ".join(PARTS))
    parser.add_argument("--row", action="append", choices=names, metavar="NAME", help=f"of {', '.join(names)}")
    parser.add_argument("--mesh", action="append", type=Path, metavar="FILE", help="an OBJ file, for `meshes`")
    parser.add_argument("--sizes", nargs="+", type=int, metavar="N", help="vertices, for `growth`")
    parser.add_argument("--limit", type=float, default=600.0, help="`growth` leaves out what would take more seconds")
    parser.add_argument("--scale", type=float, default=1.0, help="of all numbers of vertices")
    parser.add_argument("--seconds", type=float, default=operator_scenes.SECONDS, help="repeat a scene for this long")
    parser.add_argument("--blender", default=runs.BLENDER, help=f"default {runs.BLENDER}")
    parser.add_argument("--bff", metavar="PROGRAM")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all figures to this file")
    parser.add_argument("--plot", type=Path, metavar="FILE", help="draw `growth`; .svg or .png")
    options = parser.parse_args(words)
    parts = options.parts or PARTS
    if not set(parts) <= set(PARTS):
        parser.error(f"the parts are {', '.join(PARTS)}")
    if options.scale <= 0.0:
        parser.error("--scale must be above 0")
    if options.plot and not plot.is_possible():
        parser.error("--plot needs matplotlib: build/venv/bin/python -m pip install matplotlib")
    report = Report()
    report.kept = {"machine": machine(), "blender": options.blender, "scale": options.scale}
    print(json.dumps(report.kept))
    if "table" in parts:
        measured = figures.Measured(options.scale, options.blender, options.bff, options.seconds)
        table(report, measured, [row for row in figures.ROWS if not options.row or row.name in options.row])
    if "meshes" in parts:
        meshes(report, options)
    if "growth" in parts:
        growth(report, options)
    if options.json:
        options.json.write_text(json.dumps(report.kept, indent=1) + "\n")
    return int(report.failures > 0)


if __name__ == "__main__":
    sys.exit(main())
