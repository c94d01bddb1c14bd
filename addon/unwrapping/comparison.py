# SPDX-License-Identifier: GPL-3.0-or-later
"""The same faces unwrapped by this and by Blender's own methods, one after the other; their UVs stay as they are."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from ..core import texts
from ..core.errors import ReadableError
from ..core.map_view import IslandNumbers, MapArrays, MapView, joined_numbers
from ..core.options import Settings
from ..core.solve import Solution
from ..edit_mesh.read import EditMesh, read_uv
from ..edit_mesh.write import write_uv
from . import steps
from .steps import WhileWriting


@dataclass(frozen=True)
class Candidate:
    """What a method made of the faces.

    Attributes:
        method: its identifier in `texts.COMPARED_METHODS`.
        views: the maps, one per mesh; empty if the method failed.
        numbers: of all maps together; None if the method failed.
        seconds: what it took.
    """

    method: str
    views: tuple[MapView, ...]
    numbers: IslandNumbers | None
    seconds: float


@dataclass(frozen=True)
class Tried:
    """The maps of a method, one per mesh, None if it failed, and the seconds that it took."""

    method: str
    maps: tuple[MapArrays, ...] | None
    seconds: float


_last: list[Candidate] = []


def methods() -> list[str]:
    """Return the methods to compare, ours first: those of `texts.COMPARED_METHODS` that this Blender has."""
    known = bpy.ops.uv.unwrap.get_rna_type().properties["method"].enum_items.keys()
    return [method for method in texts.COMPARED_METHODS if method == texts.OURS or method in known]


def ours(
    settings: Settings,
    edit_meshes: Sequence[EditMesh],
    solutions: Sequence[Solution],
    seconds: float,
    while_writing: WhileWriting,
) -> Tried:
    """Place and pack our solutions, and leave the UVs as they are.

    Args:
        settings: of the unwrap.
        edit_meshes: what `steps.read` returned.
        solutions: what `steps.solve` returned for them.
        seconds: what that took.
        while_writing: makes a context manager that is entered for the time in which UVs change.
    """

    def unwrap() -> None:
        if any(solution.solved_corners.any() for solution in solutions):
            steps.write_maps(settings, edit_meshes, solutions)

    return _try(texts.OURS, unwrap, edit_meshes, seconds, while_writing)


def theirs(
    context: bpy.types.Context,
    settings: Settings,
    edit_meshes: Sequence[EditMesh],
    method: str,
    while_writing: WhileWriting,
) -> Tried:
    """Let Blender unwrap by one of its methods, with the settings that it shares, and leave the UVs as they are."""

    def unwrap() -> None:
        with _copied_scene(context):
            bpy.ops.uv.unwrap(
                "EXEC_DEFAULT",
                method=method,
                fill_holes=settings.options.fill_holes,
                correct_aspect=settings.correct_aspect,
                margin=settings.margin.size,
            )

    return _try(method, unwrap, edit_meshes, 0.0, while_writing)


def measured(tried: Tried) -> Candidate:
    """Measure the maps of a method; any thread may call it."""
    if tried.maps is None:
        return Candidate(tried.method, (), None, tried.seconds)
    views = tuple(map(MapView, tried.maps))
    return Candidate(tried.method, views, joined_numbers(views) if views else None, tried.seconds)


def remember(found: Sequence[Candidate]) -> None:
    """Make these what was compared last."""
    _last[:] = found


def last() -> list[Candidate]:
    """Return what was compared last."""
    return _last


def forget() -> None:
    """Forget what was compared."""
    _last.clear()


def best(candidates: Sequence[Candidate]) -> Candidate | None:
    """Return the one with the least angle distortion; None if none has a map."""
    measured = [each for each in candidates if each.numbers is not None and each.numbers.mapped]
    most = max((each.numbers.mapped for each in measured), default=0)
    # What a method leaves out distorts nothing.
    complete = [each for each in measured if each.numbers.mapped == most]
    return min(complete, key=lambda each: each.numbers.mean_qc, default=None)


def _try(
    method: str,
    unwrap: Callable[[], None],
    edit_meshes: Sequence[EditMesh],
    seconds: float,
    while_writing: WhileWriting,
) -> Tried:
    with while_writing(), _restored(edit_meshes):
        _clear(edit_meshes)
        start = time.perf_counter()
        try:
            unwrap()
        except (RuntimeError, ReadableError):
            # Blender's operators raise what they would report; the table says that the method failed.
            return Tried(method, None, seconds + time.perf_counter() - start)
        seconds += time.perf_counter() - start
        maps = tuple(_arrays(edit_mesh) for edit_mesh in edit_meshes if edit_mesh.mesh.uv_layers)
        return Tried(method, maps, seconds)


@contextmanager
def _copied_scene(context: bpy.types.Context) -> Iterator[None]:
    """Within, the context has a copy of the scene: Blender's Unwrap leaves its settings in the scene, for the next."""
    layer = context.view_layer.name
    copy = context.scene.copy()
    try:
        with context.temp_override(scene=copy, view_layer=copy.view_layers[layer]):
            yield
    finally:
        bpy.data.scenes.remove(copy)


def _clear(edit_meshes: Sequence[EditMesh]) -> None:
    """Draw all corners to unwrap that are not pinned to a point: what a method leaves so has not been unwrapped."""
    for edit_mesh in edit_meshes:
        polygons = edit_mesh.polygons
        if polygons.uv is not None:
            corners = polygons.selected_faces[polygons.face_of_corner()]
            kept = polygons.pinned_corners[:, None] if polygons.pinned_corners is not None else False
            write_uv(edit_mesh, np.where(kept, polygons.uv, 0.0), corners)


@contextmanager
def _restored(edit_meshes: Sequence[EditMesh]) -> Iterator[None]:
    """Afterwards all UVs are as they were, and UV maps that were made are gone."""
    try:
        yield
    finally:
        for edit_mesh in edit_meshes:
            polygons = edit_mesh.polygons
            if polygons.uv is not None:
                write_uv(edit_mesh, polygons.uv, np.ones(len(polygons.corner_vertices), dtype=bool))
            elif edit_mesh.mesh.uv_layers:
                edit_mesh.mesh.uv_layers.remove(edit_mesh.mesh.uv_layers.active)


def _arrays(edit_mesh: EditMesh) -> MapArrays:
    polygons = edit_mesh.polygons
    return MapArrays(
        positions=polygons.vertices.astype(np.float32),
        face_offsets=polygons.face_offsets.astype(np.int32),
        corner_vertices=polygons.corner_vertices.astype(np.int32),
        uv=read_uv(edit_mesh).astype(np.float32),
        visible_faces=polygons.selected_faces,
        uv_faces=polygons.selected_faces,
        aspect=polygons.aspect,
    )
