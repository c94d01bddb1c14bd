"""Border chains that are nearly straight become straight, along the axes, where that costs little distortion.

The chains are linear constraints (`Constraints.horizontal` and `vertical`), which the map meets exactly; so a nearly
rectangular island becomes a rectangle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ._constraints import Constraints
from ._measuring import next_corner
from ._quality import face_distortion
from ._results import Unwrap

AUTOMATIC = "auto"
AUTOMATIC_SHARE = 0.02
# Largest distance of a chain from its chord, relative to the chord.
_SAGITTA = 0.05
# Chord over the root of the chart's area from which a chain counts.
_LEAST_CHORD = 0.1
# Of the largest distance from a chord, from which another is equal to it.
_EQUALLY_FAR = 0.999
# A single face may be distorted more than the average by this factor.
_OF_ONE_FACE = 5.0
# Charts whose chains cost too much are tried again with half of the tolerance.
_ATTEMPTS = 3

# Makes the map with these constraints; the numbers are the part of the progress.
Solve = Callable[["Constraints | None", float, float], Unwrap]


@dataclass(frozen=True)
class _Chain:
    """A chain of border corners, nearly along an axis.

    Attributes:
        chart: in which it lies.
        corners: one of each vertex, in order.
        is_row: along u, else along v.
    """

    chart: int
    corners: list[int]
    is_row: bool


def straightened(solve: Solve, share: float) -> Unwrap:
    """Return the map with the constraints that raise the distortion of no chart by more than a share.

    A chart may pay the whole share if its whole border becomes straight, and in proportion for a part of it, so that a
    gear is not skewed for a few of its teeth. Distortion is the mean quasi-conformal distortion, and the energy, which
    sees sizes, too: the symmetric Dirichlet energy sigma_1^2 + sigma_2^2 + sigma_1^-2 + sigma_2^-2, averaged over the
    surface, at the chart's best scale. No chart gets more flipped or overlapping faces, or fewer straight borders;
    failed charts, and those with pins, stay as they are.

    Args:
        solve: see `Solve`.
        share: for example 0.02.
    """
    free = solve(None, 0.0, 0.4)
    energy, straight = _energies(free), _straight_shares(free)
    remaining = (free.charts.column("status") == "solved") & (free.charts.column("n_pins") == 0)
    accepted: list[_Chain] = []
    loops = list(_loops(free))
    for attempt in range(_ATTEMPTS):
        chains = list(_chains(free, loops, remaining, _SAGITTA * 0.5**attempt))
        if not chains:
            break
        trial = solve(_constraints(chains), 0.4 + 0.5 * attempt / _ATTEMPTS, 0.4 + 0.5 * (attempt + 1) / _ATTEMPTS)
        tried = np.zeros(len(remaining), dtype=bool)
        tried[[chain.chart for chain in chains]] = True
        now = _straight_shares(trial)
        good = tried & (trial.charts.column("status") == "solved") & (now > straight)
        compared = [(energy, _energies(trial), 1.0)]
        for column, factor in (("mean_qc", 1.0), ("max_qc", _OF_ONE_FACE)):
            compared.append((free.charts.column(column), trial.charts.column(column), factor))
        # Any share, however large.
        with np.errstate(over="ignore"):
            for before, after, factor in compared:
                good &= after <= (1.0 + factor * share * now) * before
        for defect in ("flipped", "overlapping"):
            good &= trial.charts.column(defect) <= free.charts.column(defect)
        accepted += [chain for chain in chains if good[chain.chart]]
        remaining &= tried & ~good
    return solve(_constraints(accepted), 0.9, 1.0) if accepted else free


def _constraints(chains: list[_Chain]) -> Constraints:
    return Constraints(
        horizontal=[chain.corners for chain in chains if chain.is_row],
        vertical=[chain.corners for chain in chains if not chain.is_row],
        of="corners",
    )


def _energies(result: Unwrap) -> npt.NDArray[np.float64]:
    """Return the energy of every chart, (charts,); infinite if a face is collapsed."""
    found = face_distortion(result)
    counted = (result.chart_of_face >= 0) & (found.area > 0.0)
    chart, area = result.chart_of_face[counted], found.area[counted]
    # sigma_1^2 + sigma_2^2 = a m and sigma_1^-2 + sigma_2^-2 = m / a, with a the change of area.
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        m = found.qc[counted] + 1.0 / found.qc[counted]
        a = np.exp2(2.0 * found.log2_scale[counted])
        n = len(result.charts)
        total, stretched, shrunk = (np.bincount(chart, area * each, n) for each in (np.ones_like(m), a * m, m / a))
        energy = 2.0 * np.sqrt(stretched * shrunk) / total
    return np.where(np.isfinite(energy), energy, np.inf)


def _straight_shares(result: Unwrap) -> npt.NDArray[np.float64]:
    """Return for every chart the share of its border that is along an axis, (charts,)."""
    corners, step = border_edges(result)
    chart, n = _chart_of_corner(result)[corners], len(result.charts)
    length = np.abs(step)
    along = np.bincount(chart, length * is_along_axis(step), n)
    return along / np.maximum(np.bincount(chart, length, n), np.finfo(float).tiny)


def border_edges(result: Unwrap) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.complex128]]:
    """Return the corners from which border edges of charts go, (B,), and these edges in the map, (B,) complex."""
    following = next_corner(result.face_offsets)
    start = result.vertex_of_corner.astype(np.int64)
    end = start[following]
    n = int(start.max(initial=-1)) + 1
    corners = np.flatnonzero((_chart_of_corner(result) >= 0) & ~np.isin(start * n + end, end * n + start))
    z = result.uv[:, 0] + 1j * result.uv[:, 1]
    return corners, z[following[corners]] - z[corners]


def is_along_axis(step: npt.NDArray[np.complex128]) -> npt.NDArray[np.bool_]:
    """Return whether edges in a map, (n,) complex, are within two degrees of an axis, (n,)."""
    return np.minimum(np.abs(step.real), np.abs(step.imag)) <= np.sin(np.radians(2.0)) * np.abs(step)


def _chart_of_corner(result: Unwrap) -> npt.NDArray[np.int64]:
    return np.repeat(result.chart_of_face.astype(np.int64), np.diff(result.face_offsets))


def _loops(result: Unwrap) -> Iterator[tuple[int, npt.NDArray[np.int64]]]:
    """Yield the closed border loops: the chart of each and its corners, one of each vertex, in order."""
    corners, _ = border_edges(result)
    chart = _chart_of_corner(result)[corners]
    start = result.vertex_of_corner[corners]
    end = result.vertex_of_corner[next_corner(result.face_offsets)[corners]]
    # Border vertices of a chart are on one loop, once.
    at = dict(zip(start.tolist(), range(len(corners))))
    is_used = np.zeros(len(corners), dtype=bool)
    for first in range(len(corners)):
        loop: list[int] = []
        edge: int | None = first
        while edge is not None and not is_used[edge]:
            is_used[edge] = True
            loop.append(edge)
            edge = at.get(int(end[edge]))
        if len(loop) > 2 and edge == first:
            yield int(chart[first]), corners[loop]


def _chains(
    result: Unwrap, loops: list[tuple[int, npt.NDArray[np.int64]]], counted: npt.NDArray[np.bool_], sagitta: float
) -> Iterator[_Chain]:
    """Yield the chains of the `loops` of counted charts that lie nearly along the axes of their chart.

    The axes are those of the mean of the chords' directions, by their lengths, where directions a quarter turn apart
    are the same. A chain leans as little as the ends of an arc with this sagitta lean from its chord; and each of its
    edges less than a quarter of the turns at its ends, forward or back, so that a polygon that stands for a circle
    stays round, and a slit open.
    """
    least = _LEAST_CHORD * np.sqrt(np.maximum(result.charts.column("image_area"), 0.0))
    loops = [(chart, corners) for chart, corners in loops if counted[chart] and least[chart] > 0.0]
    if not loops:
        return
    sizes = np.array([len(corners) for _, corners in loops])
    # Every border twice, so that a part is a range of it.
    corner = np.concatenate([np.tile(corners, 2) for _, corners in loops])
    begin = 2 * (np.cumsum(sizes) - sizes)
    z = result.uv[corner, 0] + 1j * result.uv[corner, 1]
    following = np.arange(1, len(z) + 1)
    following[begin + 2 * sizes - 1] = begin
    step = z[following] - z
    # Of each edge from the one before it; both sides of a slit on one line would close it.
    turn = np.empty(len(z))
    turn[following] = np.abs(np.angle(step[following] * np.conj(step)))
    turn = np.minimum(turn, np.pi - turn)

    chart_of_loop = np.array([chart for chart, _ in loops])
    loop, low, high = _straight_parts(z, begin, sagitta, least[chart_of_loop])
    if not len(loop):
        return
    chart, chord = chart_of_loop[loop], z[high] - z[low]
    fourth = np.abs(chord) * (chord / np.abs(chord)) ** 4
    axis = np.angle(np.bincount(chart, fourth.real) + 1j * np.bincount(chart, fourth.imag))[chart] / 4.0
    quarter = np.rint((np.angle(chord) - axis) / (np.pi / 2))
    to_axis = np.exp(-1j * (axis + quarter * (np.pi / 2)))
    edge, part, starts = _ranges(low, high - low)
    lean = np.maximum.reduceat(np.abs(np.angle(step[edge] * to_axis[part])), starts)
    is_along = np.abs(np.angle(chord * to_axis)) <= 4.0 * sagitta
    for each in np.flatnonzero(is_along & (lean <= 0.25 * np.minimum(turn[low], turn[high]))):
        yield _Chain(int(chart[each]), corner[low[each] : high[each] + 1].tolist(), is_row=bool(quarter[each] % 2 == 0))


def _straight_parts(
    z: npt.NDArray[np.complex128],
    begin: npt.NDArray[np.int64],
    sagitta: float,
    least: npt.NDArray[np.float64],
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Split closed polygons where they are farthest from the chord (Douglas and Peucker 1973), all of them at once.

    Of places that are equally far, as the tips of teeth are, the one in the middle splits: the parts are halved then.

    Args:
        z: the polygons one after the other, each of them twice.
        begin: where each begins, (P,).
        sagitta: largest distance of a part from its chord, relative to the chord.
        least: length of a chord that counts, of each polygon, (P,).

    Returns:
        the polygon of each part, in their order, and its first and last place in `z`.
    """
    ranges = []
    for start, end in zip(begin.tolist(), [*begin[1:].tolist(), len(z)]):
        once = z[start : (start + end) // 2]
        far = int(np.argmax(np.abs(once - once.mean())))
        low, high = sorted((far, int(np.argmax(np.abs(once - once[far])))))
        ranges += [(start + low, start + high), (start + high, start + low + len(once))]
    loop = np.repeat(np.arange(len(begin)), 2)
    low, high = np.array(ranges, dtype=np.int64).reshape(-1, 2).T
    found = [(loop[:0], low[:0], high[:0])]
    while len(loop):
        vertex, part, starts = _ranges(low, high - low + 1)
        off, chord = z[vertex] - z[low][part], z[high] - z[low]
        length = np.abs(chord)
        width, height = (np.maximum.reduceat(x, starts) - np.minimum.reduceat(x, starts) for x in (off.real, off.imag))
        # From the line, or for a chord of length zero from its point.
        along = np.conj(chord) / np.where(length > 0.0, length, 1.0)
        away = np.where(length[part] > 0.0, np.abs((along[part] * off).imag), np.abs(off))
        most = np.maximum.reduceat(away, starts)
        is_straight = most <= sagitta * length
        counts = is_straight & (length >= least[loop])
        found.append((loop[counts], low[counts], high[counts]))
        # Of a rough border, most of the parts are too small.
        splits = ~is_straight & (np.hypot(width, height) >= least[loop])
        is_far = away >= _EQUALLY_FAR * most[part]
        from_middle = np.where(is_far, np.abs(2 * vertex - (low + high)[part]), 2 * len(z))
        places = np.flatnonzero(from_middle == np.minimum.reduceat(from_middle, starts)[part])
        middle = vertex[places[np.searchsorted(part[places], np.arange(len(low)))]]
        loop = np.repeat(loop[splits], 2)
        low, high = (np.stack(ends, axis=1)[splits].ravel() for ends in ((low, middle), (middle, high)))
    loop, low, high = (np.concatenate(each) for each in zip(*found))
    order = np.argsort(low, kind="stable")
    return loop[order], low[order], high[order]


def _ranges(
    low: npt.NDArray[np.int64], counts: npt.NDArray[np.int64]
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return ranges of integers one after the other: the integers, the range of each, and where each range starts."""
    starts = np.cumsum(counts) - counts
    owner = np.repeat(np.arange(len(low)), counts)
    return np.arange(len(owner)) + (low - starts)[owner], owner, starts
