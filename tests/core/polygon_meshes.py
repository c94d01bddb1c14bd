# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes for the tests of core."""

import numpy as np
from spectral_unwrap.core.mesh.polygon_mesh import PolygonMesh

SQUARE = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)


def polygon_mesh(points, faces=None, seams=(), selected=None, uv=None, **others):
    """A mesh of points in space, or in the plane, (V, 2); all faces are selected, unless told.

    Without faces, each four points are a quad of their own.
    """
    points = np.array(points, float)
    if points.shape[1] == 2:
        points = np.c_[points, np.zeros(len(points))]
    faces = np.arange(len(points)).reshape(-1, 4) if faces is None else faces
    return PolygonMesh(
        points,
        np.cumsum([0, *map(len, faces)]).astype(np.int32),
        np.concatenate(faces).astype(np.int32),
        np.asarray(seams, np.int32).reshape(-1, 2),
        np.ones(len(faces), bool) if selected is None else np.array(selected),
        uv,
        **others,
    )


def grid(columns, rows=None, height=None, **fields):
    """Unit quads, mapped as seen from above; vertex (x, y) is y (columns + 1) + x, as high as `height(x, y)`."""
    rows = rows or columns
    y, x = np.divmod(np.arange((columns + 1) * (rows + 1)), columns + 1)
    faces = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).reshape(-1, 1)
    faces = faces + [0, 1, columns + 2, columns + 1]
    points = np.c_[x, y, height(x, y) if height else 0 * x].astype(float)
    return polygon_mesh(points, faces, **{"uv": points[faces.ravel(), :2], **fields})
