# SPDX-License-Identifier: GPL-3.0-or-later
"""The map of the islands that extenders act on, updated while their strengths change."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import numpy as np

from .. import native
from ..errors import ReadableError
from ..layout import placement
from ..mesh import charts
from ..mesh.polygon_mesh import Force, PolygonMesh
from ..solve import solution
from ..solve.options import Options
from ..words.translation import translate

# Relative residual for the map on screen, where a pixel is about a thousandth of the map.
_TOLERANCE = 1e-4


@contextmanager
def _readable() -> Iterator[None]:
    try:
        yield
    except ValueError as error:
        raise ReadableError(str(error)) from error


class ExtenderAdjustment:
    """Solves charts of one mesh again for changing extenders, and keeps their position and size, or their hard pins.

    Charts and factors are kept, so a change costs only a few solves.

    Attributes:
        corners: (C,) bool, the corners of the charts that the extenders act on, whole faces.
        unused: how many of the extenders had no effect on the last map.
        charts: the records of the charts in the last map.
        flipped, overlapping: numbers of faces in the last map.
    """

    @_readable()
    def __init__(self, mesh: PolygonMesh, options: Options, pairs: Collection[tuple[int, int]]) -> None:
        """Take the charts of `mesh`, which has a map, that hold both vertices of one of the `pairs`.

        Raises:
            ReadableError: there is none, or `spectral_conformal` cannot be imported.
        """
        faces = charts.faces_of_charts_with(mesh, mesh.selected_faces, pairs)
        if not faces.any():
            raise ReadableError(
                translate("No effect: the vertices lie in different islands; remove the seams between them")
            )
        self._mesh, self._options = replace(mesh, selected_faces=faces), replace(options, method="spectral")
        self._pairs = set(map(frozenset, pairs))
        arguments = solution.arguments(self._mesh, self._options)
        self._unwrapper = native.spectral_conformal().Unwrapper(**arguments)
        self._shown: np.ndarray | None = None
        self._folded = 0
        self.corners = faces[mesh.face_of_corner()]
        self.unused, self.charts, self.flipped, self.overlapping = 0, (), 0, 0

    @_readable()
    def map(self, changed: Force | None = None, is_final: bool = False) -> np.ndarray:
        """Return the map, (C, 2) float64, right at `corners`; `is_final` asks for all digits.

        `changed` replaces the extender of the same two vertices, or is added to those of the mesh.

        Raises:
            ReadableError: an island could not be solved, or pins hold all the extenders; and unless it is final, an
                island has more flipped or overlapping faces than the first map.
        """
        extenders = self._mesh.extenders
        if changed is not None:
            extenders = (*(each for each in extenders if each[:2] != changed[:2]), changed)
        mesh = replace(self._mesh, extenders=extenders)
        tolerance: dict[str, Any] = {} if is_final else {"tolerance": _TOLERANCE}
        result = self._unwrapper.solve(**solution.soft_constraints(mesh, self._options), **tolerance)
        failed = np.flatnonzero(result.charts.column("status") != "solved")
        flipped, overlapping = (int(result.charts.column(name).sum()) for name in ("flipped", "overlapping"))
        folded = flipped + overlapping
        # The first map is that of the mesh as it is.
        if self._shown is not None and not is_final and (len(failed) or folded > self._folded):
            raise ReadableError(translate("More would fold the island; add a seam, or push or pull other vertices"))
        if len(failed):
            raise ReadableError(result.charts[failed[0]].message)
        unused = [flag for each, flag in zip(extenders, result.unused_extenders) if frozenset(each[:2]) in self._pairs]
        if unused and all(unused):
            raise ReadableError(translate("No effect: pins hold both ends; unpin one or use soft pins"))
        self.unused, self.charts = sum(map(bool, unused)), result.charts
        self.flipped, self.overlapping = flipped, overlapping
        uv, charts = solution.unmirrored(mesh, result.uv), result.charts
        if self._shown is None:
            self._folded = folded
            self._begin(uv, result.chart_of_face[mesh.face_of_corner()], charts.column("area"))
        turned = placement.turned_onto(uv, self._shown, self._chart, self._scale, mesh.constrained_corners())
        is_hard = (charts.column("method") == "lscm") | (self._options.soft_pins == 0.0)
        is_held = (charts.column("n_pins") > 1) & is_hard
        self._shown = np.where(np.append(is_held, False)[self._chart][:, None], uv, turned)
        shown = mesh.from_isotropic_uv(self._shown)
        return shown if mesh.held_corners is None else np.where(mesh.held_corners[:, None], mesh.uv, shown)

    def _begin(self, uv: np.ndarray, chart: np.ndarray, area: np.ndarray) -> None:
        """Take the former map of the charts, and the scales to its areas; charts without area go side by side."""
        former = np.nan_to_num(self._mesh.isotropic_uv(), posinf=0.0, neginf=0.0)
        mapped = placement.areas(former, chart, self._mesh.face_offsets, len(area))[chart] > 0.0
        self._shown = np.where(mapped[:, None], former, placement.side_by_side(uv, np.where(mapped, -1, chart)))
        self._chart = chart
        self._scale = np.sqrt(placement.areas(self._shown, chart, self._mesh.face_offsets, len(area)) / area)
