"""Unwrap one asset with given settings and report on it: the core of every batch."""

from __future__ import annotations

import json
import os
import platform
import sys
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from .._build import build_info
from .._command_line import said
from .._drawing_plan import DrawingLimits, DrawingPlan
from .._pattern import Pattern
from .._results import Unwrap
from .._texture_size import TextureSize
from ..assets import AssetError, AssetMesh, NoMeshError, SharedTextures, UvMap, drawing
from ..assets.report import Measurement
from ..assets.temporary import digest
from ..assets.unwrapping import CutMesh, cut, laid_out, laid_out_anew, on_sizes, share_of_boxes, sheets_of, unwrapped
from . import entries, estimate, files, layout_picture, memory, report_file
from .settings import SMART, BatchSettings, SettingsError, from_values

THUMBNAIL = 160
# Of the names of meshes in a warning.
_SHOWN = 4
# Of all textures of an asset: as many as four of 8192 x 8192 have, of which islands cover less than a quarter.
_MANY_TEXELS, _SPARSE = 1 << 28, 0.25
# Less is not worth a line before it is done: the texels of a texture of 8192 x 8192.
_TOLD_TEXELS = 1 << 26
# The status of the answer to a request for an atlas.
ATLAS = "atlas"
# Of the islands' area in their bounding boxes. Even a strip a thousand times as long as wide, bent to a circle, has
# ten times this.
LEAST_SHARE = 1e-4


# Takes the name of a phase, and what is known of it or nothing.
Tell = Callable[[str, str], None]


@dataclass(frozen=True)
class Request:
    """A request to unwrap an asset; all values are JSON values.

    Attributes:
        name: of the asset in the batch.
        source: the file.
        folder: for the report and pictures; must exist.
        target: the unwrapped file.
        settings: in the form that `settings.from_values` accepts.
        seconds: after which its worker is ended; None for no limit.
        memory: bytes beyond which its worker is ended; None for no limit.
    """

    name: str
    source: str
    folder: str
    target: str
    settings: dict[str, Any]
    seconds: float | None = None
    memory: int | None = None


@dataclass(frozen=True)
class Atlas:
    """A request to unwrap several assets into one texture; all values are JSON values.

    Attributes:
        name: of the atlas.
        picture: file of the picture of the whole layout; empty for none.
        assets: what to unwrap; the layout and the size of textures are those of the first one's settings.
        folder: for the textures that the assets share; empty if each has its own.
    """

    name: str
    picture: str
    assets: list[Request]
    folder: str = ""


class _Phases:
    """Seconds per phase, by name; `tell` takes the name of each as it begins, and what is known of it."""

    def __init__(self, tell: Tell) -> None:
        self.seconds: dict[str, float] = {}
        self._tell = tell
        self._phase = ""

    def note(self, text: str) -> None:
        """Tell what is known of the phase."""
        self._tell(self._phase, text)

    @contextmanager
    def __call__(self, name: str) -> Iterator[None]:
        start = time.perf_counter()
        self._phase = name
        self._tell(name, "")
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start


def run(request: Request, tell: Tell = lambda phase, note: None) -> dict[str, Any]:
    """Unwrap one asset, write the file, the pictures and finally the report, and return the report.

    `tell` takes the name of each phase as it begins, and again with what is known of it.

    Problems of the asset are in the report. Each file appears completely or not at all.
    """
    return _together([request], tell)[0]


def run_atlas(atlas: Atlas, tell: Tell = lambda phase, note: None) -> list[dict[str, Any]]:
    """Unwrap several assets into one texture, each as `run` does, and return their reports.

    Assets that cannot be read or unwrapped get no share of the texture.
    """
    return _together(atlas.assets, tell, atlas)


def answer(line: str, tell: Tell = lambda phase, note: None) -> dict[str, Any]:
    """Return the report on a request in a line of JSON; for an atlas a record with all `reports`."""
    request = request_of(line)
    if isinstance(request, Request):
        return run(request, tell)
    return {"status": ATLAS, "reports": run_atlas(request, tell)}


def _together(requests: Sequence[Request], tell: Tell, atlas: Atlas | None = None) -> list[dict[str, Any]]:
    """Unwrap assets into one texture; return their reports."""
    memory.reset_peak()
    works = [_Work(request, tell) for request in requests]
    for work in works:
        with _guarded([work]):
            work.solve()
    fitting = [work for work in works if not work.has_failed]
    maps: list[list[UvMap]] = []
    with _guarded(fitting):
        if fitting:
            maps = _laid_out(fitting)
    if atlas is not None and maps:
        _share_textures(atlas, fitting, maps)
    for work, own in zip(fitting, maps):
        if not work.has_failed:
            with _guarded([work]):
                work.finish(own)
    if atlas is not None:
        names = [work.request.name for work in fitting]
        for work in works:
            work.report["atlas"] = {"name": atlas.name, "assets": names}
        _draw_atlas(atlas, [work for work in fitting if not work.has_failed])
    return [work.end() for work in works]


@contextmanager
def _guarded(works: Sequence[_Work]) -> Iterator[None]:
    """Put errors into the reports of these assets; the time is that of the first one."""
    start = time.perf_counter()
    try:
        yield
    except NoMeshError as error:
        found: dict[str, Any] = {"status": "skipped", "failure": {"kind": "no mesh", "message": str(error)}}
    except (AssetError, SettingsError, MemoryError, OSError) as error:
        kind = "memory" if isinstance(error, MemoryError) else "error"
        found = {"status": "failed", "failure": {"kind": kind, "message": said(error) or "there is too little memory"}}
    except Exception as error:  # noqa: BLE001 - importers are third-party Python; the next asset must go on
        # For the log.
        traceback.print_exc()
        found = {"status": "failed", "failure": {"kind": "error", "message": f"{type(error).__name__}: {error}"}}
    else:
        found = {}
    for work in works:
        work.report.update(found)
    if works:
        works[0].seconds += time.perf_counter() - start


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


class _Work:
    """An asset on its way from the file to the report."""

    def __init__(self, request: Request, tell: Tell) -> None:
        self.request = request
        self.phases = _Phases(tell)
        self.report: dict[str, Any] = {
            "name": request.name,
            "source": request.source,
            "settings": request.settings,
            "warnings": [],
        }
        self.results: list[Unwrap | None] = []
        self._cut_meshes: list[CutMesh] = []
        self._failures: Counter[str] = Counter()
        self._objects: dict[str, list[str]] = {}
        self.seconds = 0.0

    @property
    def has_failed(self) -> bool:
        return "failure" in self.report

    def solve(self) -> None:
        """Read the asset and unwrap its islands, or find its existing map."""
        source, target = Path(self.request.source), Path(self.request.target)
        self.report["source_digest"] = digest(source)
        self.settings = from_values(self.request.settings)
        try:
            drawing.check(self.settings.draws)
        except ValueError as error:
            raise AssetError(str(error)) from error
        with self.phases("read"):
            self.asset = files.read(source, self.settings)
        if self.asset.suffix != source.suffix.lower() and not self.settings.usd_over:
            self._warn(f"{source.suffix} holds no UVs: written as {target.suffix}.")
        elif self.asset.suffix != target.suffix.lower():
            self._warn(f"Written as {target.suffix}, with only the meshes of the {source.suffix} file.")
        if not self.settings.unwrap:
            meshes = self.asset.meshes
            missing = [mesh.name or self.asset.suffix for mesh in meshes if not mesh.has_uv().any()]
            if len(missing) == len(meshes):
                raise AssetError(f"There is no UV map in {', '.join(missing)}: leave out --no-unwrap.")
            return
        with self.phases("seams"):
            self._cut_meshes = _cut(self.asset.meshes, self.settings, self.report["warnings"])
        self.report["styles"] = [self.settings.style(each) for each in self._cut_meshes]
        with self.phases("solve"):
            self.results = [_unwrapped(each, self.settings, self._failures, self._objects) for each in self._cut_meshes]
        _note(self.results, self._failures, self.report)
        self.report["warnings"] += on_sizes(self.results)
        if not any(result is not None and result.solved_corners.any() for result in self.results):
            raise AssetError(f"No island could be unwrapped: {'; '.join(self._failures)}")

    @property
    def textures(self) -> TextureSize | None:
        """The size of textures to draw anew, and what they may take; None to leave them."""
        size, request = self.settings.textures, self.request
        limits = DrawingLimits.share_of(request.seconds, request.memory, self._plan_textures)
        return size and replace(size, limits=limits)

    def _plan_textures(self, plan: DrawingPlan) -> None:
        """Tell what textures take before they are drawn, if that is much; record the limits that make them smaller."""
        if plan.asked_texels > _TOLD_TEXELS or plan.warning:
            self.phases.note(estimate.line_of_textures(plan))
        if plan.warning:
            self.report["reduced_by"] = {"seconds": self.request.seconds, "memory": self.request.memory}

    def share(self, maps: Sequence[UvMap], shared: SharedTextures) -> None:
        """Add the textures, for these maps, to those that assets share."""
        if self.textures is None:
            return
        with self.phases("textures"):
            files.share(Path(self.request.target), self.asset, maps, self.textures, shared)

    def finish(self, maps: Sequence[UvMap]) -> None:
        """Write the asset with its maps, measure and draw what was written."""
        target, settings = Path(self.request.target), self.settings
        counts = self._counted(maps) if settings.unwrap else {}
        with self.phases("write"):
            written, warnings = files.write(target, self.asset, maps, self.textures)
        self.report["warnings"] += warnings
        self.report["textures"] = [asdict(each) for each in getattr(self.asset, "drawn_textures", [])]
        if settings.pack_by != "material":
            self.report["warnings"] += _on_textures(self.report["textures"])
        with self.phases("measure"):
            width, height = settings.texture
            # As OBJ, an asset of another format has no materials.
            sheets = sheets_of(self.asset.meshes, settings.pack_by)
            measured = Measurement(written, width / height, sheets)
            self.report["islands"] = [_json_of(asdict(island)) for island in measured.islands()]
            totals = {**_json_of(asdict(measured.report())), **counts}
            self.report["totals"] = {"meshes": len(self.asset.meshes), "failed": 0, **totals}
        self.report["warnings"] += _on_scales(self.asset.meshes) + _on_faces(self.report["totals"])
        # Islands that lie on each other may be meant to; what this made is not.
        if settings.unwrap:
            self.report["warnings"] += _on_overlaps(measured)
        if settings.draws:
            with self.phases("pattern"):
                try:
                    pattern = measured.pattern()
                except ValueError as error:
                    self._warn(f"There is no pattern: {error}")
                else:
                    _draw_pattern(self.request, settings, pattern, self.asset.meters, self.report)
        with self.phases("picture"):
            _draw(self.request, settings, measured, written, self.report)
        self.written = written
        self.report["output"] = os.path.relpath(target, self.request.folder)
        self.report["output_digest"] = digest(target)
        failed = self.report["totals"]["failed"]
        self.report["status"] = "incomplete" if failed else "unwrapped" if settings.unwrap else "kept"

    def _counted(self, maps: Sequence[UvMap]) -> dict[str, Any]:
        """Return further totals of an unwrapping, whose failed islands get warnings.

        Raises:
            AssetError: the map is useless.
        """
        meshes = self.asset.meshes
        share = share_of_boxes(meshes, self.results, maps)
        if share < LEAST_SHARE:
            raise AssetError(
                f"The islands cover {share:.1e} of their bounding boxes, less than {LEAST_SHARE:g}: such a map is "
                "useless; look for faces that are much larger or thinner than the others."
            )
        for reason, number in self._failures.items():
            islands = "1 island" if number == 1 else f"{number} islands"
            where = ", ".join(dict.fromkeys(self._objects[reason]))
            self._warn(f"{islands}{where and f' of {where}'} could not be unwrapped: {reason}")
        welded = (int((each.vertex_of != np.arange(len(each.vertex_of))).sum()) for each in self._cut_meshes)
        return {
            "vertices": sum(len(mesh.vertices) for mesh in meshes),
            "welded": sum(welded),
            "seam_length": sum(each.mesh.scale * each.seam_length for each in self._cut_meshes),
            "failed": sum(self._failures.values()),
        }

    def _warn(self, sentence: str) -> None:
        self.report["warnings"].append(sentence)

    def end(self) -> dict[str, Any]:
        """Write the report and return it."""
        self.report["versions"] = versions()
        self.report["seconds"] = {**self.phases.seconds, "total": self.seconds}
        self.report["peak_memory"] = memory.peak()
        report_file.write(Path(self.request.folder), self.report)
        return self.report


def _laid_out(works: Sequence[_Work]) -> list[list[UvMap]]:
    """Return the maps of assets in one texture, those of each.

    Raises:
        AssetError: there is too little room.
    """
    layout, does_unwrap = works[0].settings.layout, works[0].settings.unwrap
    if any(work.settings.unwrap != does_unwrap for work in works):
        raise AssetError("All assets of an atlas are unwrapped, or none: no-unwrap must be the same for all.")
    meshes = [mesh for work in works for mesh in work.asset.meshes]
    try:
        with works[0].phases("pack"):
            if does_unwrap:
                maps = laid_out(meshes, [result for work in works for result in work.results], layout)
            else:
                faces = np.cumsum([len(mesh.face_offsets) - 1 for mesh in meshes])[:-1]
                islands = np.split(Measurement(meshes).island_of_face, faces)
                maps = laid_out_anew(meshes, islands, layout)
    except ValueError as error:
        raise AssetError(str(error)) from error
    ends = np.cumsum([len(work.asset.meshes) for work in works]).tolist()
    return [maps[end - len(work.asset.meshes) : end] for work, end in zip(works, ends)]


def _share_textures(atlas: Atlas, works: Sequence[_Work], maps: Sequence[Sequence[UvMap]]) -> None:
    """Draw the textures of all assets together, an image for each role, if they are to be drawn anew."""
    size = works[0].textures
    if not (atlas.folder and size):
        return
    shared = SharedTextures(Path(atlas.folder), atlas.name, size)
    for work, own in zip(works, maps):
        with _guarded([work]):
            work.share(own, shared)
    left = [work for work in works if not work.has_failed]
    with _guarded(left), works[0].phases("textures"):
        shared.draw()
        for drawn in shared.all():
            report_file.replace(drawn.path, drawn.content)
    for work in left:
        work.report["shared_textures"] = [drawn.path.name for drawn in shared.all()]


def _draw_atlas(atlas: Atlas, works: Sequence[_Work]) -> None:
    """Write the picture of the whole layout, if requested."""
    if not (atlas.picture and works and works[0].settings.picture_size):
        return
    width, height = works[0].settings.texture
    measured = Measurement([mesh for work in works for mesh in work.written], width / height)
    picture = layout_picture.draw(*measured.triangles(), *measured.qc_range(), works[0].settings.picture_size)
    try:
        report_file.replace(Path(atlas.picture), layout_picture.png(picture))
    except OSError as error:
        works[0].report["warnings"].append(f"The picture of the atlas cannot be written: {said(error)}")


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


def _on_overlaps(measured: Measurement) -> list[str]:
    """Warn of faces that share texels."""
    kinds = (
        (measured.double, "have the vertices of another one, such as a back, and its place in the map"),
        (measured.overlapping & ~measured.double, "overlap others in the map"),
        (measured.flipped, "are flipped in the map"),
    )
    return [f"{chosen.sum()} of {len(chosen)} faces {what}." for chosen, what in kinds if chosen.any()]


def _json_of(values: dict[str, Any]) -> dict[str, Any]:
    """Return values for JSON, with None for NaN."""
    return {name: None if value != value else value for name, value in values.items()}


def _cut(meshes: Sequence[AssetMesh], settings: BatchSettings, warnings: list[str]) -> list[CutMesh]:
    """Cut every mesh; if the search rejects one, cut it at its own seams and add a warning."""
    found = []
    said: dict[str, list[str]] = {}
    for mesh in meshes:
        try:
            each = cut(mesh, settings.cutting)
        except (ValueError, MemoryError) as error:
            each = cut(mesh, replace(settings.cutting, seams="keep"))
            said.setdefault(f"no seams were found: {_reason(error)}", []).append(mesh.name)
        if each.message:
            said.setdefault(each.message, []).append(mesh.name)
        found.append(each)
    warnings += [_named(names, sentence) for sentence, names in said.items()]
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
        result = unwrapped(cut_mesh, settings.maps, settings.straightening(cut_mesh))
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


def _on_textures(records: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return the warning about drawn textures that together are large and for the most part empty."""
    texels = [each["width"] * each["height"] for each in records]
    covered = sum(number * each["covered"] for number, each in zip(texels, records))
    if sum(texels) <= _MANY_TEXELS or covered >= _SPARSE * sum(texels):
        return []
    return [
        f"The {len(records)} drawn textures have {sum(texels) / 1e6:.0f} million texels, of which islands cover "
        f"{100.0 * covered / sum(texels):.0f} %: with --pack-by material, each material has a map of its own."
    ]


def _named(names: Sequence[str], sentence: str) -> str:
    """Return a warning about meshes with these names, of which formats with one mesh have none."""
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    named = ", ".join(filter(None, names[:_SHOWN]))
    return f"{named}{more}: {sentence}" if named else sentence[0].upper() + sentence[1:]


def _note(results: Sequence[Unwrap | None], failures: Counter[str], report: dict[str, Any]) -> None:
    """Record the islands that were solved by a fallback or after a repair, and those that failed."""
    fallbacks: Counter[str] = Counter()
    repairs: Counter[str] = Counter()
    for result in filter(None, results):
        solved = result.charts.column("status") == "solved"
        fallbacks.update(filter(None, result.charts.column("fallback")[solved].tolist()))
        repairs.update(filter(None, result.charts.column("message")[solved].tolist()))
    report.update(fallbacks=dict(fallbacks), repairs=dict(repairs), failed_islands=dict(failures))


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


def request_of(text: str) -> Request | Atlas:
    """Return the request in a line of JSON."""
    found = json.loads(text)
    if "assets" in found:
        return Atlas(**{**found, "assets": [Request(**each) for each in found["assets"]]})
    return Request(**found)
