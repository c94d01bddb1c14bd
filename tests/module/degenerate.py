"""Degenerate triangles inserted into a good mesh, so that the rest can be compared with the original map.

Each function returns (vertices, triangles); the given vertices come first. `height` is relative to an edge: how far the
triangles are from having no area at all.
"""

from __future__ import annotations

import numpy as np


def _halfedges(triangles):
    return {
        (int(t[k]), int(t[(k + 1) % 3])): (f, int(t[(k + 2) % 3])) for f, t in enumerate(triangles) for k in range(3)
    }


def _inner_edges(triangles, count, rng):
    """(i, j, face to the left, its apex, face to the right, its apex) of inner edges whose quads share no vertex."""
    halfedges = _halfedges(triangles)
    edges = [edge for edge in sorted(halfedges) if edge[0] < edge[1] and edge[::-1] in halfedges]
    used, result = set(), []
    for k in rng.permutation(len(edges)):
        i, j = edges[k]
        (left, a), (right, b) = halfedges[i, j], halfedges[j, i]
        if used & {i, j, a, b}:
            continue
        used |= {i, j, a, b}
        result.append((i, j, left, a, right, b))
        if len(result) == count:
            break
    return result


def _changed(vertices, triangles, dropped, points, added):
    kept = np.delete(triangles, sorted(dropped), axis=0)
    return np.vstack([vertices, points]), np.vstack([kept, added])


def caps(vertices, triangles, height, count=12, seed=2):
    """Edges split on one side only, the gap closed by a triangle of three points on a line (a T-junction)."""
    rng = np.random.default_rng(seed)
    points, added, dropped = [], [], set()
    for i, j, left, a, _, _ in _inner_edges(triangles, count, rng):
        middle = len(vertices) + len(points)
        edge = vertices[j] - vertices[i]
        up = vertices[a] - vertices[i]
        up = up - up.dot(edge) / edge.dot(edge) * edge
        lift = height * np.linalg.norm(edge) * up / np.linalg.norm(up)
        points.append(vertices[i] + rng.uniform(0.2, 0.8) * edge + lift)
        dropped.add(left)
        added += [[i, middle, a], [middle, j, a], [i, j, middle]]
    return _changed(vertices, triangles, dropped, points, added)


def needles(vertices, triangles, height, count=12, seed=2):
    """Edges split next to their first vertex, so that two vertices (nearly) coincide."""
    rng = np.random.default_rng(seed)
    points, added, dropped = [], [], set()
    for i, j, left, a, right, b in _inner_edges(triangles, count, rng):
        middle = len(vertices) + len(points)
        points.append(vertices[i] + height * (vertices[j] - vertices[i]))
        dropped |= {left, right}
        added += [[i, middle, a], [middle, j, a], [j, middle, b], [middle, i, b]]
    return _changed(vertices, triangles, dropped, points, added)


def points(vertices, triangles, height, count=12, seed=2):
    """Triangles shrunk to (nearly) a point in the middle of others."""
    rng = np.random.default_rng(seed)
    corners, added, dropped = [], [], set()
    for face in rng.permutation(len(triangles))[:count]:
        outer = [int(v) for v in triangles[face]]
        first = len(vertices) + len(corners)
        center = vertices[outer].mean(0)
        corners += [center + height * (vertices[v] - center) for v in outer]
        dropped.add(int(face))
        added.append([first, first + 1, first + 2])
        for k in range(3):
            after = (k + 1) % 3
            added += [[outer[k], outer[after], first + after], [outer[k], first + after, first + k]]
    return _changed(vertices, triangles, dropped, corners, added)


def with_middles(vertices, triangles, count=12, seed=2):
    """The counterpart of `points` without area: the same triangles with one vertex in their middle."""
    rng = np.random.default_rng(seed)
    centers, added, dropped = [], [], set()
    for face in rng.permutation(len(triangles))[:count]:
        outer = [int(v) for v in triangles[face]]
        middle = len(vertices) + len(centers)
        centers.append(vertices[outer].mean(0))
        dropped.add(int(face))
        added += [[outer[k], outer[(k + 1) % 3], middle] for k in range(3)]
    return _changed(vertices, triangles, dropped, centers, added)


def nested(vertices, triangles, ratio, count=3, seed=2):
    """Triangles inside triangles, each 0.3 times the last, down to `ratio` of the first (areas: its square)."""
    rng = np.random.default_rng(seed)
    corners, added, dropped = [], [], set()
    for face in rng.permutation(len(triangles))[:count]:
        outer = [int(v) for v in triangles[face]]
        center = vertices[outer].mean(0)
        dropped.add(int(face))
        ring, size = outer, 1.0
        while size > ratio:
            size *= 0.3
            first = len(vertices) + len(corners)
            corners += [center + size * (vertices[v] - center) for v in outer]
            inner = [first, first + 1, first + 2]
            for k in range(3):
                after = (k + 1) % 3
                added += [[ring[k], ring[after], inner[after]], [ring[k], inner[after], inner[k]]]
            ring = inner
        added.append(ring)
    return _changed(vertices, triangles, dropped, corners, added)
