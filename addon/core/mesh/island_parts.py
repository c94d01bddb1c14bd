# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces of an island whose UVs change while the rest of the island stays.

The islands are those of the present map: faces are connected where an edge has the same UVs on both sides and is not a
seam. A corner of one of the faces is *shared* if such edges around its vertex lead to another face: its UV belongs to
both, so it must not change.
"""

from dataclasses import replace

import numpy as np

from .charts import chart_of_face, edge_keys, edges_at
from .density_factors import chart_sums
from .group_bounds import group_bounds
from .polygon_mesh import PolygonMesh, face_areas


def shared_corners(mesh: PolygonMesh, faces: np.ndarray) -> np.ndarray:
    """Return the corners of `faces` (F,) bool that share their UV with another face, (C,) bool.

    Other faces count whether visible or not. The mesh has a map.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    if faces.all():
        return np.zeros(len(mesh.corner_vertices), dtype=bool)
    inside = faces[mesh.face_of_corner()]
    # Only vertices with corners of both kinds matter, which are few.
    at_both = np.zeros(len(mesh.vertices), dtype=bool)
    at_both[mesh.corner_vertices[~inside]] = True
    at_inside = np.zeros_like(at_both)
    at_inside[mesh.corner_vertices[inside]] = True
    at_both &= at_inside
    first, second, is_seam = _ends_of_edges(mesh, at_both)
    is_joined = ~(_is_cut(mesh, first, second) | is_seam)
    first, second = first[is_joined], second[is_joined]
    reached, n_reached = ~inside, -1
    # Each pass advances by one face around the vertices.
    while n_reached != (n_reached := np.count_nonzero(reached)):
        reached[first[reached[second]]] = True
        reached[second[reached[first]]] = True
    return reached & inside


def map_cuts(mesh: PolygonMesh, faces: np.ndarray) -> np.ndarray:
    """Return the edges, (N, 2) vertex pairs, where the present map is cut between two of the `faces` (F,) bool.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    inside = faces[mesh.face_of_corner()]
    at_inside = np.zeros(len(mesh.vertices), dtype=bool)
    at_inside[mesh.corner_vertices[inside]] = True
    first, second, _ = _ends_of_edges(mesh, at_inside, inside)
    half = len(first) // 2
    cut = _is_cut(mesh, first, second)[:half]
    ends = np.stack([mesh.corner_vertices[first[:half]], mesh.corner_vertices[first[half:]]], axis=1)
    return np.unique(np.sort(ends[cut], axis=1), axis=0)


def with_rest_held(mesh: PolygonMesh, shared: np.ndarray) -> PolygonMesh:
    """Return the mesh prepared for a solve of its `selected_faces` that leaves the rest of their islands as it is.

    `shared` (C,) bool are their `shared_corners`, which become `held_corners`. Partly selected islands are cut where
    their map is cut, and mirrored ones stay mirrored. An island whose shared UVs all lie at one point, although they
    belong to several vertices, has no map to keep: it is solved as a whole.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    faces = mesh.selected_faces
    shared = shared & np.isfinite(mesh.uv).all(axis=1)
    if not shared.any():
        return mesh
    cuts = map_cuts(mesh, faces)
    face_of_corner = mesh.face_of_corner()
    seams = mesh.seam_edges.reshape(-1, 2)
    chart = chart_of_face(replace(mesh, seam_edges=np.concatenate([seams, cuts]).astype(np.int32)), faces)
    of_corner = chart[face_of_corner]
    n = int(chart.max()) + 1
    points = np.column_stack([mesh.uv[shared], mesh.corner_vertices[shared]])
    low, high = group_bounds(points, of_corner[shared], n)
    is_part = (high[:, :2] > low[:, :2]).any(axis=1) | (high[:, 2] == low[:, 2])
    part = np.append(is_part, False)[of_corner]
    held_corners = shared & part
    if not held_corners.any():
        return mesh
    is_mirrored = np.append(signed_areas(mesh, chart, n) < 0.0, False)
    pinned = held_corners if mesh.pinned_corners is None else mesh.pinned_corners | held_corners
    return replace(
        mesh,
        seam_edges=np.concatenate([seams, cuts[edges_at(mesh, cuts, part)]]).astype(np.int32),
        pinned_corners=pinned,
        held_corners=held_corners,
        mirrored_corners=is_mirrored[of_corner] & part,
    )


def with_parts_held(mesh: PolygonMesh, faces: np.ndarray) -> PolygonMesh:
    """Return the mesh with the parts of islands that have these `faces` (F,) bool as charts with their rim held.

    The other `selected_faces` stay selected, in charts of their own.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    part = with_rest_held(replace(mesh, selected_faces=faces), shared_corners(mesh, faces))
    if part.held_corners is None:
        return mesh
    inside = faces[mesh.face_of_corner()]
    rim = mesh.sides()[inside & (part.held_corners | part.held_corners[mesh.next_corner()])]
    rim = rim[edges_at(mesh, rim, ~inside)]
    return replace(part, selected_faces=mesh.selected_faces, seam_edges=np.concatenate([part.seam_edges, rim]))


def signed_areas(mesh: PolygonMesh, chart: np.ndarray, n: int) -> np.ndarray:
    """Return the area of each of `n` charts in the map, (n,), negative where mirrored."""
    return chart_sums(face_areas(mesh.uv, mesh.face_offsets), chart, n)


def _is_cut(mesh: PolygonMesh, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return whether the edges of pairs of corners, as `_ends_of_edges` returns them, are cut in the map, (N,) bool."""
    differs = (mesh.uv[first] != mesh.uv[second]).any(axis=1)
    half = len(first) // 2
    return np.tile(differs[:half] | differs[half:], 2)


def _ends_of_edges(
    mesh: PolygonMesh, vertices: np.ndarray, corners: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the pairs of corners, (N,) each, that edges between two faces connect, and which are seams, (N,) bool.

    The first half are the lower-numbered ends of the edges, the second half the others. Only edges with an end at one
    of the `vertices` (V,) bool count, and with `corners` (C,) bool only sides of faces with these.
    """
    following = mesh.next_corner()
    counted = vertices[mesh.corner_vertices] | vertices[mesh.corner_vertices[following]]
    if corners is not None:
        counted &= corners
    start = np.flatnonzero(counted)
    end = following[start]
    swapped = mesh.corner_vertices[start] > mesh.corner_vertices[end]
    low, high = np.where(swapped, end, start), np.where(swapped, start, end)
    key = edge_keys(mesh, np.stack([mesh.corner_vertices[low], mesh.corner_vertices[high]], axis=1))
    order = np.argsort(key, kind="stable")
    low, high, key = low[order], high[order], key[order]
    same = np.flatnonzero(key[1:] == key[:-1])
    is_seam = np.isin(key[same], edge_keys(mesh, mesh.seam_edges))
    first, second = np.append(low[same], high[same]), np.append(low[same + 1], high[same + 1])
    return first, second, np.append(is_seam, is_seam)
