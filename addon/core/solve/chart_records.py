# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of up to a million charts: one field of all as an array, and the charts of one of several meshes."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np


def column(charts: Sequence[Any], name: str) -> np.ndarray:
    """Return one field of all `charts`, (number of charts,); `n_faces` is their number of faces.

    The native module has fields as arrays, without a record for each chart.
    """
    if isinstance(charts, (list, tuple)):
        values = [len(chart.faces) if name == "n_faces" else getattr(chart, name) for chart in charts]
        return np.array(values, None if values else object)
    return charts.n_faces if name == "n_faces" else charts.column(name)


class PartOfCharts(Sequence):
    """The charts of one of several joined meshes, or of a subdivided one, with the faces of that mesh."""

    def __init__(
        self,
        charts: Sequence[Any],
        first_face: int = 0,
        last: Any | None = None,  # noqa: ANN401 - a record
        face_of_face: np.ndarray | None = None,
    ) -> None:
        """Take the `charts` of this mesh in a result for several.

        Args:
            charts: the charts of this mesh alone.
            first_face: the index of the mesh's first face among all.
            last: another chart with some faces of this mesh; None for none.
            face_of_face: the face of this mesh for each face of the result's mesh; None if they are the same.
        """
        self._charts = charts
        self._first_face = first_face
        self._last = [] if last is None else [last]
        self._face_of_face = face_of_face

    def __len__(self) -> int:
        """Return the number of charts."""
        return len(self._charts) + len(self._last)

    def __getitem__(self, index: Any) -> Any:  # noqa: ANN401 - a record, or several
        """Return a record, or the list of several."""
        indices = range(len(self))[index]
        return [self._record(i) for i in indices] if isinstance(indices, range) else self._record(indices)

    def __iter__(self) -> Iterator[Any]:
        """Iterate over the records."""
        for chart in self._charts:
            yield self._own(chart)
        yield from map(self._own, self._last)

    @property
    def n_faces(self) -> np.ndarray:
        """Number of faces of each chart."""
        return self.column("n_faces")

    def column(self, name: str) -> np.ndarray:
        """Return one field of all charts."""
        of_most = column(self._charts, name)
        return np.concatenate([of_most, column(self._last, name)]) if self._last else of_most

    def _record(self, index: int) -> Any:  # noqa: ANN401 - a record of the native module
        n = len(self._charts)
        return self._own(self._charts[index] if index < n else self._last[index - n])

    def _own(self, chart: Any) -> Any:  # noqa: ANN401 - as above
        faces = chart.faces - self._first_face
        return replace(chart, faces=faces if self._face_of_face is None else np.unique(self._face_of_face[faces]))
