# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the seams suggested for the benchmark's meshes, beside those of an earlier version.

    build/venv/bin/python -m tests.benchmarks.seam_pictures [--before FOLDER] [--images FOLDER] [name ...]

`--before` takes a folder with an earlier version of the module (`pip install --target`). The meshes are the hard
surfaces of the tests, Suzanne and, if present, the closed meshes beside the project; names select some of them. Writes
seams_hard.png and seams_organic.png, by default to docs/images. They show each mesh from two opposite corners, without
hidden seams, and its layout.
"""

from __future__ import annotations

import argparse
import io
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from PIL import Image

from tests.benchmarks.suggested_seams import SHARED, loaded
from tests.blender.inside import seam_measures
from tests.module import meshes
from tests.module.hard_surfaces import HARD_SURFACES

IMAGES = Path(__file__).resolve().parents[2] / "docs" / "images"
PANEL_INCHES = 1.7
DPI = 80
COLORS = colormaps["Pastel1"].colors + colormaps["Set3"].colors
VIEWS = ((1.0, -1.4, 0.9), (-1.0, 1.4, 0.9))
Arrays = tuple[np.ndarray, np.ndarray, np.ndarray]

WORKER = """
import sys
import numpy as np
import spectral_conformal as sc
data = np.load(sys.argv[1])
mesh = data["vertices"], data["offsets"], data["corners"]
seams = sc.suggest_seams(*mesh)
# Of a build before meshes had seams, the edges themselves.
seams = getattr(seams, "seam_edges", seams)
result = sc.unwrap(*mesh, seam_edges=seams)
uv = result.uv.copy()
for chart in range(int(result.chart_of_face.max()) + 1):
    of_chart = np.repeat(result.chart_of_face == chart, np.diff(mesh[1]))
    uv[of_chart] -= uv[of_chart].min(axis=0)
np.savez(sys.argv[2], seams=seams, uv=uv, chart=result.chart_of_face, worst=max(c.max_qc for c in result.charts))
"""


@dataclass(frozen=True)
class Seams:
    """Suggested seams (S, 2) of a mesh, its map (corners, 2), the islands of the faces, and the worst distortion."""

    seams: np.ndarray
    uv: np.ndarray
    chart: np.ndarray
    worst: float

    @property
    def title(self) -> str:
        """Islands, and the angle distortion of the worst face."""
        n = int(self.chart.max()) + 1
        return f"{n} island{'s' if n > 1 else ''}, worst {self.worst:.2f}"


def suggested(mesh: Arrays, package: Path | None, folder: Path) -> Seams:
    """Return what the module suggests, or that in the folder `package`, in a process of its own."""
    given, made = folder / "mesh.npz", folder / "seams.npz"
    np.savez(given, vertices=mesh[0], offsets=mesh[1], corners=mesh[2])
    environment = dict(os.environ, **({"PYTHONPATH": str(package)} if package else {}))
    subprocess.run([sys.executable, "-c", WORKER, str(given), str(made)], env=environment, check=True)
    data = np.load(made)
    return Seams(data["seams"], data["uv"], data["chart"], float(data["worst"]))


def hard() -> Iterator[tuple[str, Arrays]]:
    """Return the models of hard surfaces."""
    for name, model in HARD_SURFACES.items():
        vertices, faces = model.make()
        yield name, (vertices, *meshes.polygons(faces))


def organic() -> Iterator[tuple[str, Arrays]]:
    """Return Suzanne and the closed meshes beside the project."""
    yield "Suzanne", seam_measures.arrays(seam_measures.monkey(0))
    for path in sorted(SHARED.glob("*closed*.obj")):
        yield path.stem, loaded(path)


def _packed(found: Seams, offsets: np.ndarray) -> np.ndarray:
    """Lay the islands in rows by height; return (corners, 2)."""
    uv = found.uv.copy()
    of_corner = np.repeat(found.chart, np.diff(offsets))
    charts = [np.flatnonzero(of_corner == chart) for chart in range(int(found.chart.max()) + 1)]
    charts = [corners for corners in charts if len(corners)]
    sizes = [np.ptp(uv[corners], axis=0) for corners in charts]
    side = 1.15 * max(np.sqrt(sum(w * h for w, h in sizes)), max(w for w, _ in sizes))
    gap, x, y, row = 0.02 * side, 0.0, 0.0, 0.0
    for k in sorted(range(len(charts)), key=lambda k: -sizes[k][1]):
        width, height = sizes[k]
        if x + width > side and x > 0:
            x, y, row = 0.0, y + row + gap, 0.0
        uv[charts[k]] += (x, y) - uv[charts[k]].min(axis=0)
        x, row = x + width + gap, max(row, height)
    return uv


def _draw_surface(axes: Axes, mesh: Arrays, found: Seams, toward: tuple[float, float, float]) -> None:
    vertices, offsets, corners = mesh
    view = np.array(toward) / np.linalg.norm(toward)
    right = np.cross((0, 0, 1), view)
    right /= np.linalg.norm(right)
    up = np.cross(view, right)
    flat = vertices @ np.c_[right, up]
    faces = np.split(corners, offsets[1:-1])
    normals = np.array([_normal(vertices[face]) for face in faces])
    facing = normals @ view
    front = np.flatnonzero(facing > 0)
    depth = np.array([vertices[faces[f]].mean(axis=0) @ view for f in front])
    front = front[np.argsort(depth, kind="stable")]
    light = 0.45 + 0.55 * np.clip(normals @ (view + 0.5 * up - 0.3 * right) / 1.16, 0, 1)
    colors = [np.array(COLORS[found.chart[f] % len(COLORS)][:3]) * light[f] for f in front]
    axes.add_collection(
        PolyCollection([flat[faces[f]] for f in front], facecolors=colors, edgecolors=colors, linewidths=0.3)
    )
    size = np.linalg.norm(np.ptp(vertices, axis=0))
    tree = BVHTree.FromPolygons(vertices.tolist(), [face.tolist() for face in faces])
    lines = []
    for a, b in found.seams:
        for start, end in _pieces(vertices[a], vertices[b], 0.02 * size):
            middle = Vector((start + end) / 2 + 2e-3 * size * view)
            if tree.ray_cast(middle, Vector(view))[0] is None:
                lines.append(np.array([start, end]) @ np.c_[right, up])
    axes.add_collection(LineCollection(lines, colors="#c01818", linewidths=1.3))
    _frame(axes, flat)


def _normal(points: np.ndarray) -> np.ndarray:
    normal = np.cross(points - points[0], np.roll(points, -1, axis=0) - points[0]).sum(axis=0)
    return normal / max(np.linalg.norm(normal), 1e-300)


def _pieces(start: np.ndarray, end: np.ndarray, step: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    n = max(int(np.ceil(np.linalg.norm(end - start) / step)), 1)
    points = start + np.linspace(0, 1, n + 1)[:, None] * (end - start)
    yield from zip(points[:-1], points[1:], strict=True)


def _draw_layout(axes: Axes, mesh: Arrays, found: Seams) -> None:
    uv = _packed(found, mesh[1])
    polygons = np.split(uv, mesh[1][1:-1])
    edge = "#404040" if len(polygons) < 3000 else "none"
    axes.add_collection(
        PolyCollection(
            polygons,
            facecolors=[COLORS[chart % len(COLORS)] for chart in found.chart],
            edgecolors=edge,
            linewidths=0.2,
        )
    )
    _frame(axes, uv)


def _frame(axes: Axes, points: np.ndarray) -> None:
    low, high = points.min(axis=0), points.max(axis=0)
    half = 0.53 * max(high - low)
    middle = (low + high) / 2
    axes.set_xlim(middle[0] - half, middle[0] + half)
    axes.set_ylim(middle[1] - half, middle[1] + half)
    axes.set_aspect("equal")
    axes.axis("off")


def sheet(cases: list[tuple[str, Arrays]], packages: dict[str, Path | None], folder: Path) -> bytes:
    """Draw a sheet: two meshes to a row, each with its versions one above the other."""
    columns = 2
    rows = -(-len(cases) // columns) * len(packages)
    shape = (rows, columns * (len(VIEWS) + 1))
    figure = Figure(figsize=(PANEL_INCHES * shape[1], PANEL_INCHES * 1.12 * rows))
    grid = figure.subplots(*shape, squeeze=False)
    for axes in grid.ravel():
        axes.axis("off")
    for k, (name, mesh) in enumerate(cases):
        for row, (version, package) in enumerate(packages.items()):
            found = suggested(mesh, package, folder)
            line = grid[k // columns * len(packages) + row, k % columns * (len(VIEWS) + 1) :]
            for axes, view in zip(line, VIEWS, strict=False):
                _draw_surface(axes, mesh, found, view)
            _draw_layout(line[len(VIEWS)], mesh, found)
            line[0].set_title(f"{name}, {version}: {found.title}", fontsize=7, loc="left")
    figure.tight_layout(pad=0.2)
    file = io.BytesIO()
    figure.savefig(file, dpi=DPI, metadata={"Software": None})
    image = io.BytesIO()
    Image.open(file).convert("P", palette=Image.Palette.ADAPTIVE, colors=128).save(image, "PNG", optimize=True)
    return image.getvalue()


def main() -> int:
    """Draw the sheets."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*")
    parser.add_argument("--before", type=Path)
    parser.add_argument("--images", type=Path, default=IMAGES)
    options = parser.parse_args()
    options.images.mkdir(parents=True, exist_ok=True)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    packages = {**({"before": options.before} if options.before else {}), "now": None}
    with tempfile.TemporaryDirectory() as folder:
        for kind, cases in (("hard", hard), ("organic", organic)):
            chosen = [case for case in cases() if not options.names or case[0] in options.names]
            if chosen:
                (options.images / f"seams_{kind}.png").write_bytes(sheet(chosen, packages, Path(folder)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
