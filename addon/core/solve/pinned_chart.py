# SPDX-License-Identifier: GPL-3.0-or-later
"""The map of one chart while its pins move."""

import numpy as np

from .. import native
from ..mesh.polygon_mesh import PolygonMesh

# Maps kept of one chart: every pin that moves by itself needs one more.
_MAX_SAMPLES = 12
# Relative; Blender keeps pins in single precision, whose spacing is 1.2e-7.
_PIN_TOLERANCE = 1e-6


class PinnedChart:
    """The maps of one chart with the same pins at changing positions.

    The least squares conformal map is a complex linear function of its pins. So the maps solved before give, without a
    solve, the map for all pin positions that are a complex linear combination of theirs: two or three suffice while the
    same pins are dragged.

    Attributes:
        corners: (N,) intp, the corners of the chart.
        pinned: (N,) bool, which of them are pinned.
        n_pins: number of pinned points.
    """

    def __init__(self, mesh: PolygonMesh, faces: np.ndarray, pinned: np.ndarray, uv: np.ndarray) -> None:
        """Take the chart of the `faces` (F,) bool, with pins at the `pinned` corners (C,) bool.

        Pinned corners of a vertex with the same `uv` (C, 2) are one point.
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
        self._positions: list[np.ndarray] = []
        self._maps: list[np.ndarray] = []

    def map(self, start: np.ndarray, now: np.ndarray) -> np.ndarray | None:
        """Return the map, (N, 2) at `corners`, for the pin positions in `now` (C, 2); None if there is none.

        Pins at their positions in `start`, (C, 2), give `start`. A single pin moves its chart, two turn and scale it.

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
        if self.n_pins == 2:
            found = self._turned(start, positions)
        else:
            found = self._combined(positions)
            if found is None:
                found = self._solved(now)
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

    def _combined(self, positions: np.ndarray) -> np.ndarray | None:
        """Return the map as a combination of known maps; None if the pin `positions` are no combination of theirs."""
        if not self._positions:
            return None
        target = _complex(positions * self._isotropy)
        # The constant map, with all pins at one point.
        basis = np.stack([*self._positions, np.ones_like(target)], axis=1)
        factors = np.linalg.lstsq(basis, target, rcond=_PIN_TOLERANCE)[0]
        if np.abs(basis @ factors - target).max() > _PIN_TOLERANCE * np.abs(target).max():
            return None
        points = np.stack([*self._maps, np.ones_like(self._maps[0])], axis=1) @ factors
        return np.stack([points.real, points.imag], axis=1) / self._isotropy

    def _solved(self, now: np.ndarray) -> np.ndarray | None:
        pins = self.corners[self.pinned]
        positions = now[pins] * self._isotropy
        corners = len(self._mesh.corner_vertices)
        corner_uv, pinned = np.zeros((corners, 2)), np.zeros(corners, dtype=bool)
        corner_uv[pins], pinned[pins] = positions, True
        try:
            result = native.spectral_conformal().unwrap(
                self._mesh.vertices,
                self._mesh.face_offsets,
                self._mesh.corner_vertices,
                seam_edges=self._mesh.seam_edges,
                selected_faces=self._faces,
                corner_uv=corner_uv,
                pinned_corners=pinned,
            )
        except ValueError:
            return None
        if not result.solved_corners[self.corners].all() or len(result.charts) != 1:
            return None
        uv = result.uv[self.corners].astype(np.float64)
        self._positions = [*self._positions, _complex(positions)][-_MAX_SAMPLES:]
        self._maps = [*self._maps, _complex(uv)][-_MAX_SAMPLES:]
        return uv / self._isotropy


def _complex(points: np.ndarray) -> np.ndarray:
    return points[:, 0] + 1j * points[:, 1]
