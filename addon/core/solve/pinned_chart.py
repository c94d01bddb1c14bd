# SPDX-License-Identifier: GPL-3.0-or-later
"""The map of one chart while its pins move."""

from typing import Any

import numpy as np

from .. import native
from ..mesh.polygon_mesh import PolygonMesh
from .solution import constraints

# Charts of up to this many faces are polished in each movement, too: twice the time, 50 ms for this many.
_MAX_POLISHED = 20_000


class PinnedChart:
    """The maps of one chart with the same pins at changing positions.

    The factor of the first map serves the next ones (`Unwrapper.solve` with `corner_uv`).

    Attributes:
        corners: (N,) intp, the corners of the chart.
        pinned: (N,) bool, which of them are pinned.
        n_pins: number of pinned points.
    """

    def __init__(self, mesh: PolygonMesh, faces: np.ndarray, pinned: np.ndarray, uv: np.ndarray, polish: bool) -> None:
        """Take the chart of the `faces` (F,) bool, with pins at the `pinned` corners (C,) bool.

        Pinned corners of a vertex with the same `uv` (C, 2) are one point. With `polish`, maps of charts that are not
        too large are polished.
        """
        self._mesh = mesh
        self._faces = faces
        self.corners = np.flatnonzero(faces[mesh.face_of_corner()])
        self.pinned = pinned[self.corners]
        pins = self.corners[self.pinned]
        points = np.column_stack([mesh.corner_vertices[pins], uv[pins]])
        self.n_pins = len(np.unique(points, axis=0))
        self._isotropy = 1.0 / mesh.from_isotropic_uv(np.ones((1, 2)))
        if mesh.mirrored_corners is not None and mesh.mirrored_corners[self.corners[0]]:
            # The solver's orientation.
            self._isotropy = self._isotropy * (-1.0, 1.0)
        # Constraints single out directions, which a similarity would turn.
        self._is_similar = self.n_pins == 2 and mesh.equations is None
        self._polish = polish and np.count_nonzero(faces) <= _MAX_POLISHED
        self._unwrapper: Any = None

    def map(self, start: np.ndarray, now: np.ndarray) -> np.ndarray | None:
        """Return the map, (N, 2) at `corners`, for the pin positions in `now` (C, 2); None if there is none.

        Pins at their positions in `start`, (C, 2), give `start`. A single pin moves its chart; two turn and scale
        it, unless it has constraints.

        Raises:
            NativeModuleError: `spectral_conformal` cannot be imported.
        """
        start, positions = start[self.corners], now[self.corners][self.pinned]
        if np.array_equal(positions, start[self.pinned]):
            return start
        # A script may move a pin to a position that is not finite.
        if not (np.isfinite(positions).all() and np.isfinite(start[self.pinned]).all()):
            return None
        if self.n_pins == 1:
            return start + (positions[0] - start[self.pinned][0])
        found = self._turned(start, positions) if self._is_similar else self._solved(now)
        if found is not None:
            found[self.pinned] = positions
        return found

    def _turned(self, start: np.ndarray, positions: np.ndarray) -> np.ndarray | None:
        """Return `start` turned and scaled so that its two pins lie at `positions`; None where they lie together."""
        points, before = _complex(start * self._isotropy), _complex(start[self.pinned] * self._isotropy)
        after = _complex(positions * self._isotropy)
        other = np.argmax(np.abs(before - before[0]))
        if before[other] == before[0] or after[other] == after[0]:
            return None
        moved = after[0] + (points - before[0]) * ((after[other] - after[0]) / (before[other] - before[0]))
        return np.stack([moved.real, moved.imag], axis=1) / self._isotropy

    def _solved(self, now: np.ndarray) -> np.ndarray | None:
        pins = self.corners[self.pinned]
        corners = len(self._mesh.corner_vertices)
        corner_uv = np.zeros((corners, 2))
        corner_uv[pins] = now[pins] * self._isotropy
        try:
            if self._unwrapper is None:
                pinned = np.zeros(corners, dtype=bool)
                pinned[pins] = True
                self._unwrapper = native.spectral_conformal().Unwrapper(
                    *self._mesh.surface,
                    seam_edges=self._mesh.seam_edges,
                    selected_faces=self._faces,
                    pinned_corners=pinned,
                    corner_uv=corner_uv,
                    polish=self._polish,
                    **constraints(self._mesh),
                )
            result = self._unwrapper.solve(corner_uv=corner_uv)
        except ValueError:
            return None
        if not result.solved_corners[self.corners].all() or len(result.charts) != 1:
            return None
        return result.uv[self.corners].astype(np.float64) / self._isotropy


def _complex(points: np.ndarray) -> np.ndarray:
    return points[:, 0] + 1j * points[:, 1]
