"""Meshes that the tests make themselves: (vertices (V, 3), triangles (F, 3)) or polygon arrays."""

from __future__ import annotations

import types

import numpy as np
import spectral_conformal as sc
from scipy.spatial import ConvexHull, Delaunay


def read_obj(path):
    """(V, 3) vertices and the corner lists of the faces of an OBJ file."""
    lines = [line.split() for line in path.read_text().splitlines()]
    vertices = np.array([line[1:4] for line in lines if line[:1] == ["v"]], float).reshape(-1, 3)
    faces = [[int(corner.split("/")[0]) - 1 for corner in line[1:]] for line in lines if line[:1] == ["f"]]
    return vertices, faces


def without_unused(vertices, triangles):
    used, compact = np.unique(triangles, return_inverse=True)
    return vertices[used], compact.reshape(triangles.shape)


def without_bow_ties(triangles):
    """Removes the triangles at vertices where the boundary passes twice, until there are none."""
    while True:
        tail, head = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
        n = triangles.max() + 1
        boundary = tail[~np.isin(tail * n + head, head * n + tail)]
        passed = np.bincount(boundary, minlength=n)
        if passed.max() <= 1:
            return triangles
        triangles = triangles[(passed[triangles] <= 1).all(1)]


def random_disk(n, holes=0, seed=0):
    """A planar disk, randomly sampled, counter-clockwise, with round holes on a spiral."""
    rng = np.random.default_rng(seed)
    n_boundary = int(2.2 * np.sqrt(n))
    rim = np.exp(2j * np.pi * np.arange(n_boundary) / n_boundary)
    inside = np.sqrt(rng.random(n - n_boundary)) * 0.985 * np.exp(2j * np.pi * rng.random(n - n_boundary))
    z = np.r_[rim, inside]
    triangles = Delaunay(np.c_[z.real, z.imag]).simplices.astype(np.int64)
    corners = z[triangles]
    area = ((corners[:, 1] - corners[:, 0]).conj() * (corners[:, 2] - corners[:, 0])).imag
    triangles[area < 0] = triangles[area < 0][:, ::-1]
    triangles = triangles[np.abs(area) > 1e-10]
    center = z[triangles].mean(1)
    for k in range(holes):
        middle = 0.85 * np.sqrt((k + 0.5) / holes) * np.exp(2.4j * k)
        triangles = triangles[np.abs(center - middle) > 0.35 / np.sqrt(holes)]
        center = z[triangles].mean(1)
    triangles = without_bow_ties(triangles)
    return without_unused(np.c_[z.real, z.imag, 0 * z.real], triangles)


def bumpy_disk(n, holes=0, seed=0):
    """The random disk lifted to a surface without symmetry."""
    vertices, triangles = random_disk(n, holes, seed)
    x, y = vertices[:, 0], vertices[:, 1]
    vertices[:, 2] = 0.6 * np.exp(-6 * ((x - 0.3) ** 2 + (y - 0.1) ** 2)) + 0.15 * np.sin(4 * x + 1) * np.cos(3 * y)
    return vertices, triangles


def grid_quads(n, m):
    """Corner lists (n - 1)(m - 1) x 4 of a grid of n x m vertices; vertex i m + j."""
    i, j = np.meshgrid(np.arange(n - 1), np.arange(m - 1), indexing="ij")
    first = (i * m + j).ravel()
    return np.c_[first, first + m, first + m + 1, first + 1]


def triangles_of(faces):
    """Triangles as they are, of quads those along their first diagonals."""
    faces = np.asarray(faces)
    return faces if faces.shape[1] == 3 else np.r_[faces[:, :3], faces[:, [0, 2, 3]]]


def unit_square(n, m=None):
    """n x m points of the unit square, (n m, 2), and the quads between them (grid_quads)."""
    m = m or n
    return np.stack(np.divmod(np.arange(n * m), m), axis=1) / (n - 1, m - 1), grid_quads(n, m)


def saddle_quads(n):
    """The quad mesh of z = x^2 - y^2 on n x n vertices (paper Fig. 3), mirror symmetric in x and in y."""
    t = np.linspace(-1, 1, n)
    x, y = (a.ravel() for a in np.meshgrid(t, t, indexing="ij"))
    return np.c_[x, y, x**2 - y**2], grid_quads(n, n)


def bulge(n, height):
    """A deep round bulge on a square, which a conformal map shrinks."""
    t = np.linspace(-1, 1, n)
    x, y = (a.ravel() for a in np.meshgrid(t, t, indexing="ij"))
    return np.c_[x, y, height * np.exp(-5 * (x**2 + y**2))], grid_quads(n, n)


def torn_hat(around=64, rings=16, stack=12, radius=0.35, height=0.5, tear=0.25):
    """A brim with a crown whose torn edge is longer than the brim, so that it is taken for the outer boundary.
    The brim's border is the first `around` vertices."""
    angle = np.arange(around) * 2 * np.pi / around
    profile = [(r, 0.0) for r in np.linspace(1, radius, rings)]
    profile += [(radius, h) for h in np.linspace(0, height, stack)[1:]]
    torn = 1 + tear / height * (np.arange(around) % 2)
    vertices = [
        (r * np.cos(a), r * np.sin(a), h * (1 + (t - 1) * (h / height) ** 3))
        for r, h in profile
        for a, t in zip(angle, torn)
    ]
    k, i = (a.ravel() for a in np.meshgrid(np.arange(len(profile) - 1), np.arange(around), indexing="ij"))
    a, b = k * around + i, k * around + (i + 1) % around
    return np.array(vertices), np.r_[np.c_[a, b, b + around], np.c_[a, b + around, a + around]]


def spiral_ramp(turns, along=60, across=4):
    """The quads of a flat ramp that climbs slowly around an axis: beyond one turn its conformal map covers itself."""
    angle, radius = np.meshgrid(
        np.linspace(0, 2 * np.pi * turns, along + 1), np.linspace(2, 3, across + 1), indexing="ij"
    )
    vertices = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.05 * angle], axis=-1).reshape(-1, 3)
    return vertices, grid_quads(along + 1, across + 1)


def finger(sides, rings):
    """A tube of unit radius, closed at its far end: rings of squares, each split in two, then a tip."""
    angle = 2 * np.pi * np.arange(sides) / sides
    step = 2 * np.pi / sides
    ring = np.c_[np.cos(angle), np.sin(angle)]
    vertices = np.vstack([np.c_[ring, np.full(sides, k * step)] for k in range(rings)] + [[[0, 0, rings * step]]])
    k, q = (x.ravel() for x in np.meshgrid(np.arange(rings - 1), np.arange(sides), indexing="ij"))
    a, b = k * sides + q, k * sides + (q + 1) % sides
    last = (rings - 1) * sides + np.arange(sides)
    tip = np.c_[last, np.roll(last, -1), np.full(sides, rings * sides)]
    return vertices, np.vstack([np.c_[a, b, b + sides], np.c_[a, b + sides, a + sides], tip])


def floater(offset):
    """Three triangles around one inner vertex that stands aside (Floater 1998): beyond -1 the map folds one of them."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1, 0], [0.5, offset, 1]], float)
    return vertices, np.array([[0, 1, 3], [1, 2, 3], [2, 0, 3]])


def rough_grid_points(n, roughness, seed):
    """The vertices of n by n quads (grid_quads), every one moved at random."""
    return _rough_grid_points(n, roughness, np.random.default_rng(seed))


def _rough_grid_points(n, roughness, rng):
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n), indexing="ij")
    return np.stack([x, y, 0 * x], -1).reshape(-1, 3) + roughness * rng.normal(size=(n * n, 3)) / n


def rough_grid(n, roughness, seed, dropped=0.0):
    """A grid of triangles, every vertex moved at random, some cells left out: its conformal map has folds."""
    rng = np.random.default_rng(seed)
    vertices = _rough_grid_points(n, roughness, rng)
    index = np.arange(n * n).reshape(n, n)
    kept = rng.random((n - 1, n - 1)) >= dropped
    a, b, c, d = (part[kept] for part in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
    return without_unused(vertices, without_bow_ties(np.vstack([np.c_[a, b, c], np.c_[a, c, d]])))


def prism(n):
    """Two polygons of n corners, joined by a ring of quads."""
    angle = 2 * np.pi * np.arange(n) / n
    ring = np.c_[np.cos(angle), np.sin(angle), 0 * angle]
    after = np.roll(np.arange(n), -1)
    sides = np.c_[np.arange(n), after, after + n, np.arange(n) + n].tolist()
    return np.r_[ring, ring + [0, 0, 1]], [*sides, list(range(n))[::-1], list(range(n, 2 * n))]


def tube(around, rings):
    """An open tube, twice as long as wide, of (rings - 1) x around quads."""
    angle = 2 * np.pi * np.arange(around) / around
    height = np.repeat(np.linspace(0, 4, rings), around)
    vertices = np.c_[np.tile(np.cos(angle), rings), np.tile(np.sin(angle), rings), height]
    i = np.arange(around)
    quads = [
        np.c_[i, (i + 1) % around, (i + 1) % around + around, i + around] + ring * around for ring in range(rings - 1)
    ]
    return vertices, np.concatenate(quads)


def spindle(n):
    """A double cone: two vertices with n triangles each."""
    angle = 2 * np.pi * np.arange(n) / n
    after = np.roll(np.arange(n), -1)
    upper = np.c_[np.arange(n), after, np.full(n, n)]
    lower = np.c_[after, np.arange(n), np.full(n, n + 1)]
    vertices = np.r_[np.c_[np.cos(angle), np.sin(angle), 0 * angle], [[0, 0, 1], [0, 0, -1]]]
    return vertices, np.r_[upper, lower].tolist()


def petals(n):
    """One polygon that comes to its first vertex n times."""
    first = 2 * np.pi * np.arange(n) / n
    angle = np.c_[first, first + 1.6 * np.pi / n].ravel()
    corners = np.c_[np.zeros(n, int), 2 * np.arange(n) + 1, 2 * np.arange(n) + 2]
    return np.r_[[[0, 0, 0]], np.c_[np.cos(angle), np.sin(angle), 0 * angle]], [corners.ravel().tolist()]


def boxes(n):
    """Boxes of different sizes in a row."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    sizes = 1 + 0.3 * np.sin(np.arange(n))
    vertices = np.concatenate([size * corners + [3 * k, 0, 0] for k, size in enumerate(sizes)])
    return vertices, np.concatenate([quads + 8 * k for k in range(n)]).tolist()


def polygons(faces):
    """(face_offsets, corner_vertices) of a list of corner lists."""
    sizes = [len(face) for face in faces]
    return np.r_[0, np.cumsum(sizes)].astype(np.int64), np.concatenate([np.asarray(face) for face in faces])


def border_of(triangles, n):
    """Whether each of n vertices is on a boundary."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    distinct, counts = np.unique(edges, axis=0, return_counts=True)
    border = np.zeros(n, bool)
    border[distinct[counts == 1]] = True
    return border


def similarity_deviation(uv, reference):
    """Greatest distance between uv and the reference moved by the best orientation-preserving similarity, relative to
    the extent of uv."""
    z = uv @ [1, 1j]
    w = reference @ [1, 1j]
    z = z - z.mean()
    w = w - w.mean()
    return np.abs(z - np.vdot(w, z) / np.vdot(w, w) * w).max() / np.abs(z).max()


def limbs(n, count, seed):
    """A closed body of n vertices with this number of limbs, at random places."""
    rng = np.random.default_rng(seed)
    height = 1.0 - (2.0 * np.arange(n) + 1.0) / n
    turn = np.pi * (1.0 + 5.0**0.5) * (np.arange(n) + 0.5)
    sphere = np.c_[np.sqrt(1.0 - height**2)[:, None] * np.c_[np.cos(turn), np.sin(turn)], height]
    faces = ConvexHull(sphere).simplices.copy()
    first, second, third = (sphere[faces[:, k]] for k in range(3))
    inwards = (np.cross(second - first, third - first) * first).sum(axis=1) < 0.0
    faces[inwards] = faces[inwards][:, ::-1]
    directions = rng.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    radius = 1.0
    for direction in directions:
        radius = radius + rng.uniform(1.0, 3.0) * np.exp(rng.uniform(15.0, 40.0) * (sphere @ direction - 1.0))
    return sphere * radius[:, None], *polygons(faces)


def with_fine_border(vertices, triangles, chosen, points):
    """Puts this many points on the border edges whose middle is chosen; the surface stays as it is."""
    tail, head = triangles, np.roll(triangles, -1, axis=1)
    n = len(vertices)
    on_border = ~np.isin(tail * n + head, head * n + tail)
    middles = (vertices[tail] + vertices[head]) / 2
    cut = on_border & np.apply_along_axis(chosen, 2, middles)
    assert cut.sum(axis=1).max() <= 1
    part = np.arange(1, points + 1)[:, None] / (points + 1)
    faces, added = list(triangles[~cut.any(axis=1)]), []
    for face, side in zip(*np.nonzero(cut)):
        first, last, apex = np.roll(triangles[face], -side)
        row = [first, *range(n + points * len(added), n + points * (len(added) + 1)), last]
        added.append((1 - part) * vertices[first] + part * vertices[last])
        faces += [(a, b, apex) for a, b in zip(row, row[1:])]
    return np.vstack([vertices, *added]), np.array(faces)


# Maps by vertex, as igl has them, through functions whose maps are by corner


def mesh(vertices, faces, corner_vertices=None, uv=None):
    return sc.Mesh(vertices, faces, uv, corner_vertices=corner_vertices)


def mapped(vertices, faces, uv, corner_vertices=None):
    """A mesh with a map given by vertex, (V, 2)."""
    plain = mesh(vertices, faces, corner_vertices)
    return plain.with_uv(np.asarray(uv)[plain.corner_vertices])


def flat(uv, faces, corner_vertices=None):
    """A mesh in the plane, whose positions are its map, (V, 2)."""
    return mapped(np.column_stack([uv, np.zeros(len(uv))]), faces, uv, corner_vertices)


def by_vertex(found, start):
    """The map of a mesh by vertex, (V, 2); vertices without a face keep their `start`."""
    result = np.array(start, dtype=np.float64)
    result[found.corner_vertices] = found.uv
    return result


def pack(uv, faces, corner_vertices=None, **options):
    found = sc.pack(flat(uv, faces, corner_vertices), **options)
    return types.SimpleNamespace(**{**vars(found), "uv": by_vertex(found, uv)})


def fixed_corners(fixed, triangles, n):
    """Flags by corner of vertices given by flags or indices; None for none."""
    if fixed is None:
        return None
    flags = np.zeros(n, bool)
    flags[fixed] = True
    return flags[triangles]


def relax(vertices, triangles, uv, fixed=None, **options):
    given = mapped(vertices, triangles, uv)
    found = sc.relax(given, fixed=fixed_corners(fixed, triangles, len(uv)), **options)
    return types.SimpleNamespace(**{**vars(found), "uv": by_vertex(found, uv)})


def defects(face_offsets, corner_vertices, corner_uv, **options):
    """The defects of a map without positions."""
    corners = np.asarray(face_offsets if corner_vertices is None else corner_vertices)
    positions = np.zeros((int(corners.max(initial=-1)) + 1, 3))
    return sc.map_defects(mesh(positions, face_offsets, corner_vertices, corner_uv), **options)


class Relaxation:
    """`sc.Relaxation` of a map by vertex, (V, 2)."""

    def __init__(self, vertices, triangles, uv, fixed=None, **options):
        self._start = uv
        fixed = fixed_corners(fixed, triangles, len(uv))
        self._inner = sc.Relaxation(mapped(vertices, triangles, uv), fixed=fixed, **options)
        self.step = self._inner.step

    @property
    def uv(self):
        return self.result.uv

    @property
    def energy(self):
        return self._inner.energy

    @property
    def result(self):
        found = self._inner.result
        return types.SimpleNamespace(**{**vars(found), "uv": by_vertex(found, self._start)})
