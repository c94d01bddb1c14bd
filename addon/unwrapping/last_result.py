# SPDX-License-Identifier: GPL-3.0-or-later
"""Which islands failed when they were unwrapped last, by mesh, as long as the file is open.

Faces and vertices are known by their index, so a result holds for the topology that the mesh had then, and holds again
once an undo brings that back.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from .. import session
from ..core.solve.solution import Solution
from ..edit_mesh.read import EditMesh
from ..session import Remembered, identity
from ..session.identity import Identity


@dataclass(frozen=True)
class Failed:
    """What failed in a mesh.

    Attributes:
        islands: (F,) intp, the failed island of every face, -1 for the others.
        contradicting: the edges whose constraints contradict each other, by their vertices.
        topology: the digest of the topology that they belong to.
    """

    islands: np.ndarray
    contradicting: list[tuple[int, int]]
    topology: int


class _Results(Remembered):
    """What failed, by mesh."""

    def __init__(self) -> None:
        self.by_mesh: dict[Identity, Failed] = {}


def remember(edit_meshes: Sequence[EditMesh], solutions: Sequence[Solution]) -> None:
    """Remember what failed. Faces that were not unwrapped this time keep what is remembered of them."""
    results = session.of(_Results).by_mesh
    for edit_mesh, solution in zip(edit_meshes, solutions):
        polygons = edit_mesh.polygons
        failed = solution.failed_islands.copy()
        mesh = identity.of(edit_mesh.mesh)
        before = results.get(mesh)
        if before is not None and before.topology == polygons.topology and before.islands.max(initial=-1) >= 0:
            kept = ~polygons.selected_faces & (before.islands >= 0)
            failed[kept] = before.islands[kept] + failed.max(initial=-1) + 1
        results[mesh] = Failed(failed, solution.contradicting_edges(), polygons.topology)


def is_remembered(mesh: bpy.types.Mesh) -> bool:
    """Return whether a mesh was unwrapped since the file was opened, whether it has changed or not."""
    return identity.of(mesh) in session.of(_Results).by_mesh


def failed(edit_mesh: EditMesh) -> Failed | None:
    """Return what failed in a mesh when it was unwrapped last; None if it has another topology now."""
    result = session.of(_Results).by_mesh.get(identity.of(edit_mesh.mesh))
    return result if result is not None and result.topology == edit_mesh.polygons.topology else None
