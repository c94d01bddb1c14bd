# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the guide's picture of the same islands in the UV tile: as boxes, by Spectral Unwrap and by Spectral Pack.

    build/venv/bin/python -m tests.benchmarks.packing_picture [folder]

The folder is docs/images by default.
"""

from __future__ import annotations

import importlib
import io
import sys
from pathlib import Path

import numpy as np

from addon.core.layout.placement import side_by_side
from addon.core.layout.shape_packing import ShapePacking
from addon.core.mesh.polygon_mesh import PolygonMesh
from tests.benchmarks import packing

IMAGES = Path(__file__).resolve().parents[2] / "docs" / "images"
DPI = 80
PANEL_INCHES = 3.2
COLORS = 128
SIDE, MARGIN, STEPS = 1024, 6.0, 40


def islands() -> tuple[np.ndarray, np.ndarray]:
    """Return triangles, (T, 3, 2), and the island of each, (T,): parts of a machine, nets of a figure and straps."""
    rng = np.random.default_rng(1)
    kinds = (packing.hard,) * 16 + (packing.organic,) * 8 + (packing.strips,) * 5
    given = [kind(rng) for kind in kinds]
    return np.concatenate(given), np.repeat(np.arange(len(given)), [len(each) for each in given])


def main() -> None:
    """Pack three times and draw."""
    triangles, island = islands()
    uv = triangles.reshape(-1, 2)
    starts = np.arange(0, len(uv) + 1, 3)
    mesh = PolygonMesh(
        np.zeros((len(uv), 3)), starts, np.arange(len(uv)), np.empty((0, 2)), np.ones(len(island), bool), uv
    )
    maps = {"as boxes": side_by_side(uv, np.repeat(island, 3), MARGIN / SIDE)}
    for title, rotation, steps in (("Spectral Unwrap", "none", 0), ("Spectral Pack", "free", STEPS)):
        found = ShapePacking([mesh], [uv], [island], SIDE, MARGIN, rotation=rotation, keep_stacks=False)
        if steps:
            found.step(steps)
        maps[title] = found.now().maps[0]
    figure = importlib.import_module("matplotlib.figure").Figure(figsize=(PANEL_INCHES * len(maps), PANEL_INCHES + 0.3))
    collections = importlib.import_module("matplotlib.collections")
    colors = np.random.default_rng(2).uniform(0.3, 0.9, (island.max() + 1, 3))[island]
    for axes, (title, found) in zip(figure.subplots(1, len(maps)), maps.items()):
        shown = found.reshape(-1, 3, 2)
        axes.add_collection(collections.PolyCollection(shown, facecolors=colors, edgecolors=colors, linewidths=0.5))
        axes.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0), xticks=[], yticks=[], aspect="equal")
        axes.set_title(f"{title}: {100.0 * packing.area(shown):.0f} %", fontsize=10)
    figure.tight_layout()
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=DPI, format="png")
    image = importlib.import_module("PIL.Image").open(drawn).convert("RGB").quantize(COLORS)
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else IMAGES
    image.save(folder / "pack.png", optimize=True)


if __name__ == "__main__":
    main()
