# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as generators make them, with suggested seams and packed, compared with xatlas and Smart UV Project.

    build/venv/bin/python -m tests.benchmarks.generated_assets [--faces N] [--only NAME ...] [--methods NAME ...]
        [--keep]
    build/venv/bin/python -m tests.benchmarks.generated_assets [--faces N] [--only NAME ...] --write FOLDER

The meshes are noise-displaced marching cubes, merged primitives, and decimated and torn scans. They have no seams. Many
are not manifold, intersect themselves or have hundreds of components.

Needs scikit-image (pip install scikit-image). xatlas and Smart UV Project (bpy) are skipped if not installed. Each map
is made in its own process, with limits on time and memory. Peak memory is that of the whole process, including its
imports and the mesh. Mean QC limits the QC of each face to 10. The number of faces is approximate. Of several faces on
the same vertices, one is measured. "batch" is the same as "spectral" with the limits of the batch. A second table has
islands / length / mean QC of each method. The second command writes the meshes as OBJ files, for the batch.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import math
import resource
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path

import numpy as np

from tests.benchmarks import documents
from tests.benchmarks.generated import write_obj

Mesh = tuple[np.ndarray, np.ndarray]
SECONDS, GIGABYTES = 1200, 12
QC_CAP = 10.0
# Faces of the documents' larger table.
MILLION = 1_000_000
# Of a part of a grid for marching cubes: two of them, in 4 bytes a value, fit beside the mesh.
GRID_VALUES = 1_300_000_000
# Of the suggested seams, that a run may set.
LIMITS = ("qc_limit", "qc_gain")


def noise(points: np.ndarray, seed: int, octaves: int = 4, frequency: float = 2.0) -> np.ndarray:
    """Smooth noise at (..., 3) points: sums of waves of random direction, each octave finer and lower by half."""
    rng = np.random.default_rng(seed)
    total = np.zeros(points.shape[:-1], np.float32)
    for octave in range(octaves):
        for _ in range(6):
            direction = rng.normal(size=3).astype(np.float32)
            direction *= frequency * 2**octave / np.linalg.norm(direction)
            total += np.sin(points @ direction + rng.uniform(0, 2 * np.pi)).astype(np.float32) * 0.5**octave / 6
    return total


def isosurface(field: Callable[[np.ndarray], np.ndarray]) -> Callable[[int], Mesh]:
    """Return the maker of the level 0 of a field on [-1, 1]^3, from the cells per side."""

    def make(resolution: int) -> Mesh:
        from skimage.measure import marching_cubes

        pieces = []
        for first, values in grid_parts(field, resolution):
            if values.min() < 0 < values.max():
                with warnings.catch_warnings():
                    # scikit-image's own, with NumPy 2.5.
                    warnings.simplefilter("ignore", DeprecationWarning)
                    vertices, triangles, _, _ = marching_cubes(values, 0.0)
                pieces.append((vertices.astype(float) + [first, 0, 0], triangles.astype(np.int64)))
        vertices, triangles = welded(pieces)
        return vertices * 2 / (resolution - 1) - 1, triangles

    return make


def grid_parts(field: Callable[[np.ndarray], np.ndarray], resolution: int) -> Iterator[tuple[int, np.ndarray]]:
    """Yield the values on a grid of [-1, 1]^3 part by part, each with the number of its first layer.

    A part shares one layer with the next, where surfaces of both have the same vertices.
    """
    axis = np.linspace(-1, 1, resolution, dtype=np.float32)
    n_parts = -(-(resolution**3) // GRID_VALUES)
    shared = np.empty((0, resolution, resolution), np.float32)
    for part in np.array_split(np.arange(resolution), n_parts):
        first = part[0] - len(shared)
        values = np.empty((part[-1] + 1 - first, resolution, resolution), np.float32)
        values[: len(shared)] = shared
        for slab in np.array_split(part, max(1, len(part) // 16)):
            values[slab - first] = field(np.stack(np.meshgrid(axis[slab], axis, axis, indexing="ij"), axis=-1))
        shared = values[-1:].copy()
        yield first, values


def welded(pieces: list[Mesh]) -> Mesh:
    """Join meshes at the vertices that are at the same place; one alone stays as it is."""
    if len(pieces) == 1:
        return pieces[0]
    offsets = np.cumsum([0] + [len(vertices) for vertices, _ in pieces])
    triangles = np.concatenate([faces + offset for offset, (_, faces) in zip(offsets, pieces)])
    vertices, number = np.unique(np.concatenate([vertices for vertices, _ in pieces]), axis=0, return_inverse=True)
    return vertices, number.ravel()[triangles]


def radius(points: np.ndarray) -> np.ndarray:
    """Distance from the origin."""
    return np.linalg.norm(points, axis=-1)


def blobs(seed: int, count: int, size: float) -> Callable[[np.ndarray], np.ndarray]:
    """A field of many balls, that merge where they touch, for grids of points."""
    rng = np.random.default_rng(seed)
    centers = rng.uniform(-0.9, 0.9, (count, 3)).astype(np.float32)
    sizes = (size * rng.uniform(0.4, 1.2, count)).astype(np.float32)

    def field(points: np.ndarray) -> np.ndarray:
        # Far from all balls any positive value will do: the surface is where the field is 0.
        far = np.float32(0.1)
        axes = points[:, 0, 0, 0], points[0, :, 0, 1], points[0, 0, :, 2]
        nearest = np.full(points.shape[:-1], far, np.float32)
        for center, own in zip(centers, sizes):
            reach = center - own - far, center + own + far
            box = tuple(slice(*np.searchsorted(axis, ends)) for axis, ends in zip(axes, zip(*reach)))
            np.minimum(nearest[box], radius(points[box] - center) - own, out=nearest[box])
        return nearest

    return field


def ball(n: int) -> Mesh:
    """A cube's grid of n by n on each side, blown up to a sphere."""
    return _cube(n, lambda p: p / np.linalg.norm(p, axis=1)[:, None])


def block(n: int) -> Mesh:
    """A cube of n by n squares on each side."""
    return _cube(n, lambda p: p)


def _cube(n: int, shape: Callable[[np.ndarray], np.ndarray]) -> Mesh:
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    corners, faces = [], []
    for axis in range(3):
        for side in (0, n):
            quad = np.stack([np.c_[i + a, j + b] for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))], axis=1)
            whole = np.insert(quad, 0, side, axis=2)
            corners.append(np.roll(whole, axis, axis=2)[:, :: 1 if side else -1])
    points, faces = np.unique(np.concatenate(corners).reshape(-1, 3), axis=0, return_inverse=True)
    quads = faces.reshape(-1, 4)
    return shape(2.0 * points / n - 1), np.r_[quads[:, :3], quads[:, [0, 2, 3]]]


def ring(n: int) -> Mesh:
    """A torus of 2 n by n squares."""
    n = max(n, 3)
    u, v = (a.ravel() for a in np.meshgrid(np.arange(2 * n), np.arange(n), indexing="ij"))
    a, b = np.pi * u / n, 2 * np.pi * v / n
    vertices = np.c_[(1 + 0.35 * np.cos(b)) * np.cos(a), (1 + 0.35 * np.cos(b)) * np.sin(a), 0.35 * np.sin(b)]

    def at(k: int, m: int) -> np.ndarray:
        return (u + k) % (2 * n) * n + (v + m) % n

    return vertices, np.r_[np.c_[at(0, 0), at(1, 0), at(1, 1)], np.c_[at(0, 0), at(1, 1), at(0, 1)]]


def merged(count: int, seed: int, shapes: tuple[Callable[[int], Mesh], ...]) -> Callable[[int], Mesh]:
    """Return the maker of `count` primitives at random places, turned and stretched, from their fineness."""

    def make(fineness: int) -> Mesh:
        rng = np.random.default_rng(seed)
        vertices, triangles, used = [], [], 0
        made = [shape(max(1, fineness)) for shape in shapes]
        for k in range(count):
            points, faces = made[k % len(made)]
            turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
            turn *= np.sign(np.linalg.det(turn))
            size = rng.uniform(0.3, 1.0, 3) * 1.6 / count ** (1 / 3)
            vertices.append((points * size) @ turn.T + rng.uniform(-1, 1, 3))
            triangles.append(faces + used)
            used += len(points)
        return np.concatenate(vertices), np.concatenate(triangles)

    return make


def clustered(mesh: Mesh, cell: float) -> Mesh:
    """Merge the vertices of each cell of a grid, as fast decimation does: not manifold where sheets are near."""
    vertices, triangles = mesh
    _, number = np.unique(np.floor(vertices / cell).astype(np.int64), axis=0, return_inverse=True)
    number = number.ravel()
    count = np.bincount(number)
    points = np.stack([np.bincount(number, vertices[:, k]) / count for k in range(3)], axis=1)
    faces = number[triangles]
    kept = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return compact((points, faces[kept]))


def compact(mesh: Mesh) -> Mesh:
    """Drop the vertices that no triangle uses."""
    used, number = np.unique(mesh[1], return_inverse=True)
    return mesh[0][used], number.reshape(-1, 3)


def torn(mesh: Mesh, fraction: float, seed: int) -> Mesh:
    """Leave out this fraction of the triangles, in patches where noise is low, and some alone."""
    vertices, triangles = mesh
    rng = np.random.default_rng(seed)
    height = noise(vertices[triangles].mean(axis=1).astype(np.float32), seed, 3, 6.0)
    kept = (height > np.quantile(height, fraction)) & (rng.random(len(triangles)) > fraction / 20)
    return compact((vertices, triangles[kept]))


def shaken(mesh: Mesh, amount: float, seed: int) -> Mesh:
    """Move every vertex at random, by `amount` of the mean edge."""
    vertices, triangles = mesh
    edge = np.linalg.norm(vertices[triangles[:, 0]] - vertices[triangles[:, 1]], axis=1).mean()
    return vertices + amount * edge * np.random.default_rng(seed).normal(size=vertices.shape), triangles


def soiled(mesh: Mesh, seed: int) -> Mesh:
    """Duplicate some faces, flip some, and collapse some to slivers, as merges and exporters do."""
    vertices, triangles = mesh
    rng = np.random.default_rng(seed)
    turned = rng.random(len(triangles)) < 0.002
    triangles = np.where(turned[:, None], triangles[:, ::-1], triangles)
    again = triangles[rng.random(len(triangles)) < 0.005]
    slivers = triangles[rng.random(len(triangles)) < 0.002]
    vertices = vertices.copy()
    vertices[slivers[:, 0]] = (vertices[slivers[:, 1]] + vertices[slivers[:, 2]]) / 2
    return vertices, np.r_[triangles, again]


def rock(seed: int, depth: float, octaves: int) -> Callable[[np.ndarray], np.ndarray]:
    """A ball, displaced by noise."""
    return lambda p: radius(p) - 0.65 + depth * noise(p, seed, octaves, 3.0)


def gyroid(p: np.ndarray) -> np.ndarray:
    """A shell between the two sides of a gyroid, inside a ball."""
    x, y, z = np.moveaxis(7 * p, -1, 0)
    sheet = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    return np.maximum(np.abs(sheet) - 0.35, 3 * (radius(p) - 0.9))


def cut_gyroid(p: np.ndarray) -> np.ndarray:
    """A gyroid that ends at the sides of the box, open there."""
    x, y, z = np.moveaxis(6 * p, -1, 0)
    return np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x) + 0.3 * noise(p, 3)


def donut(p: np.ndarray) -> np.ndarray:
    """A torus, displaced by noise."""
    across = np.hypot(p[..., 0], p[..., 1]) - 0.6
    return np.hypot(across, p[..., 2]) - 0.22 + 0.08 * noise(p, 11, 4, 4.0)


def statue(p: np.ndarray) -> np.ndarray:
    """A blocky body of several parts under noise, like the output of text-to-3D."""
    body = np.maximum(np.hypot(p[..., 0], p[..., 1]) - 0.22 - 0.1 * p[..., 2] ** 2, np.abs(p[..., 2]) - 0.75)
    head = radius(p - np.array([0, 0, 0.72], np.float32)) - 0.24
    arms = np.maximum(np.hypot(p[..., 1], p[..., 2] - 0.3) - 0.09, np.abs(p[..., 0]) - 0.8)
    return np.minimum(np.minimum(body, head), arms) + 0.03 * noise(p, 17, 5, 5.0)


def marched(field: Callable[[np.ndarray], np.ndarray], change: Callable[[Mesh], Mesh] = lambda m: m) -> Callable:
    """Return the maker of a changed isosurface from the cells per side."""
    return lambda resolution: change(isosurface(field)(resolution))


def terrain(resolution: int) -> Mesh:
    """A square of land with steep valleys, as in an airborne scan."""
    n = resolution
    t = np.linspace(-1, 1, n)
    x, y = (a.ravel() for a in np.meshgrid(t, t, indexing="ij"))
    z = 0.25 * np.abs(noise(np.c_[x, y, 0 * x].astype(np.float32), 23, 7, 4.0))
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij"))
    first = i * n + j
    return np.c_[x, y, z], np.r_[np.c_[first, first + n, first + n + 1], np.c_[first, first + n + 1, first + 1]]


scan = marched(rock(9, 0.2, 5))


def shaken_scan(mesh: Mesh) -> Mesh:
    """Return `scan` with noise."""
    return shaken(mesh, 0.15, 9)


# Each from a number that is raised until there are as many faces as asked for; faces grow with its square.
ASSETS: dict[str, Callable[[int], Mesh]] = {
    "rock": marched(rock(1, 0.25, 4)),
    "rough rock": marched(rock(2, 0.35, 6)),
    "noise": marched(lambda p: noise(p, 5, 4, 5.0) + 0.4 * (radius(p) - 0.5)),
    "gyroid shell": marched(gyroid),
    "cut gyroid": marched(cut_gyroid),
    "donut": marched(donut),
    "statue": marched(statue),
    "blobs, 60": marched(blobs(3, 60, 0.2)),
    "blobs, 600": marched(blobs(4, 600, 0.06)),
    "balls, 40": merged(40, 1, (ball,)),
    "blocks, 300": merged(300, 2, (block,)),
    "primitives, 100": merged(100, 3, (ball, block, ring)),
    "primitives, 500": merged(500, 4, (ball, block, ring)),
    "soiled primitives": lambda n: soiled(merged(100, 5, (ball, block, ring))(n), 5),
    "welded primitives": lambda n: clustered(merged(100, 6, (ball, block, ring))(n), 0.5 / n),
    "torn scan": marched(rock(7, 0.2, 5), lambda m: torn(m, 0.3, 7)),
    "torn donut": marched(donut, lambda m: torn(m, 0.5, 8)),
    "decimated scan": lambda n: clustered(isosurface(statue)(n), 3.3 / n),
    "shaken scan": lambda n: shaken_scan(scan(n)),
    "soiled scan": marched(statue, lambda m: soiled(torn(m, 0.1, 10), 10)),
    "decimated, torn": lambda n: torn(clustered(isosurface(gyroid)(n), 3.3 / n), 0.2, 11),
    "terrain": terrain,
    "torn terrain": lambda n: shaken(torn(terrain(n), 0.2, 12), 0.1, 12),
}


def asset(name: str, faces: int) -> Mesh:
    """Return the mesh of this name with about this many triangles."""
    return of_size(ASSETS[name], faces)


def of_size(make: Callable[[int], Mesh], faces: int) -> Mesh:
    """Return a mesh with about this many triangles, given the maker of those whose number grows with a square."""
    number, before, size = 24, 0, 0
    for _ in range(6):
        mesh = make(number)
        size = len(mesh[1])
        if abs(size / faces - 1) < 0.15 or number == before:
            break
        before, number = number, max(1, round(number * (faces / size) ** 0.5))
    return mesh


def spectral(
    vertices: np.ndarray, triangles: np.ndarray, **limits: float
) -> tuple[np.ndarray, np.ndarray, dict[str, float]]:
    """Suggest seams, unwrap, pack: (triangles, (3 F, 2) map, seconds of the phases and failed islands)."""
    import spectral_conformal as sc

    from addon.core.layout import placement

    offsets, corners = np.arange(0, 3 * len(triangles) + 1, 3), triangles.ravel()
    start = time.process_time()
    seams = sc.suggest_seams(vertices, offsets, corners, **limits).seam_edges
    cut = time.process_time()
    result = sc.unwrap(vertices, offsets, corners, seam_edges=seams, polish=True)
    solved = time.process_time()
    uv = placement.side_by_side(result.uv, np.repeat(result.chart_of_face, 3))
    packed = time.process_time()
    failed = [chart for chart in result.charts if chart.status == "failed"]
    phases = {"seams": cut - start, "unwrap": solved - cut, "pack": packed - solved, "failed": len(failed)}
    for chart in failed[:3]:
        print(f"failed: {len(chart.faces)} faces: {chart.message}", file=sys.stderr)
    return triangles, uv, phases


def by_xatlas(vertices: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray, dict[str, float]]:
    """The same by xatlas with its default settings, packed."""
    import xatlas

    atlas = xatlas.Atlas()
    atlas.add_mesh(vertices.astype(np.float32), triangles.astype(np.uint32))
    atlas.generate()
    _, indices, uv = atlas[0]
    return triangles, (uv * [atlas.width, atlas.height])[indices.ravel()].astype(float), {}


def smart_project(vertices: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray, dict[str, float]]:
    """The same by Blender's Smart UV Project with its default settings, packed."""
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    data = bpy.data.meshes.new("asset")
    data.from_pydata(vertices.tolist(), [], triangles.tolist())
    solid = bpy.data.objects.new("asset", data)
    bpy.context.collection.objects.link(solid)
    bpy.context.view_layer.objects.active = solid
    solid.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project()
    bpy.ops.object.mode_set(mode="OBJECT")
    uv = np.empty(2 * 3 * len(triangles), np.float32)
    data.uv_layers.active.uv.foreach_get("vector", uv)
    return triangles, uv.reshape(-1, 2).astype(float), {}


def without_doubles(triangles: np.ndarray) -> np.ndarray:
    """Return the indices of the triangles without duplicates, which share the map of the first."""
    return np.sort(np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)[1])


# What makes a map, what it needs, and its limits of the suggested seams: "batch" has those of the batch.
METHODS: dict[str, tuple[Callable, str | None, dict[str, float]]] = {
    "spectral": (spectral, None, {}),
    "batch": (spectral, None, {"qc_limit": 1.01, "qc_gain": 0.001}),
    "xatlas": (by_xatlas, "xatlas", {}),
    "Smart UV": (smart_project, "bpy", {}),
}


def measured(name: str, faces: int, method: str, **limits: float) -> dict[str, float]:
    """Make one map of one mesh and measure it."""
    import spectral_conformal as sc
    from spectral_conformal.batch import memory

    from tests.benchmarks.map_measures import measure

    vertices, triangles = asset(name, faces)
    memory.reset_peak()
    start, used = time.perf_counter(), time.process_time()
    make, _, own = METHODS[method]
    triangles, uv, phases = make(vertices, triangles, **(own | (limits if make is spectral else {})))
    seconds, used = time.perf_counter() - start, time.process_time() - used
    gigabytes = (memory.peak() or math.nan) / 2**30
    once = without_doubles(triangles)
    triangles, uv = triangles[once], uv.reshape(-1, 3, 2)[once].reshape(-1, 2)
    offsets, corners = np.arange(0, 3 * len(triangles) + 1, 3), triangles.ravel()
    faced = sc.face_distortion(sc.Mesh(vertices, offsets, uv, corner_vertices=corners))
    qc = float(np.average(np.minimum(faced.qc, QC_CAP), weights=np.maximum(faced.area, 1e-300)))
    common = {"faces": len(triangles), "seconds": seconds, "processor": used, "gigabytes": gigabytes, "qc": qc}
    return {**common, **asdict(measure(vertices, offsets, corners, uv)), **phases}


def in_process(name: str, faces: int, method: str, seconds: int = SECONDS, **limits: float) -> dict[str, float] | str:
    """`measured` in its own process; a failure as text."""
    module = "tests.benchmarks.generated_assets"
    command = [sys.executable, "-m", module, "--faces", str(faces), "--measure", name, method]
    command += [f"--{key.replace('_', '-')}={value}" for key, value in limits.items()]

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (GIGABYTES << 30, GIGABYTES << 30))

    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds, preexec_fn=limit)
    except subprocess.TimeoutExpired:
        return f"no end after {seconds} s"
    if done.returncode:
        last = done.stderr.strip().splitlines()[-1:] or [""]
        return f"exit code {done.returncode}: {last[0]}"
    if done.stderr and METHODS[method][0] is spectral:
        print("\n".join(f"    {line}" for line in done.stderr.splitlines() if line.startswith("failed")), flush=True)
    return json.loads(done.stdout.strip().splitlines()[-1])


def main() -> None:
    """Print the table, or write the meshes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--faces", type=int, default=20_000)
    parser.add_argument("--only", nargs="*", choices=[*ASSETS], default=[*ASSETS], metavar="NAME")
    there = [name for name, (_, needs, _) in METHODS.items() if not needs or importlib.util.find_spec(needs)]
    parser.add_argument("--methods", nargs="*", choices=there, default=there, metavar="NAME")
    for name in LIMITS:
        parser.add_argument(f"--{name.replace('_', '-')}", type=float, help="of the suggested seams, see SeamOptions")
    parser.add_argument("--seconds", type=int, default=SECONDS, help="limit of each map (default: %(default)s)")
    parser.add_argument("--write", type=Path, metavar="FOLDER", help="write the meshes there instead")
    parser.add_argument("--measure", nargs=2, metavar=("NAME", "METHOD"), help="one map, measured, as JSON")
    parser.add_argument("--keep", action="store_true", help="put the second table into the documents")
    arguments = parser.parse_args()
    limits = {name: value for name in LIMITS if (value := getattr(arguments, name)) is not None}
    if arguments.measure:
        name, method = arguments.measure
        print(json.dumps(measured(name, arguments.faces, method, **limits)))
        return
    if arguments.write:
        arguments.write.mkdir(parents=True, exist_ok=True)
        for name in arguments.only:
            write_obj(
                arguments.write / f"{name.replace(', ', ' ').replace(' ', '_')}.obj", *asset(name, arguments.faces)
            )
        return
    columns = ("islands", "QC", "seams", "flipped", "overlapping", "seconds", "processor s", "GB", "phases")
    print(f"| mesh | faces | method | {' | '.join(columns)} |\n" + "|---" * (3 + len(columns)) + "|", flush=True)
    found = {}
    for name in arguments.only:
        for method in arguments.methods:
            found[name, method] = each = in_process(name, arguments.faces, method, arguments.seconds, **limits)
            if isinstance(each, str):
                print(f"| {name} | | {method} | {each} |", flush=True)
                continue
            phases = ", ".join(f"{key} {each[key]:.1f}" for key in ("seams", "unwrap", "pack") if key in each)
            failed = f", {each['failed']} islands failed" if each.get("failed") else ""
            print(
                f"| {name} | {each['faces']} | {method} | {each['islands']} | {each['qc']:.4f} "
                f"| {each['length']:.2f} | {each['flipped']} | {each['overlapping']} | {each['seconds']:.1f} "
                f"| {each['processor']:.1f} | {each['gigabytes']:.2f} | {phases}{failed} |",
                flush=True,
            )
    table = summary(found, arguments)
    if arguments.keep:
        documents.keep(table)


def summary(found: dict[tuple[str, str], dict[str, float] | str], arguments: argparse.Namespace) -> documents.Table:
    """Print and return the table of the documents: islands / length / mean QC, and our seconds and memory."""
    ours = [method for method in arguments.methods if METHODS[method][0] is spectral]
    titles = [title for m in arguments.methods for title in ((m, "s", "GB") if m in ours else (m,))]
    name = "million" if arguments.faces == MILLION else "assets"
    table = documents.Table(name, (f"mesh of {arguments.faces:,} faces", *titles), documents.SEAMS)
    for mesh in arguments.only:
        cells: list[str] = []
        for method in arguments.methods:
            each = found[mesh, method]
            if isinstance(each, str):
                cells += [each] + (["", ""] if method in ours else [])
                continue
            faults = [f", {each[kind]:,} {kind}" for kind in ("flipped", "overlapping") if each[kind]]
            cells.append(f"{each['islands']:,} / {each['length']:.1f} / {each['qc']:.3f}{''.join(faults)}")
            cells += [f"{each['processor']:.1f}", f"{each['gigabytes']:.1f}"] if method in ours else []
        table.row(mesh, *cells)
    return table


if __name__ == "__main__":
    main()
