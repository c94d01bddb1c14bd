# SPDX-License-Identifier: GPL-3.0-or-later
"""Several meshes as one, so that the solver is called once: a call costs as much as a small mesh."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..mesh.polygon_mesh import PolygonMesh
from .chart_records import PartOfCharts


def joined(meshes: Sequence[PolygonMesh]) -> PolygonMesh:
    """Return the meshes as one, without maps, pins, extenders and stretching.

    Raises:
        ValueError: a mesh has an index of a vertex beyond its own.
    """
    first_vertices = _starts(len(mesh.vertices) for mesh in meshes)
    first_corners = _starts(len(mesh.corner_vertices) for mesh in meshes)
    return PolygonMesh(
        vertices=np.concatenate([mesh.vertices for mesh in meshes]),
        face_offsets=np.concatenate([first_corners[:1], *(mesh.face_offsets[1:] for mesh in meshes)])
        + np.repeat([0, *first_corners[:-1]], [1, *(len(mesh.selected_faces) for mesh in meshes)]).astype(np.int32),
        corner_vertices=_renumbered([mesh.corner_vertices for mesh in meshes], first_vertices),
        seam_edges=_renumbered([mesh.seam_edges for mesh in meshes], first_vertices),
        selected_faces=np.concatenate([mesh.selected_faces for mesh in meshes]),
    )


def _renumbered(vertices: Sequence[np.ndarray], starts: np.ndarray) -> np.ndarray:
    """Return the vertex indices of all meshes, shifted by the first vertex of each mesh."""
    number = np.concatenate(vertices)
    counts = [len(part) for part in vertices]
    first = np.repeat(starts[:-1], counts).reshape(-1, *[1] * (number.ndim - 1))
    end = np.repeat(np.diff(starts), counts).reshape(first.shape)
    if (number < 0).any() or (number >= end).any():
        raise ValueError
    return number + first


def parts(
    meshes: Sequence[PolygonMesh],
    result: Any,  # noqa: ANN401 - of the native module
    chart_of_corner: np.ndarray,
    failed_islands: np.ndarray,
    too_small: np.ndarray,
    extents: np.ndarray,
) -> Iterator[tuple[np.ndarray, np.ndarray, PartOfCharts, np.ndarray, int, np.ndarray]]:
    """Yield what a `result` for the joined meshes has for each of them: the first fields of a `Solution`, its extents.

    Charts are numbered within the mesh. `result` is changed.

    `chart_of_corner` (C,) and `failed_islands` (F,) are charts of the result, -1 for none; `too_small`
    (N,) are faces; `extents` (K, 5) are those of the result's charts.
    """
    corners = _starts(len(mesh.corner_vertices) for mesh in meshes)
    faces = _starts(len(mesh.selected_faces) for mesh in meshes)
    # The charts of the result are numbered by their first face. The last may hold the faces of all meshes that can be
    # in no chart.
    n_others = max(0, len(result.charts) - 1)
    last = result.charts[-1] if len(result.charts) else None
    # Faces in no chart, -1, come first.
    numbers, first_of_chart = np.unique(np.append(result.chart_of_face, -1), return_index=True)
    owners = np.searchsorted(faces, first_of_chart[1 : 1 + n_others], side="right") - 1
    first_charts = np.searchsorted(owners, np.arange(len(meshes) + 1))
    owners_of_last = np.searchsorted(faces, [] if last is None else last.faces, side="right") - 1
    with_last = set(owners_of_last.tolist())
    # For each mesh with faces in it, the last chart is the last of its own.
    number = result.chart_of_face
    own_number = np.where(number < 0, -1, number - np.repeat(first_charts[:-1], np.diff(faces)))
    is_last = number == n_others
    own_number[is_last] = np.repeat(np.diff(first_charts), np.diff(faces))[is_last]
    own_failed = np.where(failed_islands < 0, -1, own_number)
    own_of_corner = np.where(chart_of_corner < 0, -1, chart_of_corner - np.repeat(first_charts[:-1], np.diff(corners)))
    counts = np.diff(np.searchsorted(np.sort(too_small), faces)).tolist()
    starts = list(zip(*(array.tolist() for array in (faces, corners, first_charts))))
    for k, ((face, corner, first), (face_end, corner_end, end)) in enumerate(zip(starts, starts[1:])):
        own_last = replace(last, faces=last.faces[owners_of_last == k]) if k in with_last else None
        yield (
            result.uv[corner:corner_end],
            own_of_corner[corner:corner_end],
            PartOfCharts(result.charts, slice(first, end), face, own_last),
            own_failed[face:face_end],
            counts[k],
            np.concatenate([extents[first:end], extents[-1:]]) if k in with_last else extents[first:end],
        )


def numbered_together(charts: Sequence[np.ndarray], counts: Sequence[int]) -> np.ndarray:
    """Number the charts of several meshes together, given the chart of every corner, -1 for none, and their counts."""
    if len(charts) == 1:
        return charts[0].copy()
    chart = np.concatenate(charts)
    first = np.repeat(_starts(counts)[:-1], [len(part) for part in charts])
    return np.where(chart < 0, -1, chart + first)


def _starts(counts: Iterable[int]) -> np.ndarray:
    """Return the first index of each of several consecutive parts, and the end of the last, int32."""
    return np.cumsum([0, *counts], dtype=np.int32)
