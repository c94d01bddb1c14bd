"""All measurements of speed: on generated meshes, on your own meshes and beside other programs.

    build/venv/bin/python -m tests.benchmarks [part ...] [--keep] [--json FILE] [--plot FILE.svg] [...]

table   all speed figures with their goals (`--row NAME` selects some), and the time per phase: read, native by phase,
        place and pack, write, undo
meshes  seconds on meshes of every kind, or on OBJ files (`--mesh FILE`): the module, igl.lscm, xatlas and BFF if
        installed, our operator and Blender's methods
growth  seconds against vertices, for our operator and Blender's methods; `--plot` draws them (matplotlib)

Runs these three if none is named. By name only:

blenders   seconds of one grid in every Blender that the tests have here
demo       the table of `build_addon.py demo`
documents  write the tables of README.md and docs/benchmarks.md from tests/benchmarks/results.json, measuring nothing

`--keep` puts the measured tables there and into the documents. Use an idle machine. For a quick trial, `--scale 0.01`
shrinks all meshes to a hundredth of their size. BFF is the program of Boundary First Flattening (Sawhney and Crane
2017), called as `PROGRAM in.obj out.obj`. xatlas and libigl are Python packages:
`build/venv/bin/python -m pip install xatlas`.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tests.benchmarks import documents, figures, generated, operator_scenes, peers, plot, runs
from tests.benchmarks.documents import Table
from tests.benchmarks.runs import Figures, NotMeasured

# Run if none is named; then those that are run by name alone.
PARTS = ("table", "meshes", "growth")
FURTHER = ("blenders", "demo", "documents")
VERTICES_OF_KINDS, VERTICES_OF_BLENDERS = 20_000, 49_729
GROWTH = (1_000, 4_000, 16_000, 44_100, 134_000, 535_000)
OURS = "spectral"


class Report:
    """The measurements, printed at once, for the file and the documents."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self.kept: dict[str, Any] = {}
        self.tables: list[Table] = []
        self.failures = 0

    def table(self, name: str, titles: Sequence[str], code: Sequence[str]) -> Table:
        """Begin a table."""
        self.tables.append(Table(name, titles, code))
        return self.tables[-1]

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
    titles = ("what", "case", "figure", "reach", "reached")
    goals = report.table("goals", titles, (*documents.OPERATOR, *documents.SEAMS, "addon/live"))
    for row in rows:
        for case, reach in row.reach.items():
            value, reason = report.attempt(lambda row=row, case=case: row.figure(measured, case))
            sign = "at least" if row.is_more_better else "at most"
            # What is within reach is so at full size.
            is_reached = None if value is None or measured.scale != 1.0 else row.is_reached(case, value)
            found = reason if value is None else f"{value:.3g} {row.unit}".rstrip() + row.beside(measured, case)
            answer = {None: "", True: "yes", False: "no"}[is_reached]
            goals.row(row.what, case, found, f"{sign} {reach:g}", answer)
            entry = {"row": row.name, "what": row.what, "case": case, "unit": row.unit, "figure": value}
            entry |= {"reach": reach, "is_more_better": row.is_more_better, "is_reached": is_reached, "reason": reason}
            report.kept["table"].append(entry)
    report.kept["measurements"] = measured.all
    _phases(report, measured)


def _phases(report: Report, measured: figures.Measured) -> None:
    """Print where the time went, in seconds, for the measured scenes and sizes."""
    scenes = {key: found for key, found in measured.all.items() if key.startswith("operators: ")}
    native = {key: found for key, found in measured.all.items() if key.startswith("parameterize: ")}
    _phases_of(report, "phases", "operator, s", scenes, "phases")
    _phases_of(report, "native-phases", "native, operator, s", scenes, "native_phases")
    _phases_of(report, "solve-phases", "native, `parameterize`, s", native, "phases")


def _phases_of(report: Report, name: str, title: str, measured: dict[str, Figures], key: str) -> None:
    if not measured:
        return
    phases = list(dict.fromkeys(phase for found in measured.values() for phase in found[key]))
    table = report.table(name, (title, "vertices", *phases), documents.OPERATOR)
    for what, found in measured.items():
        seconds = (f"{found[key].get(phase, 0.0):.4f}" for phase in phases)
        table.row(what.partition(": ")[2], found["vertices"], *seconds)


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
    print(f"`unwrap` on {report.kept['machine']['blas'] or 'no BLAS'}, one thread per core", end="")
    for peer in others:
        if peer != peers.BFF or options.bff:
            print(f"; {peer} on {peers.solver(peer, options.bff)}", end="")
    print(flush=True)
    titles = ("mesh, s", "vertices", "`unwrap`", *others, f"operator in {options.blender}", *methods)
    table = report.table("meshes", titles, documents.OPERATOR)
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
        table.row(name, entry["vertices"], *texts)


def growth(report: Report, options: argparse.Namespace) -> None:
    """Measure our operator and Blender's on growing grids; plot seconds against vertices."""
    curves: dict[str, list[tuple[int, float]]] = {OURS: [], **{method: [] for method in operator_scenes.METHODS}}
    report.kept["growth"] = curves
    table = report.table("growth", ("vertices, s", *curves), documents.OPERATOR)
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
            table.row(side**2, reason)
            continue
        seconds = {OURS: found["seconds"], **found["methods"]}
        for name, each in seconds.items():
            curves[name].append((found["vertices"], each))
        table.row(found["vertices"], *(f"{seconds[name]:.4f}" if name in seconds else "" for name in curves))
    if options.plot:
        title = f"Unwrap of one patch, Blender {options.blender}"
        plot.seconds_against_vertices(options.plot, title, {name: points for name, points in curves.items() if points})


def _may_take(points: Sequence[tuple[int, float]], n: int, limit: float) -> bool:
    """Return whether a method probably takes less than `limit` seconds, given its last ones; they grow as V^1.5."""
    return not points or points[-1][1] * (n / points[-1][0]) ** 1.5 < limit


def blenders(report: Report, options: argparse.Namespace) -> None:
    """Measure our operator and Blender's on one grid in every Blender that the tests have here."""
    from tests.blender import blenders as known

    methods = ("CONFORMAL", "ANGLE_BASED")
    table = report.table(
        "blenders", ("Blender", "Spectral Unwrap, s", *(f"{m}, s" for m in methods)), documents.OPERATOR
    )
    given = generated.Scene(max(4, round((VERTICES_OF_BLENDERS * options.scale) ** 0.5))).meshes()
    arguments = {"methods": methods, "seconds": options.seconds}
    for name in [blender.name for blender in (*known.all_blenders(), *known.further_blenders())]:
        found, reason = report.attempt(
            lambda name=name: runs.run("operator_scenes", "operators", arguments, given, name)
        )
        if not found:
            print(f"not measured: {name}: {reason}")
            continue
        own = found["seconds"]
        theirs = (f"{found['methods'][method]:.2f} ({found['methods'][method] / own:.1f} times)" for method in methods)
        table.row(found["blender"], f"{own:.2f}", *theirs)


def demo(report: Report, _options: argparse.Namespace) -> None:
    """Run the demonstration and take the table that it prints."""
    from tools import demo as demonstration

    demonstration.run(None)
    found = json.loads((demonstration.OUTPUT / "report.json").read_text())
    table = report.table("demo", demonstration.TITLES, (*documents.OPERATOR, "tools/demo"))
    for row in found["methods"]:
        table.row(*demonstration.cells(row))


def main(words: Sequence[str] | None = None) -> int:
    """Measure what the command line names; return 1 if a measurement failed."""
    parser = argparse.ArgumentParser(
        prog="tests.benchmarks", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    names = [row.name for row in figures.ROWS]
    parser.add_argument("parts", nargs="*", metavar="part", help=", ".join((*PARTS, *FURTHER)))
    parser.add_argument("--row", action="append", choices=names, metavar="NAME", help=f"of {', '.join(names)}")
    parser.add_argument("--mesh", action="append", type=Path, metavar="FILE", help="an OBJ file, for `meshes`")
    parser.add_argument("--sizes", nargs="+", type=int, metavar="N", help="vertices, for `growth`")
    parser.add_argument("--limit", type=float, default=600.0, help="`growth` leaves out what would take more seconds")
    parser.add_argument("--scale", type=float, default=1.0, help="of all numbers of vertices")
    parser.add_argument("--seconds", type=float, default=operator_scenes.SECONDS, help="repeat a scene for this long")
    parser.add_argument("--blender", default=runs.BLENDER, help=f"default {runs.BLENDER}")
    parser.add_argument("--bff", metavar="PROGRAM")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all figures to this file")
    parser.add_argument("--keep", action="store_true", help="put the tables into the documents")
    parser.add_argument("--plot", type=Path, metavar="FILE", help="draw `growth`; .svg or .png")
    options = parser.parse_args(words)
    parts = options.parts or PARTS
    if not set(parts) <= {*PARTS, *FURTHER}:
        parser.error(f"the parts are {', '.join((*PARTS, *FURTHER))}")
    if options.keep and (options.row or options.mesh or options.sizes or options.scale != 1.0):
        parser.error("--keep keeps whole tables, at full size")
    if options.scale <= 0.0:
        parser.error("--scale must be above 0")
    if options.plot and not plot.is_possible():
        parser.error("--plot needs matplotlib: build/venv/bin/python -m pip install matplotlib")
    if "documents" in parts:
        documents.write_documents()
        if parts == ["documents"]:
            return 0
    report = Report()
    report.kept = {"machine": documents.machine(), "blender": options.blender, "scale": options.scale}
    print(json.dumps(report.kept))
    if "table" in parts:
        measured = figures.Measured(options.scale, options.blender, options.bff, options.seconds)
        table(report, measured, [row for row in figures.ROWS if not options.row or row.name in options.row])
    for name, measure in {"meshes": meshes, "growth": growth, "blenders": blenders, "demo": demo}.items():
        if name in parts:
            measure(report, options)
    if options.json:
        options.json.write_text(json.dumps(report.kept, indent=1) + "\n")
    if options.keep and not report.failures:
        documents.keep(*report.tables)
    return int(report.failures > 0)


if __name__ == "__main__":
    sys.exit(main())
