# SPDX-License-Identifier: GPL-3.0-or-later
"""Turn islands of a map so that an edge, most edges or an axis of the mesh is upright."""

from collections.abc import Sequence

import numpy as np

from ..mesh.charts import corner_edge_keys, edge_keys, map_defects
from ..mesh.polygon_mesh import PolygonMesh


def islands_of_corners(mesh: PolygonMesh) -> np.ndarray:
    """Return the island of the map for every corner, (C,) int, -1 outside the selected faces.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    island = map_defects(mesh, mesh.uv, mesh.selected_faces).island_of_face
    return island[mesh.face_of_corner()]


def angle_of_sides(sides: np.ndarray) -> float:
    """Return the turn, at most an eighth, that lays most of the `sides` (N,) complex along or across.

    It is that of the mean sum |s| (s / |s|)^4, which does not tell quarter turns apart.
    """
    length = np.abs(sides)
    mean = (sides**4 / np.maximum(length, 1e-90) ** 3).sum()
    return -float(np.angle(mean)) / 4.0 if abs(mean) > 0.0 else 0.0


def angle_of_axis(uv: np.ndarray, heights: np.ndarray) -> float:
    """Return the turn that makes the best linear fit of the heights (N,) of points uv (N, 2) grow upward."""
    centered = uv - uv.mean(axis=0)
    gradient = np.linalg.lstsq(centered, heights - heights.mean(), rcond=None)[0]
    if not np.abs(gradient).max() * np.ptp(centered, axis=0).max() > 1e-4 * np.ptp(heights):
        return 0.0
    return float(np.pi / 2.0 - np.arctan2(gradient[1], gradient[0]))


def aligned(
    mesh: PolygonMesh, island: np.ndarray, edges: Sequence[tuple[int, int]] | None, axis: int | None
) -> tuple[np.ndarray, np.ndarray]:
    """Turn every island about the middle of its bounds; return the map (C, 2) and the corners (C,) bool that move.

    `island` (C,) is the island of every corner, -1 for corners that stay; see `islands_of_corners`. The `axis` of the
    mesh (0 to 2) becomes upright, or the mean of the `edges`, by the nearest quarter turn; with neither, most of all
    edges. Islands without any of the edges stay.
    """
    uv = np.array(mesh.isotropic_uv())
    following = mesh.next_corner()
    counts = np.ones(len(uv), dtype=bool)
    if edges is not None:
        counts = np.isin(corner_edge_keys(mesh), edge_keys(mesh, edges))
    side = (uv[following] - uv) @ [1.0, 1j]
    moved = np.zeros(len(uv), dtype=bool)
    order = np.argsort(island, kind="stable")
    starts = np.searchsorted(island[order], np.arange(island.max(initial=-1) + 2))
    for first, last in zip(starts[:-1], starts[1:]):
        corners = order[first:last]
        own = corners[counts[corners]]
        if not len(own) or not np.isfinite(uv[corners]).all():
            continue
        if axis is None:
            angle = angle_of_sides(side[own])
        else:
            angle = angle_of_axis(uv[corners], mesh.vertices[mesh.corner_vertices[corners], axis])
        # Rounding in single precision does not count as leaning.
        if abs(angle) < 1e-6:
            continue
        middle = (uv[corners].min(axis=0) + uv[corners].max(axis=0)) / 2.0
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        uv[corners] = (uv[corners] - middle) @ turn + middle
        moved[corners] = True
    return mesh.from_isotropic_uv(uv), moved
