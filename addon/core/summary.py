# SPDX-License-Identifier: GPL-3.0-or-later
"""Totals over the charts of several meshes."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .solve import Solution


@dataclass(frozen=True)
class Summary:
    """Totals over all charts of all meshes.

    Attributes:
        solved: number of solved charts.
        mean_qc: quasi-conformal distortion averaged over the solved area, 1 where angles are kept.
        max_qc: largest quasi-conformal distortion of a face.
        flipped: number of faces with a flipped triangle.
        overlapping: number of faces that cover others of their chart.
        unfolded: number of flipped triangles that were unfolded on request.
        embedded: number of charts whose map was replaced by an embedding on request.
        mean_qc_change: mean QC of the charts of both kinds that had a map, before and after; None where there are none.
        failures: how many charts failed for each reason.
        repairs: how many charts were solved after each repair or fallback.
        pinned: how many charts with two or more pins were solved by each method.
        refused: why meshes were refused as a whole, one "name: reason" each.
    """

    solved: int
    mean_qc: float
    max_qc: float
    flipped: int
    overlapping: int
    unfolded: int
    embedded: int
    mean_qc_change: tuple[float, float] | None
    failures: Counter[str]
    repairs: Counter[str]
    pinned: Counter[str]
    refused: tuple[str, ...]

    @property
    def failed(self) -> int:
        """Number of failed charts."""
        return sum(self.failures.values())

    @property
    def lacks_seams(self) -> bool:
        """Whether charts failed that seams would cut open, as the solver's reasons say in these words."""
        return any({"mark", "seams"} <= set(reason.lower().split()) for reason in self.failures)


def summarize(solutions: Sequence[Solution], names: Sequence[str]) -> Summary:
    """Add up the charts of all meshes; `names` are those of the meshes' objects, in the same order."""
    charts = [chart for solution in solutions for chart in solution.charts]
    solved = [chart for chart in charts if chart.status == "solved"]
    area = sum(chart.area for chart in solved)
    changed = [chart for chart in solved if _is_unfolded(chart)]
    return Summary(
        solved=len(solved),
        mean_qc=sum(chart.mean_qc * (chart.area / area) for chart in solved) if area > 0.0 else float("nan"),
        max_qc=max((chart.max_qc for chart in solved), default=float("nan")),
        flipped=sum(chart.flipped for chart in solved),
        overlapping=sum(chart.overlapping for chart in solved),
        unfolded=sum(chart.unfolded for chart in changed),
        embedded=sum(chart.is_embedding for chart in changed),
        mean_qc_change=_mean_qc_change(changed),
        failures=Counter(chart.message for chart in charts if chart.status != "solved"),
        # What unfolding did has a sentence of its own, with numbers that differ from chart to chart.
        repairs=Counter(chart.message for chart in solved if chart.message and not _is_unfolded(chart)),
        pinned=Counter(chart.method for chart in solved if chart.n_pins > 1),
        refused=tuple(f"{name}: {solution.error}" for solution, name in zip(solutions, names) if solution.error),
    )


def _is_unfolded(chart: Any) -> bool:  # noqa: ANN401 - a chart of the native module, which core does not import
    return bool(chart.unfolded or chart.is_embedding) and not chart.flipped


def _mean_qc_change(charts: Sequence[Any]) -> tuple[float, float] | None:
    """Return the mean QC before and after unfolding, weighted by area, of the charts that had a map before."""
    mapped = [chart for chart in charts if not np.isnan(chart.mean_qc_before)]
    area = sum(chart.area for chart in mapped)
    if not area > 0.0:
        return None
    return tuple(
        sum(value(chart) * (chart.area / area) for chart in mapped)
        for value in (lambda chart: chart.mean_qc_before, lambda chart: chart.mean_qc)
    )
