"""Meshes of every kind for the benchmarks, generated or read from OBJ files, and their transfer to other processes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

# Patches of a scene that is scaled by their number, not by their size.
MANY = 50


class Mesh(NamedTuple):
    """Polygons as `spectral_conformal.unwrap` takes them; V vertices, F faces, C corners."""

    vertices: np.ndarray
    """(V, 3) float64."""
    face_offsets: np.ndarray
    """(F + 1,) int32."""
    corner_vertices: np.ndarray
    """(C,) int32."""

    def triangles(self) -> np.ndarray:
        """Return the faces as fans of triangles, (T, 3) int64."""
        first, size = self.face_offsets[:-1], np.diff(self.face_offsets)
        own = np.repeat(np.arange(len(size)), size - 2)
        place = np.arange(len(own)) - np.repeat(np.cumsum(size - 2) - (size - 2), size - 2)
        corners = first[own][:, None] + np.c_[0 * place, place + 1, place + 2]
        return self.corner_vertices[corners].astype(np.int64)


@dataclass(frozen=True)
class Scene:
    """`objects` meshes of `islands` bumpy patches each, all in edit mode.

    Attributes:
        side: the root of the number of vertices of a patch.
        is_triangulated: quads are split in two, not all along the same diagonal.
        noise: every vertex is moved at random by this part of an edge.
        is_shuffled: vertices and faces are numbered at random.
        is_sampled: a disk whose vertices lie at random, in place of a grid; triangles always, numbered at random.
        bystanders: further objects in the file, which are not in edit mode.
    """

    side: int
    objects: int = 1
    islands: int = 1
    is_triangulated: bool = False
    noise: float = 0.0
    is_shuffled: bool = False
    is_sampled: bool = False
    bystanders: int = 0

    @property
    def n_vertices(self) -> int:
        """Number of vertices of all meshes; about, where they are sampled."""
        return self.objects * self.islands * self.side**2

    def scaled(self, scale: float) -> Scene:
        """Return the scene with about `scale` times as many vertices, by reducing its largest number."""
        if self.bystanders >= MANY:
            return replace(self, bystanders=max(2, round(self.bystanders * scale)))
        if self.objects >= MANY:
            return replace(self, objects=max(2, round(self.objects * scale)))
        if self.islands >= MANY:
            return replace(self, islands=max(2, round(self.islands * scale)))
        return replace(self, side=max(4, round(self.side * scale**0.5)))

    def meshes(self) -> list[Mesh]:
        """Make the meshes; islands differ in height and size."""
        return [self._mesh(number) for number in range(self.objects)]

    def _mesh(self, number: int) -> Mesh:
        rng = np.random.default_rng(number)
        plane, faces = _sampled(self.side**2) if self.is_sampled else _grid(self.side)
        if self.is_triangulated and not self.is_sampled:
            faces = _split(faces, rng)
        height = 0.3 * np.sin(7.0 * plane[:, 0]) * np.cos(5.0 * plane[:, 1])
        vertices = []
        for island in range(self.islands):
            scale = 1.0 + (number * self.islands + island) % 17 / 17.0
            patch = np.column_stack([plane, height * (1.0 + island % 5 / 5.0)]) * scale
            patch += self.noise * scale / self.side * rng.normal(size=patch.shape)
            vertices.append(patch + [island % 32 * 3.0, island // 32 * 3.0, 0.0])
        faces = np.concatenate([faces + island * len(plane) for island in range(self.islands)])
        vertices = np.concatenate(vertices)
        if self.is_shuffled:
            new = rng.permutation(len(vertices))
            vertices, faces = vertices[np.argsort(new)], new[faces][rng.permutation(len(faces))]
        return polygons(vertices, faces)


def polygons(vertices: np.ndarray, faces: Sequence[Sequence[int]] | np.ndarray) -> Mesh:
    """Return a mesh from the corner lists of its faces."""
    offsets = np.cumsum([0, *map(len, faces)], dtype=np.int32)
    return Mesh(np.asarray(vertices, dtype=np.float64), offsets, np.concatenate(faces).astype(np.int32))


def _grid(side: int) -> tuple[np.ndarray, np.ndarray]:
    y, x = np.divmod(np.arange(side**2), side)
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).reshape(-1, 1)
    return np.stack([x, y], axis=1) / (side - 1), corner + np.array([0, 1, side + 1, side])


def _sampled(n: int) -> tuple[np.ndarray, np.ndarray]:
    # SciPy, which a Blender does not have, is needed for this kind alone.
    from tests.module import meshes

    vertices, triangles = meshes.random_disk(n)
    return (vertices[:, :2] + 1.0) / 2.0, triangles


def _split(quads: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    turned = np.where(rng.random(len(quads))[:, None] < 0.5, quads, np.roll(quads, 1, axis=1))
    return np.stack([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]], axis=1).reshape(-1, 3)


def kinds(n: int) -> dict[str, Scene]:
    """Return a scene of about `n` vertices of every kind."""
    side = max(4, round(n**0.5))
    small = 8
    many = max(2, round(n / small**2))
    return {
        "quads": Scene(side),
        "triangles": Scene(side, is_triangulated=True),
        "noisy quads": Scene(side, noise=0.15),
        "noisy triangles": Scene(side, is_triangulated=True, noise=0.15),
        "quads numbered at random": Scene(side, is_shuffled=True),
        "sampled triangles": Scene(side, is_sampled=True),
        "many islands": Scene(small, islands=many),
        "many objects": Scene(small, objects=many),
    }


def read(path: Path) -> Mesh:
    """Read an OBJ file.

    Raises:
        ValueError: there is no face in it.
    """
    from tests.module import meshes

    vertices, faces = meshes.read_obj(path)
    if not faces:
        raise ValueError(f"{path} has no faces; it must be a mesh in OBJ format")
    return polygons(vertices, faces)


def write_obj(path: Path, vertices: np.ndarray, triangles: np.ndarray) -> None:
    """Write a mesh of triangles."""
    with path.open("w") as file:
        file.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices.tolist())
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in (triangles + 1).tolist())


def write_ply(path: Path, vertices: np.ndarray, triangles: np.ndarray) -> None:
    """Write a mesh of triangles, in single precision."""
    rows = np.empty(len(triangles), [("count", "u1"), ("vertices", "<i4", 3)])
    rows["count"], rows["vertices"] = 3, triangles
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
    header += "property float x\nproperty float y\nproperty float z\n"
    header += f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    path.write_bytes(header.encode() + np.asarray(vertices, "<f4").tobytes() + rows.tobytes())


def save(path: Path, meshes: Sequence[Mesh]) -> None:
    """Write meshes to a file for `load`."""
    np.savez(path, **{f"{name}{k}": part for k, mesh in enumerate(meshes) for name, part in mesh._asdict().items()})


def load(path: Path) -> list[Mesh]:
    """Read what `save` wrote."""
    with np.load(path) as file:
        names = Mesh._fields
        return [Mesh(*(file[f"{name}{k}"] for name in names)) for k in range(len(file.files) // len(names))]


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """Return the meshes as one."""
    vertices = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    corners = np.cumsum([0, *(len(mesh.corner_vertices) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([[0], *(mesh.face_offsets[1:] + first for mesh, first in zip(meshes, corners))]).astype(
            np.int32
        ),
        np.concatenate([mesh.corner_vertices + first for mesh, first in zip(meshes, vertices)]).astype(np.int32),
    )
