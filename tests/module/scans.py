# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces as of scanners, and maps in many pieces."""

import numpy as np
from scipy.spatial import cKDTree
from spectral_conformal._measuring import edges_between

from tests.module import meshes
from tests.module.textured_assets import on_side


def bumpy_sphere(n):
    """Points and quads of a sphere with bumps, as a cube of n x n quads to a side."""
    places, quads = meshes.unit_square(n + 1)
    points = np.concatenate([on_side(np.full(len(places), side), places) for side in range(6)])
    faces = np.concatenate([side * len(places) + quads[:, :: 1 - side % 2 * 2] for side in range(6)])
    # Sides share their borders.
    _, first, number = np.unique(points.round(9), axis=0, return_index=True, return_inverse=True)
    points, faces = points[first], number.ravel()[faces]
    rng = np.random.default_rng(0)
    height = sum(np.cos(6 * points @ rng.normal(size=3) + 6 * rng.random()) for _ in range(12))
    return points * (1 + 0.02 * height)[:, None], faces


def fragments(points, faces, n, seed=1):
    """Return which of n pieces each face belongs to: that of the nearest of n random faces."""
    centers = points[faces].mean(axis=1)
    seeds = np.random.default_rng(seed).choice(len(centers), n, replace=False)
    return cKDTree(centers[seeds]).query(centers)[1]


def borders(faces, piece):
    """Return the edges, (S, 2), between pieces."""
    offsets = np.arange(len(faces) + 1) * faces.shape[1]
    return edges_between(piece, offsets, faces.ravel(), int(faces.max()) + 1)
