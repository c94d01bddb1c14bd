"""Measure a UV map, and check requirements on it."""

from __future__ import annotations

import ast
import functools
import operator
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, fields

import numpy as np

from .._measuring import area_mean, area_percentiles, next_corner
from .._mesh import Mesh, uv_per_length
from .._pattern import MapBorder, Pattern, map_border, pattern
from .._quality import face_distortion, face_triangles, map_defects
from . import degenerate, welding
from .mesh import AssetMesh
from .unwrapping import SHEETS, sheets_of

_UNKNOWN = float("nan")
# Area ratio of a quad's triangles below which single precision decides how the smaller one is wound.
_ROUNDING = 1e-4
# Percentage of the area that the range of colors spans, and its minimal width, so that a good map looks good.
_SHOWN = 98.0
_LEAST_SHOWN = 0.2
_COMPARISONS = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}


class RequirementError(ValueError):
    """A requirement cannot be parsed; the message says why and what is allowed."""


@dataclass(frozen=True)
class MapReport:
    """Measures of the map of an asset, over all of its meshes."""

    faces: int
    degenerate: int
    """Faces without area in 3D; they count only for flips and overlaps."""
    unmapped: int
    """Faces with a corner that has no UV."""
    collapsed: int
    """Mapped faces without area in the map, or lower there than single precision tells apart."""
    islands: int
    flips: int
    """Faces that are flipped in their island."""
    overlaps: int
    """Faces that overlap another face, of any mesh and island with the same texture, or coincide with a duplicate."""
    qc_mean: float
    """Area-weighted mean quasi-conformal distortion of the faces that are neither degenerate nor collapsed; 1 if angles
    are preserved. NaN if there are no such faces, like the next four."""
    qc_p99: float
    """99th percentile over the area."""
    qc_max: float
    density_spread: float
    """Standard deviation over mean of the texel density, the root of area in the map over area in the scene, weighted
    by the latter."""
    fill: float
    """Area of the map over the area of all texture tiles that it touches."""
    split_flips: int = 0
    """Quads with a flipped triangle if they are split at the first corner, as Blender and most exporters do; the other
    diagonal may be right."""
    tiles: int = 0
    """Texture tiles that the map touches, of all textures."""
    uv_per_length: float = _UNKNOWN
    """The scale of the map: the root of its area over that in the scene; on a texture that is not square, of a square
    one with the same number of pixels. NaN without area."""
    seam_error: float = 0.0
    """How much too long or too short the sides of seams are in the map over `uv_per_length`: the sum of
    |length in the map - length in the scene| over the sum of the latter. 0 without seams, like the next one."""
    seam_mismatch: float = 0.0
    """How much the two sides of seams differ: the sum of |difference in the map| over the length in the scene."""

    @classmethod
    def from_json(cls, values: Mapping[str, float | None]) -> MapReport:
        """Return the report with these numbers, None for NaN; other keys are ignored."""
        return cls(**{name: _UNKNOWN if values[name] is None else values[name] for name in _NAMES})


@dataclass(frozen=True)
class IslandReport:
    """One island of a map; numbers as in `MapReport`."""

    mesh: str
    faces: int
    area: float
    """In the scene."""
    border_length: float
    """In the scene; an edge between two faces of the island counts twice."""
    flips: int
    overlaps: int
    qc_mean: float
    qc_p99: float
    qc_max: float
    density: float
    """Texel density: the root of area in the map over area in the scene, weighted by the latter."""


class Measurement:
    """Measures of the map of an asset, face by face; its meshes are joined, welded and in the scene's scale.

    Attributes:
        vertices: (V, 3)
        face_offsets: (F + 1,)
        corner_vertices: (C,) of the welded meshes.
        uv: (C, 2), 0 for faces without a map.
        shown_uv: (C, 2) the same, with the textures beside each other.
        mesh_of_face: (F,)
        has_map: (F,) bool.
        qc: (F,) as in `FaceDistortion`, like the next two.
        area: (F,)
        image_area: (F,)
        island_of_face: (F,) as in `MapDefects`, like the next two.
        flipped: (F,) bool.
        overlapping: (F,) bool, between islands, too, and faces that coincide, such as two back to back.
        double: (F,) bool, those that coincide.
        counted: (F,) bool, faces that are neither degenerate nor collapsed.
    """

    def __init__(
        self, meshes: Sequence[AssetMesh], aspect: float = 1.0, sheets: Sequence[np.ndarray] | None = None
    ) -> None:
        """Measure the meshes; faces without UVs are only counted.

        Args:
            meshes: of the asset.
            aspect: width over height of a texture.
            sheets: the texture of each face of each mesh, as `unwrapping.sheets_of` has them, or of the meshes of the
                source, with the same faces in this order; by default the same for all.
        """
        self.names = [mesh.name for mesh in meshes]
        sizes = np.concatenate([np.diff(mesh.face_offsets) for mesh in meshes])
        self.face_offsets = np.append(0, np.cumsum(sizes))
        first = np.append(0, np.cumsum([len(mesh.vertices) for mesh in meshes]))
        stands = [_welded(mesh)[mesh.corner_vertices] for mesh in meshes]
        self.corner_vertices = np.concatenate([start + corners for start, corners in zip(first, stands)])
        self.vertices = np.concatenate([mesh.scale * mesh.vertices for mesh in meshes])
        self.mesh_of_face = np.repeat(np.arange(len(meshes)), [len(mesh.face_offsets) - 1 for mesh in meshes])
        self.has_map = np.concatenate([mesh.has_uv() for mesh in meshes])
        uv = [np.zeros((len(m.corner_vertices), 2)) if m.corner_uv is None else m.corner_uv for m in meshes]
        self.uv = np.where(np.repeat(self.has_map, sizes)[:, None], np.concatenate(uv), 0.0)
        numbers = np.zeros(len(sizes), np.int64) if sheets is None else np.concatenate(sheets)
        sheet = np.unique(numbers, return_inverse=True)[1].ravel()
        tile = _tiles(self.uv[:, 0])
        beside = (tile.max(initial=0.0) - tile.min(initial=0.0) + 1.0) * np.repeat(sheet, sizes)
        self._beside = np.stack([beside, np.zeros(len(beside))], axis=1)
        self.shown_uv = self.uv + self._beside
        surface = Mesh(self.vertices, self.face_offsets, corner_vertices=self.corner_vertices)
        # In pixels, which are square; areas stay.
        pixels = self.shown_uv * np.array([aspect**0.5, aspect**-0.5])
        self._surface = surface.with_uv(pixels)
        found = face_distortion(self._surface, selected_faces=self.has_map)
        self.qc, self.area, self.image_area = found.qc, found.area, np.abs(found.image_area)
        defects = map_defects(surface.with_uv(self.shown_uv), selected_faces=self.has_map, between_islands=True)
        self.island_of_face = defects.island_of_face
        self.flipped, self.overlapping = defects.flipped, defects.overlapping
        mapped = self.area[self.has_map]
        self.is_degenerate = self.has_map & (
            self.area <= degenerate.LEAST_AREA * (mapped.mean() if len(mapped) else 0.0)
        )
        self.is_collapsed = self.has_map & ~self.is_degenerate & (~np.isfinite(self.qc) | self._is_below_rounding())
        self.counted = self.has_map & ~self.is_degenerate & ~self.is_collapsed
        # One index per distinct UV, as complex numbers, which sort ten times as fast as rows.
        self._points = np.unique(self.shown_uv.view(np.complex128).ravel(), return_inverse=True)[1].ravel()
        self.double = self._doubles()
        self.overlapping = self.overlapping | self.double

    def _doubles(self) -> np.ndarray:
        """Return which faces, (F,) bool, have all their corners in the map where another one has them."""
        # A random number per point: equal sums of different points have a probability of 2^-64.
        keys = np.random.default_rng(1).integers(1 << 63, size=int(self._points.max(initial=-1)) + 1, dtype=np.uint64)
        result = np.zeros(len(self.counted), dtype=bool)
        faces = np.flatnonzero(self.counted)
        if not len(faces):
            return result
        sums = np.add.reduceat(keys[self._points], self.face_offsets[:-1])[faces]
        order = np.argsort(sums, kind="stable")
        same = sums[order[1:]] == sums[order[:-1]]
        result[faces[order[np.append(same, False) | np.append(False, same)]]] = True
        return result

    def _is_below_rounding(self) -> np.ndarray:
        """Return which faces, (F,) bool, are lower in the map than single precision tells apart, as renderers read it.

        Their distortion is that of the rounding.
        """
        first = self.face_offsets[:-1]
        edges = self.uv[next_corner(self.face_offsets)] - self.uv
        longest = np.maximum.reduceat(np.hypot(edges[:, 0], edges[:, 1]), first)
        u, v = np.abs(self.uv).T
        largest = np.maximum.reduceat(np.maximum(u, v), first)
        return self.image_area <= np.finfo(np.float32).eps * largest * longest

    def report(self) -> MapReport:
        """Return the report of the whole map."""
        mean, p99, largest = self._qc(self.counted)
        spread = _UNKNOWN
        if self.counted.any():
            density, weight = self._densities(self.counted), self.area[self.counted]
            average = area_mean(density, weight)
            spread = area_mean((density - average) ** 2, weight) ** 0.5 / average
        has_map = np.repeat(self.has_map, np.diff(self.face_offsets))
        error, mismatch = self._border.seam_errors()
        # Pairs as complex numbers, which sort ten times as fast as rows.
        tiles = np.unique((_tiles(self.uv) + self._beside)[has_map].view(np.complex128))
        return MapReport(
            faces=len(self.has_map),
            degenerate=int(self.is_degenerate.sum()),
            unmapped=int((~self.has_map).sum()),
            collapsed=int(self.is_collapsed.sum()),
            islands=int(self.island_of_face.max(initial=-1)) + 1,
            flips=int(self.flipped.sum()),
            split_flips=int(self._split_flips().sum()),
            overlaps=int(self.overlapping.sum()),
            qc_mean=mean,
            qc_p99=p99,
            qc_max=largest,
            density_spread=spread,
            fill=float(self.image_area[self.has_map].sum() / len(tiles)) if len(tiles) else _UNKNOWN,
            tiles=len(tiles),
            uv_per_length=uv_per_length(self._surface, self.has_map),
            seam_error=error,
            seam_mismatch=mismatch,
        )

    def islands(self) -> Iterator[IslandReport]:
        """Yield the report of every island, in order."""
        island = self.island_of_face
        order = np.argsort(island, kind="stable")
        order = order[island[order] >= 0]
        borders = self._border_lengths()
        for faces in np.split(order, np.flatnonzero(np.diff(island[order])) + 1) if len(order) else ():
            counted = faces[self.counted[faces]]
            mean, p99, largest = self._qc(counted)
            yield IslandReport(
                mesh=self.names[self.mesh_of_face[faces[0]]],
                faces=len(faces),
                area=float(self.area[faces].sum()),
                border_length=float(borders[island[faces[0]]]),
                flips=int(self.flipped[faces].sum()),
                overlaps=int(self.overlapping[faces].sum()),
                qc_mean=mean,
                qc_p99=p99,
                qc_max=largest,
                density=area_mean(self._densities(counted), self.area[counted]),
            )

    def qc_range(self) -> tuple[float, float]:
        """Return the values at the two ends of the color range: 1, and a high percentile over the area."""
        (end,) = area_percentiles(self.qc[self.counted], self.area[self.counted], (_SHOWN,))
        return 1.0, float(np.fmax(end, 1.0 + _LEAST_SHOWN))

    def triangles(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the mapped faces as triangles: UVs (T, 3, 2), and the QC of each (T,)."""
        polygons = self.vertices, self.face_offsets, self.corner_vertices
        corners, faces = face_triangles(*polygons, selected_faces=self.has_map)
        return self.shown_uv[corners], self.qc[faces]

    def _qc(self, faces: np.ndarray) -> tuple[float, float, float]:
        """Return mean, 99th percentile and maximum over some faces; NaN if there are none."""
        qc, weight = self.qc[faces], self.area[faces]
        (p99,) = area_percentiles(qc, weight, (99.0,))
        return area_mean(qc, weight), p99, float(qc.max()) if len(qc) else _UNKNOWN

    def _split_flips(self) -> np.ndarray:
        """Return which faces, (F,) bool, are quads whose triangles from the first corner are wound differently."""
        quads = np.flatnonzero(self.counted & (np.diff(self.face_offsets) == 4))
        first = self.uv[self.face_offsets[:-1][quads]]
        one, two, three = (self.uv[self.face_offsets[:-1][quads] + k] - first for k in (1, 2, 3))
        areas = [a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] for a, b in ((one, two), (two, three))]
        result = np.zeros(len(self.counted), dtype=bool)
        # The orientation of smaller triangles is rounding.
        result[quads] = np.minimum(*areas) < -_ROUNDING * np.abs(np.maximum(*areas))
        result[quads] &= np.maximum(*areas) > _ROUNDING * np.abs(np.minimum(*areas))
        return result

    def _densities(self, faces: np.ndarray) -> np.ndarray:
        return np.sqrt(self.image_area[faces] / self.area[faces])

    def pattern(self) -> Pattern:
        """Return the pattern of the map, in units of the scene.

        Raises:
            ValueError: the map has no area.
        """
        uv = np.where(np.repeat(self.has_map, np.diff(self.face_offsets))[:, None], self._surface.uv, np.nan)
        return pattern(self._surface.with_uv(uv))

    @functools.cached_property
    def _border(self) -> MapBorder:
        return map_border(self._surface, self.has_map)

    def _border_lengths(self) -> np.ndarray:
        """Return the border length of every island: edges that no other face of the island shares in the map."""
        face = np.repeat(np.arange(len(self.has_map)), np.diff(self.face_offsets))
        island = self.island_of_face[face[self._border.corners]]
        counted = island >= 0
        number = int(self.island_of_face.max(initial=-1)) + 1
        return np.bincount(island[counted], self._border.length[counted], number)


def _tiles(uv: np.ndarray) -> np.ndarray:
    """Return the tile of each coordinate; those on the border belong to the tile nearer to 0."""
    return np.floor(uv - 1e-6 * np.sign(uv))


def map_report(meshes: Sequence[AssetMesh], pack_by: str = SHEETS[0]) -> MapReport:
    """Measure the map of an asset; faces without UVs are only counted. pack_by: as in `unwrapping.Layout`."""
    return Measurement(meshes, sheets=sheets_of(meshes, pack_by)).report()


def _welded(mesh: AssetMesh) -> np.ndarray:
    """Return a representative of coincident vertices: files have one per normal, but normals do not end islands."""
    return welding.coincident_vertices(mesh.vertices, mesh.face_offsets, mesh.corner_vertices, welding.DISTANCES[0])


class Requirement:
    """A condition such as "flips == 0 and qc_p99 < 1.5"."""

    def __init__(self, text: str, further: Sequence[str] = ()) -> None:
        """Parse a condition: comparisons of a field of `MapReport` with a number, joined by `and`.

        Args:
            text: the condition.
            further: other names that may be compared; `failures` takes their values.

        Raises:
            RequirementError: the text is not such a condition.
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
            if term.left.id not in (*_NAMES, *further):
                raise RequirementError(f"A report has no '{term.left.id}', but {', '.join((*_NAMES, *further))}.")
            self._terms.append((ast.unparse(term), term.left.id, type(term.ops[0]), term.comparators[0].value))

    @staticmethod
    def _problem(text: str) -> RequirementError:
        return RequirementError(f"'{text}' is not a comparison such as 'qc_p99 < 1.5', nor several joined by 'and'.")

    def failures(self, report: MapReport, **further: float) -> list[str]:
        """Return the violated terms, with the actual number; NaN violates every term, and so does a missing map."""
        values = {**asdict(report), **further}
        found = [
            f"{text}, but {name} is {values[name]:.6g}"
            for text, name, comparison, limit in self._terms
            if not _COMPARISONS[comparison](values[name], limit) or values[name] != values[name]
        ]
        # Without faces in the map, nothing can be wrong with it.
        return found or (["a UV map, but there is none"] if report.unmapped == report.faces else [])


_NAMES = tuple(field.name for field in fields(MapReport))
