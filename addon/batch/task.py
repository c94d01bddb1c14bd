# SPDX-License-Identifier: GPL-3.0-or-later
"""One asset by some settings to a report: what every door of the batch comes to."""

from __future__ import annotations

import json
import math
import os
import platform
import shutil
import sys
import time
import traceback
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ..core import kept_maps, native, seam_suggestion, texts, welding
from ..core.errors import ReadableError
from ..core.map_view import MapArrays, MapView, automatic_range, weighted_percentiles
from ..core.mesh import PolygonMesh
from ..core.solve import Solution, are_solved, column_of_all
from ..core.summary import summarize
from ..edit_mesh import packing, read_map
from ..edit_mesh.read import EditMesh
from ..unwrapping import seams, steps
from . import assets, checker, formats, layout_picture, memory, report_file, usd_over
from .settings import BatchSettings, from_values
from .version import version

THUMBNAIL = 160
# Of splitmix64: spreads every bit over the higher ones.
_MULTIPLIER = np.uint64(0xBF58476D1CE4E5B9)
# Of the space that Smart UV Project leaves between its islands, none matters: they are made again.
_SMART_PROJECT = {"island_margin": 0.0}


class AssetError(ReadableError):
    """An asset has nothing that could be unwrapped; the message says why."""


@dataclass(frozen=True)
class Request:
    """What to unwrap, by values that JSON has.

    Attributes:
        name: of the asset in the batch.
        source: the file.
        folder: where report and pictures go; must exist.
        target: the unwrapped file.
        settings: as `settings.from_values` takes them.
    """

    name: str
    source: str
    folder: str
    target: str
    settings: dict[str, Any]


class _Phases:
    """Seconds by the name of a phase."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def __call__(self, name: str) -> Iterator[None]:
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start


def run(request: Request) -> dict[str, Any]:
    """Unwrap one asset, write the file, the pictures and at last the report, and return it.

    What is wrong with the asset is in the report; the results appear whole or not at all.
    """
    memory.reset_peak()
    start = time.perf_counter()
    phases = _Phases()
    report: dict[str, Any] = {
        "name": request.name,
        "source": request.source,
        "settings": request.settings,
        "versions": versions(),
        "warnings": [],
    }
    try:
        report["source_digest"] = assets.digest(Path(request.source))
        _run(request, from_values(request.settings), phases, report)
    except (ReadableError, MemoryError, OSError) as error:
        kind = "memory" if isinstance(error, MemoryError) else "error"
        report.update(status="failed", failure={"kind": kind, "message": str(error) or type(error).__name__})
    except Exception as error:  # noqa: BLE001 - importers are others' Python; the next asset is not their fault
        # The log has where it was.
        traceback.print_exc()
        report.update(status="failed", failure={"kind": "error", "message": f"{type(error).__name__}: {error}"})
    report["seconds"] = {**phases.seconds, "total": time.perf_counter() - start}
    report["peak_memory"] = memory.peak()
    report_file.write(Path(request.folder), report)
    return report


def versions() -> dict[str, str]:
    """Return what the result may depend on."""
    build = native.spectral_conformal().build_info()
    return {
        "blender": bpy.app.version_string,
        "spectral_unwrap": version(),
        "factorization": str(build["factorization"]),
        "blas": str(build["blas"]),
        "kernel": str(build["kernel"]),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "platform": f"{sys.platform}-{platform.machine()}",
    }


def _run(request: Request, settings: BatchSettings, phases: _Phases, report: dict[str, Any]) -> None:
    source, target = Path(request.source), Path(request.target)
    with phases("read"):
        formats.read(source)
        objects = _objects(report["warnings"])
        _choose_maps(objects, settings.uv_map)
    if source.suffix.lower() in assets.WITHOUT_UVS and source.suffix.lower() != target.suffix.lower():
        report["warnings"].append(f"{source.suffix} holds no UVs: written as {target.suffix}.")
    report["fallbacks"], report["failed_islands"] = {}, {}
    with _edit_mode(objects):
        _mark_seams(settings, phases, report)
        if settings.unwrap:
            _unwrap(settings, phases, report)
        elif settings.pack:
            with phases("pack"):
                _pack(settings)
    with phases("measure"):
        maps = _maps(objects)
        vertices_of = [_vertex_of(arrays, settings) for arrays in maps]
        views = list(map(_view, maps, vertices_of))
        report.update(_measured(objects, views, vertices_of))
        report["totals"]["failed"] = sum(report["failed_islands"].values())
    with phases("picture"):
        _draw(request, settings, views, report)
    with phases("write"), _published(target) as partial:
        if settings.usd_over and source.suffix.lower() in assets.USD:
            usd_over.write(partial, source, target, [(o.data.name, m) for o, m in zip(objects, maps)])
        else:
            formats.write(partial)
    report["output"] = os.path.relpath(target, request.folder)
    report["output_digest"] = assets.digest(target)
    failed = report["totals"]["failed"]
    report["status"] = "incomplete" if failed else "unwrapped" if settings.unwrap else "kept"


def _objects(warnings: list[str]) -> list[bpy.types.Object]:
    """Return one visible object of every mesh with faces that may be edited."""
    found: dict[bpy.types.Mesh, bpy.types.Object] = {}
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    left_out = []
    for item in bpy.context.view_layer.objects:
        if item.type != "MESH" or not item.data.polygons or item.data in found:
            continue
        if item.data.library or item.library or not item.visible_get():
            left_out.append(item.name)
        else:
            found[item.data] = item
    if left_out:
        warnings.append(f"Hidden or linked objects were left alone: {', '.join(sorted(left_out))}.")
    if not found:
        raise AssetError("There is no visible mesh with faces in it.")
    bad = [item.name for item in found.values() if not _is_finite(item.data)]
    if bad:
        raise AssetError(f"Coordinates are infinite or not numbers in {', '.join(bad)}: repair the asset.")
    return list(found.values())


def _is_finite(mesh: bpy.types.Mesh) -> bool:
    positions = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", positions)
    return bool(np.isfinite(positions).all())


def _choose_maps(objects: Sequence[bpy.types.Object], name: str) -> None:
    """Make the map of this name the one that is edited and exported, in every mesh; without a name keep the active."""
    for item in objects:
        layers = item.data.uv_layers
        layer = (layers.get(name) or layers.new(name=name)) if name else layers.active
        if name and layer is None:
            raise AssetError(f"{item.name} has no room for another UV map: remove one.")
        if layer is not None:
            layers.active = layer
            layer.active_render = True


@contextmanager
def _edit_mode(objects: Sequence[bpy.types.Object]) -> Iterator[None]:
    """Within, all objects are in edit mode together and all their visible faces are selected."""
    bpy.ops.object.select_all(action="DESELECT")
    for item in objects:
        item.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        bpy.ops.mesh.select_all(action="SELECT")
        yield
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")


def _mark_seams(settings: BatchSettings, phases: _Phases, report: dict[str, Any]) -> None:
    with phases("seams"):
        if settings.seams == "suggest":
            target = seams.read(bpy.context, settings.operator_settings())
            if target is not None:
                _mark_suggested(target, settings, report)
        elif settings.seams == "sharp":
            target = seams.read(bpy.context, settings.operator_settings())
            if target is not None:
                _mark_sharp(target, settings)
        elif settings.seams == "smart":
            bpy.ops.uv.smart_project(**_SMART_PROJECT)
            bpy.ops.uv.seams_from_islands(mark_seams=True, mark_sharp=False)


def _mark_suggested(target: seams.Target, settings: BatchSettings, report: dict[str, Any]) -> None:
    """Make the suggested edges of the welded meshes seams, in all faces that have them."""
    vertices_of = [_vertex_of(polygons, settings) for polygons in target.polygons]
    meshes = list(map(welding.welded, target.polygons, vertices_of))
    found = seam_suggestion.suggest(meshes, settings.seam_options())
    seams.mark(target, welding.unwelded(found, target.polygons, vertices_of))
    refused = texts.without_suggestion(found.errors, target.names)
    report["warnings"] += [refused] if refused else []


def _mark_sharp(target: seams.Target, settings: BatchSettings) -> None:
    """Make the edges between two faces of the welded meshes that lie at the given angle, or at a larger one, seams.

    Edges that are marked sharp do not count: readers of formats with normals mark every edge of a flat mesh.
    """
    vertices_of = [_vertex_of(polygons, settings) for polygons in target.polygons]
    angle = math.radians(settings.sharp_angle)
    cuts = tuple(
        seam_suggestion.Cut(index, welding.sharp_edges(welding.welded(polygons, vertex_of), angle), 0.0)
        for index, (polygons, vertex_of) in enumerate(zip(target.polygons, vertices_of))
    )
    seams.mark(target, welding.unwelded(seam_suggestion.Suggestion(cuts, ()), target.polygons, vertices_of))


def _vertex_of(mesh: PolygonMesh | MapArrays, settings: BatchSettings) -> np.ndarray:
    """Return the vertex that stands for each, (V,).

    Kept seams and the islands of Smart UV Project go with borders between faces that have vertices of their own: such
    as glTF has at the seams of its map.
    """
    positions = mesh.vertices if isinstance(mesh, PolygonMesh) else mesh.positions
    if not settings.unwrap or settings.seams in ("keep", "smart") or not settings.weld_distance:
        return np.arange(len(positions), dtype=np.int32)
    return welding.coincident_vertices(positions, mesh.face_offsets, mesh.corner_vertices, settings.weld_distance)


def _welded(edit_mesh: EditMesh, settings: BatchSettings) -> EditMesh:
    """Return the mesh with vertices of one place joined; one that is subdivided stays as it is."""
    if edit_mesh.subdivision is not None:
        return edit_mesh
    vertex_of = _vertex_of(edit_mesh.polygons, settings)
    return replace(edit_mesh, polygons=welding.welded(edit_mesh.polygons, vertex_of))


def _unwrap(settings: BatchSettings, phases: _Phases, report: dict[str, Any]) -> None:
    """Solve and write all islands, as the operator does."""
    operator = settings.operator_settings()
    with phases("solve"):
        edit_meshes = steps.read(bpy.context, operator)
        if not edit_meshes:
            raise AssetError("All faces are hidden.")
        edit_meshes = [_welded(edit_mesh, settings) for edit_mesh in edit_meshes]
        solutions = steps.solve(edit_meshes, operator)
    with phases("pack"):
        outcome = steps.write(operator, edit_meshes, solutions)
    # The next asset has others.
    kept_maps.forget()
    _note_solutions(edit_meshes, solutions, report)
    report["warnings"] += [text for level, text in steps.reports(outcome, 0.0) if level == "WARNING"]
    if not outcome.summary.solved:
        raise AssetError(report["warnings"][-1] if report["warnings"] else "No island could be unwrapped.")


def _note_solutions(edit_meshes: Sequence[EditMesh], solutions: Sequence[Solution], report: dict[str, Any]) -> None:
    summary = summarize(solutions, [edit_mesh.edit_object.name for edit_mesh in edit_meshes])
    solved = are_solved(solutions)
    report["fallbacks"] = dict(Counter(filter(None, column_of_all(solutions, "fallback")[solved].tolist())))
    report["repairs"] = dict(summary.repairs)
    report["failed_islands"] = dict(summary.failures)


def _pack(settings: BatchSettings) -> None:
    operator = settings.operator_settings()
    edit_meshes = [mesh for mesh in steps.read(bpy.context, operator) if mesh.polygons.uv is not None]
    if not edit_meshes:
        raise AssetError("There is no UV map to pack: leave out --no-unwrap.")
    packing.pack(bpy.context, edit_meshes, [mesh.polygons.selected_faces for mesh in edit_meshes], operator.margin)


def _maps(objects: Sequence[bpy.types.Object]) -> list[MapArrays]:
    arrays = [read_map.read_own_map(bpy.context, item) for item in objects]
    missing = [item.name for item, found in zip(objects, arrays) if found is None]
    if missing:
        raise AssetError(f"There is no UV map to keep in {', '.join(missing)}: leave out --no-unwrap.")
    return [found for found in arrays if found is not None]


def _view(arrays: MapArrays, vertex_of: np.ndarray) -> MapView:
    """Return the map as that of the welded mesh, whose islands it has."""
    return MapView(replace(arrays, corner_vertices=vertex_of[arrays.corner_vertices]))


def _measured(
    objects: Sequence[bpy.types.Object], views: Sequence[MapView], vertices_of: Sequence[np.ndarray]
) -> dict[str, Any]:
    """Return the report's records of the islands, and of all of them together."""
    islands = [record for item, view in zip(objects, views) for record in _islands(item, view)]
    whole = _numbers(
        np.concatenate([view.qc for view in views]),
        np.concatenate([view.log2_scale for view in views]),
        np.concatenate([view.area for view in views]),
    )
    summary = {
        "meshes": len(views),
        "vertices": sum(len(view.arrays.positions) for view in views),
        "welded": sum(int((vertex_of != np.arange(len(vertex_of))).sum()) for vertex_of in vertices_of),
        "faces": sum(len(view.arrays.visible_faces) for view in views),
        "islands": len(islands),
        **whole,
        "flips": sum(int(view.flipped.sum()) for view in views),
        "overlaps": sum(int(view.overlapping.sum()) for view in views),
        "seam_length": sum(map(_seam_length, objects, vertices_of)),
    }
    return {"totals": {**summary, "failed": 0}, "islands": islands}


def _numbers(qc: np.ndarray, scale: np.ndarray, area: np.ndarray) -> dict[str, float | None]:
    """Return the distortion of faces, (F,) each; None where nothing is mapped."""
    counted = (area > 0.0) & np.isfinite(qc) & np.isfinite(scale)
    if not counted.any():
        return dict.fromkeys(("mean_qc", "p99_qc", "max_qc", "area_spread"))
    weights = area[counted]
    mean = np.average(scale[counted], weights=weights)
    return {
        "mean_qc": float(np.average(qc[counted], weights=weights)),
        "p99_qc": weighted_percentiles(qc[counted], weights, (99.0,))[0],
        "max_qc": float(qc[counted].max()),
        "area_spread": float(np.sqrt(np.average((scale[counted] - mean) ** 2, weights=weights))),
    }


def _islands(item: bpy.types.Object, view: MapView) -> Iterator[dict[str, Any]]:
    """Yield a record of every island of a mesh."""
    island = view.island_of_face
    order = np.argsort(island, kind="stable")
    order = order[island[order] >= 0]
    borders = _border_lengths(view)
    for faces in np.split(order, np.flatnonzero(np.diff(island[order])) + 1) if len(order) else ():
        yield {
            "mesh": item.data.name,
            "faces": len(faces),
            "area": float(view.area[faces].sum()),
            **_numbers(view.qc[faces], view.log2_scale[faces], view.area[faces]),
            "flips": int(view.flipped[faces].sum()),
            "overlaps": int(view.overlapping[faces].sum()),
            "border_length": float(borders[island[faces[0]]]),
        }


def _border_lengths(view: MapView) -> np.ndarray:
    """Return the length in object space of the edges around every island, those between two islands in both."""
    arrays, island = view.arrays, view.island_of_face
    following = _next_corner(arrays.face_offsets)
    face = np.repeat(np.arange(len(island)), np.diff(arrays.face_offsets))
    vertices, uv = arrays.corner_vertices.astype(np.int64), arrays.uv
    forward = vertices < vertices[following]
    start = np.where(forward, np.arange(len(vertices)), following)
    end = np.where(forward, following, np.arange(len(vertices)))
    # An edge within an island is there twice, with the same UVs. Numbers of 64 bits in place of the rows: sorting rows
    # takes ten times as long, and two rows of one number are as good as impossible.
    columns = (vertices[start], vertices[end], island[face].astype(np.int64), *(uv + 0.0)[start].T, *(uv + 0.0)[end].T)
    key = np.zeros(len(vertices), dtype=np.uint64)
    for column in columns:
        bits = column.view(np.uint32) if column.dtype == np.float32 else column.view(np.uint64)
        key = (key ^ bits.astype(np.uint64)) * _MULTIPLIER
        key ^= key >> np.uint64(32)
    _, first, count = np.unique(key, return_index=True, return_counts=True)
    border = first[count == 1]
    border = border[island[face[border]] >= 0]
    ends = arrays.positions[vertices[border]], arrays.positions[vertices[following[border]]]
    lengths = np.linalg.norm((ends[0] - ends[1]).astype(np.float64), axis=1)
    return np.bincount(island[face[border]], lengths, int(island.max(initial=-1)) + 1)


def _next_corner(face_offsets: np.ndarray) -> np.ndarray:
    following = np.arange(1, face_offsets[-1] + 1)
    following[face_offsets[1:] - 1] = face_offsets[:-1]
    return following


def _seam_length(item: bpy.types.Object, vertex_of: np.ndarray) -> float:
    """Return the length of the edges that are marked as seams, in object space, of those at one place once."""
    mesh = item.data
    is_seam = np.empty(len(mesh.edges), dtype=bool)
    mesh.edges.foreach_get("use_seam", is_seam)
    ends = np.empty(2 * len(mesh.edges), dtype=np.int32)
    mesh.edges.foreach_get("vertices", ends)
    positions = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", positions)
    return welding.edges_length(positions.reshape(-1, 3), vertex_of, ends.reshape(-1, 2)[is_seam])


def _draw(request: Request, settings: BatchSettings, views: Sequence[MapView], report: dict[str, Any]) -> None:
    """Write the picture of the layout, and the checker where it is asked for."""
    folder = Path(request.folder)
    if settings.picture_size:
        low, high = automatic_range(views, texts.LOOK_ANGLE)
        maps = [(view.arrays.uv, *view.triangles, view.qc) for view in views]
        picture = layout_picture.draw(*layout_picture.triangles_of(maps), low, high, settings.picture_size)
        report_file.replace(folder / assets.LAYOUT, layout_picture.png(picture))
        report["layout"] = assets.LAYOUT
        small = layout_picture.thumbnail(picture[: settings.picture_size], THUMBNAIL)
        report_file.replace(folder / assets.THUMBNAIL, layout_picture.png(small))
    if settings.checker:
        with _published(folder / assets.CHECKER) as partial:
            checker.render(partial, settings.picture_size or 512)
        report["checker"] = assets.CHECKER


@contextmanager
def _published(target: Path) -> Iterator[Path]:
    """Yield a path of the same name in a folder beside it; move all that was written there to where it belongs.

    Files that belong together, as OBJ and MTL, or glTF and its buffers, name each other and keep their names.
    """
    folder = target.parent / f".{target.name}.{os.getpid()}.partial"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    try:
        yield folder / target.name
        # The named file last: where it is, all others are.
        for path in sorted(folder.iterdir(), key=lambda path: path.name == target.name):
            if path.is_dir():
                shutil.copytree(path, target.parent / path.name, dirs_exist_ok=True)
            else:
                path.replace(target.parent / path.name)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def request_of(text: str) -> Request:
    """Return the request that a line of JSON says."""
    return Request(**json.loads(text))


def line_of(request: Request) -> str:
    """Return a request as a line of JSON."""
    return json.dumps(asdict(request))
