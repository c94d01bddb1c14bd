"""Unwrap mesh files on the command line: python -m spectral_conformal mesh.obj [--out FILE] [--seams suggest].

`python -m spectral_conformal batch` unwraps many files, `python -m spectral_conformal report` measures their maps.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path

from . import assets
from ._command_line import add_fields
from ._options import Options, SeamOptions
from ._results import Unwrap
from .assets.report import Requirement, RequirementError, map_report
from .assets.unwrapping import Cutting, Layout, cut, laid_out, on_sizes, unwrapped

# Side of the texture; here its size does not matter.
_PIXELS = 1000


def main(arguments: Sequence[str] | None = None) -> int:
    """Unwrap a file, print the result for each island, and return the exit code.

    0: every island has a map; 1: the file cannot be read or written, or an island has no map. Invalid arguments exit
    with 2.
    """
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    if arguments[:1] == ["report"]:
        return _report(arguments[1:])
    if arguments[:1] == ["batch"]:
        from .batch import command

        return command.main(arguments[1:])
    parser = _parser()
    given = parser.parse_args(arguments)
    chosen = vars(given)
    try:
        options, seam_options = (
            kind(**{field.name: chosen[field.name] for field in fields(kind) if field.name in chosen})
            for kind in (Options, SeamOptions)
        )
    except (TypeError, ValueError) as error:
        parser.error(str(error))
    if not given.mesh.name:
        parser.error("the mesh must be the name of a file.")
    idle = [name for name in _of_seams_alone() if name in chosen and given.seams != "suggest"]
    if idle:
        parser.error(f"--{idle[0].replace('_', '-')} has an effect only with --seams suggest.")
    own = assets.written_as(given.mesh)
    out = given.out or given.mesh.with_name(f"{given.mesh.stem}_uv{own}")
    if out.suffix.lower() not in (own, ".obj"):
        formats = " or ".join(dict.fromkeys((own, ".obj")))
        parser.error(f"--out must end with {formats}, which {given.mesh.name} can be written as, not '{out.name}'.")
    if out.is_dir() or not out.parent.is_dir():
        what = f"{out} is a folder" if out.is_dir() else f"there is no folder {out.parent}"
        parser.error(f"--out must be a file in a folder that exists; {what}.")
    if not 0.0 <= given.margin < 0.5:
        parser.error(f"--margin must be at least 0 and less than 0.5, not {given.margin:g}.")
    cutting = Cutting(given.seams, keep_islands=True, weld_distance=0.0, options=seam_options)
    try:
        failed = _unwrap_file(given.mesh, out, cutting, given.margin, options)
    except (ValueError, OSError) as error:
        print(f"error: {_said(error)}", file=sys.stderr)
        return 1
    except MemoryError:
        print(f"error: {given.mesh}: there is too little memory to unwrap it.", file=sys.stderr)
        return 1
    return 1 if failed else 0


def _said(error: Exception) -> str:
    """Return the message of an error, that of the system with the file and without its number."""
    if isinstance(error, OSError) and error.filename is not None and error.strerror:
        return f"{error.filename}: {error.strerror.lower()}."
    return str(error)


def _of_seams_alone() -> list[str]:
    shared = {field.name for field in fields(Options)}
    return [field.name for field in fields(SeamOptions) if field.name not in shared]


def _report(arguments: Sequence[str]) -> int:
    """Print measures of the maps of files; return 1 if a file cannot be read or violates the requirement."""
    from .batch import files
    from .batch.settings import BatchSettings

    parser = argparse.ArgumentParser(
        prog="python -m spectral_conformal report", description="Measure the UV maps of files; nothing is changed."
    )
    parser.add_argument("files", type=Path, nargs="+", metavar="FILE", help="file with a UV map")
    parser.add_argument(
        "--require", metavar="CONDITION", help='such as "flips == 0 and overlaps == 0 and qc_p99 < 1.5"'
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object per line, one for each file")
    given = parser.parse_args(arguments)
    try:
        requirement = Requirement(given.require) if given.require is not None else None
    except RequirementError as error:
        parser.error(str(error))
    code = 0
    for path in given.files:
        try:
            report = map_report(files.read(path, BatchSettings()).meshes)
        except (ValueError, OSError, MemoryError) as error:
            message = _said(error) or f"{path}: there is too little memory to read it."
            print(f"error: {message}", file=sys.stderr)
            code = 1
            continue
        failures = requirement.failures(report) if requirement else []
        code = 1 if failures else code
        values = asdict(report)
        if given.json:
            numbers = {name: None if value != value else value for name, value in values.items()}
            print(json.dumps({"file": str(path), **numbers, "failures": failures}))
        else:
            print(path)
            print(*(f"  {name:<15}{value:>12.6g}" for name, value in values.items()), sep="\n")
        for failure in failures:
            print(f"{path}: required: {failure}", file=sys.stderr)
    return code


def _unwrap_file(source: Path, out: Path, cutting: Cutting, margin: float, options: Options) -> int:
    """Read, cut, unwrap, lay out, write, print; return the number of islands that failed."""
    asset = assets.read(source)
    results = [unwrapped(cut(mesh, cutting), options) for mesh in asset.meshes]
    layout = Layout(margin=margin * _PIXELS, width=_PIXELS, height=_PIXELS)
    warnings = [*assets.write(out, asset, laid_out(asset.meshes, results, layout)), *on_sizes(results)]
    status: Counter[str] = Counter()
    for mesh, result in zip(asset.meshes, results):
        print(*([mesh.name] if mesh.name else []), _table(result), sep="\n")
        status.update(result.charts.column("status"))
    print(*(f"warning: {warning}" for warning in warnings), sep="\n", end="\n" if warnings else "")
    print(f"{status['solved']} of {sum(status.values())} islands written to {out}")
    return status["failed"]


def _table(result: Unwrap) -> str:
    lines = [f"{'island':>6} {'faces':>9} {'mean QC':>9} {'max QC':>9} {'flips':>7} {'overlaps':>8}"]
    for number, chart in enumerate(result.charts):
        row = f"{number:>6} {len(chart.faces):>9}"
        if chart.status == "solved":
            row += f" {chart.mean_qc:>9.4f} {chart.max_qc:>9.4g} {chart.flipped:>7} {chart.overlapping:>8}"
        lines.append(f"{row}  {chart.message}".rstrip())
    return "\n".join(lines)


def _parser() -> argparse.ArgumentParser:
    """Return the parser; its options for maps and seams are the fields of the records, with their documentation."""
    parser = argparse.ArgumentParser(
        prog="python -m spectral_conformal",
        description="Unwrap a glTF, OBJ, PLY, OFF, STL or USD file and write it with UVs.",
        epilog="For many files: python -m spectral_conformal batch --help. To measure the UV maps of files: python -m "
        "spectral_conformal report --help.",
    )
    parser.add_argument("mesh", type=Path, help="the file; it stays unchanged unless --out names it")
    parser.add_argument(
        "--out",
        type=Path,
        help="the file to write, in the format of the mesh or as OBJ; by default <mesh>_uv beside it",
    )
    parser.add_argument(
        "--seams",
        choices=("keep", "suggest"),
        default="keep",
        help="keep: cut at the island borders of the file's UV map, if it has one (default); suggest: there, and where "
        "it lowers the distortion most",
    )
    parser.add_argument(
        "--margin", type=float, default=0.004, help="between islands, as a fraction of the texture's side (0.004)"
    )
    maps = add_fields(parser.add_argument_group("options of maps"), Options())
    add_fields(parser.add_argument_group("options of suggested seams"), SeamOptions(), maps)
    return parser


if __name__ == "__main__":
    sys.exit(main())
