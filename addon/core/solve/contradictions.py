# SPDX-License-Identifier: GPL-3.0-or-later
"""The edges at which constraints contradict each other, from the steps of failed charts."""

import itertools

import numpy as np

from .solution import Solution

_REASONS = {"constraints_join_vertices", "constraints_flatten_triangle"}


def contradicting_edges(solution: Solution) -> list[tuple[int, int]]:
    """Return, sorted, the edges left without extent and the sides of triangles left without area, by their vertices."""
    found = set()
    charts = solution.failed_islands[solution.failed_islands >= 0]
    for chart in np.unique(charts).tolist() if len(solution.charts) else ():
        for step in solution.charts[chart].steps:
            if step.reason in _REASONS:
                vertices = [step.count, step.index]
                vertices += [step.limit] if step.reason == "constraints_flatten_triangle" else []
                found |= {(min(ends), max(ends)) for ends in itertools.combinations(vertices, 2)}
    return sorted(found)
