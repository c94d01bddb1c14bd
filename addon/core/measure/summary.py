# SPDX-License-Identifier: GPL-3.0-or-later
"""Totals over the charts of several meshes."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .. import native
from ..mesh.polygon_mesh import PolygonMesh
from ..solve.chart_records import ChartsOfAll
from ..solve.solution import Solution, charts_of
from ..words import texts
from ..words.translation import translate

# The angles of a face are off by 100 %: squares of a texture become rectangles of twice their width, which is obvious
# however good the average is.
STRAINED_QC = 2.0
# Reasons for which the solver rejects charts that more seams would cut open.
_LACK_OF_SEAMS = {"closed", "handles", "border_of_two"}


@dataclass(frozen=True)
class Summary:
    """Totals over all charts of all meshes.

    Attributes:
        solved: number of solved charts.
        mean_qc: quasi-conformal distortion averaged over the solved area, 1 where angles are kept.
        max_qc: largest quasi-conformal distortion of a face.
        flipped: number of faces with a flipped triangle.
        overlapping: number of faces that overlap others of their chart.
        unfolded: number of flipped triangles that were unfolded on request.
        embedded: number of charts whose map was replaced by an embedding on request.
        mean_qc_change: mean QC of the charts of both kinds that had a map, before and after; None where there are none.
        failures: how many charts failed for each reason. Of reasons that differ only in their numbers, such as those of
            vertices, the first one stands for all.
        repairs: how many charts were solved after each repair or fallback, counted in the same way.
        pinned: how many charts whose pins bend them were solved by each method.
        refused: why meshes were refused as a whole, one "name: reason" each.
        lacks_seams: whether charts failed for lack of seams.
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
    lacks_seams: bool = False

    @property
    def failed(self) -> int:
        """Number of failed charts."""
        return sum(self.failures.values())


def mean_qc(charts: ChartsOfAll) -> float:
    """Return the quasi-conformal distortion averaged over the surface of all solved charts; NaN where there is none.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    qc, area = (charts.column(name)[charts.solved] for name in ("mean_qc", "area"))
    return native.measuring().area_mean(qc, area)


class Strain(NamedTuple):
    """How many solved faces are distorted beyond STRAINED_QC, and the quasi-conformal distortion of the worst one."""

    faces: int
    max_qc: float


class Unevenness(NamedTuple):
    """How many solved charts vary in size visibly, and the deviation of the worst one."""

    charts: int
    deviation: float


def unevenness(charts: ChartsOfAll) -> Unevenness:
    """Return the unevenness of the solved charts.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    uneven = native.measuring().uneven(charts.column("scale_deviation")[charts.solved])
    return Unevenness(len(uneven), max(uneven.tolist(), default=0.0))


def strain(meshes: Sequence[PolygonMesh], solutions: Sequence[Solution], charts: ChartsOfAll) -> Strain:
    """Return the strain of the maps of the selected faces of the meshes; `charts` are those of the solutions.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
    """
    faces, worst = 0, 1.0
    # Faces are measured only in meshes with charts whose worst triangle, which is known, is beyond the limit.
    is_beyond = charts.solved & (charts.column("max_qc") > STRAINED_QC)
    if not is_beyond.any():
        return Strain(faces, worst)
    owners = np.repeat(np.arange(len(solutions)), [len(solution.charts) for solution in solutions])
    for k in np.unique(owners[is_beyond]).tolist():
        mesh, solution = meshes[k], solutions[k]
        solved = mesh.selected_faces & solution.solved_corners[mesh.face_offsets[:-1]]
        face_distortion = native.spectral_conformal().face_distortion
        measured = face_distortion(mesh.with_map(solution.uv), selected_faces=solved)
        strained = measured.qc[solved & (measured.area > 0.0) & (measured.qc > STRAINED_QC)]
        faces, worst = faces + len(strained), max([worst, *strained.tolist()])
    return Strain(faces, worst)


def summarize(solutions: Sequence[Solution], names: Sequence[str], charts: ChartsOfAll | None = None) -> Summary:
    """Add up the charts of all meshes, which may be given; `names` are those of the meshes' objects, in this order."""
    charts = charts_of(solutions) if charts is None else charts
    of, solved = charts.column, charts.solved
    unfolded = solved & ((of("unfolded") > 0) | of("is_embedding").astype(bool)) & (of("flipped") == 0)
    # The other methods treat two pins, like one, by a similarity.
    bent_by_pins = (of("n_pins") > 2) | ((of("n_pins") == 2) & (of("method") == "lscm"))
    messages = of("message")
    steps = _steps_of_messages(solutions, messages)
    reasons = {step.reason for message in set(messages[~solved].tolist()) for step in steps[message]}
    return Summary(
        solved=int(np.count_nonzero(solved)),
        mean_qc=mean_qc(charts),
        max_qc=max(of("max_qc")[solved].tolist(), default=float("nan")),
        flipped=sum(of("flipped")[solved].tolist()),
        overlapping=sum(of("overlapping")[solved].tolist()),
        unfolded=sum(of("unfolded")[unfolded].tolist()),
        embedded=sum(of("is_embedding")[unfolded].tolist()),
        mean_qc_change=_mean_qc_change(*(of(name)[unfolded] for name in ("mean_qc_before", "mean_qc", "area"))),
        failures=_counted(messages[~solved].tolist(), steps),
        # Unfolding is reported by a sentence of its own.
        repairs=_counted(filter(None, messages[solved & ~unfolded].tolist()), steps),
        pinned=Counter(of("method")[solved & bent_by_pins].tolist()),
        refused=tuple(
            f"{name}: {translate(solution.error)}" for solution, name in zip(solutions, names) if solution.error
        ),
        lacks_seams=not reasons.isdisjoint(_LACK_OF_SEAMS),
    )


def _steps_of_messages(solutions: Sequence[Solution], messages: np.ndarray) -> dict[str, Sequence[Any]]:
    """Return the solver's steps behind each of the `messages` of all charts; none for messages without steps."""
    steps: dict[str, Sequence[Any]] = {"": ()}
    ends = np.cumsum([len(solution.charts) for solution in solutions])
    for i, message in enumerate(messages.tolist()):
        if message not in steps:
            k = int(np.searchsorted(ends, i, side="right"))
            steps[message] = solutions[k].charts[i - ends[k]].steps
    return steps


def _counted(messages: Iterable[str], steps: dict[str, Sequence[Any]]) -> Counter[str]:
    """Count messages, in the language of the user; those with steps of the same kinds together."""
    describe = native.spectral_conformal().hosts.describe
    alike: dict[object, Counter[str]] = {}
    for message, count in Counter(messages).items():
        kinds = tuple((step.kind, step.reason) for step in steps[message])
        alike.setdefault(kinds or message, Counter())[message] = count
    counts: Counter[str] = Counter()
    for group in alike.values():
        first, count = next(iter(group.items()))
        words = describe(steps[first], translate) or first
        counts[texts.with_similar(words, group.total() - count)] += group.total()
    return counts


def _mean_qc_change(before: np.ndarray, after: np.ndarray, area: np.ndarray) -> tuple[float, float] | None:
    """Return the mean QC by area of the charts that had a map, before and after unfolding."""
    mapped = ~np.isnan(before)
    if not area[mapped].sum() > 0.0:
        return None
    area_mean = native.measuring().area_mean
    return area_mean(before[mapped], area[mapped]), area_mean(after[mapped], area[mapped])
