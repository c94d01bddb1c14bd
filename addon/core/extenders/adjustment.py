# SPDX-License-Identifier: GPL-3.0-or-later
"""The map of the islands that extenders act on, updated while their strengths change."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from .. import native
from ..errors import ReadableError
from ..layout import placement
from ..mesh import charts
from ..mesh.polygon_mesh import PolygonMesh
from ..solve import solution
from ..solve.options import Options
from ..words import texts
from ..words.translation import translate

# Relative residual for the map on screen, where a pixel is about a thousandth of the map.
_TOLERANCE = 1e-4


class AdjustmentError(ReadableError, ValueError):
    """The extenders cannot be adjusted; the message says why and what to do."""


class ExtenderAdjustment:
    """Solves charts of one mesh again for changing strengths of extenders, and keeps their position and size.

    Charts and factors are kept, so that a change costs a few solves only.

    Attributes:
        corners: (N,) intp, the corners of the charts that the extenders act on, whole faces.
        unused: how many of the extenders had no effect on the last map.
        charts: the records of the charts in the last map.
    """

    def __init__(self, mesh: PolygonMesh, options: Options, pairs: Sequence[tuple[int, int]]) -> None:
        """Take the charts of `mesh` that hold both vertices of one of the `pairs`.

        The adjusted extenders replace those of `mesh` between the same two vertices.

        Raises:
            AdjustmentError: no chart holds both vertices of a pair.
            NativeModuleError: `spectral_conformal` cannot be imported.
        """
        try:
            faces = charts.faces_of_charts_with(mesh, mesh.selected_faces, pairs)
        except ValueError as error:
            raise AdjustmentError(str(error)) from error
        if not faces.any():
            raise AdjustmentError(translate(texts.NO_COMMON_ISLAND))
        self._mesh = replace(mesh, selected_faces=faces)
        self._options = replace(options, method="spectral")
        self._pairs = list(pairs)
        adjusted = {frozenset(pair) for pair in pairs}
        self._others = [extender for extender in mesh.extenders if frozenset(extender[:2]) not in adjusted]
        self.corners = np.flatnonzero(faces[mesh.face_of_corner()])
        self.unused = 0
        self.charts: Sequence[Any] = ()
        try:
            self._unwrapper = native.spectral_conformal().Unwrapper(
                mesh.vertices,
                mesh.face_offsets,
                mesh.corner_vertices,
                **solution.arguments(self._mesh, self._options),
            )
        except ValueError as error:
            raise AdjustmentError(str(error)) from error
        self._chart: np.ndarray | None = None
        self._shown: np.ndarray | None = None
        self._scale: np.ndarray | None = None

    def map(self, strengths: Sequence[float], is_final: bool = False) -> np.ndarray:
        """Return the map at `corners`, (N, 2) float64, for a strength of each pair; `is_final` asks for all digits.

        Raises:
            AdjustmentError: an island could not be solved with these strengths, or pins hold all of them.
        """
        adjusted = [(*pair, strength) for pair, strength in zip(self._pairs, strengths)]
        extenders = [*self._others, *adjusted]
        constraints = {**solution.soft_constraints(self._mesh, self._options), "extenders": extenders}
        try:
            result = self._unwrapper.solve(**constraints, **({} if is_final else {"tolerance": _TOLERANCE}))
        except ValueError as error:
            raise AdjustmentError(str(error)) from error
        failed = np.flatnonzero(result.charts.column("status") != "solved")
        if len(failed):
            raise AdjustmentError(result.charts[failed[0]].message)
        self.unused = int(np.count_nonzero(result.unused_extenders[len(self._others) :]))
        if self.unused == len(self._pairs):
            raise AdjustmentError(translate(texts.HELD_BY_PINS))
        self.charts = result.charts
        if self._shown is None:
            self._chart = result.chart_of_face[self._mesh.face_of_corner()]
            self._shown, self._scale = self._start(result.uv, self._chart, result.charts.column("area"))
        self._shown = placement.turned_onto(result.uv, self._shown, self._chart, self._scale)
        return self._mesh.from_isotropic_uv(self._shown[self.corners])

    def _start(self, uv: np.ndarray, chart: np.ndarray, area: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the former map of the charts, (C, 2), side by side if the mesh has none, and their scale."""
        offsets = self._mesh.face_offsets
        former = self._mesh.isotropic_uv()
        former = np.zeros_like(uv) if former is None else np.where(np.isfinite(former), former, 0.0)
        former_area = placement.areas(former, chart, offsets, len(area))
        mapped = former_area > 0.0
        start = np.where(mapped[chart][:, None], former, placement.side_by_side(uv, np.where(mapped[chart], -1, chart)))
        return start, np.sqrt(placement.areas(start, chart, offsets, len(area)) / area)
