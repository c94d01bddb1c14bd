"""Unwrap one asset with given settings and report on it: the core of every batch."""

from __future__ import annotations

import json
import os
import platform
import sys
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .._build import build_info
from .._command_line import said
from .._pattern import Pattern
from .._results import Unwrap
from ..assets import Asset, AssetError, AssetMesh, NoMeshError, UvMap
from ..assets.report import Measurement
from ..assets.temporary import digest
from ..assets.unwrapping import CutMesh, Layout, cut, laid_out, laid_out_anew, on_sizes, share_of_boxes, unwrapped
from . import entries, files, layout_picture, memory, report_file
from .settings import SMART, BatchSettings, SettingsError, from_values

if TYPE_CHECKING:
    from .blender.files import BlenderAsset

THUMBNAIL = 160
# Of the islands' area in their bounding boxes. Even a strip a thousand times as long as wide, bent to a circle, has
# ten times this.
LEAST_SHARE = 1e-4


@dataclass(frozen=True)
class Request:
    """A request to unwrap an asset; all values are JSON values.

    Attributes:
        name: of the asset in the batch.
        source: the file.
        folder: for the report and pictures; must exist.
        target: the unwrapped file.
        settings: in the form that `settings.from_values` accepts.
    """

    name: str
    source: str
    folder: str
    target: str
    settings: dict[str, Any]


class _Phases:
    """Seconds per phase, by name; `tell` takes the name of each as it begins."""

    def __init__(self, tell: Callable[[str], None]) -> None:
        self.seconds: dict[str, float] = {}
        self._tell = tell

    @contextmanager
    def __call__(self, name: str) -> Iterator[None]:
        start = time.perf_counter()
        self._tell(name)
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start


def run(request: Request, tell: Callable[[str], None] = lambda phase: None) -> dict[str, Any]:
    """Unwrap one asset, write the file, the pictures and finally the report, and return the report.

    `tell` takes the name of each phase as it begins.

    Problems of the asset are in the report. Each file appears completely or not at all.
    """
    memory.reset_peak()
    start = time.perf_counter()
    phases = _Phases(tell)
    report: dict[str, Any] = {
        "name": request.name,
        "source": request.source,
        "settings": request.settings,
        "warnings": [],
    }
    try:
        report["source_digest"] = digest(Path(request.source))
        _run(request, from_values(request.settings), phases, report)
    except NoMeshError as error:
        report.update(status="skipped", failure={"kind": "no mesh", "message": str(error)})
    except (AssetError, SettingsError, MemoryError, OSError) as error:
        kind = "memory" if isinstance(error, MemoryError) else "error"
        report.update(status="failed", failure={"kind": kind, "message": said(error) or "there is too little memory"})
    except Exception as error:  # noqa: BLE001 - importers are third-party Python; the next asset must go on
        # For the log.
        traceback.print_exc()
        report.update(status="failed", failure={"kind": "error", "message": f"{type(error).__name__}: {error}"})
    report["versions"] = versions()
    report["seconds"] = {**phases.seconds, "total": time.perf_counter() - start}
    report["peak_memory"] = memory.peak()
    report_file.write(Path(request.folder), report)
    return report


def versions() -> dict[str, str]:
    """Return the versions that may affect the result."""
    build = build_info()
    found = {
        "factorization": str(build["factorization"]),
        "blas": str(build["blas"]),
        "kernel": str(build["kernel"]),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "platform": f"{sys.platform}-{platform.machine()}",
    }
    blender = sys.modules.get("bpy")
    return {**found, "blender": blender.app.version_string} if blender else found


def _run(request: Request, settings: BatchSettings, phases: _Phases, report: dict[str, Any]) -> None:
    source, target = Path(request.source), Path(request.target)
    with phases("read"):
        asset = files.read(source, settings)
    if asset.suffix != source.suffix.lower() and not settings.usd_over:
        report["warnings"].append(f"{source.suffix} holds no UVs: written as {target.suffix}.")
    elif asset.suffix != target.suffix.lower():
        report["warnings"].append(f"Written as {target.suffix}, with only the meshes of the {source.suffix} file.")
    maps = _unwrap(asset, settings, phases, report) if settings.unwrap else _keep(asset, settings.layout, phases)
    with phases("write"):
        written, warnings = files.write(target, asset, maps, settings.textures)
    report["warnings"] += warnings
    report["textures"] = [asdict(each) for each in getattr(asset, "drawn_textures", [])]
    with phases("measure"):
        width, height = settings.texture
        measured = Measurement(written, width / height)
        report["islands"] = [_json_of(asdict(island)) for island in measured.islands()]
        totals = {**_json_of(asdict(measured.report())), **report.pop("counts", {})}
        report["totals"] = {"meshes": len(asset.meshes), "failed": 0, **totals}
    report["warnings"] += _on_scales(asset.meshes) + _on_faces(report["totals"])
    if settings.draws:
        with phases("pattern"):
            _draw_pattern(request, settings, measured.pattern(), asset.meters, report)
    with phases("picture"):
        _draw(request, settings, measured, written, report)
    report["output"] = os.path.relpath(target, request.folder)
    report["output_digest"] = digest(target)
    failed = report["totals"]["failed"]
    report["status"] = "incomplete" if failed else "unwrapped" if settings.unwrap else "kept"


def _on_scales(meshes: Sequence[AssetMesh]) -> list[str]:
    """Warn of meshes whose density in the scene matches that of the others only on average."""
    uneven = [mesh.name for mesh in meshes if not mesh.is_scaled_evenly]
    return [f"Scaled unevenly in the scene, so that density is an average: {', '.join(uneven)}."] if uneven else []


def _on_faces(totals: dict[str, Any]) -> list[str]:
    """Warn of faces that cannot be painted because of a defect of the mesh or the map."""
    kinds = {
        "degenerate": "have no area",
        "collapsed": "have no area in the map",
        "unmapped": "have no UVs",
    }
    return [f"{totals[kind]} of {totals['faces']} faces {what}." for kind, what in kinds.items() if totals[kind]]


def _json_of(values: dict[str, Any]) -> dict[str, Any]:
    """Return values for JSON, with None for NaN."""
    return {name: None if value != value else value for name, value in values.items()}


def _unwrap(
    asset: Asset | BlenderAsset, settings: BatchSettings, phases: _Phases, report: dict[str, Any]
) -> list[UvMap]:
    with phases("seams"):
        cut_meshes = _cut(asset.meshes, settings, report["warnings"])
    failures: Counter[str] = Counter()
    objects: dict[str, list[str]] = {}
    with phases("solve"):
        results = [_unwrapped(each, settings, failures, objects) for each in cut_meshes]
    _note(results, failures, report)
    report["warnings"] += on_sizes(results)
    if not any(result is not None and result.solved_corners.any() for result in results):
        raise AssetError(f"No island could be unwrapped: {'; '.join(failures)}")
    with phases("pack"):
        maps = laid_out(asset.meshes, results, settings.layout)
        share = share_of_boxes(asset.meshes, results, maps)
    if share < LEAST_SHARE:
        raise AssetError(
            f"The islands cover {share:.1e} of their bounding boxes, less than {LEAST_SHARE:g}: such a map is useless; "
            "look for faces that are much larger or thinner than the others."
        )
    for reason, number in failures.items():
        islands = "1 island" if number == 1 else f"{number} islands"
        where = ", ".join(dict.fromkeys(objects[reason]))
        report["warnings"].append(f"{islands}{where and f' of {where}'} could not be unwrapped: {reason}")
    report["counts"] = {
        "vertices": sum(len(mesh.vertices) for mesh in asset.meshes),
        "welded": sum(int((each.vertex_of != np.arange(len(each.vertex_of))).sum()) for each in cut_meshes),
        "seam_length": sum(each.mesh.scale * each.seam_length for each in cut_meshes),
        "failed": sum(failures.values()),
    }
    return maps


def _cut(meshes: Sequence[AssetMesh], settings: BatchSettings, warnings: list[str]) -> list[CutMesh]:
    """Cut every mesh; if the search rejects one, cut it at its own seams and add a warning."""
    found = []
    for mesh in meshes:
        try:
            each = cut(mesh, settings.cutting)
        except (ValueError, MemoryError) as error:
            each = cut(mesh, replace(settings.cutting, seams="keep"))
            warnings.append(_named(mesh, f"no seams were found: {_reason(error)}"))
        if each.message:
            warnings.append(_named(mesh, each.message))
        found.append(each)
    if settings.seams == SMART:
        from .blender import smart_project

        more = smart_project.seams(found)
        found = [replace(each, seam_edges=np.concatenate([each.seam_edges, edges])) for each, edges in zip(found, more)]
    return found


def _unwrapped(
    cut_mesh: CutMesh, settings: BatchSettings, failures: Counter[str], objects: dict[str, list[str]]
) -> Unwrap | None:
    """Return the maps of a mesh, None if it is rejected as a whole; record failures and their objects."""
    mesh = cut_mesh.mesh
    try:
        result = unwrapped(cut_mesh, settings.options, settings.straightening(cut_mesh))
    except (ValueError, MemoryError) as error:
        failures[_reason(error)] += 1
        objects.setdefault(_reason(error), []).extend(mesh.names_of(np.arange(len(mesh.face_offsets) - 1)))
        return None
    for number in np.flatnonzero(result.charts.column("status") != "solved").tolist():
        chart = result.charts[number]
        failures[chart.message] += 1
        objects.setdefault(chart.message, []).extend(mesh.names_of(chart.faces))
    return result


def _reason(error: Exception) -> str:
    return str(error) or "there is too little memory for it."


def _named(mesh: AssetMesh, sentence: str) -> str:
    return f"{mesh.name}: {sentence}" if mesh.name else sentence


def _note(results: Sequence[Unwrap | None], failures: Counter[str], report: dict[str, Any]) -> None:
    """Record the islands that were solved by a fallback or after a repair, and those that failed."""
    fallbacks: Counter[str] = Counter()
    repairs: Counter[str] = Counter()
    for result in filter(None, results):
        solved = result.charts.column("status") == "solved"
        fallbacks.update(filter(None, result.charts.column("fallback")[solved].tolist()))
        repairs.update(filter(None, result.charts.column("message")[solved].tolist()))
    report.update(fallbacks=dict(fallbacks), repairs=dict(repairs), failed_islands=dict(failures))


def _keep(asset: Asset | BlenderAsset, layout: Layout, phases: _Phases) -> list[UvMap]:
    """Return the existing maps, packed if requested."""
    missing = [mesh.name or asset.suffix for mesh in asset.meshes if not mesh.has_uv().any()]
    if len(missing) == len(asset.meshes):
        raise AssetError(f"There is no UV map in {', '.join(missing)}: leave out --no-unwrap.")
    with phases("pack"):
        measured = Measurement(asset.meshes)
        faces = np.cumsum([len(mesh.face_offsets) - 1 for mesh in asset.meshes])[:-1]
        return laid_out_anew(asset.meshes, np.split(measured.island_of_face, faces), layout)


def _draw(
    request: Request,
    settings: BatchSettings,
    measured: Measurement,
    written: Sequence[AssetMesh],
    report: dict[str, Any],
) -> None:
    """Write the picture of the layout and, if requested, the checker."""
    folder = Path(request.folder)
    if settings.picture_size:
        picture = layout_picture.draw(*measured.triangles(), *measured.qc_range(), settings.picture_size)
        report_file.replace(folder / entries.LAYOUT, layout_picture.png(picture))
        report["layout"] = entries.LAYOUT
        small = layout_picture.thumbnail(picture[: settings.picture_size], THUMBNAIL)
        report_file.replace(folder / entries.THUMBNAIL, layout_picture.png(small))
    if settings.checker:
        from .blender import checker

        checker.render(
            folder / entries.CHECKER, settings.picture_size or 512, written, files.y_is_up(Path(request.source))
        )
        report["checker"] = entries.CHECKER


def _draw_pattern(
    request: Request, settings: BatchSettings, pattern: Pattern, meters: float | None, report: dict[str, Any]
) -> None:
    """Write the pattern, and the lengths of the sides of its seams into the report."""
    names = []
    for suffix, text in settings.drawings(pattern, meters).items():
        names.append(f"{entries.PATTERN}{suffix}")
        report_file.replace(Path(request.folder) / names[-1], text.encode())
    sides: dict[int, list[float]] = {}
    lengths: dict[int, float] = {}
    for seam, length, found in zip(*(each.tolist() for each in (pattern.seams, pattern.lengths, pattern.map_lengths))):
        if seam:
            lengths[seam] = length
            sides.setdefault(seam, []).append(found)
    report["pattern"] = {
        "files": names,
        "seams": [{"number": seam, "length": lengths[seam], "sides": sides[seam]} for seam in sorted(sides)],
    }


def request_of(text: str) -> Request:
    """Return the request in a line of JSON."""
    return Request(**json.loads(text))
