# SPDX-License-Identifier: GPL-3.0-or-later
"""The constraints that a selection asks for, with their marks."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..core import choices
from ..core.constraints import marks
from ..core.constraints.equations import BY_LENGTH, EVEN, FREE
from ..core.constraints.mirror_axis import mirror_axes, mirrored_pairs, seams_alone_differ
from ..core.mesh.charts import faces_of_charts_with_corners
from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh.selection import Selected
from ..edit_mesh.shapes import Shape

# This many selected vertices are the corners of a rectangle.
_N_CORNERS = 4
_DIRECTIONS = {"HORIZONTAL": marks.HORIZONTAL, "VERTICAL": marks.VERTICAL, "NEAREST": None}
_SPACINGS = {"FREE": FREE, "EVEN": EVEN, "LENGTH": BY_LENGTH}


@dataclass
class Found:
    """The constraints to add to a mesh.

    Attributes:
        made: each with its marks, by the vertices of edges.
        refused: the parts of the selection that cannot be constrained, None for none.
        alike: the edges of each pair of islands that are unwrapped alike and need no marks.
        missing: what to say if nothing is selected; empty for no edges.
        is_faceless: whether edges without a visible face were left out.
    """

    made: list[tuple[Shape, marks.Marks]]
    refused: marks.Refused | None = None
    alike: list[list[marks.Edge]] = field(default_factory=list)
    missing: str = ""
    is_faceless: bool = False

    @property
    def edges(self) -> set[marks.Edge]:
        """The edges whose islands change."""
        return {edge for marked in (*(marked for _, marked in self.made), *self.alike) for edge in marked}


def find(
    options: Any,  # noqa: ANN401 - the operator
    mesh: PolygonMesh,
    chosen: Selected,
) -> Found:
    """Return the constraints of the kind of the `options` to add to a mesh, whose visible faces are selected."""
    found = _FINDERS[options.kind](options, mesh, chosen)
    of_faces = [(constraint, marks.of_visible_faces(mesh, marked)) for constraint, marked in found.made]
    found.is_faceless, found.made = of_faces != found.made, of_faces
    if found.refused is not None and not found.refused.reasons:
        found.refused = None
    return found


def _straight(options: Any, mesh: PolygonMesh, chosen: Selected) -> Found:  # noqa: ANN401 - as above
    """Mark the selected edges."""
    kind = choices.SHAPE_STRAIGHT
    if options.direction != "OWN":
        return Found([(Shape(kind), marks.straight(mesh, chosen.edges, _DIRECTIONS[options.direction]))])
    chains = marks.chains(mesh, chosen.edges)
    return Found(
        [
            (Shape(kind, angle=math.degrees(marks.own_angle(mesh, chain))), dict.fromkeys(chain, marks.SLANTED))
            for chain in chains
        ]
    )


def _rectangle(_options: Any, mesh: PolygonMesh, chosen: Selected) -> Found:  # noqa: ANN401 - as above
    """Mark the borders of selected faces; of islands with selected vertices if no faces are, or only corners."""
    touched = np.isin(mesh.corner_vertices, chosen.vertices)
    if not touched.any():
        return Found([], missing=translate(texts.NO_RECTANGLE_SELECTED))
    faces = chosen.faces & mesh.selected_faces
    if not faces.any() or len(chosen.vertices) <= _N_CORNERS:
        faces = faces_of_charts_with_corners(mesh, mesh.selected_faces, touched)
    marked, refused = marks.rectangles(mesh, faces, chosen.vertices)
    return Found([(Shape(choices.SHAPE_RECTANGLE), marked)], refused, missing=translate(texts.NO_RECTANGLE_SELECTED))


def _grid(options: Any, mesh: PolygonMesh, chosen: Selected) -> Found:  # noqa: ANN401 - as above
    """Mark the edges of the selected quads."""
    faces = chosen.faces & mesh.selected_faces
    if not faces.any():
        return Found([], missing=translate(texts.NO_QUADS_SELECTED))
    marked, refused = marks.grids(mesh, faces)
    shape = Shape(choices.SHAPE_GRID, spacing=_SPACINGS[options.spacing])
    return Found([(shape, marked)], refused, missing=translate(texts.NO_QUADS_SELECTED))


def _symmetric(_options: Any, mesh: PolygonMesh, chosen: Selected) -> Found:  # noqa: ANN401 - as above
    """Mark the selected edges as the axis, or those on the mirror planes of the islands of selected faces."""
    shape, faces = Shape(choices.SHAPE_SYMMETRIC), chosen.faces & mesh.selected_faces
    if not faces.any():
        return Found([(shape, dict.fromkeys(chosen.edges, marks.AXIS))])
    islands = faces_of_charts_with_corners(mesh, mesh.selected_faces, faces[mesh.face_of_corner()])
    axes = mirror_axes(mesh, islands)
    alike = [pair for pair in mirrored_pairs(mesh, islands) if axes.keys().isdisjoint(pair)]
    missing = ""
    if not (axes or alike):
        missing = translate("No mirror plane found; select the edges along the axis of symmetry")
        if seams_alone_differ(mesh, islands):
            missing = translate("The mesh mirrors, but its seams do not; mark them alike on both sides")
    return Found([(shape, axes)], alike=alike, missing=missing)


_FINDERS: dict[str, Callable[[Any, PolygonMesh, Selected], Found]] = {
    choices.SHAPE_STRAIGHT: _straight,
    choices.SHAPE_RECTANGLE: _rectangle,
    choices.SHAPE_GRID: _grid,
    choices.SHAPE_SYMMETRIC: _symmetric,
}
