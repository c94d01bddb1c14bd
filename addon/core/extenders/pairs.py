# SPDX-License-Identifier: GPL-3.0-or-later
"""Extenders without Blender: amounts in sliders, pairs from a selection, and free names.

An extender is a soft force between two vertices (Mullen et al. 2008, section 4.2): it pushes them apart where its
strength is positive, and pulls them together where it is negative.
"""

from collections.abc import Collection, Sequence

import numpy as np

from ..errors import ReadableError
from ..mesh.charts import chart_of_face, twins
from ..mesh.polygon_mesh import PolygonMesh
from ..words.translation import translate

# Limit of all strengths, in drags and scripts.
STRENGTH_LIMIT = 1e4
# Beyond, or its inverse, the pair or the border has no extent.
_MIN_HALF = 1e-3
# Strength with half of the effect of an infinite one where there is no map to measure it.
HALF = 0.2


def half_strengths(mesh: PolygonMesh, pairs: Sequence[tuple[int, int]]) -> list[float]:
    """Return the strength with half of the effect of an infinite one on each pair of vertices of a mesh with a map.

    Let B be the form of the map's border (Eq. 5), T its total mass, and z_k, of mu_k, the eigenvectors of B z = mu L z,
    of which the map is the first. Adding s T d^T d to B, for a pair with the difference d z, gives the map
    sum of a_k z_k / (mu - mu_k), a_k = d z_k, with s T sum of |a_k|^2 / (mu - mu_k) = 1. The first term outweighs the
    others: mu - mu_1 = s T |a_1|^2, and relative to it all of small mu_k grow as s / (s + h), with

        h = mu_1 / (T |a_1|^2) = z^H B z / (T |d z|^2):

    the mean square distance of the border from its middle over that of the pair.
    """
    if mesh.uv is None or not len(mesh.selected_faces):
        return [HALF] * len(pairs)
    uv, chart = mesh.isotropic_uv(), chart_of_face(mesh, mesh.selected_faces)[mesh.face_of_corner()]
    sides = np.flatnonzero(twins(mesh) < 0)
    ends = np.stack([sides, mesh.next_corner()[sides]])
    mass = np.linalg.norm(np.subtract(*mesh.vertices[mesh.corner_vertices[ends]]), axis=1)
    halves = []
    for pair in pairs:
        first, second = (mesh.corner_vertices == vertex for vertex in pair)
        common = np.intersect1d(chart[first], chart[second])
        inside = np.isin(chart, common[common >= 0][:1])
        points, of_side = uv[ends[:, inside[sides]]], mass[inside[sides]]
        with np.errstate(all="ignore"):
            off = points - of_side @ points.sum(axis=0) / (2.0 * of_side.sum())
            spread = of_side @ (off**2).sum(axis=(0, 2)) / (2.0 * of_side.sum())
            middles = (uv[inside & corners].sum(axis=0) / (inside & corners).sum() for corners in (first, second))
            half = float(spread / (np.subtract(*middles) ** 2).sum())
        halves.append(half if _MIN_HALF < half < 1.0 / _MIN_HALF else HALF)
    return halves


def amount_of(strength: float, half: float = HALF) -> float:
    """Return the amount in percent, -100 to 100, that stands for a strength s in sliders: s / (|s| + half).

    With the pair's half strength, the effect of the amount is about even.
    """
    return 100.0 * strength / (abs(strength) + half)


def strength_of(amount: float, half: float = HALF) -> float:
    """Return the strength that an amount in percent stands for, the inverse of `amount_of`."""
    part = min(max(amount / 100.0, -1.0), 1.0)
    # A quotient beyond the limit would be refused, even by a rounding.
    return min(max(half * part / max(1.0 - abs(part), half / STRENGTH_LIMIT), -STRENGTH_LIMIT), STRENGTH_LIMIT)


def pairs(selected: Sequence[int], active: int | None) -> list[tuple[int, int]]:
    """Return the pairs of every other `selected` vertex and the `active` one; two vertices need none that is active.

    Raises:
        ReadableError: fewer than two vertices are selected, or more and none of them is active.
    """
    if len(selected) < 2:
        raise ReadableError(translate("Select two vertices; or several, ending with the one to connect the others to"))
    if active is None and len(selected) > 2:
        raise ReadableError(translate("No vertex is active; Shift-click the one to connect the others to"))
    last = selected[-1] if active is None else active
    return [(vertex, last) for vertex in selected if vertex != last]


def free_name(name: str, taken: Collection[str]) -> str:
    """Return `name`, or as Blender does the first of name.001, name.002, ... that is not in `taken`."""
    return next(new for new in (name, *(f"{name}.{k:03d}" for k in range(1, len(taken) + 2))) if new not in taken)
