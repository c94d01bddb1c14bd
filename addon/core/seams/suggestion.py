# SPDX-License-Identifier: GPL-3.0-or-later
"""Suggested cuts of several meshes, and parts of them."""

import hashlib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import zip_longest
from typing import NamedTuple

import numpy as np

from .. import choices, native
from ..mesh.charts import corner_edge_keys, edge_keys
from ..mesh.polygon_mesh import PolygonMesh
from ..mesh.world_scale import area_growth, area_vectors
from ..solve.progress import Progress, parts
from ..words import texts

# Options that the module takes as they are.
_SEARCHED = (
    *("scale_limit", "qc_limit", "max_length", "weights", "boundary", "area_blend"),
    *("front", "qc_gain", "style", "longest_side"),
)


def _no_edges() -> np.ndarray:
    return np.empty((0, 2), np.int32)


@dataclass(frozen=True)
class Wishes:
    """Where seams are wanted in a mesh, and where not; edges are (n, 2) vertex pairs.

    Attributes:
        preference: (V,) float64 from -1, to avoid seams, to 1, to prefer them; None for no preference.
        cut: edges to cut.
        never: edges to spare.
        cheap: edges along which seams are cheap.
        cheapness: how cheap, (n,) float64 from 0 to 1.
    """

    preference: np.ndarray | None = None
    cut: np.ndarray = field(default_factory=_no_edges)
    never: np.ndarray = field(default_factory=_no_edges)
    cheap: np.ndarray = field(default_factory=_no_edges)
    cheapness: np.ndarray = field(default_factory=lambda: np.empty(0))


@dataclass(frozen=True)
class Options:
    """What to search for, the same for all meshes but for the wishes.

    Other fields are options of `spectral_conformal.suggest_cuts`, by the names and values it documents; `max_length` is
    a limit per mesh, `longest_side` refers to the area of all of them, and `front` is in object space.

    Attributes:
        style: as there; or "angle": seams are the edges where the surface bends by `sharp_angle` radians or more, and
            no other options but edges to cut and to spare count.
        wishes: of each mesh; empty for none.
    """

    scale_limit: float = 1.25
    qc_limit: float = 1.1
    max_length: float | None = None
    weights: str = "uniform"
    boundary: str = "length"
    area_blend: float = 0.0
    front: tuple[float, float, float] | None = None
    qc_gain: float = 0.0
    style: str = "auto"
    longest_side: float = 1.75
    sharp_angle: float = 0.5
    wishes: Sequence[Wishes] = ()


@dataclass(frozen=True)
class Cut:
    """Seams to mark together.

    Attributes:
        mesh: index of the mesh.
        edges: (n, 2) int32, vertex pairs.
        length: sum of the edges' lengths, in object space.
    """

    mesh: int
    edges: np.ndarray
    length: float


@dataclass(frozen=True)
class Suggestion:
    """Cuts of several meshes, the most useful first.

    Attributes:
        cuts: the first cut of every mesh, then the second ones, and so on.
        errors: why a mesh, or a part of it, was refused; one text per mesh, empty if it was not.
        fixed: seams that belong to every part of the suggestion: those hinted, or all those by angle.
        refused_hints: number of edges that are cut against a hint.
        styles: those that "auto" found, "hard" or "organic", each once, the most frequent first.
        is_hard: whether the seams of all meshes are those of hard surfaces.
    """

    cuts: tuple[Cut, ...]
    errors: tuple[str, ...]
    fixed: tuple[Cut, ...] = ()
    refused_hints: int = 0
    styles: tuple[str, ...] = ()
    is_hard: bool = False

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to mark."""
        return not self.cuts and not self.fixed

    @property
    def length(self) -> float:
        """The length of all cuts."""
        return sum(cut.length for cut in self.fixed + self.cuts)

    def edges(self, mesh: int) -> np.ndarray:
        """Return the edges, (n, 2) int32, of the cuts that are in a mesh."""
        fixed = [cut for cut in self.fixed if cut.mesh == mesh]
        return np.concatenate([np.empty((0, 2), np.int32), *(cut.edges for cut in fixed + self.cuts_of(mesh))])

    def cuts_of(self, mesh: int) -> list[Cut]:
        """Return the cuts that are in a mesh."""
        return self._cuts_by_mesh.get(mesh, [])

    @cached_property
    def _cuts_by_mesh(self) -> dict[int, list[Cut]]:
        # For all meshes at once, so that a loop over them does not search all cuts for each.
        groups: dict[int, list[Cut]] = {}
        for cut in self.cuts:
            groups.setdefault(cut.mesh, []).append(cut)
        return groups

    def part(self, start: int, end: int) -> "Suggestion":
        """Return the cuts `start` to `end` - 1 alone, and what is fixed."""
        return replace(self, cuts=self.cuts[start:end])


def suggest(meshes: Sequence[PolygonMesh], options: Options, progress: Progress | None = None) -> Suggestion:
    """Suggest cuts of the selected faces of every mesh. A refused mesh does not stop the others.

    Raises:
        NativeModuleError: `spectral_conformal` cannot be imported.
        spectral_conformal.Cancelled: `progress` returned False.
        MemoryError: there is too little memory for any mesh.
    """
    wishes = options.wishes or [Wishes()] * len(meshes)
    fixed = [_fixed(mesh, options, each) for mesh, each in zip(meshes, wishes)]
    kept = tuple(Cut(i, edges, _length(meshes[i], edges)) for i, edges in enumerate(fixed) if len(edges))
    if options.style.upper() == choices.SEAMS_BY_ANGLE:
        return Suggestion((), ("",) * len(meshes), kept)
    each = parts([[mesh] for mesh in meshes], progress)
    cut_open = [replace(mesh, seam_edges=np.concatenate([mesh.seam_edges, own])) for mesh, own in zip(meshes, fixed)]
    sides = _longest_sides(meshes, options.longest_side)
    found = [
        _suggest(mesh, replace(options, longest_side=side), part, own)
        for mesh, side, part, own in zip(cut_open, sides, each, wishes)
    ]
    if found and all(each.is_too_large for each in found):
        raise MemoryError
    cuts = [
        [Cut(index, edges, _length(meshes[index], edges)) for edges in each.cuts] for index, each in enumerate(found)
    ]
    in_turn = (cut for turn in zip_longest(*cuts) for cut in turn if cut is not None)
    refused = sum(
        int(_among(meshes[i], np.concatenate(each.cuts), wishes[i].never).sum())
        for i, each in enumerate(found)
        if each.cuts
    )
    found_styles = Counter(each.style for each in found if each.style and options.style == "auto")
    styles = tuple(style for style, _ in found_styles.most_common())
    is_hard = {each.style for each in found if each.style} == {"hard"}
    return Suggestion(tuple(in_turn), tuple(each.message for each in found), kept, refused, styles, is_hard)


def _longest_sides(meshes: Sequence[PolygonMesh], longest_side: float) -> list[float]:
    """Return the longest side for each mesh, in roots of its own area, of the sheet that all of them share."""
    if len(meshes) == 1:
        return [longest_side]
    with np.errstate(invalid="ignore", over="ignore"):
        sizes = [np.linalg.norm(area_vectors(mesh), axis=1) * area_growth(mesh) for mesh in meshes]
        areas = np.array([size[mesh.selected_faces].sum() for size, mesh in zip(sizes, meshes)])
    is_known = np.isfinite(areas) & (areas > 0.0)
    total = areas[is_known].sum()
    return [
        longest_side * float(np.sqrt(total / area)) if known else longest_side for area, known in zip(areas, is_known)
    ]


def _fixed(mesh: PolygonMesh, options: Options, wishes: Wishes) -> np.ndarray:
    """Return the new seams, (n, 2) int32, that are hinted or sharp, between two of the selected faces."""
    inner = np.empty((0, 2), np.int32)
    if options.style.upper() == choices.SEAMS_BY_ANGLE:
        sharp_edges = native.spectral_conformal("_sharp_edges").sharp_edges
        arrays, faces = (mesh.vertices, mesh.face_offsets, mesh.corner_vertices), mesh.selected_faces
        with np.errstate(invalid="ignore", over="ignore"):
            inner = sharp_edges(*arrays, options.sharp_angle, selected_faces=faces)
        inner = inner[~_among(mesh, inner, wishes.never)]
    wanted = wishes.cut[_is_inner(mesh, wishes.cut) & ~_among(mesh, wishes.cut, inner)]
    inner = np.concatenate([inner, wanted])
    return inner[~_among(mesh, inner, mesh.seam_edges)].astype(np.int32)


def _is_inner(mesh: PolygonMesh, edges: np.ndarray) -> np.ndarray:
    """Return which of the edges, (n, 2), lie between selected faces, (n,) bool."""
    if not len(edges):
        return np.zeros(0, dtype=bool)
    inside = mesh.selected_faces[mesh.face_of_corner()]
    found, count = np.unique(corner_edge_keys(mesh)[inside], return_counts=True)
    return np.isin(edge_keys(mesh, edges), found[count > 1])


def _among(mesh: PolygonMesh, edges: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Return which of the edges, (n, 2), are among others, (n,) bool."""
    if not len(edges) or not len(others):
        return np.zeros(len(edges), dtype=bool)
    return np.isin(edge_keys(mesh, edges), edge_keys(mesh, others))


class _Found(NamedTuple):
    """The cuts of one mesh, why it or a part of it was refused, whether memory is too small for it, and its style."""

    cuts: list[np.ndarray]
    message: str
    is_too_large: bool = False
    style: str = ""


def _suggest(mesh: PolygonMesh, options: Options, progress: Progress | None, wishes: Wishes) -> _Found:
    try:
        cuts = native.spectral_conformal().suggest_cuts(
            mesh.with_map(),
            seam_edges=mesh.seam_edges,
            selected_faces=mesh.selected_faces,
            vertex_preference=wishes.preference,
            avoided_edges=wishes.never if len(wishes.never) else None,
            preferred_edges=wishes.cheap if len(wishes.cheap) else None,
            edge_preference=wishes.cheapness if len(wishes.cheap) else None,
            progress=progress,
            **{name: getattr(options, name) for name in _SEARCHED},
        )
    except ValueError as error:
        return _Found([], message=str(error))
    except MemoryError:
        return _Found([], message=texts.TOO_LITTLE_MEMORY_FOR_MESH, is_too_large=True)
    return _Found(cuts, message=getattr(cuts, "message", ""), style=getattr(cuts, "style", ""))


def _length(mesh: PolygonMesh, edges: np.ndarray) -> float:
    first, second = segments(mesh, edges).reshape(-1, 2, 3).transpose(1, 0, 2)
    return float(np.linalg.norm(first - second, axis=1).sum())


def segments(mesh: PolygonMesh, edges: np.ndarray) -> np.ndarray:
    """Return the ends of the edges, (2 n, 3) float64 in object space, edge after edge."""
    return mesh.vertices[edges].reshape(-1, 3)


def cut_open(meshes: Sequence[PolygonMesh], cuts: Suggestion) -> list[PolygonMesh]:
    """Return the meshes with the cuts added to their seams."""
    return [
        replace(mesh, seam_edges=np.concatenate([mesh.seam_edges, cuts.edges(index)]))
        for index, mesh in enumerate(meshes)
    ]


class Search:
    """`suggest` that keeps its last answer, and returns it for the same question."""

    def __init__(self) -> None:
        """Begin without an answer."""
        self._last: tuple[bytes, Suggestion] | None = None

    def suggest(self, meshes: Sequence[PolygonMesh], options: Options, progress: Progress | None = None) -> Suggestion:
        """Suggest cuts as the function `suggest` does."""
        question = _digest(meshes, options)
        last = self._last
        if last is not None and last[0] == question:
            return last[1]
        answer = suggest(meshes, options, progress)
        self._last = (question, answer)
        return answer


def _digest(meshes: Sequence[PolygonMesh], options: Options) -> bytes:
    """Return a digest of everything that the cuts depend on."""
    digest = hashlib.blake2b(repr(replace(options, wishes=())).encode())
    for mesh in meshes:
        for array in (mesh.vertices, mesh.face_offsets, mesh.corner_vertices, mesh.seam_edges, mesh.selected_faces):
            digest.update(repr((array.shape, array.dtype.str)).encode())
            digest.update(np.ascontiguousarray(array).data)
    for array in (array for each in options.wishes for array in vars(each).values()):
        digest.update(b"none" if array is None else repr(array.shape).encode() + np.ascontiguousarray(array).tobytes())
    return digest.digest()
