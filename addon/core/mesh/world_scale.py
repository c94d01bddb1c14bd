# SPDX-License-Identifier: GPL-3.0-or-later
"""How the scale of an object enlarges the faces of its mesh in the world.

An object's linear transformation M maps a face with the area vector a (its normal, as long as its area) to the area
vector cof(M) a. Its length needs only the metric G = M^T M: |cof(M) a|^2 = a^T cof(G) a. So rotations and mirrors
change nothing, and a uniform scale s enlarges all areas by s^2.
"""

import math
from collections.abc import Sequence

import numpy as np

from .polygon_mesh import PolygonMesh

# Differences of scale that Blender's own Unwrap ignores.
_EVEN = 1e-4
# Single precision leaves a rotation this far from a metric of 1.
_ROUNDING = 1e-6


def metric_of(transformation: Sequence[Sequence[float]]) -> np.ndarray | None:
    """Return the metric G, (3, 3) float64, of a `transformation`, (3, 3) or (4, 4).

    None for the scale 1, and for a transformation that is not finite. An even scale gives a multiple of the identity.
    """
    # Numbers, because arrays of nine cost each object of a scene ten times as much.
    columns = list(zip(*(tuple(row)[:3] for row in tuple(transformation)[:3])))[:3]
    metric = [[a[0] * b[0] + a[1] * b[1] + a[2] * b[2] for b in columns] for a in columns]
    if not all(map(math.isfinite, (*metric[0], *metric[1], *metric[2]))):
        return None
    square = (metric[0][0] + metric[1][1] + metric[2][2]) / 3.0
    differences = (abs(value - square * (i == j)) for i, row in enumerate(metric) for j, value in enumerate(row))
    if max(differences) > 2.0 * _EVEN * square:
        return np.array(metric)
    return None if abs(square - 1.0) <= _ROUNDING else square * np.eye(3)


def is_uneven(metric: np.ndarray | None) -> bool:
    """Return whether the metric scales directions differently, so that a chart has no single scale in the world."""
    return metric is not None and bool((metric != metric[0, 0] * np.eye(3)).any())


def area_growth(mesh: PolygonMesh) -> np.ndarray:
    """Return the area in the world over the area in object space of every face, (F,) float64.

    1 for faces without area, and where the object has no extent in the world.
    """
    n_faces = len(mesh.selected_faces)
    if mesh.world_metric is None or not n_faces:
        return np.ones(n_faces)
    if not is_uneven(mesh.world_metric):
        growth = np.full(n_faces, mesh.world_metric[0, 0])
    else:
        g = mesh.world_metric
        cofactors = np.cross(g[[1, 2, 0]], g[[2, 0, 1]])
        vectors = area_vectors(mesh)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            squares = np.einsum("fi,ij,fj->f", vectors, cofactors, vectors) / (vectors**2).sum(axis=1)
            growth = np.sqrt(np.maximum(squares, 0.0))
    growth[~(np.isfinite(growth) & (growth > 0.0))] = 1.0
    return growth


def area_vectors(mesh: PolygonMesh) -> np.ndarray:
    """Return the area vectors of faces in object space, (F, 3): half the sum of x_i x x_(i + 1) over the corners."""
    first = mesh.face_offsets[:-1]
    points = mesh.vertices.take(mesh.corner_vertices, axis=0)
    # Relative to the face's first corner, which keeps the digits of a small face far from the origin.
    points -= np.repeat(points.take(first, axis=0), np.diff(mesh.face_offsets), axis=0)
    with np.errstate(invalid="ignore", over="ignore"):
        return 0.5 * np.add.reduceat(np.cross(points, points.take(mesh.next_corner(), axis=0)), first)
