# SPDX-License-Identifier: GPL-3.0-or-later
"""Charts of a mesh in edit mode that follow their moving pins."""

import time
from dataclasses import dataclass, field
from enum import Enum, auto
from itertools import chain, compress

import bmesh
import bpy
import numpy as np
from bmesh.types import BMLayerItem, BMLoop

from .. import compatibility
from ..core.mesh.charts import chart_of_face
from ..core.mesh.polygon_mesh import PolygonMesh
from ..core.solve.options import Options
from ..core.solve.pinned_chart import PinnedChart
from ..edit_mesh.write import write_loops
from . import last_operator

# In seconds: a map that takes longer waits until the pins rest, because it would block the mouse.
_SLOW = 2.0


class Followed(Enum):
    """The result of a movement of pins."""

    NOTHING_MOVED = auto()
    WRITTEN = auto()
    WRITTEN_TOO_LATE = auto()
    """The transform has ended, so its undo step lacks the map."""
    WAITS = auto()
    """The map takes long and waits until the pins rest."""


@dataclass
class _Chart:
    """A chart with moving pins; `loops` are its corners without a pin."""

    pinned_chart: PinnedChart
    loops: list[BMLoop]


@dataclass
class _Drag:
    """A movement of pins since its start.

    `charts` are those of islands, then those of parts, each by number; None for those that move as a whole.
    """

    operator: int
    start: np.ndarray
    chart_of_face: tuple[np.ndarray, np.ndarray]
    polish: str
    charts: tuple[dict[int, _Chart | None], dict[int, _Chart | None]] = field(default_factory=lambda: ({}, {}))
    seconds: float = 0.0
    last_motion: float = 0.0


class PinnedMap:
    """The UV map of a mesh in edit mode, with pins.

    Attributes:
        waits: whether the map waits for the pins to rest, because it is slow.
    """

    def __init__(
        self, mesh: bpy.types.Mesh, polygons: PolygonMesh, with_parts: PolygonMesh, parts: np.ndarray | None
    ) -> None:
        """Read the mesh; the `selected_faces` of `polygons` are the visible ones.

        `parts` (F,) bool are the faces of parts of islands, which follow by themselves `with_parts` that are held. Pins
        of the rest move their whole island.
        """
        self.waits = False
        self._mesh = mesh
        self._polygons = polygons
        self._with_parts = with_parts
        self._of_parts = np.zeros_like(polygons.selected_faces) if parts is None else parts
        self._pins = np.flatnonzero(with_parts.pinned_corners)
        self._bm = bmesh.from_edit_mesh(mesh)
        corners = chain.from_iterable(face.loops for face in self._bm.faces)
        self._loops = list(compress(corners, with_parts.pinned_corners.tolist()))
        self._operator = last_operator.address()
        self._drag: _Drag | None = None

    @property
    def is_valid(self) -> bool:
        """Whether the pins are still readable."""
        return self._bm.is_valid and all(loop.is_valid for loop in self._loops)

    @property
    def is_dragged(self) -> bool:
        """Whether the pins have moved and no operator has ended since."""
        return self._drag is not None and self._drag.operator == last_operator.address()

    @property
    def seconds_of_rest(self) -> float:
        """Seconds since the pins moved last."""
        return time.perf_counter() - self._drag.last_motion

    def continue_from(self, before: "PinnedMap") -> None:
        """Continue the drag of the map `before`, if it is the same drag of the same pins."""
        drag = before._drag
        if drag and drag.operator == self._operator and np.array_equal(before._pins, self._pins):
            self._drag, self.waits = drag, before.waits

    def note_operators(self) -> None:
        """Note that no operator until now has moved the pins."""
        self._operator = last_operator.address()

    def follow(self, options: Options, use_sync_selection: bool, is_resting: bool = False) -> Followed:
        """Map the charts whose pins have moved; slow ones only once the pins rest."""
        layer = self._bm.loops.layers.uv.active
        positions = np.array([loop[layer].uv for loop in self._loops], dtype=np.float64).reshape(-1, 2)
        moved = (positions != self._polygons.uv[self._pins]).any(axis=1)
        if not moved.any() and not (is_resting and self.waits):
            return Followed.NOTHING_MOVED
        if not last_operator.moves_pins(self._operator):
            self._polygons.uv[self._pins] = positions
            return Followed.NOTHING_MOVED
        drag = self._drag
        operator = last_operator.address()
        if drag is None or drag.operator != self._operator:
            islands = chart_of_face(self._polygons, self._polygons.selected_faces)
            parts = islands
            if self._with_parts is not self._polygons:
                parts = chart_of_face(self._with_parts, self._polygons.selected_faces)
            polish = options.polish if options.method == "spectral" else "off"
            drag = self._drag = _Drag(self._operator, self._polygons.uv.copy(), (islands, parts), polish)
        self._polygons.uv[self._pins] = positions
        drag.last_motion = time.perf_counter()
        corners = self._pins[moved]
        in_part = self._of_parts[self._faces_of(corners)]
        self._add_charts(drag, corners[~in_part], False, layer, use_sync_selection)
        self._add_charts(drag, corners[in_part], True, layer, use_sync_selection)
        if drag.seconds > _SLOW and not is_resting:
            self.waits = True
            return Followed.WAITS
        start = time.perf_counter()
        # Islands last: if pins of the rest moved, too, the part moves with its island.
        charts = chain(drag.charts[True].values(), drag.charts[False].values())
        written = [self._write(chart, layer) for chart in charts if chart]
        self.waits = False
        if any(written):
            bmesh.update_edit_mesh(self._mesh, loop_triangles=False, destructive=False)
        drag.seconds = time.perf_counter() - start
        if not any(written):
            return Followed.NOTHING_MOVED
        return Followed.WRITTEN if operator == drag.operator else Followed.WRITTEN_TOO_LATE

    def _faces_of(self, corners: np.ndarray) -> np.ndarray:
        """Return the faces of a few corners, without those of all."""
        return np.searchsorted(self._polygons.face_offsets, corners, side="right") - 1

    def _add_charts(
        self, drag: _Drag, moved: np.ndarray, as_parts: bool, layer: BMLayerItem, use_sync_selection: bool
    ) -> None:
        """Add the charts of the `moved` corners to the drag, `as_parts` or as whole islands."""
        polygons = self._with_parts if as_parts else self._polygons
        chart, charts = drag.chart_of_face[as_parts], drag.charts[as_parts]
        for number in set(chart[self._faces_of(moved)].tolist()) - set(charts) - {-1}:
            faces = chart == number
            loops = [loop for face in compress(self._bm.faces, faces.tolist()) for loop in face.loops]
            if compatibility.all_selected(self._bm, layer, loops, use_sync_selection):
                charts[number] = None
                continue
            pinned_chart = PinnedChart(polygons, faces, polygons.pinned_corners, drag.start, drag.polish)
            free = ~polygons.pinned_corners[faces[polygons.face_of_corner()]]
            charts[number] = _Chart(pinned_chart, list(compress(loops, free.tolist())))

    def _write(self, chart: _Chart, layer: BMLayerItem) -> bool:
        """Write the map of a chart for its current pins; return whether there is one."""
        uv = chart.pinned_chart.map(self._polygons.uv)
        if uv is None:
            return False
        write_loops(layer, chart.loops, uv)
        self._polygons.uv[chart.pinned_chart.free] = uv.astype(np.float32)
        return True
