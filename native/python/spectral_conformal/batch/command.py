"""The batch command: its arguments, the run, and the results."""

from __future__ import annotations

import argparse
import importlib.metadata
import json
import logging
import math
import os
import sys
from collections import ChainMap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .._command_line import add_version, number_or_word, said
from .._drawing_plan import DrawingLimits
from .._texture_size import SAME
from ..assets import drawing
from ..assets.report import MapReport, Requirement, RequirementError
from ..assets.temporary import digest, left_beside
from ..assets.unwrapping import SHEETS
from . import entries, estimate, files, memory, overview, pool, progress, report_file, settings
from .entries import Entry, InputError
from .settings import BatchSettings, SettingsError
from .worker_process import Launcher, Limits, StartError, blender_command, blender_program, python_command

ALL_WORKED, SOME_WORKED, NONE_WORKED, INTERRUPTED, WRONG_USE = 0, 1, 2, 130, 64
WORKED = ("unwrapped", "kept")
# Files without a mesh, of which nothing is expected.
SKIPPED = "skipped"
LOG = "batch.log"
WORKER_LOGS = "logs"
# What a condition of `--require` may name beside the measures of the map.
_FURTHER = ("warnings", "seam_length")
_EXIT_CODES = (
    f"Exit code: {ALL_WORKED} all assets worked, {SOME_WORKED} some did not, {NONE_WORKED} none worked, {WRONG_USE} "
    f"an argument, input, program or folder that cannot be used, {INTERRUPTED} interrupted. An asset with islands that "
    "could not be unwrapped is written, and counts as one that did not work; files without a mesh are skipped and do "
    "not count. A part has worked if all of its assets have a report."
)

_log = logging.getLogger(__name__)


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> None:
        raise SettingsError(message)


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    result = _Parser(prog="python -m spectral_conformal batch", description="Unwrap many files.", epilog=_EXIT_CODES)
    add_version(result)
    result.add_argument("inputs", nargs="+", metavar="INPUT", help=f"file or folder; {', '.join(entries.READABLE)}")
    result.add_argument("--out", required=True, type=Path, metavar="DIR", help="folder of the results")
    for name, what in (("include", "only assets whose names fit"), ("exclude", "leave out assets whose names fit")):
        text = f'{what} this pattern, such as "props/*.obj"; may be given several times'
        result.add_argument(f"--{name}", action="append", default=[], metavar="PATTERN", help=text)
    result.add_argument("--format", default="", help="obj: only the meshes, as OBJ; by default that of the source")
    result.add_argument("--overwrite-source", action="store_true", help="write the unwrapped files over the sources")
    result.add_argument(
        "--atlas",
        metavar="NAME",
        help="all assets share one texture; its picture is NAME.png in the folder of the results",
    )
    result.add_argument(
        "--settings", type=Path, metavar="FILE",
        help='TOML with the settings below, by their names; tables such as ["*.lod*"] are for the assets that fit',
    )  # fmt: skip
    result.add_argument("--dry-run", action="store_true", help="show what would be done, and do nothing")
    result.add_argument("--resume", action="store_true", help="skip assets that an earlier run has finished")
    result.add_argument(
        "--part", type=_part, metavar="K/N", help="process the K-th of N parts of the assets, and write no overview"
    )
    result.add_argument("--overview", action="store_true", help="only write the overview over the results of all parts")
    result.add_argument(
        "--require",
        metavar="CONDITION",
        help='such as "flips == 0 and overlaps == 0 and qc_p99 < 1.5"; an asset that violates it is written, but '
        "counts as one that did not work",
    )
    run = result.add_argument_group("running")
    run.add_argument("--jobs", type=_positive, metavar="N", default=_cores(), help="assets at once (%(default)s)")
    run.add_argument("--seconds", type=_positive_number, metavar="N", help="time limit per asset")
    run.add_argument("--memory", type=_positive, metavar="MIB", help="memory limit per worker")
    run.add_argument("--recycle", type=_positive, default=50, metavar="N", help="files per worker (%(default)s)")
    run.add_argument("--threads", type=_positive, metavar="N", default=1, help="threads per worker (%(default)s)")
    run.add_argument("--blender", metavar="PROGRAM", help="Blender to run the workers in")
    run.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster to run on")
    run.add_argument("--quiet", action="store_true", help="print errors only")
    run.add_argument(
        "--progress", choices=progress.FORMS, default=progress.TEXT,
        help="on the standard output, json: an object per line, for every phase and asset; openjd: what farms with "
        "Open Job Description read (%(default)s)",
    )  # fmt: skip
    settings.add_to(result)
    return result


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _part(text: str) -> tuple[int, int]:
    part, _, parts = text.partition("/")
    if not (part.isdecimal() and parts.isdecimal() and 1 <= int(part) <= int(parts)):
        raise argparse.ArgumentTypeError(f"{text} is not a part and a number of parts, such as 1/4")
    return int(part), int(parts)


def _positive(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text} is not a whole number of at least 1")
    return int(text)


def _positive_number(text: str) -> float:
    number = number_or_word(text)
    if isinstance(number, str) or not number > 0.0:
        raise argparse.ArgumentTypeError(f"{text} is not a number above 0")
    return float(number)


@dataclass(frozen=True)
class Plan:
    """The batch that a command line describes.

    Attributes:
        entries: the assets, in the order of their names.
        settings: of all of them, but for `tables`.
        out: folder of the results, absolute.
        arguments: everything else.
        requirement: for every map; None for none.
        results: files in the inputs that are left out, since an earlier run has written them.
        tables: settings of the assets whose names fit a pattern, with the command line's, in the order of the file.
    """

    entries: Sequence[Entry]
    settings: BatchSettings
    out: Path
    arguments: argparse.Namespace
    requirement: Requirement | None = None
    results: Sequence[Path] = ()
    tables: Sequence[tuple[str, dict[str, Any]]] = ()

    def settings_of(self, entry: Entry) -> BatchSettings:
        """Return the settings of an asset."""
        tables = [table for pattern, table in self.tables if entries.fits(entry.name, [pattern])]
        if not tables:
            return self.settings
        return settings.from_values({**self.settings.as_json(), **dict(ChainMap(*reversed(tables)))})


def plan(arguments: Sequence[str]) -> Plan:
    """Return the batch that a command line describes.

    Raises:
        SettingsError: an argument is unknown or invalid.
        InputError: the inputs do not form a batch.
        StartError: there is no program of the name given for Blender.
    """
    parsed = parser().parse_args(arguments)
    values, tables = _settings_file(parsed.settings) if parsed.settings else ({}, [])
    chosen = settings.from_values({**values, **settings.given(parsed)})
    for pattern, table in tables:
        if "usd_over" in table:
            raise SettingsError(f"usd_over is for all assets, and cannot be set for {pattern}.")
        try:
            settings.from_values({**chosen.as_json(), **table})
        except SettingsError as error:
            raise SettingsError(f"{pattern}: {error}") from error
    # The command line goes before the file.
    tables = [(pattern, {**table, **settings.given(parsed)}) for pattern, table in tables]
    try:
        requirement = Requirement(parsed.require, _FURTHER) if parsed.require is not None else None
    except RequirementError as error:
        raise SettingsError(f"--require: {error}") from error
    # A cluster has its own programs.
    if parsed.blender is not None and not parsed.scheduler:
        blender_program(parsed.blender)
    if parsed.memory and not memory.is_measurable() and not parsed.scheduler:
        raise SettingsError("--memory needs psutil on this system: pip install psutil, or leave it out.")
    suffix = parsed.format.lower()
    suffix = f".{suffix}" if suffix and not suffix.startswith(".") else suffix
    out = parsed.out.resolve()
    if out.exists() and not out.is_dir():
        raise InputError(f"--out {parsed.out} is a file, and must be a folder.")
    patterns = parsed.include, parsed.exclude
    results: list[Path] = []
    found = entries.find(
        *(parsed.inputs, out, suffix, chosen.usd_over, parsed.overwrite_source, *patterns), on_result=results.append
    )
    for pattern, _ in tables:
        if not any(entries.fits(entry.name, [pattern]) for entry in found):
            raise SettingsError(f'{parsed.settings}: no asset fits the pattern "{pattern}".')
    if parsed.part:
        part, parts = parsed.part
        found = found[part - 1 :: parts]
    wanted = Plan(found, chosen, out, parsed, requirement, results, tables)
    if parsed.atlas is not None:
        _check_atlas(wanted)
    return wanted


def _check_atlas(wanted: Plan) -> None:
    """Raise SettingsError if an atlas is impossible with these arguments."""
    arguments, chosen = wanted.arguments, wanted.settings
    name = arguments.atlas
    if not name or Path(name).name != name or name.startswith("."):
        raise SettingsError(f"--atlas must be a name for files, not '{name}'.")
    if arguments.part:
        raise SettingsError("--atlas and --part exclude each other: an atlas is packed as a whole.")
    if chosen.pack_by != SHEETS[0] or chosen.pack == "none":
        raise SettingsError(f"--atlas needs --pack shape or box, and --pack-by {SHEETS[0]}: it is one texture for all.")
    if any(wanted.settings_of(entry).layout != chosen.layout for entry in wanted.entries):
        raise SettingsError("--atlas needs the same layout for all assets, without tables that change it.")
    if any(wanted.settings_of(entry).textures != chosen.textures for entry in wanted.entries):
        raise SettingsError("--atlas needs the same rebake and rebake_colors for all assets: they share the textures.")
    if chosen.rebake == SAME:
        raise SettingsError("--atlas needs --rebake auto or a size: assets share the textures, which have one size.")


def _settings_file(path: Path) -> tuple[dict[str, Any], list[tuple[str, dict[str, Any]]]]:
    """Return the settings of a file, and its tables for assets whose names fit a pattern.

    Raises:
        SettingsError: it cannot be read.
    """
    try:
        import tomllib
    except ImportError:
        try:
            import tomli as tomllib
        except ImportError as error:
            raise SettingsError("--settings needs Python 3.11, or tomli in this one; give options instead.") from error
    try:
        found = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        message = said(error) if isinstance(error, OSError) else f"{path}: {error}"
        raise SettingsError(message) from error
    tables = [(name, value) for name, value in found.items() if isinstance(value, dict)]
    return {name: value for name, value in found.items() if not isinstance(value, dict)}, tables


def main(arguments: Sequence[str], worker_words: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code.

    `worker_words` replace the command that `worker_process` finds for starting a worker.
    """
    try:
        wanted = plan(arguments)
        if wanted.results:
            count = len(wanted.results)
            files_of = "1 file" if count == 1 else f"{count} files"
            print(
                f"{files_of} left out, as written by an earlier run: {wanted.results[0]}{' and others' * (count > 1)}",
                file=sys.stderr,
            )
        if wanted.arguments.dry_run:
            _print_plan(wanted)
            return ALL_WORKED
        return _run(wanted, worker_words)
    except (SettingsError, InputError, StartError) as error:
        print(f"error: {error}", file=sys.stderr)
        return WRONG_USE
    except OSError as error:
        print(f"error: the results cannot be written: {said(error)}", file=sys.stderr)
        return WRONG_USE
    except SystemExit as end:
        # argparse exits after printing the help.
        return int(end.code or 0)


def _print_plan(wanted: Plan) -> None:
    estimates, before = [], wanted.settings.as_json()
    for asset in wanted.entries:
        chosen = wanted.settings_of(asset)
        if wanted.arguments.resume and _is_done(asset, chosen, wanted):
            print(f"{asset.name} -> {asset.target} (done already)")
            continue
        found = estimate.of_asset(asset, chosen)
        # The assets of an atlas share textures, which nobody knows before all are read.
        plan = None if wanted.arguments.atlas else estimate.of_textures(asset, chosen, _limits_of_textures(wanted))
        estimates.append(found and found.with_textures(plan))
        print(f"{asset.name} -> {asset.target} ({estimate.line(estimates[-1])})")
        if plan:
            print("\n  ".join(filter(None, (f"  {estimate.line_of_textures(plan)}", plan.warning))))
        if differing := {name: value for name, value in chosen.as_json().items() if value != before[name]}:
            print(f"  with {json.dumps(differing)}")
    print(estimate.summary(estimates, wanted.arguments.jobs, bool(wanted.arguments.atlas)))
    print(json.dumps(before, indent=1))


def _run(wanted: Plan, worker_words: Sequence[str] | None) -> int:
    arguments = wanted.arguments
    logs = wanted.out / WORKER_LOGS
    logs.mkdir(parents=True, exist_ok=True)
    # Parts may run concurrently, on machines that share the folder.
    name = LOG if not arguments.part else "batch-{}-{}.log".format(*arguments.part)
    handler = logging.FileHandler(wanted.out / name, encoding="utf-8", errors="backslashreplace")
    _claim(handler, wanted.out / name)
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    _log.setLevel(logging.INFO)
    _log.propagate = False
    _log.addHandler(handler)
    reports: dict[str, dict[str, Any]] = {}
    try:
        if arguments.overview:
            reports.update(_found(wanted))
        elif arguments.resume:
            reports.update(_done(wanted))
        todo = [asset for asset in wanted.entries if asset.name not in reports]
        _log.info("%d assets, %d of them done before; settings %s", len(wanted.entries), len(reports), wanted.settings)
        is_interrupted = not arguments.overview and _work(wanted, todo, reports, worker_words)
        if arguments.part:
            code = INTERRUPTED if is_interrupted else ALL_WORKED
            _say_end(wanted, reports, code)
            return code
        for report in reports.values():
            if wanted.requirement and "totals" in report:
                report["not_met"] = _not_met(wanted.requirement, report)
        overview.write(wanted.out, [reports.get(a.name) or _missing(a) for a in wanted.entries], is_interrupted)
        code = INTERRUPTED if is_interrupted else _exit_code(wanted, reports)
        _say_end(wanted, reports, code)
        if not arguments.quiet and arguments.progress == progress.TEXT:
            print(_ending(wanted, reports, len(wanted.entries) - len(todo)), file=sys.stderr)
        return code
    finally:
        _log.removeHandler(handler)
        handler.close()


def _say_end(wanted: Plan, reports: dict[str, dict[str, Any]], code: int) -> None:
    if wanted.arguments.progress == progress.JSON:
        progress.event("end", exit_code=code, worked=_worked(wanted, reports), assets=len(wanted.entries))


def _claim(handler: logging.FileHandler, path: Path) -> None:
    """Lock the log while it is open, so that no other batch writes the same results.

    Raises:
        InputError: another batch holds the lock.
    """
    try:
        import fcntl
    except ImportError:
        # Windows: no lock.
        return
    try:
        fcntl.flock(handler.stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        handler.close()
        raise InputError(f"Another batch writes into {path.parent}: wait for it, or name another --out.") from error
    except OSError:
        # A file system without locks.
        return


def _work(
    wanted: Plan, todo: Sequence[Entry], reports: dict[str, dict[str, Any]], worker_words: Sequence[str] | None
) -> bool:
    """Unwrap the assets and collect their reports; return whether the user interrupted the run."""
    for entry in todo:
        entry.folder.mkdir(parents=True, exist_ok=True)
        _clean(entry)
    # No part of an atlas is made elsewhere.
    for path in wanted.out.glob(".*.partial*") if wanted.arguments.atlas else ():
        path.unlink(missing_ok=True)
    with progress.bar(len(todo), wanted.arguments.quiet, wanted.arguments.progress) as advance:
        try:
            for asset, report in _reports(wanted, todo, worker_words):
                report = _completed(asset, report, wanted)
                reports[asset.name] = report
                level = logging.INFO if _has_worked(report) or report["status"] == SKIPPED else logging.ERROR
                _log.log(level, "%s: %s", asset.name, overview.line(report))
                advance(asset.name, report["status"], overview.line(report), report.get("seconds", {}).get("total"))
        except KeyboardInterrupt:
            _log.error("interrupted")
            return True
    return False


def _reports(
    wanted: Plan, todo: Sequence[Entry], worker_words: Sequence[str] | None
) -> Iterator[tuple[Entry, dict[str, Any]]]:
    arguments = wanted.arguments
    logs, limits = wanted.out / WORKER_LOGS, _limits(arguments)
    # What is unwrapped together: an asset, or all of an atlas.
    groups = [todo] if arguments.atlas else [[entry] for entry in todo]
    requests = [
        (_line(group, wanted), any(files.needs_blender(entry.source, wanted.settings_of(entry)) for entry in group))
        for group in groups
    ]
    if not todo:
        return
    if arguments.scheduler:
        from . import dask_cluster

        place = (arguments.scheduler, limits, arguments.blender, arguments.threads, logs)
        for i, report in dask_cluster.run(requests, *place):
            yield from _of_each(groups[i], report)
        return
    launchers: dict[bool, Launcher] = {}
    try:
        for in_blender in {needs for _, needs in requests}:
            try:
                words = blender_command(arguments.blender, arguments.threads) if in_blender else python_command()
            except StartError as error:
                if arguments.blender:
                    raise
                # The others need none.
                failed = {"status": "failed", "failure": {"kind": "error", "message": str(error)}}
                for group, (_, needs) in zip(groups, requests):
                    if needs:
                        yield from _of_each(group, failed)
                continue
            launchers[in_blender] = Launcher(worker_words or words, logs, arguments.threads)
        served = [group for group, (_, needs) in zip(groups, requests) if needs in launchers]
        lines = [(line, launchers[needs]) for line, needs in requests if needs in launchers]

        def tell(index: int, phase: str, seconds: float, begins: bool, note: str) -> None:
            name = arguments.atlas or served[index][0].name
            if arguments.progress == progress.JSON:
                kind, more = "note" if note else "phase" if begins else "alive", {"note": note} if note else {}
                progress.event(kind, name=name, phase=phase, seconds=round(seconds, 3), **more)
            if begins:
                return
            text = f"{name}: {note}" if note else f"{name}: {phase}, {progress.duration(seconds)} so far"
            _log.info("%s", text)
            if not arguments.quiet and arguments.progress == progress.TEXT:
                progress.say(text)

        for k, report in pool.run(lines, limits, arguments.jobs, tell):
            yield from _of_each(served[k], report)
    finally:
        for launcher in launchers.values():
            launcher.close()


def _limits(arguments: argparse.Namespace) -> Limits:
    return Limits(arguments.seconds, arguments.memory << 20 if arguments.memory else None, arguments.recycle)


def _limits_of_textures(wanted: Plan) -> DrawingLimits:
    limits = _limits(wanted.arguments)
    return DrawingLimits.share_of(limits.seconds, limits.memory)


def _line(group: Sequence[Entry], wanted: Plan) -> str:
    """Return the request for assets that are unwrapped together, in the form that `task.request_of` reads."""
    requests = []
    for asset in group:
        paths = {name: str(getattr(asset, name)) for name in ("source", "folder", "target")}
        limits = _limits(wanted.arguments)
        given = {"settings": wanted.settings_of(asset).as_json(), "seconds": limits.seconds, "memory": limits.memory}
        requests.append({"name": asset.name, **paths, **given})
    atlas = wanted.arguments.atlas
    if not atlas:
        return json.dumps(requests[0])
    out = wanted.out
    return json.dumps({"name": atlas, "picture": str(out / f"{atlas}.png"), "assets": requests, "folder": str(out)})


def _of_each(group: Sequence[Entry], report: dict[str, Any]) -> Iterator[tuple[Entry, dict[str, Any]]]:
    """Yield the report of each asset of a group, given that of the group, which may have failed as a whole."""
    reports = report.get("reports") or [report] * len(group)
    further = {"attempts": report["attempts"]} if "attempts" in report else {}
    yield from ((entry, {**each, **further}) for entry, each in zip(group, reports))


def _clean(asset: Entry) -> None:
    """Remove an earlier run's files of an asset to process again, except the target, which is replaced later."""
    patterns = (f"{entries.PATTERN}{suffix}" for suffix in drawing.FORMATS)
    for name in (entries.REPORT, entries.LAYOUT, entries.CHECKER, entries.THUMBNAIL, *patterns):
        (asset.folder / name).unlink(missing_ok=True)
    _remove_partial(asset)


def _remove_partial(asset: Entry) -> None:
    """Remove what a killed process has left of the files of an asset."""
    for path in (*left_beside(asset.target), *asset.folder.glob(".*.partial*")):
        path.unlink(missing_ok=True)


def _completed(entry: Entry, report: dict[str, Any], wanted: Plan) -> dict[str, Any]:
    """Complete a report with data from this process, write it and return it."""
    known = {"name": entry.name, "source": str(entry.source), "settings": wanted.settings_of(entry).as_json()}
    report = {**known, "warnings": [], **report}
    report.setdefault("versions", {})["spectral_conformal"] = _version()
    if report["status"] == "failed":
        _remove_partial(entry)
    elif wanted.requirement and "totals" in report:
        report["not_met"] = _not_met(wanted.requirement, report)
    try:
        entry.folder.mkdir(parents=True, exist_ok=True)
        report_file.write(entry.folder, report)
    except OSError as error:
        report.update(status="failed", failure={"kind": "error", "message": f"its report cannot be written: {error}"})
    return report


def _not_met(requirement: Requirement, report: dict[str, Any]) -> list[str]:
    totals = report["totals"]
    length = totals.get("seam_length", 0.0)
    return requirement.failures(MapReport.from_json(totals), warnings=len(report["warnings"]), seam_length=length)


def _version() -> str:
    try:
        return importlib.metadata.version("spectral-conformal")
    except importlib.metadata.PackageNotFoundError:
        return "unknown"


def _missing(asset: Entry) -> dict[str, Any]:
    failure = {"kind": "interrupted", "message": "not begun, or not finished"}
    return {"name": asset.name, "source": str(asset.source), "status": "failed", "failure": failure}


def _done(wanted: Plan) -> dict[str, dict[str, Any]]:
    done = ((asset.name, _is_done(asset, wanted.settings_of(asset), wanted)) for asset in wanted.entries)
    found = {name: report for name, report in done if report}
    atlas = wanted.arguments.atlas and {"name": wanted.arguments.atlas, "assets": [e.name for e in wanted.entries]}
    if any(report.get("atlas") != atlas for report in found.values()) or (atlas and len(found) < len(wanted.entries)):
        # An atlas is packed as a whole.
        return {} if atlas else {name: report for name, report in found.items() if not report.get("atlas")}
    return found


def _is_done(asset: Entry, settings: BatchSettings, wanted: Plan) -> dict[str, Any] | None:
    """Return the report of an asset whose file, settings and result are unchanged, or None.

    Nor is one done whose textures were reduced, if there is more time or memory for them now.
    """
    report = report_file.read(asset.folder)
    if report is None or report["status"] in ("failed", SKIPPED) or report["settings"] != settings.as_json():
        return None
    if not asset.target.is_file() or digest(asset.target) != report["output_digest"]:
        return None
    if not all((wanted.out / name).is_file() for name in report.get("shared_textures", ())):
        return None
    limits, before = _limits(wanted.arguments), report.get("reduced_by")
    if before is not None and any(
        (now or math.inf) > (before.get(name) or math.inf)
        for name, now in (("seconds", limits.seconds), ("memory", limits.memory))
    ):
        return None
    # An asset that overwrote its source no longer has the source's digest.
    unchanged = (report["source_digest"], report["output_digest"])[: 2 if asset.target == asset.source else 1]
    return report if digest(asset.source) in unchanged else None


def _found(wanted: Plan) -> dict[str, dict[str, Any]]:
    found = ((asset.name, report_file.read(asset.folder)) for asset in wanted.entries)
    return {name: report for name, report in found if report}


def _ending(wanted: Plan, reports: dict[str, dict[str, Any]], before: int) -> str:
    """Return the last line for the user."""
    done = f" ({before} done before)" if before else ""
    skipped = _skipped(wanted, reports)
    without = f", {skipped} skipped, which have no mesh" if skipped else ""
    count = len(wanted.entries) - skipped
    return f"{_worked(wanted, reports)} of {count} assets worked{done}{without}: {wanted.out / overview.PAGE}"


def _worked(wanted: Plan, reports: dict[str, dict[str, Any]]) -> int:
    return sum(_has_worked(reports.get(entry.name, {})) for entry in wanted.entries)


def _skipped(wanted: Plan, reports: dict[str, dict[str, Any]]) -> int:
    return sum(reports.get(entry.name, {}).get("status") == SKIPPED for entry in wanted.entries)


def _exit_code(wanted: Plan, reports: dict[str, dict[str, Any]]) -> int:
    worked = _worked(wanted, reports)
    if worked and worked + _skipped(wanted, reports) == len(wanted.entries):
        return ALL_WORKED
    return SOME_WORKED if worked else NONE_WORKED


def _has_worked(report: dict[str, Any]) -> bool:
    return report.get("status") in WORKED and not report.get("not_met")
