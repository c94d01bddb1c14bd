# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard-surface models as artists make them, and how many islands they would make of each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

Points = list[tuple[float, float, float]]
Model = tuple[np.ndarray, list[list[int]]]


@dataclass(frozen=True)
class HardSurface:
    """A model, the number of islands that an artist makes of it, and the reason."""

    make: Callable[[], Model]
    islands: range
    reason: str


def joined(parts: Sequence[tuple[Points, list[list[int]]]]) -> Model:
    vertices: Points = []
    faces: list[list[int]] = []
    for points, polygons in parts:
        faces += [[corner + len(vertices) for corner in polygon] for polygon in polygons]
        vertices += points
    return np.array(vertices, float), faces


def box(size: Sequence[float], origin: Sequence[float] = (0, 0, 0)) -> tuple[Points, list[list[int]]]:
    points = [
        (origin[0] + x * size[0], origin[1] + y * size[1], origin[2] + z * size[2])
        for x in (0, 1)
        for y in (0, 1)
        for z in (0, 1)
    ]
    return points, [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def loft(rings: Sequence[Points], closed: bool = False, capped: bool = False) -> tuple[Points, list[list[int]]]:
    """Quads from one ring of points to the next, and n-gons on the first and the last."""
    n = len(rings[0])
    faces = []
    for k in range(len(rings) if closed else len(rings) - 1):
        low, high = k * n, (k + 1) % len(rings) * n
        faces += [[low + i, low + (i + 1) % n, high + (i + 1) % n, high + i] for i in range(n)]
    if capped:
        faces += [list(range(n))[::-1], list(range((len(rings) - 1) * n, len(rings) * n))]
    return [point for ring in rings for point in ring], faces


def circle(n: int, radius: float, z: float) -> Points:
    return [(radius * np.cos(2 * np.pi * i / n), radius * np.sin(2 * np.pi * i / n), z) for i in range(n)]


def extruded(outline: Sequence[tuple[float, float]], width: float) -> Model:
    """An outline (x, z), as seen from the side, with n-gons on both sides."""
    return joined([loft([[(x, y, z) for x, z in outline] for y in (0.0, width)], capped=True)])


def chair() -> Model:
    legs = [box((0.1, 0.1, 0.5), (x, y, 0)) for x in (0, 0.9) for y in (0, 0.9)]
    return joined([box((1, 1, 0.1), (0, 0, 0.5)), *legs, box((1, 0.1, 0.7), (0, 0.9, 0.6))])


def gear(teeth: int = 16) -> Model:
    n = 4 * teeth
    angles = 2 * np.pi * np.arange(n) / n
    radii = np.where(np.isin(np.arange(n) % 4, (1, 2)), 1.2, 1.0)
    outline = np.c_[radii * np.cos(angles), radii * np.sin(angles)]
    bore = 0.4 * np.c_[np.cos(angles), np.sin(angles)]
    rings = [(bore, 0.0), (outline, 0.0), (outline, 0.5), (bore, 0.5)]
    return joined([loft([[(x, y, z) for x, y in ring] for ring, z in rings], closed=True)])


def triangulated(model: Model) -> Model:
    vertices, faces = model
    return vertices, [[face[0], face[i], face[i + 1]] for face in faces for i in range(1, len(face) - 1)]


def pipe() -> Model:
    return triangulated(joined([loft([circle(24, 0.5, 0.5 * k) for k in range(7)], capped=True)]))


def tube(around: int = 24, rows: int = 1, inner: float = 0.35) -> Model:
    z = np.linspace(0, 2, rows + 1)
    rings = [circle(around, 0.5, each) for each in z] + [circle(around, inner, each) for each in z[::-1]]
    return joined([loft(rings, closed=True)])


def torus(around: int, across: int, ratio: float) -> Model:
    """Of quads, with the radius 1."""
    angles = 2 * np.pi * np.arange(across) / across
    rings = [circle(around, 1 + ratio * np.cos(angle), ratio * np.sin(angle)) for angle in angles]
    return joined([loft(rings, closed=True)])


def beveled_cylinder(
    around: int = 32, height: float = 2, bevel: float = 0.08, segments: int = 2, fans: bool = False, top: float = 1
) -> Model:
    """With the radius 1, below `top` if it tapers; caps of one n-gon each, or of triangles around their centers."""
    arc = np.pi / 2 * np.arange(segments + 1) / segments
    low = [(1 - bevel * (1 - np.sin(t)), bevel * (1 - np.cos(t))) for t in arc]
    rings = [circle(around, r, z) for r, z in low]
    rings += [circle(around, r - 1 + top, height - z) for r, z in low[::-1]]
    vertices, faces = joined([loft(rings, capped=not fans)])
    if fans:
        n = len(vertices)
        ends = [range(around)[::-1], range(n - around, n)]
        faces += [[rim[i - 1], rim[i], n + k] for k, rim in enumerate(ends) for i in range(around)]
        vertices = np.concatenate([vertices, [(0, 0, 0), (0, 0, height)]])
    return vertices, faces


def bent_pipe(around: int = 16, wall: float = 0.1, straight: int = 6, bend: int = 8) -> Model:
    """Two straight parts with a quarter of a bend between them, with walls inside and outside, and rims."""

    def ring(radius: float, k: int) -> np.ndarray:
        angle = np.clip((k - straight) / bend, 0, 1) * np.pi / 2
        outward = np.array([np.cos(angle), 0, np.sin(angle)])
        along = np.array([-np.sin(angle), 0, np.cos(angle)])
        beyond = 0.25 * (min(k - straight, 0) + max(k - straight - bend, 0))
        u, v = np.asarray(circle(around, radius, 0))[:, :2].T
        return 1.2 * outward + beyond * along + u[:, None] * outward + v[:, None] * np.array([0.0, 1.0, 0.0])

    n = 2 * straight + bend + 1
    rings = [ring(0.5, k) for k in range(n)] + [ring(0.5 - wall, k) for k in reversed(range(n))]
    return joined([loft(rings, closed=True)])


def cone(n: int = 24) -> Model:
    base = list(range(n))[::-1]
    return np.array([*circle(n, 1, 0), (0, 0, 2)]), [*([i, (i + 1) % n, n] for i in range(n)), base]


def bolt(n: int = 24) -> Model:
    angles = 2 * np.pi * np.arange(n) / n
    radii = np.cos(np.pi / 6) / np.cos(angles % (np.pi / 3) - np.pi / 6)
    head = np.c_[radii * np.cos(angles), radii * np.sin(angles)]
    shaft = [circle(n, 0.5, 0), circle(n, 0.5, -2), circle(n, 0.42, -2.1)]
    return joined([loft([*([(x, y, z) for x, y in head] for z in (0.7, 0.0)), *shaft], capped=True)])


def stairs(steps: int = 5) -> Model:
    outline = [(0.0, 0.0)]
    for k in range(steps):
        outline += [(0.3 * k, 0.2 * (k + 1)), (0.3 * (k + 1), 0.2 * (k + 1))]
    return extruded([*outline, (0.3 * steps, 0.0)], 1.0)


def frame() -> Model:
    def rectangle(a: float, b: float, z: float) -> Points:
        return [(-a, -b, z), (a, -b, z), (a, b, z), (-a, b, z)]

    return joined(
        [loft([rectangle(*r) for r in ((1, 0.7, 0), (1, 0.7, 0.1), (0.85, 0.55, 0.1), (0.85, 0.55, 0))], True)]
    )


def block(segments: int = 1, bevel: float = 0.06, height: float = 0.5) -> Model:
    """A block of 2 x 1 with two holes through it, its edges above and below beveled."""
    numbers: dict[tuple[float, ...], int] = {}
    faces: list[list[int]] = []

    def quad(*points: tuple[float, float, float]) -> None:
        keys = [tuple(round(float(x), 9) for x in point) for point in points]
        faces.append([numbers.setdefault(key, len(numbers)) for key in keys])

    corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
    square = [
        (a[0] + (b[0] - a[0]) * k / 4, a[1] + (b[1] - a[1]) * k / 4)
        for a, b in zip(corners, [*corners[1:], corners[0]])
        for k in range(4)
    ]
    n = len(square)

    def rim(i: int, side: float, inset: float, z: float) -> tuple[float, float, float]:
        x, y = square[i % n]
        return np.clip(side + x, -1 + inset, 1 - inset), np.clip(y, -0.5 + inset, 0.5 - inset), z

    def hole(i: int, side: float, z: float) -> tuple[float, float, float]:
        angle = np.arctan2(square[i % n][1], square[i % n][0])
        return side + 0.25 * np.cos(angle), 0.25 * np.sin(angle), z

    arc = [s / segments * np.pi / 2 for s in range(segments + 1)]
    low = [(bevel * (1 - np.sin(t)), bevel * (1 - np.cos(t))) for t in arc]
    levels = [*low, *((inset, height - z) for inset, z in low[::-1])]
    for side in (-0.5, 0.5):
        for i in range(n):
            quad(rim(i, side, bevel, height), rim(i + 1, side, bevel, height), hole(i + 1, side, height),
                 hole(i, side, height))  # fmt: skip
            quad(hole(i, side, 0), hole(i + 1, side, 0), rim(i + 1, side, bevel, 0), rim(i, side, bevel, 0))
            quad(hole(i, side, 0), hole(i, side, height), hole(i + 1, side, height), hole(i + 1, side, 0))
            is_inner = all(abs(side + square[k % n][0]) < 1e-9 for k in (i, i + 1))
            for (one, z), (other, above) in zip(levels[:-1], levels[1:]):
                if not is_inner:
                    quad(rim(i, side, one, z), rim(i + 1, side, one, z), rim(i + 1, side, other, above),
                         rim(i, side, other, above))  # fmt: skip
    return np.array(list(numbers)), faces


CAR = (
    *((0, 0.2), (0.1, 0.6), (0.9, 0.75), (1.3, 1.15), (2.3, 1.2)),
    *((2.8, 0.8), (3.4, 0.75), (3.5, 0.25), (3.3, 0.1), (0.2, 0.1)),
)
HARD_SURFACES = {
    "box": HardSurface(lambda: joined([box((1, 1, 1))]), range(1, 2), "one cross"),
    "chair": HardSurface(chair, range(6, 7), "a cross for each of its six boxes"),
    "gear": HardSurface(gear, range(5, 7), "two faces, the teeth as strips no longer than the sheet, the bore"),
    "pipe": HardSurface(pipe, range(3, 4), "two caps, and the side with one straight seam"),
    "tube": HardSurface(tube, range(4, 5), "outside, inside, and a ring at either end"),
    "tube of quads": HardSurface(lambda: tube(32, 8, 0.45), range(4, 5), "the same"),
    "cone": HardSurface(cone, range(2, 3), "the base, and the side with one slit"),
    "bolt": HardSurface(
        bolt, range(3, 7), "head, shaft and what is below them; the sides of the head hang on its faces"
    ),
    "stairs": HardSurface(stairs, range(1, 4), "treads and risers as one strip, sides on it or apart"),
    "picture frame": HardSurface(frame, range(1, 5), "front and back whole, with the narrow sides on them or apart"),
    "block": HardSurface(block, range(3, 6), "a net with its bevels, and a strip for each hole"),
    "rounded block": HardSurface(lambda: block(3), range(3, 6), "the same with three segments to a bevel"),
    "car body": HardSurface(
        lambda: extruded(CAR, 1.4), range(1, 4), "roof to floor as one strip, sides on it or apart"
    ),
}
