"""Seams that lower the distortion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._arguments import Faces, Progress
from ._options import SeamOptionChanges, SeamOptions, changed

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Cuts(list):
    """Cuts, each (n, 2) int32 vertex pairs: a list, and what there is to say of it."""

    message: str = ""
    """For people: parts that there is too little memory for, which got no seams; empty where there are none."""


def suggest_seams(
    vertices: npt.ArrayLike,
    faces: Faces,
    corner_vertices: npt.ArrayLike | None = None,
    *,
    options: SeamOptions | None = None,
    seam_edges: npt.ArrayLike | None = None,
    selected_faces: npt.ArrayLike | None = None,
    vertex_preference: npt.ArrayLike | None = None,
    progress: Progress | None = None,
    **changes: Unpack[SeamOptionChanges],
) -> npt.NDArray[np.int32]:
    """Propose seams that lower the distortion of `unwrap` most, beside those that the mesh has.

    Topology comes first: handles are cut open and closed surfaces slit, whatever that takes, because they could not be
    unwrapped otherwise. Then the most distorted regions are joined to the seams one after the other, and each cut is
    solved before it is proposed, so that unwrapping with it shows lower distortion. A component gets no more of these
    once `scale_limit`, `qc_limit` and `energy_limit` are met or nothing helps. Charts that cover themselves in the map,
    or have flipped faces, are then parted until none does, unless `max_length` forbids that, and seams that the maps
    can do without are taken back. Where a plane x, y or z = constant mirrors a component's faces onto the mesh's, its
    seams come in mirrored pairs or lie on the plane if the edges allow that.

    Hard surfaces, without a `max_length`, are unfolded instead: parts that are flat, or rolled like a pipe, are cut
    from each other along sharp edges and hinged together where that fits, so that no seam crosses a flat face and
    nothing is stretched. Of the two the seams are proposed that cost less: distortion by `energy_limit`, length by how
    sharp the edges are, and islands (docs/paper.md has the formula).

    How vertices and faces are numbered makes no difference.

    Args:
        vertices: (V, 3) positions, any unit.
        faces: as in `unwrap`.
        corner_vertices: as in `unwrap`.
        options: when to stop, and how maps are made; its fields may be given one by one as keywords, which go first.
        seam_edges: (S, 2) seams that stay; the proposed ones complete them.
        selected_faces: (faces,) bool, all faces when left out; only edges between two of them are proposed.
        vertex_preference: (V,) from -1 to 1: above 0 prefers seams at these vertices, below 0 avoids them, 0 leaves the
            choice to the distortion. Where the mean of an edge's ends is p, it counts as 8^-p times as long.
        progress: as in `parameterize`.

    Returns:
        (S, 2) int32 vertex pairs, the smaller vertex first, cut after cut in the order in which they were found, first
        what topology needs, then what lowers the distortion most.

    Raises:
        ValueError: the arrays do not describe a mesh, or an option is out of range.
        TypeError: an argument is of the wrong type, or a keyword is no option; the message names the closest one.
        Cancelled: `progress` returned False.
        MemoryError: there is too little memory for the mesh, or for any part of it.

    Warns:
        RuntimeWarning: there is too little memory for a part of the mesh, which got no seams, while others did.
    """
    cuts = suggest_cuts(
        vertices,
        faces,
        corner_vertices,
        options=changed(options, SeamOptions(), changes, SeamOptionChanges, suggest_seams),
        seam_edges=seam_edges,
        selected_faces=selected_faces,
        vertex_preference=vertex_preference,
        progress=progress,
    )
    if cuts.message:
        _native.warn(cuts.message)
    return np.concatenate([np.zeros((0, 2), np.int32), *cuts])


def suggest_cuts(
    vertices: npt.ArrayLike,
    faces: Faces,
    corner_vertices: npt.ArrayLike | None = None,
    *,
    options: SeamOptions | None = None,
    seam_edges: npt.ArrayLike | None = None,
    selected_faces: npt.ArrayLike | None = None,
    vertex_preference: npt.ArrayLike | None = None,
    progress: Progress | None = None,
    **changes: Unpack[SeamOptionChanges],
) -> Cuts:
    """Return the seams of `suggest_seams` cut by cut, each (n, 2): the first few are those that help most.

    A cut and its mirror image are one. Arguments and errors are those of `suggest_seams`; what that warns of is the
    list's `message`.
    """
    used = changed(options, SeamOptions(), changes, SeamOptionChanges, suggest_cuts)
    polygons = _arguments.checked_polygon_mesh(vertices, faces, corner_vertices, seam_edges, selected_faces)
    preference = _arguments.checked_preference(vertex_preference, len(polygons[0]))
    edges, offsets, message = _native.suggest_seams(
        *polygons, preference, used.with_energy_limit(), _arguments.checked_progress(progress)
    )
    cuts = Cuts(np.split(edges, offsets[1:-1]) if len(edges) else [])
    cuts.message = message
    return cuts
