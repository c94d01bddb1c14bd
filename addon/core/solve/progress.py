# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress of several pieces of work, joined into one."""

from collections.abc import Callable, Sequence
from typing import Protocol, TypeVar

import numpy as np

from ..mesh.polygon_mesh import PolygonMesh

# Takes the fraction done and the name of the phase; returns False to stop the work.
Progress = Callable[[float, str], "bool | None"]


class Stepping(Protocol):
    """Work that gets better by steps."""

    can_move: bool

    def step(self, n: int, progress: Progress | None = None) -> bool:
        """Take up to `n` steps; return whether there may be more."""


Kind = TypeVar("Kind", bound=Stepping)


def parts(groups: Sequence[Sequence[PolygonMesh]], progress: Progress | None) -> list[Progress | None]:
    """Return the progress function of each group of meshes, which together fill `progress`; None if that is None."""
    if progress is None or len(groups) == 1:
        return [progress] * len(groups)
    faces = [sum(max(1, np.count_nonzero(mesh.selected_faces)) for mesh in group) for group in groups]
    sizes = np.array(faces, dtype=np.float64) / sum(faces)
    ends = np.cumsum(sizes)
    return [part(progress, end - size, size) for end, size in zip(ends.tolist(), sizes.tolist())]


def part(progress: Progress, start: float, length: float) -> Progress:
    """Return the progress function of a part of the work that begins at `start` and has this `length`."""
    return lambda fraction, phase: progress(start + length * fraction, phase)


def stepped(work: Kind, steps: int, progress: Progress | None = None) -> Kind:
    """Take up to `steps` steps, one by one, so that it stops at the same step as a view would; return the `work`."""
    taken = 0
    while taken < steps and work.can_move:
        own = None if progress is None else part(progress, taken / steps, 1.0 / steps)
        taken += 1
        if not work.step(1, own):
            break
    return work
