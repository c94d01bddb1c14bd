# SPDX-License-Identifier: GPL-3.0-or-later
"""How evenly a push acts over its slider, and how close a pull can bring the two vertices.

    build/venv/bin/python -m tests.benchmarks.extender_response

Measures pairs on the border and inside of several surfaces. Columns:

- the strength with half the effect of an infinite one, measured and by the add-on's formula;
- the share of the whole effect that is reached in the first fifth of the slider, for a slider of strengths from 0 to 10
  and for one of amounts;
- the smallest distance that a pull reaches without flipped triangles, relative to the distance without a pull, and the
  amount of that pull.
"""

import numpy as np
import spectral_conformal

from addon.core.extenders.pairs import STRENGTH_LIMIT, half_strengths, strength_of
from addon.core.mesh.polygon_mesh import PolygonMesh


def surface(columns, rows, height):
    """A grid of triangles over a rectangle of height 1, with a height at every point."""
    x, y = np.meshgrid(np.linspace(0.0, columns / rows, columns + 1), np.linspace(0.0, 1.0, rows + 1))
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    up = columns + 1
    triangles = np.concatenate([np.c_[first, first + 1, first + up + 1], np.c_[first, first + up + 1, first + up]])
    return np.stack([x, y, height(x, y)], axis=-1).reshape(-1, 3), triangles


SURFACES = {
    "hill": (24, 24, lambda x, y: 0.8 * np.exp(-20.0 * ((x - 0.5) ** 2 + (y - 0.5) ** 2))),
    "waves": (24, 16, lambda x, y: 0.2 * np.sin(7.0 * x) * np.cos(5.0 * y)),
    "saddle": (24, 24, lambda x, y: 0.8 * ((x - 0.5) ** 2 - (y - 0.5) ** 2)),
}


def pairs(columns, rows):
    middle = (columns + 1) * (rows // 2)
    return {
        "corners": (0, (columns + 1) * (rows + 1) - 1),
        "sides": (middle, middle + columns),
        "inside": (middle + columns // 4, middle + 3 * columns // 4),
    }


def distance(solver, mesh, pair, strength):
    """The distance of a pair in the map; None where there is no map without flipped triangles."""
    try:
        found = solver.solve(extenders=[(*pair, strength)] if strength else ())
    except spectral_conformal.SolveError:
        return None
    is_flipped = spectral_conformal.distortion(*mesh, found.uv).flipped.any()
    return None if strength < 0.0 and is_flipped else float(np.linalg.norm(found.uv[pair[0]] - found.uv[pair[1]]))


def half_of(mesh, uv, pair):
    """The half strength of a pair by the formula of the add-on, from its map."""
    vertices, triangles = mesh
    polygons = PolygonMesh(
        vertices,
        np.arange(0, triangles.size + 1, 3),
        triangles.ravel(),
        np.zeros((0, 2), int),
        np.ones(len(triangles), bool),
        uv[triangles.ravel()],
    )
    return half_strengths(polygons, [pair])[0]


def measured(mesh, pair):
    """Return both half strengths, both parts below a fifth, the smallest distance and its amount."""
    solver = spectral_conformal.Solver(*mesh)
    half = half_of(mesh, solver.solve().uv, pair)
    start, most = (distance(solver, mesh, pair, strength) for strength in (0.0, STRENGTH_LIMIT))
    low, high = 1e-4, 1e4
    for _ in range(30):
        middle = (low * high) ** 0.5
        is_less = distance(solver, mesh, pair, middle) - start < 0.5 * (most - start)
        low, high = (middle, high) if is_less else (low, middle)
    former = [distance(solver, mesh, pair, strength) - start for strength in (2.0, 10.0)]
    now = [distance(solver, mesh, pair, strength_of(amount, half)) - start for amount in (20.0, 100.0)]
    pulled, amount = 1.0, 0
    for percent in range(-2, -101, -2):
        found = distance(solver, mesh, pair, strength_of(percent, half))
        if found is None:
            break
        pulled, amount = found / start, percent
    return high, half, former[0] / former[1], now[0] / now[1], pulled, amount


def main():
    print(f"{'surface':9}{'pair':9}{'half at':>9}{'formula':>9}{'strength':>10}{'amount':>8}{'pulled to':>11}{'at':>7}")
    for name, (columns, rows, height) in SURFACES.items():
        mesh = surface(columns, rows, height)
        for label, pair in pairs(columns, rows).items():
            half, formula, former, now, pulled, amount = measured(mesh, pair)
            print(f"{name:9}{label:9}{half:9.2f}{formula:9.2f}{former:10.0%}{now:8.0%}{pulled:11.0%}{amount:6d}%")


if __name__ == "__main__":
    main()
