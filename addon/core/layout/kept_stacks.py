# SPDX-License-Identifier: GPL-3.0-or-later
"""Stack new maps of charts whose former maps were stacked, if they still have the same shape."""

import numpy as np

from ..measure.stacks import close_rows
from ..mesh.corner_groups import CornerGroups
from ..mesh.polygon_mesh import PolygonMesh, face_areas
from .shape_packing import obstacles

# In UV tiles: charts that agree to a pixel show the same pixels.
_PIXEL = 1.0 / 1024.0
# Of the diameter: as far as `spectral_conformal.pack` lets equal outlines differ.
_TOLERANCE = 0.01
# Corners are matched in their order along a direction; few lie side by side in both.
_DIRECTIONS = (0.8 - 0.6j, 0.6 + 0.8j)
# Fraction of the corners; those side by side may be matched crosswise.
_MATCHED = 0.9


def stacked_as_before(mesh: PolygonMesh, uv: np.ndarray, chart: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stack charts as they were in the mesh's former map.

    Only stacks within one mesh and a layout count: the maps of an object's copies, or of joined generated parts, lie on
    each other before anybody stacks them. Charts are moved, turned, scaled and mirrored as a whole.

    Args:
        mesh: the mesh; without a former map it has no stacks.
        uv: (C, 2) the new maps.
        chart: (C,) the chart of every corner, -1 for none.

    Returns:
        the maps, `uv` itself if nothing is stacked; and for every corner the chart below its own, or its own, (C,).
    """
    if mesh.uv is None:
        return uv, chart
    charts = CornerGroups.of(chart)
    boxes = charts.bounds(mesh.uv).reshape(-1, 4)
    usable = np.isfinite(boxes).all(axis=1)
    candidates = _candidates(np.column_stack([charts.counts, boxes]), usable) if len(charts) > 1 else []
    if not candidates:
        return uv, chart
    mapped_faces = obstacles(mesh, mesh.uv, np.ones(len(mesh.face_offsets) - 1, dtype=bool))
    usable &= charts.all(mapped_faces[mesh.face_of_corner()])
    corners = np.arange(len(chart)) if charts.corners is None else charts.corners
    points, moved = mesh.uv[corners] @ (1.0, 1j), uv @ (1.0, 1j)
    result, lies_on = moved.copy(), chart.copy()
    for members in _candidates(np.column_stack([charts.counts, boxes]), usable):
        parts = [slice(charts.starts[k], charts.starts[k] + charts.counts[k]) for k in members]
        ground = [points[parts[0]], moved[corners[parts[0]]]]
        for part in parts[1:]:
            own = corners[part]
            found = _laid_on(*ground, points[part], moved[own])
            if found is not None:
                result[own], lies_on[own] = found, charts.numbers[members[0]]
    tiles = len(np.unique(np.floor(0.5 * (boxes[:, :2] + boxes[:, 2:])[usable]), axis=0))
    if (lies_on == chart).all() or _area(mesh, lies_on == chart) > tiles:
        return uv, chart
    return np.column_stack([result.real, result.imag]), lies_on


def _area(mesh: PolygonMesh, corners: np.ndarray) -> float:
    """Return the unsigned area in the mesh's map of the faces with these `corners`, (C,) bool."""
    areas = face_areas(mesh.uv, mesh.face_offsets)
    return float(np.nansum(np.abs(areas)[corners[mesh.face_offsets[:-1]]]))


def _candidates(values: np.ndarray, usable: np.ndarray) -> list[np.ndarray]:
    """Return groups of the `usable` rows of `values` (K, n) that agree to a pixel, directly or through others."""
    group = close_rows(np.where(usable[:, None], values, np.nan), _PIXEL)
    order = np.argsort(group, kind="stable")
    parts = np.split(order, np.flatnonzero(np.diff(group[order])) + 1)
    return [part for part in parts if len(part) > 1]


def _laid_on(ground: np.ndarray, ground_map: np.ndarray, former: np.ndarray, uv: np.ndarray) -> np.ndarray | None:
    """Lay a chart's map `uv` on `ground_map`, given both former maps, all (n,) complex; None if shapes differ."""
    for direction in _DIRECTIONS:
        one, two = (np.argsort((points * direction).real, kind="stable") for points in (ground, former))
        agree = np.abs(ground[one] - former[two]) <= _PIXEL
        if agree.mean() < _MATCHED:
            continue
        one, two = one[agree], two[agree]
        to = ground_map[one]
        diameter = np.abs(to - to.mean()).max() * 2.0
        for turned in (uv, np.conj(uv)):
            center = turned[two].mean()
            arms = turned[two] - center
            size = np.vdot(arms, arms).real
            if not (size > 0.0 and np.isfinite(size)):
                continue
            factor = np.vdot(arms, to - to.mean()) / size
            if np.abs(factor * arms + to.mean() - to).max() <= _TOLERANCE * diameter:
                return factor * (turned - center) + to.mean()
    return None
