# SPDX-License-Identifier: GPL-3.0-or-later
"""How far islands of a map are from each other."""

import numpy as np


def segments(uv, faces):
    """Return the ends of all edges of the faces, (N, 2, 2)."""
    return np.stack([uv[faces], uv[np.roll(faces, -1, axis=1)]], axis=2).reshape(-1, 2, 2)


def distance(one, other):
    """Return the least distance between two sets of segments that do not cross: from ends to segments."""

    def from_ends(points, edges):
        start, along = edges[:, 0], edges[:, 1] - edges[:, 0]
        square = np.maximum((along**2).sum(axis=1), 1e-300)
        t = np.clip(((points[:, None] - start) * along).sum(axis=2) / square, 0.0, 1.0)
        return np.linalg.norm(points[:, None] - start - t[..., None] * along, axis=2).min()

    return min(from_ends(one.reshape(-1, 2), other), from_ends(other.reshape(-1, 2), one))
