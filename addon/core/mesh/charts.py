# SPDX-License-Identifier: GPL-3.0-or-later
"""The charts of a mesh before they are solved, and those at edges and vertices.

Edges are vertex pairs in any order. Only `faces` (F,) bool count, as if the others were deleted.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import native
from .polygon_mesh import PolygonMesh


def chart_of_face(mesh: PolygonMesh, faces: np.ndarray) -> np.ndarray:
    """Return the chart of every face, (F,) int, as the solver cuts them; -1 for none.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    return native.spectral_conformal().hosts.chart_of_face(
        mesh.with_map(), seam_edges=mesh.seam_edges, selected_faces=faces
    )


def faces_of_charts_at(mesh: PolygonMesh, faces: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Return which faces, (F,) bool, belong to a chart that has one of the `edges` (N, 2)."""
    return faces_of_charts_with_corners(mesh, faces, np.isin(corner_edge_keys(mesh), edge_keys(mesh, edges)))


def faces_of_charts_with_corners(mesh: PolygonMesh, faces: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return which faces, (F,) bool, belong to a chart that has one of the `corners` (C,) bool."""
    chart = chart_of_face(mesh, faces)
    touched = chart[mesh.face_of_corner()[corners]]
    return np.isin(chart, touched[touched >= 0])


def faces_of_charts_with(mesh: PolygonMesh, faces: np.ndarray, pairs: Sequence[tuple[int, int]]) -> np.ndarray:
    """Return which faces, (F,) bool, belong to a chart that has both vertices of one of the `pairs`."""
    chart = chart_of_face(mesh, faces)
    chart_of_corner = chart[mesh.face_of_corner()]
    chosen: set[int] = set()
    for pair in pairs:
        first, second = (set(chart_of_corner[mesh.corner_vertices == vertex].tolist()) for vertex in pair)
        chosen |= (first & second) - {-1}
    return np.isin(chart, list(chosen))


def edges_at(mesh: PolygonMesh, edges: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return which of the `edges` (N, 2) start or end, in a face, at one of the `corners` (C,) bool, (N,) bool."""
    return np.isin(edge_keys(mesh, edges), corner_edge_keys(mesh)[corners])


def corner_edge_keys(mesh: PolygonMesh) -> np.ndarray:
    """Return the key of the edge from every corner to the next one of its face, (C,) int64."""
    return edge_keys(mesh, mesh.sides())


def twins(mesh: PolygonMesh) -> np.ndarray:
    """Return the corner on the other side of every corner's edge, (C,); -1 at seams and where no two faces meet."""
    keys = corner_edge_keys(mesh)
    is_seam = np.isin(keys, edge_keys(mesh, mesh.seam_edges))
    inside = np.flatnonzero(mesh.selected_faces[mesh.face_of_corner()] & ~is_seam)
    order = inside[np.argsort(keys[inside], kind="stable")]
    same = keys[order][1:] == keys[order][:-1]
    result = np.full(len(keys), -1)
    # Edges of three or more faces are cut.
    one = same & ~np.append(same[1:], False) & ~np.insert(same[:-1], 0, False)
    first, second = order[:-1][one], order[1:][one]
    opposite = mesh.corner_vertices[first] != mesh.corner_vertices[second]
    result[first[opposite]], result[second[opposite]] = second[opposite], first[opposite]
    return result


def edge_keys(mesh: PolygonMesh, edges: npt.ArrayLike) -> np.ndarray:
    """Return a number for each of the `edges` (N, 2), (N,) int64: equal for the same two vertices in any order."""
    return native.measuring().edge_keys(np.asarray(edges), len(mesh.vertices))


def is_island(mesh: PolygonMesh, domain: np.ndarray, faces: np.ndarray) -> bool:
    """Return whether `faces`, indices, are still an island of the unwrapped faces, `domain` (F,) bool.

    They are one chart or, if seams have changed since, one island of the map.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    if _is_part(chart_of_face(mesh, domain), faces):
        return True
    if mesh.uv is None or not np.isfinite(mesh.uv).all():
        return False
    return _is_part(map_defects(mesh, mesh.uv, domain).island_of_face, faces)


def map_defects(mesh: PolygonMesh, uv: np.ndarray, faces: np.ndarray | None = None) -> Any:  # noqa: ANN401 - of the module
    """Return the `MapDefects` of a map, (C, 2), of some `faces` (F,) bool, by default all, as Blender would store it.

    Faces with a UV that is not finite are left out.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    is_finite = ~mesh.faces_with(~np.isfinite(uv).all(axis=1))
    selected = is_finite if faces is None else is_finite & faces
    return native.spectral_conformal().map_defects(mesh.with_map(uv.astype(np.float32)), selected_faces=selected)


def _is_part(part_of_face: np.ndarray, faces: np.ndarray) -> bool:
    """Return whether `faces` are exactly one part, given that of every face, (F,)."""
    first = part_of_face[faces[0]]
    return bool(
        first >= 0 and (part_of_face[faces] == first).all() and np.count_nonzero(part_of_face == first) == len(faces)
    )
