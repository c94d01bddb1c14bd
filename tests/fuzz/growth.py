# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of which one thing is huge, and how the instructions of every function grow with it.

    build/venv/bin/python -m tests.fuzz.growth [--seed 1] [case ...]

From the project's folder. Needs valgrind. Prints, for each case, millions of instructions at every size and the factor
between the last two; a case is `family/function`.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from tests import callgrind
from tests.fuzz.random_meshes import Mesh
from tests.module import meshes

SIZES = (500, 2000)


# Families: (rng, size) -> vertices and faces


def circle(n, radius=1.0, height=0.0):
    angle = 2 * np.pi * np.arange(n) / n
    return np.c_[radius * np.cos(angle), radius * np.sin(angle), np.full(n, height)]


def band(n):
    """Quads between two rings of n vertices."""
    i = np.arange(n)
    j = (i + 1) % n
    return np.c_[i, j, j + n, i + n].tolist()


def grid(columns, rows):
    x, y = np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0), indexing="ij")
    i = (np.arange(columns)[:, None] * (rows + 1) + np.arange(rows)).ravel()
    quads = np.c_[i, i + rows + 1, i + rows + 2, i + 1]
    return np.c_[x.ravel(), y.ravel(), 0 * x.ravel()], quads.tolist()


def valence(rng, n):
    """A fan: a hub, and a round border without holes."""
    return np.r_[circle(n), [[0, 0, rng.uniform(0.1, 1)]]], [[n, k, (k + 1) % n] for k in range(n)]


def corners(rng, n):
    """One round polygon."""
    return circle(n, rng.uniform(0.5, 2)), [list(range(n))]


def jagged_corners(rng, n):
    """One polygon with teeth."""
    return circle(n) * np.where(np.arange(n) % 2, 1, rng.uniform(0.95, 0.98))[:, None], [list(range(n))]


def spiked_corners(rng, n):
    """One star-shaped polygon of thin spikes, whose boxes nearly all meet."""
    radius = np.where(np.arange(n) % 2, 1, 0.3 + 0.5 * rng.random(n))
    return circle(n) * radius[:, None], [list(range(n))]


def cap(rng, n):
    """A cap on an open tube."""
    return np.r_[circle(n), circle(n, 1, -rng.uniform(0.5, 2))], [list(range(n)), *[q[::-1] for q in band(n)]]


def pipe(rng, n):
    """A tube with a cap at each end."""
    vertices, faces = cap(rng, n)
    return vertices, [*faces, list(range(n, 2 * n))[::-1]]


def hull(rng, n):
    """A flat ring, whose outline is round."""
    return np.r_[circle(n), circle(n, rng.uniform(0.8, 0.95))], band(n)


def border(rng, n):
    """A strip of two quads' width, bent to a horseshoe."""
    vertices, quads = grid(n, 2)
    angle = 5 * vertices[:, 0] / n
    radius = 3 + vertices[:, 1] * rng.uniform(0.2, 0.5)
    return np.c_[radius * np.cos(angle), radius * np.sin(angle), 0 * angle], quads


def loops(rng, n):
    """A plate with holes, n / 8 of them."""
    side = 2 * int((n / 8) ** 0.5) + 1
    vertices, quads = grid(side, side)
    vertices[:, 2] = rng.uniform(0, 0.1) * np.sin(vertices[:, 0])
    return vertices, [quad for k, quad in enumerate(quads) if not (k // side % 2 and k % side % 2)]


def islands(rng, n):
    """Quads with vertices of their own."""
    vertices, quads = grid(int(n**0.5), int(n**0.5))
    apart = vertices[np.ravel(quads)] * rng.uniform(0.5, 2)
    return apart, np.arange(len(apart)).reshape(-1, 4).tolist()


def alternating(rng, n):
    """A row of quads, every second of which is split into triangles."""
    vertices, quads = grid(n, 1)
    vertices[:, 2] = rng.uniform(0, 0.2) * np.sin(vertices[:, 0])
    faces = []
    for k, quad in enumerate(quads):
        faces += [quad[:3], [quad[0], *quad[2:]]] if k % 2 else [quad]
    return vertices, faces


def ribbon(rng, n):
    """A row of quads, one of which is folded."""
    vertices, quads = grid(n, 1)
    vertices[2 * (n // 2), 1] = rng.uniform(2, 3)
    return vertices, quads


def crossing_corners(rng, n):
    """One polygon that crosses itself everywhere."""
    return np.c_[rng.random((n, 2)), np.zeros(n)], [list(range(n))]


def pages(rng, n):
    """Triangles on one edge."""
    return np.r_[[[0, 0, 0], [0, 0, 1]], circle(n, 1, rng.uniform(0, 1))], [[0, 1, k + 2] for k in range(n)]


def bow_ties(rng, n):
    """Triangles that share a vertex and no edge."""
    return np.r_[[[0, 0, rng.uniform(0, 1)]], circle(2 * n)], [[0, 2 * k + 1, 2 * k + 2] for k in range(n)]


def duplicates(rng, n):
    """Faces on the same vertices, beside others."""
    vertices, quads = grid(4, 4)
    return vertices + rng.uniform(-0.1, 0.1, vertices.shape), quads + [quads[0]] * n


def duplicate_corners(rng, n):
    """Two polygons on the same vertices."""
    return circle(n, rng.uniform(0.5, 2)), [list(range(n))] * 2


def spot(rng, n):
    """A quad, and a grid that is a point beside it."""
    vertices, quads = grid(int(n**0.5), int(n**0.5))
    first = len(vertices)
    small = vertices * 10 ** rng.uniform(-9, -7)
    large = [[1, 1, 1], [2, 1, 1], [2, 2, 1], [1, 2, 1]]
    return np.r_[small, large], [*quads, [first, first + 1, first + 2, first + 3]]


def coincident(rng, n):
    """Few positions, at each of which many quads have vertices of their own."""
    vertices, quads = grid(3, 3)
    apart = np.repeat(vertices[quads], n // 9, axis=0).reshape(-1, 3) * rng.uniform(0.5, 2)
    return apart, np.arange(len(apart)).reshape(-1, 4).tolist()


def bow_tie_chain(rng, n):
    """Triangles in a row, each of which shares one vertex with the next."""
    k = np.arange(n)
    ends = np.c_[np.arange(n + 1), rng.uniform(-0.1, 0.1, n + 1), np.zeros(n + 1)]
    tips = np.c_[k + 0.5, np.where(k % 2, -1, 1), rng.uniform(0, 0.2, n)]
    return np.r_[ends, tips], [[i, i + 1, n + 1 + i] if i % 2 == 0 else [i + 1, i, n + 1 + i] for i in range(n)]


def zigzag(rng, n):
    """A strip of quads whose sides go up and down."""
    vertices, quads = grid(n, 1)
    vertices[:, 1] += rng.uniform(0.5, 1) * (vertices[:, 0] % 2)
    return vertices, quads


FAMILIES = {
    family.__name__: family
    for family in (
        valence,
        corners,
        jagged_corners,
        spiked_corners,
        cap,
        pipe,
        hull,
        border,
        loops,
        islands,
        alternating,
        ribbon,
        crossing_corners,
        pages,
        bow_ties,
        duplicates,
        duplicate_corners,
        spot,
        coincident,
        bow_tie_chain,
        zigzag,
    )
}


# Functions: (rng, mesh) -> what is counted


def unwrap(rng, mesh):
    import spectral_conformal as sc

    return lambda: sc.unwrap(mesh.vertices, mesh.offsets, mesh.corners)


def charts(rng, mesh):
    import spectral_conformal as sc

    return lambda: sc.hosts.chart_of_face(mesh.vertices, mesh.offsets, mesh.corners)


def pinned(rng, mesh):
    """Every other corner, each elsewhere."""
    import spectral_conformal as sc

    pins = rng.random(len(mesh.corners)) < 0.5
    uv = rng.random((len(mesh.corners), 2))
    return lambda: sc.unwrap(sc.Mesh(mesh.vertices, mesh.offsets, uv, corner_vertices=mesh.corners), fixed=pins)


def extended(rng, mesh):
    """Extenders, more where there are more islands."""
    import spectral_conformal as sc

    n = len(sc.unwrap(mesh.vertices, mesh.offsets, mesh.corners).charts)
    first = mesh.corners[mesh.offsets[:-1]]
    second = mesh.corners[mesh.offsets[:-1] + 1]
    which = np.linspace(0, len(first) - 1, n).astype(int)
    pairs = [(int(first[k]), int(second[k]), 0.1) for k in which]
    return lambda: sc.unwrap(mesh.vertices, mesh.offsets, mesh.corners, extenders=pairs)


def kept(rng, mesh):
    """Unwrapped again."""
    import spectral_conformal as sc

    maps = sc.hosts.KeptMaps()
    sc.unwrap(mesh.vertices, mesh.offsets, mesh.corners, kept_maps=maps)
    return lambda: sc.unwrap(mesh.vertices, mesh.offsets, mesh.corners, kept_maps=maps)


def map_defects(rng, mesh):
    uv = mesh.vertices[mesh.corners][:, :2]
    return lambda: meshes.defects(mesh.offsets, mesh.corners, uv, between_islands=True)


def distortion(rng, mesh):
    import spectral_conformal as sc

    return lambda: sc.distortion(mesh.vertices, mesh.triangles, mesh.vertices[:, :2])


def face_distortion(rng, mesh):
    import spectral_conformal as sc

    uv = mesh.vertices[mesh.corners][:, :2]
    return lambda: sc.face_distortion(sc.Mesh(mesh.vertices, mesh.offsets, uv, corner_vertices=mesh.corners))


def pack_boxes(rng, mesh):
    """The boxes of the faces, so many of them that a tree takes over from a list of 100 segments."""
    import spectral_conformal as sc

    ends = mesh.offsets[:-1]
    size = np.maximum.reduceat(mesh.vertices[mesh.corners], ends) - np.minimum.reduceat(
        mesh.vertices[mesh.corners], ends
    )
    many = np.tile(size[:, :2], (16, 1))
    return lambda: sc.hosts.pack_boxes(many)


def relax(rng, mesh):
    """Five steps from the view from above."""
    import spectral_conformal as sc

    uv = mesh.vertices[mesh.corners][:, :2] * [1, 1.5]
    seen = sc.Mesh(mesh.vertices, mesh.offsets, uv, corner_vertices=mesh.corners)
    return lambda: sc.relax(seen, max_steps=5)


def fold_free(rng, mesh):
    uv = mesh.vertices[:, :2] * [1, 1.5]
    return lambda: meshes.relax(mesh.vertices, mesh.triangles, uv, max_steps=2, fold_free=True)


def read_ply(rng, mesh):
    """A binary file."""
    from spectral_conformal import assets

    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(mesh.vertices)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(mesh.faces)}\nproperty list uint int vertex_indices\nend_header\n"
    )
    rows = [np.array([len(face), *face], "<i4").tobytes() for face in mesh.faces]
    with tempfile.NamedTemporaryFile(suffix=".ply", delete=False) as file:
        file.write(header.encode() + mesh.vertices.astype("<f8").tobytes() + b"".join(rows))

    def read() -> None:
        assets.read(Path(file.name))
        Path(file.name).unlink()

    return read


def suggest_seams(rng, mesh):
    import spectral_conformal as sc

    return lambda: sc.suggest_seams(mesh.vertices, mesh.offsets, mesh.corners).seam_edges


def suggest_cuts(rng, mesh):
    import spectral_conformal as sc

    return lambda: sc.suggest_cuts(mesh.vertices, mesh.offsets, mesh.corners)


FUNCTIONS = {
    function.__name__: function
    for function in (
        unwrap,
        charts,
        pinned,
        extended,
        kept,
        map_defects,
        distortion,
        face_distortion,
        pack_boxes,
        relax,
        fold_free,
        read_ply,
        suggest_seams,
        suggest_cuts,
    )
}
CASES = [f"{family}/{function}" for family in FAMILIES for function in FUNCTIONS]


def prepared(case: str, seed: int, size: int) -> Callable[[], object]:
    """Make the mesh and the arguments of a case."""
    family, function = case.split("/")
    rng = np.random.default_rng([seed, CASES.index(case)])
    vertices, faces = FAMILIES[family](rng, size)
    return FUNCTIONS[function](rng, Mesh(vertices, faces, family))


def work(seed: int, cases: list[str]) -> None:
    """Call each case once at every size."""
    import spectral_conformal as sc

    sc.limit_threads(1)
    # What a first call sets up is no case's own.
    prepared("valence/unwrap", seed, 100)()
    for case in cases:
        for size in SIZES:
            callgrind.count(prepared(case, seed, size))


def instructions(seed: int, cases: list[str]) -> dict[str, list[int]]:
    """Return the instructions of each case at every size."""
    worker = ("-m", "tests.fuzz.growth", "--seed", str(seed), "--worker", *cases)
    counted = iter(callgrind.counts(len(cases) * len(SIZES), *worker))
    return {case: [next(counted) for _ in SIZES] for case in cases}


def in_parallel(seed: int, cases: list[str]) -> dict[str, list[int]]:
    """As `instructions`, with a process per core."""
    n = os.cpu_count() or 1
    parts = [part for part in (cases[k::n] for k in range(n)) if part]
    with ThreadPoolExecutor(n) as threads:
        done = list(threads.map(lambda part: instructions(seed, part), parts))
    counts = {case: each for part in done for case, each in part.items()}
    return {case: counts[case] for case in cases}


def main() -> int:
    """Count, or work for a process that counts."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--worker", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("cases", nargs="*", metavar="family/function")
    options = parser.parse_args()
    if options.worker:
        work(options.seed, options.cases)
        return 0
    for case, counts in in_parallel(options.seed, options.cases or CASES).items():
        print(f"{case:32}", *(f"{count / 1e6:10.2f}" for count in counts), f"{counts[-1] / counts[-2]:8.2f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
