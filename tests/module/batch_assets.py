# SPDX-License-Identifier: GPL-3.0-or-later
"""Small assets for the batch, as generators make them, and five that are broken in different ways."""

import struct

import numpy as np

from tests.module import meshes

BROKEN = ("crash.obj", "empty.obj", "nan.usda", "notes.obj", "truncated.glb")


def grid(n, height, seed):
    """Return vertices and quads of a bumpy grid."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, n + 1), np.linspace(-1.0, 1.0, n + 1))
    z = height * np.sin(3.0 * x + rng.random()) * np.cos(2.0 * y + rng.random())
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    return np.column_stack([x.ravel(), y.ravel(), z.ravel()]), corner[:, None] + [0, 1, n + 2, n + 1]


def torus(n, m):
    """Return vertices and quads of a closed torus."""
    a, b = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    u, v = 2.0 * np.pi * a / n, 2.0 * np.pi * b / m
    ring = 1.0 + 0.4 * np.cos(v)
    points = np.stack([ring * np.cos(u), ring * np.sin(u), 0.4 * np.sin(v)], axis=-1).reshape(-1, 3)
    index = lambda i, j: (i % n) * m + j % m  # noqa: E731
    quads = np.stack([index(a, b), index(a + 1, b), index(a + 1, b + 1), index(a, b + 1)], axis=-1)
    return points, quads.reshape(-1, 4)


def not_manifold(n, seed):
    """Return two grids that share the edges of a border, with a wall on it: edges with three faces."""
    points, quads = grid(n, 0.2, seed)
    border = np.arange(n + 1) * (n + 1)
    wall = points[border] + [0.0, 0.0, 1.0]
    top = len(points) + np.arange(n + 1)
    back = points + [-2.0, 0.0, 0.0]
    walls = np.column_stack([border[:-1], border[1:], top[1:], top[:-1]])
    second = quads + len(points) + n + 1
    # The last column of the second grid lies on the first one of the first.
    shared = {int(i) + len(points) + n + 1 + n: int(i) for i in border}
    second = np.vectorize(lambda i: shared.get(int(i), int(i)))(second)
    points, faces = np.concatenate([points, wall, back]), np.concatenate([quads, walls, second])
    used, faces = np.unique(faces, return_inverse=True)
    return points[used], faces.reshape(-1, 4)


def write_obj(path, points, faces):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces.tolist()]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def write_ply(path, points, faces):
    head = (
        f"ply\nformat ascii 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
    )
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    rows = [" ".join(map(repr, point)) for point in points.tolist()]
    rows += [f"{len(face)} " + " ".join(map(str, face)) for face in faces.tolist()]
    path.write_text(head + "\n".join(rows) + "\n", encoding="ascii")


def write_stl(path, points, faces):
    triangles = meshes.triangles_of(faces)
    data = b"".join(struct.pack("<12fH", 0, 0, 0, *points[t].ravel(), 0) for t in triangles)
    path.write_bytes(b"\0" * 80 + struct.pack("<I", len(triangles)) + data)


def write_usd(path, points, faces):
    """Write USD in words; Blender's readers of the other formats take a NaN for 0, or leave the faces out."""
    places = ", ".join(f"({x!r}, {y!r}, {z!r})" for x, y, z in points.tolist())
    path.write_text(
        '#usda 1.0\n(\n    defaultPrim = "grid"\n)\ndef Mesh "grid"\n{\n'
        f"    int[] faceVertexCounts = {[len(face) for face in faces.tolist()]}\n"
        f"    int[] faceVertexIndices = {faces.ravel().tolist()}\n    point3f[] points = [{places}]\n}}\n",
        encoding="ascii",
    )


def write_cube(folder):
    """Write a cube of quads, and return its path."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    path = folder / "in" / "cube.obj"
    path.parent.mkdir(exist_ok=True)
    write_obj(path, corners, np.array(quads))
    return path


def write_good(folder, count):
    """Write `count` assets of three formats in two folders; return their names."""
    writers = ((".obj", write_obj), (".ply", write_ply), (".stl", write_stl))
    makers = (
        lambda k: grid(8 + k, 0.3, k),
        lambda k: torus(12 + k, 8),
        lambda k: not_manifold(6 + k // 3, k),
    )
    names = []
    for k in range(count):
        suffix, write = writers[k % 3]
        name = f"{'a' if k % 2 else 'b/c'}/asset {k:03}{suffix}"
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        write(folder / name, *makers[k // 3 % 3](k))
        names.append(name)
    return names


def write_broken(folder):
    """Write the assets of `BROKEN`; the one named crash makes the worker of batch_with_faults.py crash."""
    points, quads = grid(6, 0.2, 0)
    write_obj(folder / "crash.obj", points, quads)
    (folder / "empty.obj").write_bytes(b"")
    write_usd(folder / "nan.usda", np.where(np.arange(len(points))[:, None] == 10, np.nan, points), quads)
    (folder / "notes.obj").write_text("Remember the milk.\n", encoding="ascii")
    # The header promises more than there is.
    (folder / "truncated.glb").write_bytes(struct.pack("<4sIIII", b"glTF", 2, 5000, 4000, 0x4E4F534A) + b'{"asset":{')
