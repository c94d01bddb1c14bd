"""Draw what hole rigidity and the blend from angles to areas do, for the documents.

    build/venv/bin/python -m tests.benchmarks.control_pictures [folder]

The folder is docs/images by default.
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 - the backend comes first
import numpy as np  # noqa: E402
import spectral_conformal as sc  # noqa: E402

from tests.module import meshes  # noqa: E402

IMAGES = Path(__file__).resolve().parents[2] / "docs" / "images"


def draw_hole_rigidity(folder: Path) -> None:
    """Draw the torn hat, and its map without and with rigidity."""
    vertices, triangles = meshes.torn_hat()
    brim = np.r_[np.arange(64), 0]
    solver = sc.Solver(vertices, triangles)
    figure = plt.figure(figsize=(12, 4.4))
    axes = figure.add_subplot(1, 3, 1, projection="3d")
    axes.plot_trisurf(*vertices.T, triangles=triangles, color="lightsteelblue", edgecolor="slategrey", linewidth=0.2)
    axes.plot(*vertices[brim].T, color="darkorange", linewidth=2)
    axes.set_axis_off()
    axes.set_title("The torn edge is the longest border")
    for place, rigidity in ((2, 0.0), (3, 1.0)):
        solution = solver.solve(hole_rigidity=rigidity)
        measured = sc.distortion(vertices, triangles, solution.uv)
        axes = figure.add_subplot(1, 3, place)
        axes.triplot(*solution.uv.T, triangles, linewidth=0.2, color="slategrey")
        axes.plot(*solution.uv[brim].T, color="darkorange", linewidth=2)
        axes.set_aspect("equal")
        axes.set_axis_off()
        spread = measured.log2_scale_deviation
        axes.set_title(f"rigidity {rigidity:g}: brim {_length(solution.uv[brim]):.2f}, spread {spread:.2f}")
        print(
            f"hole rigidity {rigidity:g}: the brim's border is {_length(solution.uv[brim]):.2f} long instead of "
            f"{_length(vertices[brim]):.2f}, spread of log2 scale {spread:.2f}, mean QC {measured.mean_qc:.3f}"
        )
    figure.tight_layout(rect=(0, 0, 1, 0.96))
    figure.savefig(folder / "hole_rigidity.png", dpi=70)


def draw_area_blend(folder: Path) -> None:
    """Draw the maps of the bulge from keeping angles to keeping areas, coloured by scale."""
    vertices, quads = meshes.bulge(61, 1.8)
    triangles = np.r_[quads[:, :3], quads[:, [0, 2, 3]]]
    figure, axes = plt.subplots(1, 3, figsize=(12, 4.2))
    for panel, amount in zip(axes, (0.0, 0.5, 1.0)):
        solution = sc.parameterize(vertices, triangles, area_blend=amount)
        measured = sc.distortion(vertices, triangles, solution.uv)
        colors = panel.tripcolor(*solution.uv.T, triangles, measured.log2_scale, cmap="coolwarm", vmin=-2, vmax=2)
        panel.set_aspect("equal")
        panel.set_axis_off()
        spread = measured.log2_scale_deviation
        panel.set_title(f"{amount:g}: spread {spread:.2f}, mean QC {measured.mean_qc:.2f}")
        print(
            f"area blend {amount:g}: spread of log2 scale {spread:.2f}, mean QC {measured.mean_qc:.2f}, "
            f"flips {measured.flipped.sum()}"
        )
    figure.tight_layout()
    figure.colorbar(colors, ax=axes, label="log2 scale", shrink=0.7)
    figure.savefig(folder / "area_blend.png", dpi=70)


def _length(loop: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(loop, axis=0), axis=1).sum())


def main() -> None:
    """Draw both pictures."""
    folder = Path(sys.argv[1]) if sys.argv[1:] else IMAGES
    draw_hole_rigidity(folder)
    draw_area_blend(folder)


if __name__ == "__main__":
    main()
