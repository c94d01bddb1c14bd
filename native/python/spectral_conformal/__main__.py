"""Unwrap mesh files on the command line: python -m spectral_conformal mesh.obj [--out FILE].

`python -m spectral_conformal batch` unwraps many files, `python -m spectral_conformal report` measures their maps.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from . import assets
from ._command_line import add_version, said
from ._results import Unwrap
from .assets import drawing
from .assets.report import Measurement, Requirement, RequirementError, map_report
from .assets.unwrapping import SHEETS, cut, laid_out, on_sizes, sheets_of, unwrapped
from .batch import report_file
from .batch import settings as batch_settings
from .batch.settings import SMART, BatchSettings, SettingsError

# What existing maps, a report or Blender is for.
_OF_MANY = ("unwrap", "keep_overlaps", "picture_size", "checker", "usd_over")


def main(arguments: Sequence[str] | None = None) -> int:
    """Unwrap a file, print the result for each island, and return the exit code.

    0: every island has a map; 1: the file cannot be read or written, or an island has no map; 130: interrupted. Invalid
    arguments exit with 2.
    """
    try:
        return _command(list(sys.argv[1:] if arguments is None else arguments))
    except KeyboardInterrupt:
        print("error: interrupted.", file=sys.stderr)
        return 130


def _command(arguments: list[str]) -> int:
    if arguments[:1] == ["report"]:
        return _report(arguments[1:])
    if arguments[:1] == ["batch"]:
        from .batch import command

        return command.main(arguments[1:])
    parser = _parser()
    given = parser.parse_args(arguments)
    chosen = batch_settings.given(given)
    try:
        settings = batch_settings.from_values(chosen)
        drawing.check(settings.draws)
    except (SettingsError, ValueError) as error:
        parser.error(str(error))
    if not given.mesh.name:
        parser.error("the mesh must be the name of a file.")
    if settings.seams == SMART:
        parser.error("--seams smart needs Blender, with which the batch runs: python -m spectral_conformal batch.")
    used = {"suggest": batch_settings.OF_SEAMS, "merge": batch_settings.OF_MERGING}.get(settings.seams, ())
    idle = [name for name in batch_settings.OF_SEAMS if name in chosen and name not in used]
    if idle:
        also = " or merge" if idle[0] in batch_settings.OF_MERGING else ""
        parser.error(f"--{idle[0].replace('_', '-')} has an effect only with --seams suggest{also}.")
    own = assets.written_as(given.mesh)
    out = given.out or given.mesh.with_name(f"{given.mesh.stem}_uv{own}")
    if out.suffix.lower() not in (own, ".obj"):
        formats = " or ".join(dict.fromkeys((own, ".obj")))
        parser.error(f"--out must end with {formats}, which {given.mesh.name} can be written as, not '{out.name}'.")
    if out.is_dir() or not out.parent.is_dir():
        what = f"{out} is a folder" if out.is_dir() else f"there is no folder {out.parent}"
        parser.error(f"--out must be a file in a folder that exists; {what}.")
    try:
        failed = _unwrap_file(given.mesh, out, settings)
    except (ValueError, OSError) as error:
        print(f"error: {said(error)}", file=sys.stderr)
        return 1
    except MemoryError:
        print(f"error: {given.mesh}: there is too little memory to unwrap it.", file=sys.stderr)
        return 1
    return 1 if failed else 0


def _report(arguments: Sequence[str]) -> int:
    """Print measures of the maps of files; return 1 if a file cannot be read or violates the requirement."""
    from .batch import files

    parser = argparse.ArgumentParser(
        prog="python -m spectral_conformal report", description="Measure the UV maps of files; nothing is changed."
    )
    add_version(parser)
    parser.add_argument("files", type=Path, nargs="+", metavar="FILE", help="file with a UV map")
    parser.add_argument("--uv-map", default="", metavar="NAME", help="the UV map to measure, by default the first")
    parser.add_argument("--pack-by", choices=SHEETS, default=SHEETS[0], help="what has a texture of its own (asset)")
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
            report = map_report(files.read(path, BatchSettings(uv_map=given.uv_map)).meshes, given.pack_by)
        except (ValueError, OSError, MemoryError) as error:
            message = said(error) or f"{path}: there is too little memory to read it."
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


def _unwrap_file(source: Path, out: Path, settings: BatchSettings) -> int:
    """Read, cut, unwrap, lay out, write, print; return the number of islands that failed."""
    asset = assets.read(source, settings.uv_map)
    cut_meshes = [cut(mesh, settings.cutting) for mesh in asset.meshes]
    results = [unwrapped(each, settings.options, settings.straightening(each)) for each in cut_meshes]
    warnings = [each.message for each in cut_meshes if each.message]
    maps = laid_out(asset.meshes, results, settings.layout)
    warnings += assets.write(out, asset, maps, settings.textures)[1]
    if settings.draws:
        width, height = settings.texture
        mapped = [mesh.with_map(uv_map) for mesh, uv_map in zip(asset.meshes, maps)]
        pattern = Measurement(mapped, width / height, sheets_of(mapped, settings.pack_by)).pattern()
        for suffix, text in settings.drawings(pattern, asset.meters).items():
            report_file.replace(out.with_suffix(suffix), text.encode())
    warnings += on_sizes(results)
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
    """Return the parser; its settings are those of the batch, with their documentation."""
    parser = argparse.ArgumentParser(
        prog="python -m spectral_conformal",
        description="Unwrap a glTF, OBJ, PLY, OFF, STL or USD file and write it with UVs.",
        epilog="For many files: python -m spectral_conformal batch --help. To measure the UV maps of files: python -m "
        "spectral_conformal report --help.",
        # So that no abbreviation means something else in a later version.
        allow_abbrev=False,
    )
    add_version(parser)
    parser.add_argument("mesh", type=Path, help="the file; it stays unchanged unless --out names it")
    parser.add_argument(
        "--out",
        type=Path,
        help="the file to write, in the format of the mesh or as OBJ; by default <mesh>_uv beside it",
    )
    batch_settings.add_to(parser, _OF_MANY)
    return parser


if __name__ == "__main__":
    sys.exit(main())
