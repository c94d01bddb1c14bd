"""Polygons with holes: their outlines run along bridges from hole to hole, there and back."""

import numpy as np


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def area_of(points):
    return 0.5 * cross(points, np.roll(points, -1, axis=0)).sum()


def crosses(a, b, starts, ends):
    """Whether the segment from a to b meets one of others, but for ends that they share."""
    shares = (starts == a).all(1) | (starts == b).all(1) | (ends == a).all(1) | (ends == b).all(1)
    sides = [cross(b - a, starts - a), cross(b - a, ends - a), cross(ends - starts, a - starts)]
    sides.append(cross(ends - starts, b - starts))
    # Clear of others: what touches up to rounding may cross.
    sides = [np.where(np.abs(side) < 1e-3, 0, side) for side in sides]
    in_line = (sides[0] == 0) & (sides[1] == 0)
    return bool(((sides[0] * sides[1] <= 0) & (sides[2] * sides[3] <= 0) & (~shares | in_line)).any())


def lies_between(points, corner, target):
    """Whether the direction to `target` leads into the polygon at a corner."""
    here = points[corner]
    after, before = points[(corner + 1) % len(points)] - here, points[corner - 1] - here
    angles = [np.angle(complex(*direction) / complex(*after)) % (2 * np.pi) for direction in (target - here, before)]
    return 0 < angles[0] < angles[1]


def bridged(outer, holes, rng):
    """Return the corners of one polygon, counter-clockwise, (n,), as indices into the points, (V, 2): vertices at the
    ends of bridges come repeatedly. `outer` and `holes` are (k, 2), disjoint, each in either direction."""
    outer = outer if area_of(outer) > 0 else outer[::-1]
    holes = [hole if area_of(hole) < 0 else hole[::-1] for hole in holes]
    points = np.concatenate([outer, *holes])
    starts = np.concatenate([loop for loop in (outer, *holes)])
    ends = np.concatenate([np.roll(loop, -1, axis=0) for loop in (outer, *holes)])
    corners = list(range(len(outer)))
    first = len(outer)
    waiting = []
    for hole in holes:
        waiting.append(list(range(first, first + len(hole))))
        first += len(hole)
    while waiting:
        pairs = [(h, k, c) for h, hole in enumerate(waiting) for k in range(len(hole)) for c in range(len(corners))]
        for index in rng.permutation(len(pairs)):
            h, k, c = pairs[index]
            a, b = points[corners[c]], points[waiting[h][k]]
            if lies_between(points[corners], c, b) and not crosses(a, b, starts, ends):
                break
        else:
            raise AssertionError("no bridge is possible")
        hole = waiting.pop(h)
        corners[c : c + 1] = [corners[c], *hole[k:], *hole[: k + 1], corners[c]]
        starts, ends = np.concatenate([starts, [a]]), np.concatenate([ends, [b]])
    return np.array(corners), points


def around(rng, n, center, radius):
    angles = (np.arange(n) + rng.uniform(-0.3, 0.3, n)) * 2 * np.pi / n + rng.uniform(0, 2)
    lengths = radius * rng.uniform(0.4, 1, n)
    return center + np.stack([lengths * np.cos(angles), lengths * np.sin(angles)], axis=1)


def random_wall(rng):
    """Return (corners, points) as `bridged`, in single precision: a wall with up to nine windows."""
    n = int(rng.integers(3, 10))
    angles = np.arange(n) * 2 * np.pi / n
    rectangle = 5.0 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    outer = (
        rectangle if rng.random() < 0.5 else 7 / np.cos(np.pi / n) * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    )
    cells = rng.permutation(9)[: rng.integers(1, 10)]
    holes = []
    for cell in cells:
        center = np.array([cell % 3, cell // 3]) * 3.0 - 3.0
        if rng.random() < 0.4:
            size = rng.uniform(0.3, 1.3, 2).round(1)
            holes.append(center + size * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]))
        else:
            holes.append(around(rng, int(rng.integers(3, 8)), center, 1.3))
    return bridged(np.float32(outer).astype(float), [np.float32(hole).astype(float) for hole in holes], rng)


def in_space(rng, points, bend=0.0):
    """Return points of the plane, (V, 2), turned at random in space, in single precision, (V, 3)."""
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    lifted = np.column_stack([points, bend * np.sin(points[:, 0])])
    return np.float32(lifted @ turn.T).astype(float)
