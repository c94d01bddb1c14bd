"""Seams that lower the distortion."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _arguments, _native
from ._types import Boundary, Factorization, Progress, Weights


def suggest_seams(
    vertices: npt.ArrayLike,
    face_offsets: npt.ArrayLike,
    corner_vertices: npt.ArrayLike,
    *,
    seam_edges: npt.ArrayLike | None = None,
    selected_faces: npt.ArrayLike | None = None,
    max_length: float | None = None,
    scale_limit: float = 2.0,
    qc_limit: float = 1.05,
    weights: Weights = "uniform",
    boundary: Boundary = "length",
    progress: Progress | None = None,
    factorization: Factorization = "auto",
) -> npt.NDArray[np.int32]:
    """Propose seams that lower the distortion of `unwrap` most, beside those that the mesh has.

    Topology comes first: handles are cut open and closed surfaces slit, whatever that takes, because they could not be
    unwrapped otherwise. Then the most distorted places are joined to the seams one after the other, and each cut is
    solved before it is proposed, so that unwrapping with it shows lower distortion. A component gets no more seams once
    `scale_limit` and `qc_limit` are met or nothing helps. Where a plane x, y or z = constant mirrors a component's
    faces onto the mesh's, its seams come in mirrored pairs or lie on the plane if the edges allow that.

    Args:
        vertices: (V, 3) positions, any unit.
        face_offsets: as in `unwrap`.
        corner_vertices: as in `unwrap`.
        seam_edges: (S, 2) seams that stay; the proposed ones complete them.
        selected_faces: (faces,) bool, all faces when left out; only edges between two of them are proposed.
        max_length: limit of the total length of the proposed seams, in the unit of the vertices; none when left out.
            What topology needs counts, but is proposed even beyond the limit.
        scale_limit: a component is good enough when 95 % of its area has a linear scale (root of UV area over 3D area)
            within this factor of the median, and
        qc_limit: when its mean quasi-conformal distortion is not above this.
        weights: of the maps, see `parameterize`.
        boundary: see `parameterize`.
        progress: see `Progress`.
        factorization: see `parameterize`.

    Returns:
        (S, 2) int32 vertex pairs, the smaller vertex first, cut after cut in the order in which they were found: first
        what topology needs, then what lowers the distortion most.

    Raises:
        ValueError: the arrays do not describe a mesh, or an option is out of range.
        Cancelled: `progress` returned False.
    """
    cuts = suggest_cuts(
        vertices,
        face_offsets,
        corner_vertices,
        seam_edges=seam_edges,
        selected_faces=selected_faces,
        max_length=max_length,
        scale_limit=scale_limit,
        qc_limit=qc_limit,
        weights=weights,
        boundary=boundary,
        progress=progress,
        factorization=factorization,
    )
    return np.concatenate([np.zeros((0, 2), np.int32), *cuts])


def suggest_cuts(
    vertices: npt.ArrayLike,
    face_offsets: npt.ArrayLike,
    corner_vertices: npt.ArrayLike,
    *,
    seam_edges: npt.ArrayLike | None = None,
    selected_faces: npt.ArrayLike | None = None,
    max_length: float | None = None,
    scale_limit: float = 2.0,
    qc_limit: float = 1.05,
    weights: Weights = "uniform",
    boundary: Boundary = "length",
    progress: Progress | None = None,
    factorization: Factorization = "auto",
) -> list[npt.NDArray[np.int32]]:
    """Return the seams of `suggest_seams` cut by cut, each (n, 2): the first few are those that help most.

    A cut and its mirror image are one. Arguments and errors are those of `suggest_seams`.
    """
    polygons = _arguments.checked_polygon_mesh(vertices, face_offsets, corner_vertices, seam_edges, selected_faces)
    edges, offsets = _native.suggest_seams(
        *polygons,
        np.inf if max_length is None else _arguments.checked_at_least(max_length, 0.0, "max_length"),
        _arguments.checked_at_least(scale_limit, 1.0, "scale_limit"),
        _arguments.checked_at_least(qc_limit, 1.0, "qc_limit"),
        _arguments.checked_patch_options(
            weights, boundary, factorization, fill_holes=False, area_blend=0.0, fold_free=False
        ),
        _arguments.checked_progress(progress),
    )
    return np.split(edges, offsets[1:-1]) if len(edges) else []
