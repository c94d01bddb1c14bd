# SPDX-License-Identifier: GPL-3.0-or-later
"""The packing that gets denser in the view until the artist ends it."""

import time
from collections.abc import Sequence

import numpy as np

from ..core.layout.map_packing import MapPacking, MapPackOptions
from ..core.solve.progress import Progress
from ..core.words import texts
from ..edit_mesh.read import EditMesh
from .improving_view import ImprovingView


class PackView(ImprovingView):
    """Packs maps in the view.

    Attributes:
        packing: the packing; None until the first is there.
    """

    def __init__(
        self, edit_meshes: Sequence[EditMesh], chosen: Sequence[np.ndarray], options: MapPackOptions, seconds: float
    ) -> None:
        """Take meshes with a UV map, their chosen faces, (F,) bool, and the time after which the search ends."""
        super().__init__(edit_meshes)
        self.packing: MapPacking | None = None
        self._chosen = chosen
        self._options = options
        self._seconds = seconds

    def _run(self, progress: Progress) -> None:
        end = time.monotonic() + self._seconds
        packing = MapPacking([each.polygons for each in self._edit_meshes], self._chosen, self._options, progress)
        self._corners = packing.corners
        self.packing = packing
        if not packing.can_move:
            return
        self._latest = packing.now()
        may_improve = True
        while may_improve and time.monotonic() < end:
            may_improve = packing.step(1, progress)
            self._latest = packing.now()

    def _status(self) -> str:
        if self.answer is None:
            return texts.pack_status(None, 0)
        return texts.pack_status(self.answer.fill, self.answer.steps, self._options.fills_box)
