"""Propose seams that lower the distortion."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._arguments import Faces, Progress
from ._island_merging import kept_seams
from ._measuring import edge_keys, next_corner
from ._mesh import Mesh, Polygons, all_seams, checked_polygons, given_mesh
from ._messages import parts_without_seams
from ._options import SeamOptionChanges, SeamOptions, changed
from ._seam_style import style_of

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Cuts(list):
    """A list of cuts, each (n, 2) int32 vertex pairs, with a message."""

    message: str = ""
    """For people: the parts without seams because memory ran out; empty if there are none."""
    style: str = ""
    """The style of `SeamOptions` that was used, "hard" or "organic"."""


def suggest_seams(
    mesh: Mesh | npt.ArrayLike,
    faces: Faces | None = None,
    corner_vertices: npt.ArrayLike | None = None,
    *,
    options: SeamOptions | None = None,
    seam_edges: npt.ArrayLike | None = None,
    selected_faces: npt.ArrayLike | None = None,
    vertex_preference: npt.ArrayLike | None = None,
    avoided_edges: npt.ArrayLike | None = None,
    preferred_edges: npt.ArrayLike | None = None,
    edge_preference: npt.ArrayLike | None = None,
    start_edges: npt.ArrayLike | None = None,
    progress: Progress | None = None,
    **changes: Unpack[SeamOptionChanges],
) -> Mesh:
    """Propose seams that lower the distortion of `unwrap` most, in addition to those of the mesh.

    Topology comes first: handles are cut open and closed surfaces slit, at any length, because they could not be
    unwrapped otherwise. Then the most distorted regions are joined to the seams one after the other. Each cut is solved
    before it is proposed, so unwrapping with it shows lower distortion. A component gets no more of these once it meets
    `scale_limit`, `qc_limit` and `energy_limit`, or nothing helps. Then charts that cover themselves in the map or have
    flipped faces are divided until none does, unless `max_length` forbids that, and seams that the maps do not need are
    removed. If a plane x, y or z = constant mirrors a component's faces onto the mesh's, its seams come in mirrored
    pairs or lie on the plane, if the edges allow that.

    Unless a `max_length` forbids that, hard surfaces are also unfolded: parts that are flat, or rolled like a pipe, are
    cut from each other along sharp edges and hinged together where that fits, so that no seam crosses a flat face and
    nothing is stretched. The cheaper of the two sets of seams is proposed. The cost counts distortion by
    `energy_limit`, length by how sharp the edges are, islands, and what they have beyond `longest_side` (docs/paper.md
    has the formula). The `style` changes what these cost; by default, the shape says which one it is.

    For the shortest seams within a bound on the distortion, as OptCuts finds them, give the bound and `shortest`:

        suggest_seams(vertices, faces, shortest=True, energy_limit=4.1, scale_limit=100, qc_limit=100, area_blend=1)

    Stricter limits add seams to those of looser ones: seams for the default limits are among those for any that are
    all at least as strict. Among limits of which any is looser than by default, the same holds for components of up to
    2000 vertices. Not so with `max_length`, `qc_gain` and `shortest`.

    The result depends neither on the numbering of vertices and faces nor on scale and place, which decide rounding.

    Args:
        mesh: as in `unwrap`.
        faces: as in `unwrap`.
        corner_vertices: as in `unwrap`.
        options: when to stop, and how maps are made; single fields may be given as keywords, which take precedence.
        seam_edges: (S, 2) further seams beside those of the mesh. All stay; the proposed ones complete them.
        selected_faces: (faces,) bool; by default all faces. Only edges between two selected faces are proposed.
        vertex_preference: (V,) from -1 to 1: above 0 attracts seams to the vertex, below 0 repels them, 0 leaves the
            choice to the distortion. An edge whose ends have the mean p counts as 8^-p times as long.
        avoided_edges: (A, 2) vertex pairs: edges that become seams only in components that could not be unwrapped
            otherwise, or not without flips or overlaps. Pairs that are not edges are ignored.
        preferred_edges: (P, 2) vertex pairs: edges that are marked on the model, such as creases and borders of
            materials. There, a seam costs as little as along the sharpest edge. Pairs that are not edges are ignored.
        edge_preference: (P,) from 0 to 1, 1 by default: how strongly each is marked; 0 leaves the cost as it is.
        start_edges: (E, 2) vertex pairs: seams to begin with, such as the island borders of a map in many pieces. No
            cuts are searched then; those of these edges are taken back that islands do not need, so that fewer and
            larger ones remain. In its map by `defaults.MAPS`, or by the same with `fold_free` if that one has faults,
            an island made of several neither flips nor covers itself, has a mean quasi-conformal distortion of at most
            `qc_limit`, sizes within `scale_limit`, and fills at least half of the smallest rectangle around it; or it
            is no worse than these were on average. Noise does not count: `qc_limit` is raised by the mean distortion
            that unrolling the cones around the island's inner vertices takes, as measured at vertices that the
            `start_edges` leave inside. Other limits, preferences and avoided edges have no effect, and pairs that are
            not edges are ignored. Of equally long borders, the numbering of the faces decides.
        progress: as in `parameterize`.

    Returns:
        The mesh with the seams in `seam_edges`: those that stay, then the proposed ones, the smaller vertex first, cut
        by cut as from `suggest_cuts`; or what is left of `start_edges`.

    Raises:
        ValueError: the arrays do not describe a mesh, or an option is out of range.
        TypeError: an argument has the wrong type, or a keyword is not an option; the message names the closest one.
        Cancelled: `progress` returned False.
        MemoryError: there is too little memory for the mesh, or for any part of it.

    Warns:
        RuntimeWarning: memory ran out for some parts of the mesh, which got no seams.
    """
    given = given_mesh(mesh, faces, corner_vertices)
    given = given.with_seams(all_seams(given, seam_edges))
    used = changed(options, SeamOptions(), changes, SeamOptionChanges, suggest_seams)
    if start_edges is not None:
        start = _arguments.checked_indices(start_edges, "start_edges", 2, len(given.vertices))
        polygons = checked_polygons(given, None, selected_faces)
        left = kept_seams(polygons, start, used, _arguments.checked_progress(progress))
        return given.with_seams(left if polygons[3] is None else np.concatenate([polygons[3], left]))
    cuts = suggest_cuts(
        given,
        options=used,
        selected_faces=selected_faces,
        vertex_preference=vertex_preference,
        avoided_edges=avoided_edges,
        preferred_edges=preferred_edges,
        edge_preference=edge_preference,
        progress=progress,
    )
    if cuts.message:
        _native.warn(cuts.message)
    kept = np.zeros((0, 2), np.int32) if given.seam_edges is None else given.seam_edges
    return given.with_seams(np.concatenate([kept, *cuts]))


def suggest_cuts(
    mesh: Mesh | npt.ArrayLike,
    faces: Faces | None = None,
    corner_vertices: npt.ArrayLike | None = None,
    *,
    options: SeamOptions | None = None,
    seam_edges: npt.ArrayLike | None = None,
    selected_faces: npt.ArrayLike | None = None,
    vertex_preference: npt.ArrayLike | None = None,
    avoided_edges: npt.ArrayLike | None = None,
    preferred_edges: npt.ArrayLike | None = None,
    edge_preference: npt.ArrayLike | None = None,
    progress: Progress | None = None,
    **changes: Unpack[SeamOptionChanges],
) -> Cuts:
    """Return the seams of `suggest_seams` cut by cut, each (n, 2).

    The first is what topology needs; each of the others leads from one crossing of seams to the next, the longest
    first. A cut and its mirror image count as one. Arguments and errors are those of `suggest_seams`; its warning is
    the list's `message` here.
    """
    used = changed(options, SeamOptions(), changes, SeamOptionChanges, suggest_cuts)
    progress = _arguments.checked_progress(progress)
    polygons = checked_polygons(given_mesh(mesh, faces, corner_vertices), seam_edges, selected_faces)
    if used.shortest:
        used = replace(used, style="hard")
    elif used.style == "auto":
        used = replace(used, style=style_of(*polygons[:3], selected_faces=polygons[4], progress=progress))
    preference = _arguments.checked_preference(vertex_preference, len(polygons[0]))
    avoided = None
    if avoided_edges is not None:
        avoided = _arguments.checked_indices(avoided_edges, "avoided_edges", 2, len(polygons[0]))
    preferred, strengths = _arguments.checked_marks(preferred_edges, edge_preference, len(polygons[0]))
    edges, offsets, n_given_up, n_vertices = _native.suggest_seams(
        *polygons,
        preference,
        avoided,
        preferred,
        strengths,
        used.with_energy_limit(),
        progress,
    )
    cuts = np.split(edges, offsets[1:-1]) if len(edges) else []
    if avoided is not None and cuts:
        cuts = _without_avoided(polygons, cuts, avoided, used, progress)
    result = Cuts(cuts)
    result.message, result.style = parts_without_seams(n_given_up, n_vertices), used.style
    return result


def _without_avoided(
    polygons: Polygons,
    cuts: list[np.ndarray],
    avoided: np.ndarray,
    options: SeamOptions,
    progress: Progress | None,
) -> list[np.ndarray]:
    """Return the cuts with as many avoided edges removed as possible, beginning at the end of the last cut.

    A chart that has lost avoided edges must be solved, and neither flip nor overlap. Bisection finds how many of the
    first edges stay.
    """
    # Here, because that file imports this one.
    from ._unwrapping import unwrap

    vertices, offsets, corners, seams, selected = polygons
    uncut, n = Mesh(vertices, offsets, corner_vertices=corners), len(vertices)
    unwanted = edge_keys(avoided, n)
    edges = np.concatenate(cuts)
    keys = edge_keys(edges, n)
    is_avoided = np.isin(keys, unwanted)
    # Faces may have no corners.
    sides = edge_keys(np.stack([corners, corners[next_corner(np.unique(offsets))]], axis=1), n)
    given = [np.zeros((0, 2), np.int32) if seams is None else seams]

    def kept(count: int) -> np.ndarray:
        return ~is_avoided | (np.arange(len(edges)) < count)

    def is_sound(count: int) -> bool:
        is_kept = kept(count)
        solved = unwrap(
            uncut,
            seam_edges=np.concatenate([*given, edges[is_kept]]),
            selected_faces=selected,
            weights=options.weights,
            boundary=options.boundary,
            factorization=options.factorization,
            progress=progress,
        )
        bad = np.array([c.status != "solved" or c.flipped > 0 or c.overlapping > 0 for c in solved.charts] + [False])
        of_bad = sides[np.repeat(bad[solved.chart_of_face], np.diff(offsets))]
        return not np.isin(keys[~is_kept], of_bad).any()

    candidates = [0, *(np.flatnonzero(is_avoided) + 1).tolist()]
    # If all avoided edges stay, nothing changes. Removing all is tried first: part of a cut may be worse than none.
    low, high = 0, len(candidates) - 1
    if high > 0 and is_sound(0):
        high = 0
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if is_sound(candidates[middle]) else (middle + 1, high)
    parts = np.split(kept(candidates[low]), np.cumsum([len(cut) for cut in cuts])[:-1])
    return [cut[part] for cut, part in zip(cuts, parts) if part.any()]
