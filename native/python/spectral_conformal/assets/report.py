"""What a UV map that is there is like, and whether that is good enough."""

from __future__ import annotations

import ast
import operator
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields

import numpy as np

from .._quality import face_distortion, map_defects
from .mesh import AssetMesh

# Of the mean area of a face: faces below have no shape that could be kept.
_DEGENERATE = 1e-10
_COMPARISONS = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}


class RequirementError(ValueError):
    """A requirement cannot be read; the message says why and what it may hold."""


@dataclass(frozen=True)
class MapReport:
    """The map of an asset, all of its meshes together."""

    faces: int
    degenerate: int
    """Faces without area in 3D, which the numbers below but for flips and overlaps leave out."""
    unmapped: int
    """Faces of which a corner has no UV."""
    collapsed: int
    """Mapped faces without area in the map."""
    islands: int
    flips: int
    """Faces that lie the wrong way round in their island."""
    overlaps: int
    """Faces that cover part of another face, of any mesh and island, or share their place with a duplicate."""
    qc_mean: float
    """Quasi-conformal distortion of faces that are neither degenerate nor collapsed, 1 where angles are kept; weighted
    by area. Not a number where there are none, like the next four."""
    qc_p99: float
    """What 99 % of the area does not exceed."""
    qc_max: float
    density_spread: float
    """Standard deviation over mean of the texel density, the root of area in the map over area in the scene, weighted
    by the latter."""
    fill: float
    """Area of the map over the area of all tiles of the texture that it lies in."""


def map_report(meshes: Sequence[AssetMesh]) -> MapReport:
    """Measure the map of an asset; faces without UVs are counted and left out."""
    sizes = np.concatenate([np.diff(mesh.face_offsets) for mesh in meshes])
    offsets = np.append(0, np.cumsum(sizes))
    first = np.append(0, np.cumsum([len(mesh.vertices) for mesh in meshes]))
    corners = np.concatenate([start + mesh.corner_vertices for start, mesh in zip(first, meshes)])
    vertices = np.concatenate([mesh.scale * mesh.vertices for mesh in meshes])
    uv = np.concatenate(
        [
            np.full((len(mesh.corner_vertices), 2), np.nan) if mesh.corner_uv is None else mesh.corner_uv
            for mesh in meshes
        ]
    )
    has_map = np.logical_and.reduceat(np.isfinite(uv).all(axis=1), offsets[:-1])
    uv = np.where(np.repeat(has_map, sizes)[:, None], uv, 0.0)
    found = face_distortion(vertices, offsets, corners, uv, selected_faces=has_map)
    defects = map_defects(offsets, corners, uv, selected_faces=has_map, between_islands=True)
    mapped = np.flatnonzero(has_map)
    area, image = found.area[mapped], np.abs(found.image_area[mapped])
    is_degenerate = area <= _DEGENERATE * area.mean() if len(area) else area > 0
    is_collapsed = ~is_degenerate & ~np.isfinite(found.qc[mapped])
    counted = ~is_degenerate & ~is_collapsed
    qc, weight = found.qc[mapped][counted], area[counted]
    unknown = float("nan")
    mean = largest = p99 = spread = unknown
    if len(qc):
        mean, largest, p99 = float(np.average(qc, weights=weight)), float(qc.max()), _percentile(qc, weight, 0.99)
        density = np.sqrt(image[counted] / weight)
        average = np.average(density, weights=weight)
        spread = float(np.sqrt(np.average((density - average) ** 2, weights=weight)) / average)
    tiles = np.unique(np.floor(uv[np.repeat(has_map, sizes)] - 1e-6 * np.sign(uv[np.repeat(has_map, sizes)])), axis=0)
    return MapReport(
        faces=len(sizes),
        degenerate=int(is_degenerate.sum()),
        unmapped=int((~has_map).sum()),
        collapsed=int(is_collapsed.sum()),
        islands=int(defects.island_of_face.max(initial=-1)) + 1,
        flips=int(defects.flipped.sum()),
        overlaps=int(defects.overlapping.sum()),
        qc_mean=mean,
        qc_p99=p99,
        qc_max=largest,
        density_spread=spread,
        fill=float(image.sum() / len(tiles)) if len(tiles) else unknown,
    )


def _percentile(values: np.ndarray, weights: np.ndarray, part: float) -> float:
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(below, part * below[-1])])


class Requirement:
    """A condition such as "flips == 0 and qc_p99 < 1.5"."""

    def __init__(self, text: str) -> None:
        """Read it.

        Raises:
            RequirementError: it is no comparison of a number of `MapReport` with a number, or several joined by `and`.
        """
        self._terms = []
        try:
            parsed = ast.parse(text.strip(), mode="eval").body
        except SyntaxError:
            raise self._problem(text) from None
        for term in parsed.values if isinstance(parsed, ast.BoolOp) and isinstance(parsed.op, ast.And) else [parsed]:
            if not (
                isinstance(term, ast.Compare)
                and len(term.ops) == 1
                and isinstance(term.left, ast.Name)
                and type(term.ops[0]) in _COMPARISONS
                and isinstance(term.comparators[0], ast.Constant)
                and isinstance(term.comparators[0].value, (int, float))
            ):
                raise self._problem(ast.unparse(term))
            if term.left.id not in _NAMES:
                raise RequirementError(f"There is no '{term.left.id}' in a report, but {', '.join(_NAMES)}.")
            self._terms.append((ast.unparse(term), term.left.id, type(term.ops[0]), term.comparators[0].value))

    @staticmethod
    def _problem(text: str) -> RequirementError:
        return RequirementError(f"'{text}' is no comparison such as 'qc_p99 < 1.5', nor several joined by 'and'.")

    def failures(self, report: MapReport) -> list[str]:
        """Return what is not met, with the number that is there; what is not known is not met."""
        values = asdict(report)
        return [
            f"{text}, but {name} is {values[name]:.6g}"
            for text, name, comparison, limit in self._terms
            if not _COMPARISONS[comparison](values[name], limit) or values[name] != values[name]
        ]


_NAMES = tuple(field.name for field in fields(MapReport))
