# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of charts, of which there may be a million: arrays of what all have, and the records of a part of them."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np


def column(charts: Sequence[Any], name: str) -> np.ndarray:
    """Return what all `charts` have in one field, (number of charts,); of `n_faces`, how many faces they have.

    Those of the native module have it as an array, without a record for each.
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
        """Take the `charts` of a result for all, without those of other meshes.

        Args:
            charts: of this mesh alone.
            first_face: the mesh's, among all.
            last: another chart, of which only some faces are this mesh's; None for none.
            face_of_face: the face of this mesh that each of its faces there is a part of; None where they are the same.
        """
        self._charts = charts
        self._first_face = first_face
        self._last = [] if last is None else [last]
        self._face_of_face = face_of_face

    def __len__(self) -> int:
        """Return how many charts there are."""
        return len(self._charts) + len(self._last)

    def __getitem__(self, index: Any) -> Any:  # noqa: ANN401 - a record, or several
        """Return a record, or the list of several."""
        places = range(len(self))[index]
        return [self._record(place) for place in places] if isinstance(places, range) else self._record(places)

    def __iter__(self) -> Iterator[Any]:
        """Go through the records."""
        for chart in self._charts:
            yield self._own(chart)
        yield from map(self._own, self._last)

    @property
    def n_faces(self) -> np.ndarray:
        """How many faces each has."""
        return self.column("n_faces")

    def column(self, name: str) -> np.ndarray:
        """Return what all have in one field."""
        of_most = column(self._charts, name)
        return np.concatenate([of_most, column(self._last, name)]) if self._last else of_most

    def _record(self, place: int) -> Any:  # noqa: ANN401 - a record of the native module
        n = len(self._charts)
        return self._own(self._charts[place] if place < n else self._last[place - n])

    def _own(self, chart: Any) -> Any:  # noqa: ANN401 - as above
        faces = chart.faces - self._first_face
        return replace(chart, faces=faces if self._face_of_face is None else np.unique(self._face_of_face[faces]))
