# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners of a mesh grouped by chart, so that one pass over them serves all charts."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class CornerGroups:
    """K charts of C corners; `corners` are sorted so that chart k has `counts[k]` of them from `starts[k]` on.

    Attributes:
        corners: (n,) the corners of all charts; None if these are all corners in their order.
        starts: (K,).
        counts: (K,).
        numbers: (K,) the charts' numbers, ascending.
    """

    corners: np.ndarray | None
    starts: np.ndarray
    counts: np.ndarray
    numbers: np.ndarray

    @classmethod
    def of(cls, chart: np.ndarray) -> "CornerGroups":
        """Group the corners by their `chart`, (C,) integer, -1 for none; numbers need not be consecutive."""
        corners, number = None, chart
        if len(chart) and chart.min() < 0:
            corners = np.flatnonzero(chart >= 0)
            number = chart.take(corners)
        steps = number[1:] != number[:-1]
        if (number[1:] < number[:-1]).any():
            order = np.argsort(number, kind="stable")
            corners = order if corners is None else corners.take(order)
            number = number.take(order)
            steps = number[1:] != number[:-1]
        starts = np.concatenate([np.zeros(min(1, len(number)), dtype=np.intp), np.flatnonzero(steps) + 1])
        return cls(corners, starts, np.diff(starts, append=len(number)), number.take(starts))

    def __len__(self) -> int:
        """Return K."""
        return len(self.starts)

    def of_corners(self, values: np.ndarray) -> np.ndarray:
        """Return the `values` (C, ...) of the charts' corners in their order, (n, ...); maybe `values` itself."""
        # Ten times as fast as indexing rows.
        return values if self.corners is None else values.take(self.corners, axis=0)

    def bounds(self, values: np.ndarray) -> np.ndarray:
        """Return the low and high corner of each chart's bounding box, (K, 2, m), of the `values` (C, m) at corners.

        A box with a value that is not finite is not finite.
        """
        columns = np.ascontiguousarray(self.of_corners(values).T)
        if len(self) == 1:
            return np.array([[columns.min(axis=1), columns.max(axis=1)]])
        if not len(self):
            return np.zeros((0, 2, len(columns)))
        return np.stack([bound.reduceat(columns, self.starts, axis=1).T for bound in (np.minimum, np.maximum)], axis=1)

    def any(self, flags: np.ndarray) -> np.ndarray:
        """Return which charts have one of the corners with `flags` (C,) bool, (K,) bool."""
        return np.logical_or.reduceat(self.of_corners(flags), self.starts)

    def all(self, flags: np.ndarray) -> np.ndarray:
        """Return which charts have only corners with `flags` (C,) bool, (K,) bool."""
        return np.logical_and.reduceat(self.of_corners(flags), self.starts)

    def spread(self, values: np.ndarray) -> np.ndarray:
        """Return the `values` (K, ...) of the charts for every one of their corners, (n, ...) or one row for all."""
        return values if len(self) == 1 else np.repeat(values, self.counts, axis=0)

    def with_rows(self, values: np.ndarray, rows: np.ndarray) -> np.ndarray:
        """Return a copy of the `values` (C, 2) in which the charts' corners have the `rows` (n, 2), both float64."""
        if self.corners is None:
            return rows
        result = np.array(values, dtype=np.float64, order="C")
        # As complex numbers, because indexing rows is slow.
        result.view(np.complex128)[self.corners, 0] = np.ascontiguousarray(rows).view(np.complex128)[:, 0]
        return result
