"""Draw what hole rigidity and the blend from angles to areas do, for the README.

    build/venv/bin/python tests/benchmarks/control_pictures.py [folder]

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

IMAGES = Path(__file__).resolve().parents[2] / "docs" / "images"


def torn_hat(around: int = 64) -> tuple[np.ndarray, np.ndarray]:
    """Make a brim with a crown whose torn edge is longer than the brim; the brim's border is the first `around`."""
    angle = np.arange(around) * 2 * np.pi / around
    profile = [(r, 0.0) for r in np.linspace(1, 0.35, 16)] + [(0.35, h) for h in np.linspace(0, 0.5, 12)[1:]]
    torn = 0.5 * (np.arange(around) % 2)
    vertices = [
        (r * np.cos(a), r * np.sin(a), h * (1 + t * (h / 0.5) ** 3)) for r, h in profile for a, t in zip(angle, torn)
    ]
    k, i = (x.ravel() for x in np.meshgrid(np.arange(len(profile) - 1), np.arange(around), indexing="ij"))
    a, b = k * around + i, k * around + (i + 1) % around
    return np.array(vertices), np.r_[np.c_[a, b, b + around], np.c_[a, b + around, a + around]]


def bulge(n: int = 61) -> tuple[np.ndarray, np.ndarray]:
    """Make a square with a deep bulge, which a conformal map shrinks."""
    t = np.linspace(-1, 1, n)
    x, y = (a.ravel() for a in np.meshgrid(t, t, indexing="ij"))
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij"))
    a = i * n + j
    triangles = np.r_[np.c_[a, a + n, a + n + 1], np.c_[a, a + n + 1, a + 1]]
    return np.c_[x, y, 1.8 * np.exp(-5 * (x**2 + y**2))], triangles


def draw_hole_rigidity(folder: Path) -> None:
    """Draw the torn hat, and its map without and with rigidity."""
    vertices, triangles = torn_hat()
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
    vertices, triangles = bulge()
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
