"""A polygon mesh as stored in a file."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Protocol

import numpy as np
import numpy.typing as npt

# Of a message: a path, and what is wrong; the line of a damaged file may be the whole file.
_SHOWN = 600


class AssetError(ValueError):
    """A file cannot be read as a mesh; the message names file, line or element, and the violated condition.

    What it quotes from a damaged file is escaped and shortened, so that a message is one line of printable characters.
    """

    def __init__(self, message: str) -> None:
        """Escape what is not printable, and leave out the middle of what is too long."""
        shown = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in message)
        super().__init__(shown if len(shown) <= _SHOWN else f"{shown[: _SHOWN - 100]} ... {shown[-95:]}")


class NoMeshError(AssetError):
    """A file is as it should be but contains no faces, such as a point cloud, lines or materials."""


@dataclass(frozen=True)
class AssetMesh:
    """A polygon mesh, vertices and faces in the file's order."""

    vertices: npt.NDArray[np.float64]
    """(V, 3)"""
    face_offsets: npt.NDArray[np.int64]
    """(faces + 1,) as in `unwrap`."""
    corner_vertices: npt.NDArray[np.int64]
    """(C,)"""
    corner_uv: npt.NDArray[np.float64] | None = None
    """(C, 2), NaN for corners without a UV; None if the file has no UV map."""
    name: str = ""
    """Of the mesh within its file; empty if the file has a single mesh."""
    placement: npt.NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    """(4, 4) of its first instance: from `vertices`, as columns with a 1 below, to the scene."""
    seam_edges: npt.NDArray[np.int64] = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    """(S, 2) vertices of the edges that the file marks as seams."""
    pinned_corners: npt.NDArray[np.bool_] | None = None
    """(C,) corners whose UV the file pins; None for none."""

    parts: tuple[str, ...] = ()
    """Names of the objects in a file that stores all of them as one mesh; empty if it names none."""
    part_of_face: npt.NDArray[np.int64] | None = None
    """(faces,) index into `parts`, -1 for faces in none; None without parts."""
    material_of_face: npt.NDArray[np.int64] | None = None
    """(faces,) a number per material of the file, -1 for faces without one; None if the mesh has less than two."""
    material: int = -1
    """The number of the material of all faces of a mesh with less than two; -1 without one."""
    density_factors: npt.NDArray[np.float64] | None = None
    """(faces,) how many times the texel density of others an artist wants, positive; None for all alike."""

    def with_map(self, uv_map: UvMap) -> AssetMesh:
        """Return the mesh with another map."""
        uv = np.where(uv_map.mapped[self.face_of_corner(), None], uv_map.uv, np.nan)
        return replace(self, corner_uv=uv)

    def names_of(self, faces: npt.NDArray[np.integer]) -> list[str]:
        """Return the names of the objects that faces belong to; empty if the file has none."""
        if self.part_of_face is None:
            return [self.name] if self.name else []
        return [self.parts[part] for part in np.unique(self.part_of_face[faces]).tolist() if part >= 0]

    @property
    def scale(self) -> float:
        """Ratio of lengths in the scene to those of `vertices`, the geometric mean over the axes; 1 if degenerate."""
        scale = float(abs(np.linalg.det(self.placement[:3, :3]))) ** (1 / 3)
        return scale if np.isfinite(scale) and scale > 0.0 else 1.0

    @property
    def is_scaled_evenly(self) -> bool:
        """Whether all lengths in the scene are those of `vertices` times `scale`, within a hundredth."""
        with np.errstate(invalid="ignore"):
            stretch = np.sqrt(np.linalg.eigvalsh(self.placement[:3, :3].T @ self.placement[:3, :3]).clip(0.0))
        return bool((np.abs(stretch / self.scale - 1.0) <= 0.01).all())

    def materials(self) -> npt.NDArray[np.int64]:
        """Return the material of every face, (faces,), -1 for none."""
        if self.material_of_face is not None:
            return self.material_of_face
        return np.full(len(self.face_offsets) - 1, self.material, np.int64)

    def face_of_corner(self) -> npt.NDArray[np.int64]:
        """Return the face of every corner, (C,)."""
        return np.repeat(np.arange(len(self.face_offsets) - 1), np.diff(self.face_offsets))

    def has_uv(self) -> npt.NDArray[np.bool_]:
        """Return the faces that have a UV at every corner, (faces,)."""
        if self.corner_uv is None:
            return np.zeros(len(self.face_offsets) - 1, dtype=bool)
        return np.logical_and.reduceat(np.isfinite(self.corner_uv).all(axis=1), self.face_offsets[:-1])


@dataclass(frozen=True)
class UvMap:
    """A UV map to be written."""

    uv: npt.NDArray[np.float64]
    """(C, 2)"""
    mapped: npt.NDArray[np.bool_]
    """(faces,) faces with a map."""


class Asset(Protocol):
    """A file as read."""

    path: Path | None
    """Of the file; None if only its meshes are kept."""
    suffix: str
    """Of the files written from it, with the dot: its own if the format holds UVs."""
    uv_map: str
    """Name of the map to read and write, as `assets.read` takes it; empty if the format has a single map."""
    meters: float | None
    """Meters per unit of length in the scene; None if the format has no unit."""
    meshes: Sequence[AssetMesh]
    warnings: Sequence[str]
    """Other changes and losses in the files written last."""

    def references(self) -> Iterable[str]:
        """Return the files that it references by relative paths, without those that `files` returned last.

        The pieces of these must have been taken.
        """
        ...

    def rename(self, source: Path, copy: Path, named: Callable[[str], str]) -> None:
        """Change the paths in the copy of a file that it references, such as a layer, by `named`."""
        ...

    def files(self, out: Path, maps: Sequence[UvMap]) -> Mapping[Path, Iterable[bytes]]:
        """Return the contents of this asset's files with new UV maps, in pieces, by path.

        Args:
            out: path of the main file, which references the others and comes last.
            maps: one for each mesh.
        """
        ...


class OneMeshAsset:
    """A single file with one mesh."""

    path: Path
    mesh: AssetMesh
    uv_map = ""
    meters: float | None = None
    warnings: Sequence[str] = ()

    @property
    def meshes(self) -> tuple[AssetMesh]:
        """The mesh."""
        return (self.mesh,)

    def files(self, out: Path, maps: Sequence[UvMap]) -> Mapping[Path, Iterable[bytes]]:
        """Return the file with a new UV map, by its path."""
        (uv_map,) = maps
        return {out: self.with_uv(uv_map.uv, uv_map.mapped)}

    def references(self) -> Iterable[str]:
        """Return the files that it references by relative paths."""
        raise NotImplementedError

    def rename(self, source: Path, copy: Path, named: Callable[[str], str]) -> None:
        """Change the paths in the copy of a file that it references."""

    def with_uv(self, uv: npt.NDArray[np.float64], mapped: npt.NDArray[np.bool_]) -> Iterable[bytes]:
        """Return the content of the file with a new UV map, in pieces; arguments as in `UvMap`."""
        raise NotImplementedError


def checked(path: Path, mesh: AssetMesh) -> AssetMesh:
    """Return the mesh if it can be unwrapped; vertices of no face get a finite position, as gaps of scans have none.

    Raises:
        NoMeshError: it has no faces.
        AssetError: it has a corner whose position is not finite.
    """
    if len(mesh.face_offsets) == 1:
        raise NoMeshError(f"{path}: has no faces; there is nothing to unwrap.")
    missing = ~np.isfinite(mesh.vertices).all(axis=1)
    if not missing.any():
        return mesh
    is_gap = missing[mesh.corner_vertices]
    if is_gap.any():
        vertex = mesh.corner_vertices[is_gap].min() + 1
        raise AssetError(f"{path}: the position of vertex {vertex} is not finite.")
    return replace(mesh, vertices=np.where(missing[:, None], mesh.vertices[mesh.corner_vertices[0]], mesh.vertices))


_ZIP = b"PK\x03\x04"
# What else lies under the names of models: how such files begin.
_OTHER_KINDS: dict[str, tuple[bytes, ...]] = {
    "is compressed by gzip: unpack it first": (b"\x1f\x8b",),
    "is compressed by bzip2: unpack it first": (b"BZh9",),
    "is compressed by xz: unpack it first": (b"\xfd7zXZ\0",),
    "is compressed by Zstandard: unpack it first": (b"\x28\xb5\x2f\xfd",),
    "is a ZIP archive: unpack it first": (_ZIP,),
    "is a pointer of Git LFS, not the file: run 'git lfs pull'": (b"version https://git-lfs",),
    "is a web page, not a model: download the file itself": (b"<!DOCTYPE", b"<!doctype", b"<html", b"<HTML"),
}


def check_kind(path: Path) -> None:
    """Raise AssetError if a file is of another kind than its name says, by its first bytes."""
    with path.open("rb") as file:
        begin = file.read(32)
    if path.suffix.lower() == ".usdz" and begin.startswith(_ZIP):
        return
    for words, signatures in _OTHER_KINDS.items():
        if begin.startswith(signatures):
            raise AssetError(f"{path}: {words}.")


def check_text(path: Path, data: bytes) -> None:
    """Raise AssetError if a text has a zero byte, as where a disk or a download lost a part; it may end in one."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise AssetError(f"{path}: is text in UTF-16, which cannot be read: save it in UTF-8.")
    place = data.find(b"\0", 0, len(data) - 1)
    if place >= 0:
        line = 1 + max(data.count(end, 0, place) for end in (b"\n", b"\r"))
        raise AssetError(f"{path}:{line}: is text, but has bytes of zero: the file is damaged.")


def check_end(path: Path, rest: bytes) -> None:
    """Raise AssetError if anything but blanks follows the rows that the header announces."""
    if (rest := rest.strip()) not in (b"", b"\0"):
        raise AssetError(f"{path}: {len(rest)} bytes follow the rows that the header announces: the file is damaged.")


def offsets_of(sizes: npt.ArrayLike) -> npt.NDArray[np.int64]:
    """Return the first corner of each face, and the number of corners, from the faces' numbers of corners."""
    return np.concatenate([[0], np.cumsum(np.asarray(sizes, dtype=np.int64))]).astype(np.int64)


def of_short_faces(count: int, what_happens: str) -> list[str]:
    """Return the warning about faces with fewer than three corners, or nothing without any."""
    faces = "1 face has" if count == 1 else f"{count} faces have"
    return [f"{faces} fewer than three corners: {what_happens}."] if count else []


def numbers(where: str, words: list[str], count: int) -> list[float]:
    """Return the first `count` words as numbers.

    Raises:
        AssetError: there are fewer, or one is not a number.
    """
    try:
        found = [float(word) for word in words[:count]]
    except ValueError:
        raise AssetError(f"{where}: '{' '.join(words)}' has a word that is not a number.") from None
    if len(found) < count:
        raise AssetError(f"{where}: {count} numbers are needed, but the line has {len(found)}.")
    return found


def is_whole(values: npt.NDArray) -> npt.NDArray[np.bool_]:
    """Return which values, maybe floats, are integers that have an exact double."""
    if values.dtype.kind != "f":
        return np.ones(values.shape, bool)
    with np.errstate(invalid="ignore"):
        return (np.abs(values) < 2.0**53) & (values == np.floor(values))


def exist(corners: npt.NDArray, n_vertices: int) -> npt.NDArray[np.bool_]:
    """Return which corners, maybe floats, name one of so many vertices."""
    return is_whole(corners) & (corners >= 0) & (corners < n_vertices)


def checked_corners(
    where: Callable[[int], str], offsets: npt.NDArray[np.int64], corners: npt.NDArray, n_vertices: int
) -> npt.NDArray[np.int64]:
    """Return the corners, (C,), as integers.

    Args:
        where: returns the place of a face, for the message.
        offsets: (faces + 1,)
        corners: (C,) as the file has them, which may be floats.
        n_vertices: of the file.

    Raises:
        AssetError: a face has a vertex that does not exist, or no face has three corners.
    """
    is_short = np.diff(offsets) < 3
    if is_short.any() and is_short.all():
        raise AssetError(f"{where(0)}: a face needs at least three corners.")
    exists = exist(corners, n_vertices)
    if not exists.all():
        bad = int((~exists).argmax())
        face = int(np.searchsorted(offsets, bad, side="right")) - 1
        what = f"there is no vertex {corners[bad]:.15g}; the file has {n_vertices}, numbered from 0"
        raise AssetError(f"{where(face)}: {what}.")
    return corners.astype(np.int64)
