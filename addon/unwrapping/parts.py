# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of islands that were solved in place last, by mesh, until undo: live unwrapping lets them follow."""

from collections.abc import Sequence

import bpy
import numpy as np

from .. import session
from ..core.mesh.island_parts import with_parts_held
from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.solve.solution import Solution
from ..edit_mesh.read import EditMesh, Reading, read_mesh
from ..session import Lifetime, Remembered, identity
from ..session.identity import Identity


class _Parts(Remembered):
    """The faces of the parts, (F,) bool, with a digest of the topology they belong to, by mesh."""

    lifetime = Lifetime.EDIT_MODE

    def __init__(self) -> None:
        self.by_mesh: dict[Identity, tuple[np.ndarray, int]] = {}


def remember(edit_meshes: Sequence[EditMesh], solutions: Sequence[Solution]) -> None:
    """Remember the parts that were solved in each mesh, or that there are none."""
    remembered = session.of(_Parts).by_mesh
    for edit_mesh, solution in zip(edit_meshes, solutions):
        polygons, mesh = edit_mesh.polygons, identity.of(edit_mesh.mesh)
        remembered.pop(mesh, None)
        if polygons.held_corners is None or edit_mesh.subdivision is not None:
            continue
        charts = solution.chart_of_corner
        parts = np.unique(charts[polygons.held_corners & solution.solved_corners])
        remembered[mesh] = np.isin(charts[polygons.face_offsets[:-1]], parts), polygons.topology


def has_parts(mesh: bpy.types.Mesh) -> bool:
    """Return whether parts of a mesh are remembered, even if its faces have changed."""
    return identity.of(mesh) in session.of(_Parts).by_mesh


def read_visible(
    edit_object: bpy.types.Object, correct_aspect: bool
) -> tuple[EditMesh, PolygonMesh, np.ndarray | None]:
    """Read the visible faces of a mesh in edit mode.

    Returns what was read, its arrays with the remembered parts held, and the faces of these parts, (F,) bool: None if
    there are none, or the mesh has other faces now.
    """
    edit_mesh = read_mesh(edit_object, Reading(all_visible=True, correct_aspect=correct_aspect))
    polygons = edit_mesh.polygons
    faces, topology = session.of(_Parts).by_mesh.get(identity.of(edit_mesh.mesh), (None, 0))
    if faces is None or topology != polygons.topology:
        return edit_mesh, polygons, None
    faces = faces & polygons.selected_faces
    return edit_mesh, with_parts_held(polygons, faces), faces
