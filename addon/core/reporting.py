# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operator tells the user: counts and distortion of the solved islands, reasons of the failed ones.

Blender calls a chart an island; so do these sentences.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .map_defects import Defects
from .map_quality import MapQuality
from .unwrapping import Solution

# Blender's own sentence where use_subsurf_data has no effect.
NO_LEADING_SUBSURF = "Subdivision Surface modifier needs to be first to work with unwrap"
NO_ACTIVE_EDGE = "Nothing was stretched: there is no active edge; click the edge along which to stretch last"
ADJUSTED_WITHOUT_SUBSURF = (
    "Adjusting looks at the mesh without its Subdivision Surface modifier; unwrap again to heed it"
)
NO_DEFECT_CHOSEN = "Nothing to look for: turn on Flipped or Overlapping"
NO_UV_MAP = "There is no UV map to look at; unwrap first"
# Differences of scale that Blender's own Unwrap passes over.
_EVEN_SCALE = 1e-4
_PINNED_METHODS = {"lscm": "pinned least squares (LSCM)", "spectral": "the spectral method, pins attracting softly"}


@dataclass(frozen=True)
class Summary:
    """Totals over all charts of all meshes.

    Attributes:
        solved: number of solved charts.
        mean_qc: quasi-conformal distortion averaged over the solved area, 1 where angles are kept.
        max_qc: largest quasi-conformal distortion of a triangle.
        flipped: number of faces with a flipped triangle.
        overlapping: number of faces that cover others of their chart.
        unfolded: number of folded triangles that were unfolded on request.
        embedded: number of charts whose map was replaced by an embedding on request.
        mean_qc_change: mean QC of the charts of both kinds that had a map, before and after; None where there are none.
        failures: how many charts failed for each reason.
        remedies: how many charts were solved after each repair or change of method.
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
    remedies: Counter[str]
    pinned: Counter[str]
    refused: tuple[str, ...]

    @property
    def failed(self) -> int:
        """Number of failed charts."""
        return sum(self.failures.values())


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
        remedies=Counter(chart.message for chart in solved if chart.message and not _is_unfolded(chart)),
        pinned=Counter(chart.method for chart in solved if chart.n_pins > 1),
        refused=tuple(f"{name}: {solution.error}" for solution, name in zip(solutions, names) if solution.error),
    )


def information(summary: Summary, seconds: float, where_to_see: str) -> str:
    """Return the sentence for a call that solved at least one chart.

    `seconds` is the whole operator's time; `where_to_see` the label of what selects flipped and overlapping faces.
    """
    defects = _count(summary.flipped, "flipped face")
    if summary.overlapping:
        defects += f", {_count(summary.overlapping, 'overlapping face')}"
    if summary.flipped or summary.overlapping:
        defects += f" (see {where_to_see})"
    return (
        f"Unwrapped {_count(summary.solved, 'island')}: mean QC {_qc(summary.mean_qc)}, "
        f"maximum QC {_qc(summary.max_qc)}, {defects}, {seconds:.2f} s"
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


def unfolded(summary: Summary) -> str:
    """Return what was unfolded on request and what it cost; empty if nothing was."""
    parts = []
    if summary.unfolded:
        parts.append(f"{_count(summary.unfolded, 'folded triangle')} unfolded")
    if summary.embedded:
        parts.append(f"{_count(summary.embedded, 'island')} replaced by an embedding, relaxed without folding it")
    if not parts:
        return ""
    cost = ""
    if summary.mean_qc_change is not None:
        before, after = summary.mean_qc_change
        cost = f"; mean QC of these islands {_qc(before)} before, {_qc(after)} after"
    return f"Fold-free: {', '.join(parts)}{cost}"


def too_small(faces: int) -> str:
    """Return the warning for faces that Blender's single precision cannot hold; empty for none."""
    if not faces:
        return ""
    return (
        f"{_count(faces, 'face')} {'shrinks' if faces == 1 else 'shrink'} below what Blender's UV coordinates resolve; "
        "add seams that make the island flatter, or raise Angle to Area"
    )


def failures(summary: Summary) -> str:
    """Return why charts or whole meshes were left as they were; empty if none was."""
    parts = []
    if summary.failed:
        total = summary.solved + summary.failed
        parts.append(
            f"{summary.failed} of {_count(total, 'island')} failed, UVs unchanged: {_grouped(summary.failures)}"
        )
    if summary.refused:
        parts.append(f"Not unwrapped: {'; '.join(summary.refused)}")
    return ". ".join(parts)


def remedies(summary: Summary) -> str:
    """Return what was repaired or done differently to solve some charts; empty if nothing was."""
    if not summary.remedies:
        return ""
    return f"{_count(sum(summary.remedies.values()), 'island')} needed a remedy: {_grouped(summary.remedies)}"


def pinned(summary: Summary) -> str:
    """Return how charts with two or more pins were solved; empty if there were none."""
    ways = Counter({_PINNED_METHODS.get(method, method): count for method, count in summary.pinned.items()})
    return f"{_count(sum(summary.pinned.values()), 'island')} with pins: solved by {_grouped(ways)}" if ways else ""


def object_scale(scales: Sequence[tuple[float, float, float]], negative: Sequence[bool]) -> str:
    """Return Blender's own sentence about the first object whose scale along its axes is uneven or negative."""
    for (x, y, z), is_negative in zip(scales, negative):
        if abs(x - y) >= _EVEN_SCALE or abs(y - z) >= _EVEN_SCALE:
            return "Object has non-uniform scale, unwrap will operate on a non-scaled version of the mesh"
        if is_negative:
            return "Object has negative scale, unwrap will operate on a non-flipped version of the mesh"
    return ""


def broken_extenders(names: Sequence[str]) -> str:
    """Return the sentence for extenders that lack a vertex; empty for none."""
    if not names:
        return ""
    return f"Skipped {_count(len(names), 'extender')} whose vertex is gone: {', '.join(names)}"


def extenders_without_strength(names: Sequence[str]) -> str:
    """Return the sentence for extenders whose strength is no number within its limit; empty for none."""
    if not names:
        return ""
    return f"Skipped {_count(len(names), 'extender')} whose strength is no number that it can have: {', '.join(names)}"


def unused_extenders(count: int) -> str:
    """Return the sentence for extenders that no island could use; empty for none."""
    if count == 0:
        return ""
    return (
        f"{_count(count, 'extender')} had no effect: both vertices must lie in one unwrapped island, "
        "which pins must not hold"
    )


def count_failed(solutions: Sequence[Solution]) -> tuple[int, int]:
    """Return the numbers of failed charts and of their faces; a mesh refused as a whole counts as one chart."""
    charts = sum(chart.status != "solved" for solution in solutions for chart in solution.charts)
    faces = sum(int(solution.failed_faces.sum()) for solution in solutions)
    return charts + sum(bool(solution.error) for solution in solutions), faces


def selected_failed(islands: int, faces: int) -> str:
    """Return what Select Failed Islands says."""
    if faces == 0:
        return "No islands failed, selection unchanged"
    return f"Selected {_count(faces, 'face')} of {_count(islands, 'failed island')}"


def selected_defects(defects: Sequence[Defects], flipped: bool, overlapping: bool) -> str:
    """Return what Select Flipped and Overlapping says of the defects of each mesh, given which kinds were chosen."""
    kinds = [
        ("flipped", sum(int(found.flipped.sum()) for found in defects) if flipped else 0),
        ("overlapping", sum(int(found.overlapping.sum()) for found in defects) if overlapping else 0),
        ("with UVs that are not finite", sum(int(found.not_finite.sum()) for found in defects)),
    ]
    total = sum(int(found.chosen(flipped, overlapping).sum()) for found in defects)
    if total == 0:
        wanted = " or ".join(
            name for name, is_wanted in (("flipped", flipped), ("overlapping", overlapping)) if is_wanted
        )
        return f"No {wanted} faces, selection unchanged"
    counts = ", ".join(f"{count} {name}" for name, count in kinds if count)
    return f"Selected {_count(total, 'face')}: {counts}"


def marked(count: int, length: str) -> str:
    """Return what Suggest Seams says once `count` cuts are marked, of a length that is given with its unit."""
    return f"Marked {_count(count, 'cut')} of length {length}"


def nothing_to_suggest(is_limited: bool) -> str:
    """Return the sentence for no suggested seams; `is_limited` where the user gave a greatest length."""
    reasons = "the islands are even enough already, or no cut makes them better"
    return f"No seams to suggest: {reasons}{', or none within the length' if is_limited else ''}"


def without_suggestion(errors: Sequence[str], names: Sequence[str]) -> str:
    """Return why meshes got no suggestion, given one text for each, empty where there is nothing to tell."""
    refused = [f"{name}: {error.rstrip('.')}" for name, error in zip(names, errors) if error]
    return f"No seams suggested for {'; '.join(refused)}" if refused else ""


def preview(count: int, total: int, length: str, total_length: str) -> str:
    """Return which of the suggested cuts are shown, with lengths that are given with their unit."""
    if count == total:
        return f"{_count(total, 'cut')}, length {length}"
    return f"{count} of {_count(total, 'cut')}, length {length} of {total_length}"


def expected(before: MapQuality, after: MapQuality, factor: float) -> str:
    """Return what the cuts shown would make of the map; `factor` is that by which the scale may differ."""
    even = f"{_percent(after.even)} of the surface within {factor:.3g} times the median scale"
    qc = f", mean QC {_qc(after.mean_qc)}" if after.mean_qc == after.mean_qc else ""
    now = _percent(before.even) + (f", QC {_qc(before.mean_qc)}" if before.mean_qc == before.mean_qc else "")
    return f"{even}{qc} (now {now})"


def _percent(part: float) -> str:
    # Rounded down, so that only the whole is 100 %.
    return f"{int(100.0 * part + 1e-9)} %"


def without_bounds(count: int) -> str:
    """Return the sentence for `count` charts that could not be kept in place; empty for none."""
    if count == 0:
        return ""
    return f"{_count(count, 'island')} had no UV bounds to keep and were laid out side by side in the unit square"


def _grouped(messages: Counter[str]) -> str:
    """Join the messages, each with its number if there are several."""
    return "; ".join(
        message.rstrip(".") if len(messages) == 1 else f"{count}: {message.rstrip('.')}"
        for message, count in messages.most_common()
    )


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _qc(value: float) -> str:
    return f"{value:.4f}" if value < 100.0 else f"{value:.3g}"
