# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of up to a million charts: one field of all as an array, and the charts of one of several meshes."""

import functools
from collections.abc import Iterable, Iterator, Sequence
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


class ChartsOfAll:
    """The charts of several meshes, in order, for their columns: consecutive parts of one result are read at once."""

    def __init__(self, charts: Iterable[Sequence[Any]]) -> None:
        """Take the charts of each mesh."""
        runs: list[Sequence[Any]] = []
        for part in charts:
            if not (runs and isinstance(runs[-1], PartOfCharts) and runs[-1].takes(part)):
                runs.append(part.for_columns() if isinstance(part, PartOfCharts) else part)
        self._runs = [run for run in runs if len(run)]
        self._columns: dict[str, np.ndarray] = {}
        self.solved = self.column("status").astype(object) == "solved"

    def column(self, name: str) -> np.ndarray:
        """Return one field of all charts, read once; not to be changed."""
        if name not in self._columns:
            columns = [column(run, name) for run in self._runs]
            if len(columns) == 1:
                self._columns[name] = columns[0]
            else:
                self._columns[name] = np.concatenate(columns) if columns else np.zeros(0)
        return self._columns[name]


class PartOfCharts(Sequence):
    """The charts of one of several joined meshes, or of a subdivided one, with the faces of that mesh."""

    def __init__(
        self,
        charts: Sequence[Any],
        part: slice = slice(None),
        first_face: int = 0,
        last: Any | None = None,  # noqa: ANN401 - a record
        face_of_face: np.ndarray | None = None,
    ) -> None:
        """Take the `charts` of this mesh in a result for several.

        Args:
            charts: the charts of the result.
            part: those of this mesh.
            first_face: the index of the mesh's first face among all.
            last: another chart with some faces of this mesh; None for none.
            face_of_face: the face of this mesh for each face of the result's mesh; None if they are the same.
        """
        self._all, self._part = charts, part
        self._first_face = first_face
        self._last = [] if last is None else [last]
        self._face_of_face = face_of_face

    @functools.cached_property
    def _charts(self) -> Sequence[Any]:
        return self._all[self._part]

    def __len__(self) -> int:
        """Return the number of charts."""
        return len(range(*self._part.indices(len(self._all)))) + len(self._last)

    def __getitem__(self, index: Any) -> Any:  # noqa: ANN401 - a record, or several
        """Return a record, or the list of several."""
        indices = range(len(self))[index]
        return [self._record(i) for i in indices] if isinstance(indices, range) else self._record(indices)

    def __iter__(self) -> Iterator[Any]:
        """Iterate over the records."""
        for chart in self._charts:
            yield self._own(chart)
        yield from map(self._own, self._last)

    def for_columns(self) -> "PartOfCharts":
        """Return a copy that may take others, for the columns."""
        last = self._last[0] if self._last else None
        return PartOfCharts(self._all, self._part, self._first_face, last, self._face_of_face)

    def takes(self, other: Sequence[Any]) -> bool:
        """Append the `other` charts, for the columns alone; False if they are not next to these in the result."""
        is_next = isinstance(other, PartOfCharts) and other._all is self._all and other._part.start == self._part.stop
        if not is_next or self._last or other._last:
            return False
        self._part = slice(self._part.start, other._part.stop)
        return True

    @property
    def n_faces(self) -> np.ndarray:
        """Number of faces of each chart."""
        return self.column("n_faces")

    def column(self, name: str) -> np.ndarray:
        """Return one field of all charts."""
        if name == "n_faces" and self._face_of_face is not None:
            return np.array([len(chart.faces) for chart in self], dtype=np.int32)
        of_most = column(self._charts, name)
        return np.concatenate([of_most, column(self._last, name)]) if self._last else of_most

    def _record(self, index: int) -> Any:  # noqa: ANN401 - a record of the native module
        n = len(self._charts)
        return self._own(self._charts[index] if index < n else self._last[index - n])

    def _own(self, chart: Any) -> Any:  # noqa: ANN401 - as above
        faces = chart.faces - self._first_face
        return replace(chart, faces=faces if self._face_of_face is None else np.unique(self._face_of_face[faces]))
