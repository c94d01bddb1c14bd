# SPDX-License-Identifier: GPL-3.0-or-later
"""The map of one chart while its pins move."""

from typing import Any

import numpy as np

from .. import native
from ..mesh.polygon_mesh import PolygonMesh
from .solution import constraints

# Charts of up to this many faces are polished in each movement, too: twice the time, 50 ms for this many.
_MAX_POLISHED = 20_000
# The coarsest for single precision.
_TOLERANCE = 1e-6


class PinnedChart:
    """The maps of one chart with the same pins at changing positions.

    The factor of the first map serves the next ones (`Unwrapper.solve` with `corner_uv`).

    Attributes:
        free: (N,) intp, the corners of the chart without a pin.
        n_pins: number of pinned points.
    """

    def __init__(self, mesh: PolygonMesh, faces: np.ndarray, pinned: np.ndarray, uv: np.ndarray, polish: str) -> None:
        """Take the chart of the `faces` (F,) bool, with the map `uv` (C, 2) and pins at the `pinned` corners (C,) bool.

        Pinned corners of a vertex with the same UV are one point. With `polish`, maps of charts that are not too large
        are polished.
        """
        self._mesh = mesh
        self._faces = faces
        in_chart = faces[mesh.face_of_corner()]
        self.free = np.flatnonzero(in_chart & ~pinned)
        self._pins = np.flatnonzero(in_chart & pinned)
        self._start, self._pins_at_start = uv[self.free], uv[self._pins]
        points = np.column_stack([mesh.corner_vertices[self._pins], self._pins_at_start])
        self.n_pins = len(np.unique(points, axis=0))
        self._isotropy = 1.0 / mesh.from_isotropic_uv(np.ones((1, 2)))
        if mesh.mirrored_corners is not None and mesh.mirrored_corners[in_chart.argmax()]:
            # The solver's orientation.
            self._isotropy = self._isotropy * (-1.0, 1.0)
        # Constraints single out directions, which a similarity would turn.
        self._is_similar = self.n_pins == 2 and mesh.equations is None
        self._polish = polish if np.count_nonzero(faces) <= _MAX_POLISHED else "off"
        self._corner_uv = np.zeros((len(mesh.corner_vertices), 2))
        self._unwrapper: Any = None

    def map(self, now: np.ndarray) -> np.ndarray | None:
        """Return the map, (N, 2) at `free`, for the pin positions in `now` (C, 2); None if there is none.

        Pins at their positions at the start give the map at the start. A single pin moves its chart; two turn and
        scale it, unless it has constraints.

        Raises:
            NativeModuleError: `spectral_conformal` cannot be imported.
        """
        positions = now[self._pins]
        if np.array_equal(positions, self._pins_at_start):
            return self._start
        # A script may move a pin to a position that is not finite.
        if not (np.isfinite(positions).all() and np.isfinite(self._pins_at_start).all()):
            return None
        if self.n_pins == 1:
            return self._start + (positions[0] - self._pins_at_start[0])
        return self._turned(positions) if self._is_similar else self._solved(positions)

    def _turned(self, positions: np.ndarray) -> np.ndarray | None:
        """Return the map turned and scaled so that its two pins lie at `positions`; None where they lie together."""
        points, before = _complex(self._start * self._isotropy), _complex(self._pins_at_start * self._isotropy)
        after = _complex(positions * self._isotropy)
        other = np.argmax(np.abs(before - before[0]))
        if before[other] == before[0] or after[other] == after[0]:
            return None
        moved = after[0] + (points - before[0]) * ((after[other] - after[0]) / (before[other] - before[0]))
        return np.stack([moved.real, moved.imag], axis=1) / self._isotropy

    def _solved(self, positions: np.ndarray) -> np.ndarray | None:
        self._corner_uv[self._pins] = positions * self._isotropy
        try:
            if self._unwrapper is None:
                pinned = np.zeros(len(self._corner_uv), dtype=bool)
                pinned[self._pins] = True
                self._unwrapper = native.spectral_conformal().Unwrapper(
                    self._mesh.with_map(self._corner_uv),
                    seam_edges=self._mesh.seam_edges,
                    selected_faces=self._faces,
                    fixed=pinned,
                    polish=self._polish,
                    **constraints(self._mesh),
                )
            # UVs are in single precision, and nothing looks at the measures of a map that the next movement replaces.
            result = self._unwrapper.solve(uv=self._corner_uv, tolerance=_TOLERANCE, measure=False)
        except ValueError:
            return None
        if result.charts.column("status").tolist() != ["solved"]:
            return None
        return result.uv[self.free] / self._isotropy


def _complex(points: np.ndarray) -> np.ndarray:
    return points[:, 0] + 1j * points[:, 1]
