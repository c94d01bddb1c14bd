"""How long a batch takes and how much memory a worker needs, from the numbers of faces, before it starts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from .. import assets
from .._drawing_plan import DrawingLimits, DrawingPlan
from ..assets import AssetError, AssetMesh, UvMap, degenerate
from ..assets.counts import faces_in
from ..assets.unwrapping import sheets_of
from .entries import OF_BLENDER, Entry
from .progress import duration
from .settings import BatchSettings

# Of one thread, with F faces: seconds = a sqrt(F) + b F, since seams and borders grow with the root, and at most
# base + m F bytes. By tests/benchmarks/batch_estimates.py, and from a million faces on by docs/benchmarks.md.
_SECONDS = {"suggest": (7e-3, 1.1e-4), "cut": (8e-3, 3.5e-5), "kept": (3.5e-3, 1.7e-5)}
# Of a texture, covered by islands.
_FILL = 0.6
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
    memory: float

    def with_textures(self, plan: DrawingPlan | None) -> Estimate:
        """Return it with what drawing textures takes."""
        if plan is None:
            return self
        return replace(self, seconds=self.seconds + plan.seconds, memory=self.memory + plan.memory)


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


def of_textures(entry: Entry, settings: BatchSettings, limits: DrawingLimits) -> DrawingPlan | None:
    """Return what drawing the textures of an asset takes; None if none are drawn, or if that is unknown.

    The asset is read. Its new map is assumed to have the same density everywhere, or that of the old one if it is kept.
    """
    size = settings.textures
    if size is None or entry.source.suffix.lower() in OF_BLENDER:
        return None
    try:
        asset = assets.read(entry.source, settings.uv_map)
        maps = _assumed_maps(asset.meshes, settings)
        return assets.planned(Path(entry.target), asset, maps, replace(size, limits=limits))
    except (AssetError, OSError):
        # Said when it is unwrapped.
        return None


def _assumed_maps(meshes: Sequence[AssetMesh], settings: BatchSettings) -> list[UvMap]:
    """Return maps whose faces have the areas to be expected: regular polygons, or those of the old map."""
    width, height = settings.texture
    flat, area = [], []
    for mesh in meshes:
        offsets, sizes = mesh.face_offsets, np.diff(mesh.face_offsets)
        if settings.unwrap or mesh.corner_uv is None:
            area.append(0.5 * mesh.scale**2 * degenerate.areas(mesh.vertices, offsets, mesh.corner_vertices))
            turn = 2.0 * np.pi / np.repeat(sizes, sizes)
            angle = turn * (np.arange(offsets[-1]) - np.repeat(offsets[:-1], sizes))
            radius = np.sqrt(2.0 * np.repeat(area[-1] / sizes, sizes) / np.sin(turn))
            flat.append(radius[:, None] * np.c_[np.cos(angle), np.sin(angle)])
        else:
            corners = np.c_[mesh.corner_uv, np.zeros(len(mesh.corner_uv))]
            area.append(0.5 * np.nan_to_num(degenerate.areas(corners, offsets, np.arange(len(corners)))))
            flat.append(mesh.corner_uv)
    sheet = np.concatenate(sheets_of(meshes, settings.pack_by))
    _, sheet = np.unique(sheet, return_inverse=True)
    total = np.bincount(sheet, np.concatenate(area))
    if settings.texel_density:
        factors = np.full(len(total), settings.texel_density**2 / (width * height))
    elif settings.pack == "none" and not settings.unwrap:
        factors = np.ones(len(total))
    else:
        factors = np.divide(_FILL, total, out=np.zeros(len(total)), where=total > 0.0)
    of_face = np.split(np.sqrt(factors[sheet]), np.cumsum([len(each) for each in area])[:-1])
    result = []
    for mesh, uv, factor in zip(meshes, flat, of_face):
        mapped = np.ones(len(factor), bool) if settings.unwrap else mesh.has_uv()
        result.append(UvMap(uv * factor[mesh.face_of_corner(), None], mapped))
    return result


def line_of_textures(plan: DrawingPlan) -> str:
    """Return in words what drawing textures takes."""
    count = "1 texture" if len(plan.textures) == 1 else f"{len(plan.textures)} textures"
    sizes = sorted({each.size for each in plan.textures}, key=lambda size: size[0] * size[1])
    ends = " to ".join(f"{width}x{height}" for width, height in dict.fromkeys((sizes[0], sizes[-1])))
    text = (
        f"{count} of {ends}, {plan.texels / 1e6:,.0f} million texels: about {duration(max(1.0, plan.seconds))}, "
        f"up to {_mebibytes(plan.memory)}"
    )
    return f"{text}, instead of {plan.asked_texels / 1e6:,.0f} million" if plan.warning else text


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


def _mebibytes(memory: float) -> str:
    return f"{memory / 2**20:,.0f} MiB"
