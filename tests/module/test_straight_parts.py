# SPDX-License-Identifier: GPL-3.0-or-later
"""The nearly straight parts of a border: small ones, which no chain uses, are not looked for."""

import numpy as np
import pytest
from spectral_conformal import _straightening

LEAST = 0.2


def rough(n):
    """Return a circle of n vertices, no two edges of which go the same way."""
    radius = 1.0 + 0.05 * np.random.default_rng(1).random(n)
    return radius * np.exp(2j * np.pi * np.arange(n) / n)


def square(n):
    """Return a square of n edges, one side of which has teeth."""
    side = np.linspace(0.0, 1.0, n // 4, endpoint=False)
    teeth = side + 0.1j * (np.arange(len(side)) % 2)
    return np.concatenate([teeth, 1.0 + 1j * side, 1.0 + 1j - side, 1j - 1j * side])


def comb(n):
    """Return a comb of n vertices, whose teeth are all as long."""
    teeth = np.repeat(np.linspace(0.0, 1.0, n // 2), 2)[:-2] + 2j * np.tile([0, 1, 1, 0], n // 4)[: n - 2]
    return np.concatenate([teeth, [1.0 - 1j, -1j]])


def parts(polygons, least):
    """Return the straight parts of each polygon, as its vertices in order."""
    begin = np.cumsum([0, *(2 * len(z) for z in polygons)])
    z = np.concatenate([np.tile(z, 2) for z in polygons])
    found = [[] for _ in polygons]
    for which, low, high in zip(*_straightening._straight_parts(z, begin[:-1], 0.05, np.full(len(polygons), least))):
        found[which].append(((np.arange(low, high + 1) - begin[which]) % len(polygons[which])).tolist())
    return found


@pytest.mark.parametrize("make", [rough, square, comb])
def test_parts_that_are_large_enough_are_the_same(make):
    z = make(400)
    (every,), (large,) = parts([z], 0.0), parts([z], LEAST)
    assert large == [part for part in every if abs(z[part[-1]] - z[part[0]]) >= LEAST]


def test_polygons_are_split_alone():
    polygons = [rough(100), square(80), np.zeros(5, dtype=complex), comb(60)]
    found = parts(polygons, LEAST)
    assert found == [parts([z], LEAST)[0] for z in polygons]
    # The sides of the square without teeth.
    assert (len(found[1]), len(found[2])) == (3, 0)


def work(monkeypatch, z, least):
    """Return how many vertices are looked at, by what is repeated for them."""
    repeat, total = np.repeat, 0

    def counted(values, counts):
        nonlocal total
        result = repeat(values, counts)
        total += len(result)
        return result

    with monkeypatch.context() as context:
        context.setattr(_straightening.np, "repeat", counted)
        parts([z], least)
    return total


def test_what_is_too_small_is_no_work(monkeypatch):
    z = rough(20_000)
    assert work(monkeypatch, z, LEAST) < 0.7 * work(monkeypatch, z, 0.0)


def test_teeth_of_one_length_are_halved(monkeypatch):
    # From one end, half of the vertices would be looked at for every tooth.
    assert work(monkeypatch, comb(20_000), LEAST) < 2 * np.log2(20_000) * 20_000
