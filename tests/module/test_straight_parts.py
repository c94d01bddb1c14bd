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


@pytest.mark.parametrize("make", [rough, square])
def test_parts_that_are_large_enough_are_the_same(make):
    z = make(400)
    every, large = (_straightening._straight_parts(z, 0.05, least) for least in (0.0, LEAST))
    wanted = [part.tolist() for part in every if abs(z[part[-1]] - z[part[0]]) >= LEAST]
    assert [part.tolist() for part in large if abs(z[part[-1]] - z[part[0]]) >= LEAST] == wanted
    assert len(every) > 2 * len(large)


def test_what_is_too_small_is_no_work(monkeypatch):
    n, splits = 20_000, 0

    def counted(values):
        nonlocal splits
        splits += 1
        return int(values.argmax())

    monkeypatch.setattr(_straightening.np, "argmax", counted)
    _straightening._straight_parts(rough(n), 0.05, LEAST)
    # Down to single edges, there would be about as many splits as vertices.
    assert splits < n // 20
