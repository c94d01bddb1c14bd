"""How long a batch takes and how much memory a worker needs, from the numbers of faces, before it starts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..assets.counts import faces_in
from .entries import Entry
from .progress import duration
from .settings import BatchSettings

# Of one thread, with F faces: seconds = a sqrt(F) + b F, since seams and borders grow with the root, and at most
# base + m F bytes. By tests/benchmarks/batch_estimates.py, and from a million faces on by docs/benchmarks.md.
_SECONDS = {"suggest": (7e-3, 1.1e-4), "cut": (8e-3, 3.5e-5), "kept": (3.5e-3, 1.7e-5)}
# Cuts at sharp edges make thousands of islands of a scan.
_BYTES = {"suggest": (128 << 20, 1800), "cut": (200 << 20, 7600), "kept": (128 << 20, 1800)}


@dataclass(frozen=True)
class Estimate:
    """What an asset needs.

    Attributes:
        faces: of the file.
        seconds: of one thread; from a quarter to four times as much for meshes from smooth sheets to torn scans.
        memory: bytes of the worker, at most.
    """

    faces: int
    seconds: float
    memory: int


def of_asset(entry: Entry, settings: BatchSettings) -> Estimate | None:
    """Return what an asset needs, textures and checkers aside; None if its number of faces is unknown."""
    faces = faces_in(entry.source)
    if faces is None:
        return None
    kind = "kept" if not settings.unwrap else "suggest" if settings.seams == "suggest" else "cut"
    of_root, of_face = _SECONDS[kind]
    base, bytes_per_face = _BYTES[kind]
    return Estimate(faces, of_root * faces**0.5 + of_face * faces, base + bytes_per_face * faces)


def line(estimate: Estimate | None) -> str:
    """Return an estimate in words."""
    if estimate is None:
        return "number of faces unknown"
    time = duration(max(1.0, estimate.seconds))
    return f"{estimate.faces:,} faces, about {time}, up to {_mebibytes(estimate.memory)}"


def summary(estimates: Sequence[Estimate | None], jobs: int, together: bool) -> str:
    """Return the estimate of a batch in words.

    Args:
        estimates: of its assets.
        jobs: assets at once.
        together: whether one worker has all of them, for an atlas.
    """
    known = [each for each in estimates if each is not None]
    seconds = [each.seconds for each in known]
    # The last assets run while other workers have nothing left to do.
    wall = sum(seconds) if together else max(sum(seconds) / jobs, max(seconds, default=0.0))
    memory = (sum if together else max)([each.memory for each in known] or [0])
    held = memory if together else memory * min(jobs, max(1, len(known)))
    faces = sum(each.faces for each in known)
    text = (
        f"{len(estimates)} assets with {faces:,} faces: about {duration(max(1.0, wall))} with {jobs} at once, "
        f"{_mebibytes(memory)} for the largest and up to {_mebibytes(held)} for all at once"
    )
    unknown = len(estimates) - len(known)
    return f"{text}; without {unknown} of unknown size" if unknown else text


def _mebibytes(memory: int) -> str:
    return f"{memory / 2**20:,.0f} MiB"
