# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard cases of every kind, and those beside the project where they exist.

A case says what is expected, by the words of hard.json: `solve` (no flips), `solve_or_clean`, `per_component` (every
component is a chart of its own), `solve_flips` (a flip is possible and reported), `reject` (a reason, and no change).
Blenders without the package import this file, too.
"""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

Mesh = tuple[np.ndarray, Sequence[Sequence[int]]]
SHARED = Path(__file__).resolve().parents[3] / "shared" / "meshes" / "hard"


# hard.json lets three faces at an edge be split or rejected.
EITHER = ("nonmanifold_fin",)


@dataclass(frozen=True)
class Case:
    """A mesh to unwrap: the expected outcome, how to make it, and further knowledge."""

    expect: str
    make: Callable[[], Mesh]
    charts: int = 1
    allowed_flips: int = 0
    # May be rejected as well as solved.
    may_be_either: bool = False


def surface(columns, rows, place, triangles=True):
    """The image of a grid of the unit square under `place(u, v)`; its vertex (i, j) is i + j (columns + 1)."""
    u, v = np.meshgrid(np.linspace(0.0, 1.0, columns + 1), np.linspace(0.0, 1.0, rows + 1))
    vertices = np.stack(np.broadcast_arrays(*place(u, v)), axis=-1).reshape(-1, 3)
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    quads = np.stack([first, first + 1, first + columns + 2, first + columns + 1], axis=1)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]) if triangles else quads
    return vertices, faces.tolist()


def bumpy(u, v):
    """A hilly square."""
    return u, v, 0.2 * np.sin(5.0 * u + 1.0) * np.cos(4.0 * v)


def hill(columns=16, rows=16, triangles=True):
    """A hilly square of triangles or quads."""
    return surface(columns, rows, bumpy, triangles)


def welded(mesh):
    """Join vertices at one place."""
    vertices, faces = mesh
    _, first, inverse = np.unique(np.round(vertices, 9), axis=0, return_index=True, return_inverse=True)
    inverse = inverse.ravel()
    return vertices[first], [[int(inverse[i]) for i in face] for face in faces]


def joined(*meshes):
    """Several meshes as one, nothing welded."""
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in meshes])
    faces = [[int(i) + int(start) for i in face] for (_, part), start in zip(meshes, starts) for face in part]
    return np.concatenate([np.reshape(vertices, (-1, 3)) for vertices, _ in meshes]), faces


def without_faces(mesh, gone):
    """A mesh without the faces of which `gone(center)` says so, given their centers (F, 3)."""
    vertices, faces = mesh
    centers = np.array([vertices[face].mean(axis=0) for face in faces])
    return vertices, [face for face, is_gone in zip(faces, gone(centers)) if not is_gone]


def torus(around=24, across=12):
    """A closed torus."""

    def place(u, v):
        a, b = 2.0 * np.pi * u, 2.0 * np.pi * v
        return (2.0 + np.cos(b)) * np.cos(a), (2.0 + np.cos(b)) * np.sin(a), np.sin(b)

    return welded(surface(around, across, place))


def moebius(around=30, across=3):
    """A one-sided strip."""

    def place(u, v):
        a, w = 2.0 * np.pi * u, v - 0.5
        return (2.0 + w * np.cos(a / 2.0)) * np.cos(a), (2.0 + w * np.cos(a / 2.0)) * np.sin(a), w * np.sin(a / 2.0)

    return welded(surface(around, across, place))


def octahedron():
    """A closed octahedron."""
    vertices = np.array([(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], dtype=float)
    faces = [[i, (i + 1) % 4, 4] for i in range(4)] + [[(i + 1) % 4, i, 5] for i in range(4)]
    return vertices, faces


def one_coordinate(value):
    """A hilly square with one coordinate that is not a number."""
    vertices, faces = hill()
    vertices[40, 2] = value
    return vertices, faces


def fin():
    """A sheet on which another stands along a row of edges."""
    vertices, faces = hill(6, 6)
    standing, more = surface(6, 2, lambda u, v: (u, 0.5 + 0 * v, 1.0 * v))
    standing[:7] = vertices[21:28]
    both = joined((vertices, faces), (standing, more))
    return both[0], [[21 + i - 49 if 49 <= i < 56 else i for i in face] for face in both[1]]


def comb(teeth=30, length=20):
    """A sheet with long, narrow gaps."""
    flat = surface(2 * teeth - 1, length, lambda u, v: (u * (2 * teeth - 1), v * length, 0.0 * u), False)
    return without_faces(flat, lambda center: (np.floor(center[:, 0]) % 2 == 1) & (center[:, 1] > 2.0))


def fan(valence=1000):
    """A cone around one vertex."""
    angle = np.arange(valence) * (2.0 * np.pi / valence)
    rim = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    return np.vstack([rim, (0.0, 0.0, 0.7)]), [[i, (i + 1) % valence, valence] for i in range(valence)]


def floater(offset):
    """Three triangles around one vertex, whose last one folds over for offsets below -1 (after Floater 1998)."""
    return np.array([(0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (offset, 0.0, 1.0)]), [
        [0, 1, 3],
        [1, 2, 3],
        [2, 0, 3],
    ]


def frame():
    """A square with a hole nearly as large."""
    flat = surface(20, 20, bumpy)
    return without_faces(flat, lambda center: (np.abs(center[:, :2] - 0.5) < 0.4).all(axis=1))


def graded(ratio=1e6):
    """A ring whose triangles shrink inward by `ratio`."""

    def place(u, v):
        r, a = ratio ** -(1.0 - v), 2.0 * np.pi * u
        return r * np.cos(a), r * np.sin(a), 0.3 * r

    vertices, faces = surface(30, 40, place)
    # Not by position: the inner vertices are close to each other.
    merged = np.arange(len(vertices)).reshape(41, 31)
    merged[:, -1] = merged[:, 0]
    return vertices, [[int(merged.flat[i]) for i in face[::-1]] for face in faces]


def helix(turns=8, rows=2):
    """A long narrow strip around an axis."""

    def place(u, v):
        a = 2.0 * np.pi * turns * u
        return (1.0 + 0.2 * v) * np.cos(a), (1.0 + 0.2 * v) * np.sin(a), 0.1 * a

    return surface(120 * turns, rows, place)


def ring_of_quads(corners=48):
    """One polygon with many corners, surrounded by quads."""
    angle = np.arange(corners) * (2.0 * np.pi / corners)
    loops = [np.stack([r * np.cos(angle), r * np.sin(angle), 0.0 * angle + z], axis=1) for r, z in ((1, 0), (1.2, 0.1))]
    side = [[i, i + corners, (i + 1) % corners + corners, (i + 1) % corners] for i in range(corners)]
    return np.vstack(loops), [list(range(corners)), *side]


def sieve(holes=8):
    """A square with holes x holes square holes."""
    n = 3 * holes + 1
    flat = surface(n, n, bumpy)
    return without_faces(flat, lambda center: (np.floor(center[:, :2] * n) % 3 == 1).all(axis=1))


def tube(around=24, rows=16):
    """A bent tube, open at both ends."""

    def place(u, v):
        a, b = 2.0 * np.pi * u, 2.0 * v
        return (3.0 + np.cos(a)) * np.cos(b), (3.0 + np.cos(a)) * np.sin(b), np.sin(a)

    return welded(surface(around, rows, place))


def mixed():
    """Half quads, half triangles."""
    vertices, quads = hill(14, 14, triangles=False)
    triangles = [list(part) for q in quads[98:] for part in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]
    return vertices, [*quads[:98], *triangles]


def collapsed_side():
    """A sheet one side of which is a point, so that triangles there have no area."""
    vertices, faces = hill()
    vertices[:17] = vertices[8]
    return vertices, faces


def with_duplicates():
    """Ten faces twice."""
    vertices, faces = hill()
    return vertices, [*faces, *(faces[i] for i in range(100, 200, 10))]


def inconsistent():
    """Every fifth face flipped."""
    vertices, faces = hill()
    return vertices, [face[::-1] if i % 5 == 0 else face for i, face in enumerate(faces)]


def with_isolated_vertices():
    """Vertices without a face, in front of and behind the others."""
    vertices, faces = hill(8, 8)
    loose = np.random.default_rng(0).normal(size=(20, 3))
    return np.vstack([loose, vertices, loose + 5.0]), [[i + 20 for i in face] for face in faces]


def loose_triangles(count=40):
    """A sheet and many single triangles."""
    rng = np.random.default_rng(1)
    singles = [(rng.normal(size=(3, 3)) + 4.0 * i, [[0, 1, 2]]) for i in range(count)]
    return joined(hill(8, 8), *singles)


def scaled(factor, offset=0.0):
    """The hilly square, larger or smaller, elsewhere."""
    vertices, faces = hill()
    return vertices * factor + offset, faces


def _single(*points):
    return np.array(points, dtype=float), [list(range(len(points)))]


GENERATED = {
    "line": Case("reject", lambda: surface(4, 2, lambda u, v: (u + v, 2.0 * (u + v), 3.0 * (u + v)))),
    "point": Case("reject", lambda: surface(3, 3, lambda u, v: (0.0 * u, 0.0 * v, 1.0))),
    "closed": Case("reject", octahedron),
    "torus": Case("reject", torus),
    "torus with one face less": Case("reject", lambda: (torus()[0], torus()[1][1:])),
    "empty": Case("reject", lambda: (np.empty((0, 3)), [])),
    "vertices only": Case("reject", lambda: (hill()[0], [])),
    "one-sided": Case("reject", moebius),
    "NaN": Case("reject", lambda: one_coordinate(np.nan)),
    "infinite": Case("reject", lambda: one_coordinate(np.inf)),
    "three faces at an edge": Case("reject", fin, may_be_either=True),
    "too far away": Case("solve", lambda: scaled(1.0, 1e6), may_be_either=True),
    "comb": Case("solve", comb),
    "fan": Case("solve", fan),
    "Floater, regular": Case("solve", lambda: floater(0.0)),
    "Floater, on the limit": Case("solve_flips", lambda: floater(-1.0), allowed_flips=1),
    "Floater, beyond": Case("solve_flips", lambda: floater(-1.5), allowed_flips=1),
    "frame": Case("solve", frame),
    "graded": Case("solve", graded),
    "helix": Case("solve", helix),
    "closed but for one face": Case("solve", lambda: (octahedron()[0], octahedron()[1][1:])),
    "mixed": Case("solve", mixed),
    "needles": Case("solve", lambda: (hill()[0] * (1e-3, 1.0, 1e-3), hill()[1])),
    "polygon with 48 corners": Case("solve", ring_of_quads),
    "concave polygon": Case(
        "solve", lambda: (np.array([(0, 0, 0), (4, 0, 0), (4, 4, 0), (2, 1, 0), (0, 4, 0.0)]), [[0, 1, 2, 3, 4]])
    ),
    "quads": Case("solve", lambda: hill(triangles=False)),
    "reversed": Case("solve", lambda: (hill()[0], [face[::-1] for face in hill()[1]])),
    "scale 1": Case("solve", lambda: scaled(1.0)),
    "scale 1e-6": Case("solve", lambda: scaled(1e-6)),
    "scale 1e6": Case("solve", lambda: scaled(1e6)),
    # A thousandth of the extent is what single precision leaves of a square so far away.
    "far away": Case("solve", lambda: scaled(1.0, 1e4)),
    "sieve": Case("solve", sieve),
    "single quad": Case("solve", lambda: _single((0, 0, 0), (1, 0, 0), (1, 1, 0.5), (0, 1, 0))),
    "single triangle": Case("solve", lambda: _single((0, 0, 0), (3, 0, 1), (1, 2, 0))),
    "strip": Case("solve", lambda: surface(1000, 1, lambda u, v: (u * 100.0, 0.1 * v, np.sin(9.0 * u)))),
    # Both loops are equally long, so one end has to shrink; a fold near it is possible.
    "tube": Case("solve", tube, allowed_flips=1),
    "two triangles": Case("solve", lambda: (hill(1, 1)[0], hill(1, 1)[1])),
    "collapsed side": Case("solve_or_clean", collapsed_side),
    "duplicate faces": Case("solve_or_clean", with_duplicates),
    "inconsistent orientation": Case("solve_or_clean", inconsistent),
    "isolated vertices": Case("solve_or_clean", with_isolated_vertices),
    "loose triangles": Case("per_component", loose_triangles, charts=41),
    "three components": Case(
        "per_component", lambda: joined(hill(10, 10), hill(6, 4), _single((0, 0, 9), (1, 0, 9), (0, 1, 9))), charts=3
    ),
    "touching in a vertex": Case(
        "per_component",
        lambda: (np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (-1, 0, 0), (-1, -1, 0.0)]), [[0, 1, 2], [0, 3, 4]]),
        charts=2,
    ),
}


def read_obj(path):
    """Return the vertices and faces of an OBJ file."""
    lines = [line.split() for line in path.read_text(encoding="utf-8").splitlines()]
    vertices = np.array([line[1:4] for line in lines if line[:1] == ["v"]], float).reshape(-1, 3)
    return vertices, [[int(word.split("/")[0]) - 1 for word in line[1:]] for line in lines if line[:1] == ["f"]]


def shared_cases():
    """Return the cases beside the project; none where the folder is missing."""
    if not (SHARED / "hard.json").exists():
        return {}
    cases = {}
    for name, entry in json.loads((SHARED / "hard.json").read_text(encoding="utf-8")).items():
        cases[f"shared {name}"] = Case(
            entry["expect"],
            lambda name=name: read_obj(SHARED / f"{name}.obj"),
            charts=entry["components"] if entry["expect"] == "per_component" else 1,
            allowed_flips=int(entry["expect"] == "solve_flips" or name == "tube_open"),
            may_be_either=name in EITHER,
        )
    return cases


CASES = {**GENERATED, **shared_cases()}
