# SPDX-License-Identifier: GPL-3.0-or-later
"""The relaxation that runs in the view until the artist ends it."""

from collections.abc import Sequence

from ..core.solve.progress import Progress
from ..core.solve.relaxing import Relaxing, RelaxOptions
from ..core.words import texts
from ..edit_mesh.read import EditMesh
from .improving_view import ImprovingView


class RelaxView(ImprovingView):
    """Relaxes maps in the view.

    Attributes:
        can_move: whether anything may move; True until that is known.
    """

    def __init__(self, edit_meshes: Sequence[EditMesh], options: RelaxOptions, max_steps: int) -> None:
        """Take meshes with a UV map."""
        super().__init__(edit_meshes)
        self.can_move = True
        self._options = options
        self._max_steps = max_steps

    def _run(self, progress: Progress) -> None:
        relaxing = Relaxing([edit_mesh.polygons for edit_mesh in self._edit_meshes], self._options, progress)
        self._corners, self.can_move = relaxing.corners, relaxing.can_move
        steps, may_improve = 0, self.can_move
        while may_improve and steps < self._max_steps:
            may_improve = relaxing.step(1, progress)
            steps += 1
            self._latest = relaxing.now()

    def _status(self) -> str:
        return (
            texts.relax_status(0.0, 0)
            if self.answer is None
            else texts.relax_status(self.answer.gain, self.answer.steps)
        )
