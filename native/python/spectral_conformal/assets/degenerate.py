"""Faces without area: their corners lie inside the islands of their neighbors, whatever the solver made of them."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from .._measuring import next_corner
from .._results import Unwrap
from .edits import Integers, numbered

# Relative to the mean area of a face: smaller faces have no area.
LEAST_AREA = 1e-10

Polygons = tuple[npt.NDArray[np.float64], Integers, Integers]


def areas(vertices: npt.NDArray[np.float64], face_offsets: Integers, corner_vertices: Integers) -> npt.NDArray:
    """Return twice the area of each face, (faces,), of polygons that are not flat, of their projection."""
    first = face_offsets[:-1]
    face = np.repeat(np.arange(len(first)), np.diff(face_offsets))
    spokes = vertices[corner_vertices] - vertices[corner_vertices[first]][face]
    with np.errstate(over="ignore", invalid="ignore"):
        cross = np.cross(spokes, spokes[next_corner(face_offsets)])
        return np.linalg.norm(np.add.reduceat(cross, first), axis=1)


def single_corners(face_offsets: Integers, corner_vertices: Integers) -> npt.NDArray[np.bool_]:
    """Return the corners, (C,), without those that the same vertex follows: a quad that repeats one is a triangle.

    A face that would keep fewer than three keeps all.
    """
    is_single = corner_vertices != corner_vertices[next_corner(face_offsets)]
    counts = np.add.reduceat(is_single.astype(np.int64), face_offsets[:-1])
    return is_single | np.repeat(counts < 3, np.diff(face_offsets))


def with_repeats(result: Unwrap, face_offsets: Integers, corner_vertices: Integers) -> Unwrap:
    """Return a result for `single_corners` as one for all corners: repeated ones have the UVs of those that stayed."""
    kept = single_corners(face_offsets, corner_vertices)
    # The next one that stayed, around the face.
    first, end = (
        np.repeat(each, np.diff(face_offsets)) for each in (result.face_offsets[:-1], result.face_offsets[1:])
    )
    source = np.cumsum(kept) - kept
    source = np.where(source < end, source, first)
    values = {name: getattr(result, name)[source] for name in ("uv", "solved_corners", "vertex_of_corner")}
    return replace(result, face_offsets=face_offsets, corner_vertices=corner_vertices, **values)


def repeats_a_vertex(face_offsets: Integers, corner_vertices: Integers) -> npt.NDArray[np.bool_]:
    """Return which faces, (faces,), have the same vertex twice in a row."""
    return np.logical_or.reduceat(corner_vertices == corner_vertices[next_corner(face_offsets)], face_offsets[:-1])


def settled(polygons: Polygons, result: Unwrap, left_out: npt.NDArray[np.bool_]) -> Unwrap:
    """Return a result in which the corners that only faces without area have lie inside the islands.

    Nothing else defines where they are, and the solver may put them far away. They go onto the line between the two
    most distant corners of their face that have a place, in proportion to the lengths. Islands with pins stay.

    Args:
        polygons: the mesh, as unwrapped.
        result: of unwrapping it.
        left_out: (faces,) faces that were not unwrapped, which get the UVs of their neighbors.
    """
    vertices, offsets, corners = polygons
    area = areas(*polygons)
    with np.errstate(invalid="ignore"):
        is_flat = (area <= LEAST_AREA * area.mean()) | left_out
    if not is_flat.any():
        return result
    movable = (result.charts.column("status") == "solved") & (result.charts.column("n_pins") == 0)
    is_movable = np.append(movable, False)[result.chart_of_face]
    sizes = np.diff(offsets)
    first, copy = numbered(corners, result.uv)
    is_held = np.zeros(len(first), dtype=bool)
    is_held[copy[np.repeat(~is_flat & is_movable, sizes)]] = True
    floats = ~is_held[copy]
    todo = is_flat & (left_out | (is_movable & np.logical_or.reduceat(floats, offsets[:-1])))
    uv, chart, solved = result.uv.copy(), result.chart_of_face.copy(), result.solved_corners.copy()
    known = _Known(vertices, corners, uv)
    # Copies of a vertex that left-out faces may take, by vertex; the first of each island.
    beside: dict[int, dict[int, int]] = defaultdict(dict)
    wanted = np.unique(corners[np.repeat(left_out, sizes)])
    for corner in np.flatnonzero(np.isin(corners, wanted) & np.repeat(~is_flat & is_movable, sizes)).tolist():
        beside[int(corners[corner])].setdefault(int(chart[np.searchsorted(offsets, corner, side="right") - 1]), corner)
    # A corner that has each settled copy.
    places: dict[int, int] = {}
    waiting: dict[int, list[int]] = defaultdict(list)
    queue = deque(np.flatnonzero(todo).tolist())
    while queue:
        face = queue.popleft()
        own = range(int(offsets[face]), int(offsets[face + 1]))
        if left_out[face]:
            votes = [island for k in own for island in beside[int(corners[k])]]
            if not votes:
                continue
            chart[face] = max(dict.fromkeys(votes), key=votes.count)
            sources = [beside[int(corners[k])].get(int(chart[face])) for k in own]
            solved[list(own)] = True
        else:
            sources = [k if is_held[copy[k]] else places.get(int(copy[k])) for k in own]
        if not any(source is not None for source in sources):
            for k in own:
                waiting[int(copy[k])].append(face)
            continue
        known.fill(own, sources)
        for k in () if left_out[face] else own:
            if not is_held[copy[k]] and int(copy[k]) not in places:
                places[int(copy[k])] = k
                queue.extend(waiting.pop(int(copy[k]), ()))
    return replace(result, uv=uv, chart_of_face=chart, solved_corners=solved)


class _Known:
    """Places of corners."""

    def __init__(self, vertices: npt.NDArray[np.float64], corners: Integers, uv: npt.NDArray[np.float64]) -> None:
        self._vertices, self._corners, self._uv = vertices, corners, uv

    def fill(self, own: Sequence[int], sources: Sequence[int | None]) -> None:
        """Give each corner of a face the UV of its source or, without one, a UV between two that have one."""
        found = [(k, source) for k, source in zip(own, sources) if source is not None]
        points = self._vertices[self._corners[list(own)]]
        at = points[[k - own[0] for k, _ in found]]
        texels = self._uv[[source for _, source in found]]
        a = int(np.linalg.norm(at - at[0], axis=1).argmax())
        b = int(np.linalg.norm(at - at[a], axis=1).argmax())
        along = at[b] - at[a]
        length = float(along @ along)
        for k, source in zip(own, sources):
            if source is None:
                share = min(max(float((points[k - own[0]] - at[a]) @ along) / length, 0.0), 1.0) if length else 0.0
                self._uv[k] = (1.0 - share) * texels[a] + share * texels[b]
            else:
                self._uv[k] = self._uv[source]
