# SPDX-License-Identifier: GPL-3.0-or-later
"""Random polygon meshes, valid and broken: vertices (V, 3) and a list of faces, each a list of vertices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, Delaunay, QhullError


@dataclass
class Mesh:
    vertices: np.ndarray
    faces: list[list[int]]
    description: str

    @property
    def offsets(self):
        return np.r_[0, np.cumsum([len(face) for face in self.faces])].astype(np.int64)

    @property
    def corners(self):
        return np.array([vertex for face in self.faces for vertex in face], np.int64)

    @property
    def triangles(self):
        """(F, 3): every polygon split as a fan."""
        fans = [(face[0], face[i], face[i + 1]) for face in self.faces for i in range(1, len(face) - 1)]
        return np.array(fans, np.int64).reshape(-1, 3)

    @property
    def edges(self):
        """(E, 2): every face's sides."""
        pairs = [(face[i - 1], face[i]) for face in self.faces for i in range(len(face))]
        return np.array(pairs, np.int64).reshape(-1, 2)


# Shapes


def grid(rng, size):
    rows, columns = rng.integers(2, 2 + size, 2)
    x, y = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, columns / rows, columns), indexing="ij")
    faces = [
        [i * columns + j, (i + 1) * columns + j, (i + 1) * columns + j + 1, i * columns + j + 1]
        for i in range(rows - 1)
        for j in range(columns - 1)
    ]
    return np.c_[x.ravel(), y.ravel(), 0 * x.ravel()], faces


def wrapped_grid(rng, size):
    """A tube, a torus, a Moebius strip or a Klein bottle."""
    around, along = rng.integers(3, 4 + size, 2)
    twisted, closed = rng.random() < 0.3, rng.random() < 0.3

    def vertex(i, j):
        if i == around:
            i, j = 0, along - 1 - j if twisted else j
        return int(i * along + j % along)

    strips = along if closed else along - 1
    faces = [
        [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]
        for i in range(around)
        for j in range(strips)
    ]
    angle = np.repeat(np.arange(around) / around * 2 * np.pi, along)
    t = np.tile(np.linspace(-1, 1, along), around)
    if closed:
        radius = 2 + np.cos(np.pi * t)
        return np.c_[radius * np.cos(angle), radius * np.sin(angle), np.sin(np.pi * t)], faces
    half = 0.5 * angle if twisted else np.zeros_like(angle)
    radius = 1 + 0.4 * t * np.sin(half)
    return np.c_[radius * np.cos(angle), radius * np.sin(angle), t * np.cos(half)], faces


def tube(rng, size):
    """A tube, cut open by chance."""
    around, along = rng.integers(3, 4 + size, 2)
    columns = around + 1 if rng.random() < 0.5 else around
    faces = [
        [
            int(i * along + j),
            int((i + 1) % columns * along + j),
            int((i + 1) % columns * along + j + 1),
            int(i * along + j + 1),
        ]
        for i in range(around)
        for j in range(along - 1)
    ]
    angle = np.repeat(np.arange(columns) / around * 2 * np.pi, along)
    return np.c_[np.cos(angle), np.sin(angle), np.tile(np.arange(along), columns) / around], faces


def disk(rng, size):
    n = int(rng.integers(4, 5 + size * size))
    points = rng.random((n, 2))
    graded = 10 ** rng.uniform(-1, 1.2)
    points = np.sign(points - 0.5) * np.abs(points - 0.5) ** graded
    try:
        triangles = Delaunay(points).simplices
    except QhullError:
        return grid(rng, size)
    return np.c_[points, np.zeros(n)], with_holes(rng, points[triangles].mean(1), triangles.tolist())


def blob(rng, size):
    n = int(rng.integers(4, 5 + size * size))
    points = rng.normal(size=(n, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    triangles = ConvexHull(points).simplices
    outwards = np.linalg.det(points[triangles]) > 0
    triangles[~outwards] = triangles[~outwards][:, ::-1]
    faces = with_holes(rng, points[triangles].mean(1), triangles.tolist())
    bumps = 1 + 0.5 * rng.random() * np.sin(points @ rng.normal(size=(3, 3)) * 3).sum(1)
    return points * bumps[:, None], faces


def with_holes(rng, centers, faces):
    keep = np.ones(len(faces), bool)
    for _ in range(rng.integers(0, 6)):
        middle = centers[rng.integers(len(centers))]
        keep &= np.linalg.norm(centers - middle, axis=1) > rng.uniform(0, 0.4) * np.ptp(centers, axis=0).max()
    return [face for face, kept in zip(faces, keep) if kept] or faces


def polygon(rng, size):
    """One n-gon, star-shaped or crossing itself, not planar."""
    n = int(rng.integers(3, 4 + 4 * size))
    angle = np.sort(rng.random(n)) * 2 * np.pi if rng.random() < 0.7 else rng.random(n) * 2 * np.pi
    radius = rng.uniform(0.2, 1, n)
    return np.c_[radius * np.cos(angle), radius * np.sin(angle), 0.1 * rng.normal(size=n)], [list(range(n))]


def soup(rng, size):
    """Random vertices for random faces."""
    n = int(rng.integers(1, 3 + 2 * size))
    faces = [rng.integers(0, n, rng.integers(0, 7)).tolist() for _ in range(rng.integers(0, 2 + 3 * size))]
    return rng.normal(size=(n, 3)), faces


def random_bytes(rng, size):
    n = int(rng.integers(1, 3 + size))
    vertices = np.frombuffer(rng.bytes(24 * n), np.float64).reshape(-1, 3)
    faces = (np.frombuffer(rng.bytes(12 * 2 * n), np.uint32).reshape(-1, 3) % n).tolist()
    return vertices.copy(), faces


SHAPES = (grid, grid, wrapped_grid, disk, disk, blob, blob, polygon, soup, random_bytes)


# Changes of the faces


def triangulated(rng, vertices, faces):
    return vertices, [[f[0], f[i], f[i + 1]] for f in faces for i in range(1, len(f) - 1)]


def merged(rng, vertices, faces):
    """Neighboring faces joined to n-gons."""
    by_edge = {}
    for number, face in enumerate(faces):
        for i in range(len(face)):
            by_edge[face[i - 1], face[i]] = number
    result = list(faces)
    for (a, b), number in by_edge.items():
        other = by_edge.get((b, a))
        if rng.random() > 0.2 or other is None or other == number:
            continue
        left, right = result[number], result[other]
        if left is not faces[number] or right is not faces[other]:
            continue
        i, j = left.index(b), right.index(a)
        if left[i - 1] != a or right[j - 1] != b:
            continue
        result[number] = left[i:] + left[: i - 1] + right[j:] + right[: j - 1]
        result[other] = None
    return vertices, [face for face in result if face is not None]


def with_non_manifold_edges(rng, vertices, faces):
    n = len(vertices)
    fins = [[*pair, n + k] for k, pair in enumerate(random_sides(rng, faces))]
    return np.r_[vertices, rng.normal(size=(len(fins), 3))], faces + fins


def with_bow_ties(rng, vertices, faces):
    merge = {int(a): int(b) for a, b in rng.integers(0, len(vertices), (rng.integers(1, 4), 2))}
    return vertices, [[merge.get(vertex, vertex) for vertex in face] for face in faces]


def with_duplicates(rng, vertices, faces):
    copies = [list(np.roll(face, rng.integers(0, 4)))[:: rng.choice([-1, 1])] for face in chosen(rng, faces)]
    return vertices, faces + [[int(vertex) for vertex in face] for face in copies]


def with_repeated_vertices(rng, vertices, faces):
    result = [list(face) for face in faces]
    for face in chosen(rng, result):
        face.insert(int(rng.integers(0, len(face) + 1)), int(rng.choice(face)) if face else 0)
    return vertices, result


def with_reversed_faces(rng, vertices, faces):
    share = rng.random()
    return vertices, [face[::-1] if rng.random() < share else face for face in faces]


def with_tiny_faces(rng, vertices, faces):
    return vertices, faces + [[], [0], [0, len(vertices) - 1]][: rng.integers(1, 4)]


def with_isolated_vertices(rng, vertices, faces):
    number = int(rng.integers(1, 20))
    where = np.sort(rng.integers(0, len(vertices) + 1, number))
    moved = np.arange(len(vertices)) + np.searchsorted(where, np.arange(len(vertices)), side="right")
    lonely = rng.choice([0.0, 1e300, np.nan, np.inf], (number, 3))
    return np.insert(vertices, where, lonely, axis=0), [[int(moved[v]) for v in face] for face in faces]


def shuffled(rng, vertices, faces):
    place = rng.permutation(len(vertices))
    result = np.empty_like(vertices)
    result[place] = vertices
    faces = [[int(place[v]) for v in face] for face in faces]
    return result, [faces[i] for i in rng.permutation(len(faces))]


def random_sides(rng, faces):
    return [(face[0], face[1]) for face in chosen(rng, faces) if len(face) > 1]


def chosen(rng, faces):
    return [faces[i] for i in rng.integers(0, len(faces), rng.integers(1, 4))] if faces else []


HARMLESS_FACES = (triangulated, triangulated, merged, with_reversed_faces, shuffled, with_isolated_vertices)
BROKEN_FACES = (with_non_manifold_edges, with_bow_ties, with_duplicates, with_repeated_vertices, with_tiny_faces)


# Changes of the positions


def noisy(rng, vertices):
    """Like a scan."""
    return vertices + 10 ** rng.uniform(-8, 0) * rng.normal(size=vertices.shape)


def rotated(rng, vertices):
    return vertices @ np.linalg.qr(rng.normal(size=(3, 3)))[0].T


def squeezed(rng, vertices):
    return vertices * 10 ** rng.uniform(-9, 0, 3)


def scaled(rng, vertices):
    return vertices * 10 ** rng.uniform(-150, 150)


def scaled_to_the_end(rng, vertices):
    return vertices * 10 ** rng.uniform(-320, 308)


def far_away(rng, vertices):
    return vertices + 10 ** rng.uniform(0, 12) * rng.normal(size=3)


def lifted(rng, vertices):
    x, y, z = vertices.T
    return np.c_[x, y, z + rng.uniform(0, 2) * np.sin(5 * x) * np.cos(4 * y)]


def with_coincident(rng, vertices):
    result = vertices.copy()
    pairs = rng.integers(0, len(vertices), (rng.integers(1, 1 + max(1, len(vertices) // 4)), 2))
    result[pairs[:, 0]] = result[pairs[:, 1]] + rng.choice([0, 1e-14, 1e-7])
    return result


def with_spikes(rng, vertices):
    result = vertices.copy()
    result[rng.integers(0, len(vertices), 3)] *= 10 ** rng.uniform(0, 12)
    return result


def collinear(rng, vertices):
    return vertices[:, :1] * rng.normal(size=3)


def rounded(rng, vertices):
    return np.round(vertices, rng.integers(0, 4))


def not_finite(rng, vertices):
    result = vertices.copy()
    result.flat[rng.integers(0, result.size, rng.integers(1, 4))] = rng.choice([np.nan, np.inf, -np.inf])
    return result


POSITIONS = (noisy, noisy, rotated, squeezed, scaled, far_away, lifted, lifted, with_coincident, with_spikes, rounded)
BROKEN_POSITIONS = (scaled_to_the_end, collinear, not_finite)


def random_patch(rng):
    """A mesh that is most often one disk-like patch."""
    shape = (grid, disk, blob, tube, polygon)[rng.integers(5)]
    vertices, faces = shape(rng, random_size(rng))
    words = [shape.__name__]
    for change in (triangulated, merged, with_reversed_faces, shuffled):
        if rng.random() < 0.3:
            vertices, faces = change(rng, vertices, faces)
            words.append(change.__name__)
    for move in POSITIONS:
        if rng.random() < 0.15:
            vertices = move(rng, vertices)
            words.append(move.__name__)
    return Mesh(vertices, faces, " ".join(words))


def random_size(rng):
    return int(rng.choice([2, 4, 8, 16, 40, 90], p=[0.14, 0.25, 0.3, 0.24, 0.06, 0.01]))


def random_mesh(rng, size=None):
    """A mesh of about size^2 vertices, by chance valid or broken."""
    size = size or random_size(rng)
    vertices, faces, words = np.zeros((0, 3)), [], []
    for _ in range(rng.choice([1, 2, 3], p=[0.8, 0.15, 0.05])):
        shape = SHAPES[rng.integers(len(SHAPES))]
        more, its_faces = shape(rng, size)
        faces = faces + [[v + len(vertices) for v in face] for face in its_faces]
        vertices = np.r_[vertices, more]
        words.append(shape.__name__)
    changes = [HARMLESS_FACES[i] for i in rng.integers(0, len(HARMLESS_FACES), rng.integers(0, 3))]
    if rng.random() < 0.35:
        changes.append(BROKEN_FACES[rng.integers(len(BROKEN_FACES))])
    for change in changes:
        vertices, faces = change(rng, vertices, faces)
        words.append(change.__name__)
    moves = [POSITIONS[i] for i in rng.integers(0, len(POSITIONS), rng.integers(0, 3))]
    if rng.random() < 0.1:
        moves.append(BROKEN_POSITIONS[rng.integers(len(BROKEN_POSITIONS))])
    for move in moves:
        # The mesh may hold infinite coordinates already.
        with np.errstate(all="ignore"):
            vertices = move(rng, vertices)
        words.append(move.__name__)
    return Mesh(vertices, faces, " ".join(words))
