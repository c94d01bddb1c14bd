# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in build/venv: measure the distortion of every method's UVs, draw the UV layout, and write report.json."""

from __future__ import annotations

import json
import os
import platform
import sys
from importlib.metadata import version
from pathlib import Path

import matplotlib
import numpy as np
import scipy
import spectral_conformal
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 - the backend is chosen first
from matplotlib.collections import PolyCollection  # noqa: E402

SPECTRAL = "Spectral Unwrap"


def main() -> None:
    """Measure the output of blender_unwrap.py."""
    job = json.loads(Path(sys.argv[-1]).read_text())
    output, work = Path(job["output"]), Path(job["work"])
    facts = json.loads((work / "blender.json").read_text())
    arrays = np.load(work / "uvs.npz")
    vertices, triangles = arrays["vertices"].astype(float), arrays["triangles"]
    area = triangle_areas(vertices[triangles])
    rows = []
    for method, (first, again) in facts["seconds"].items():
        corner_uv = arrays[method].astype(float)
        islands, qc, flipped = measure(vertices, triangles, corner_uv)
        solved = np.isfinite(qc) & (area > 0)
        if not solved.any():
            sys.exit(f"{method} left all UVs at zero")
        rows.append(
            {
                "method": method,
                "mean_qc": float(np.average(qc[solved], weights=area[solved])),
                "p99_qc": float(np.percentile(qc[solved], 99)),
                "max_qc": float(qc[solved].max()),
                "flips": int(flipped.sum()),
                "triangles_left_out": int((~solved).sum()),
                "islands": int(islands.max()) + 1,
                # The first call also loads the native module, and gets its memory from the system.
                "first_seconds": first,
                "seconds": again,
            }
        )
        if method == SPECTRAL:
            draw_layout(corner_uv[solved], qc[solved], rows[-1], output / "uv_layout.png")
    report = {
        "mesh": {
            "name": facts["mesh"],
            "vertices": facts["vertices"],
            "faces": facts["faces"],
            "triangles": len(triangles),
            "islands": rows[0]["islands"],
        },
        "methods": rows,
        "versions": {
            "blender": facts["blender"],
            "spectral_conformal": version("spectral_conformal"),
            "build": spectral_conformal.build_info(),
            "numpy": np.__version__,
            "scipy": scipy.__version__,
            "python": platform.python_version(),
        },
        "machine": {"system": platform.platform(), "processors": os.cpu_count()},
    }
    (output / "report.json").write_text(json.dumps(report, indent=2) + "\n")


def measure(
    vertices: np.ndarray, triangles: np.ndarray, corner_uv: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return island, QC and whether flipped, each (F,), of UVs given per triangle corner (F,3,2).

    Islands are triangles that share a vertex with the same UV; each counts its flips against its own majority. The
    triangles of an island without area in the map have no QC: NaN.
    """
    keys = np.column_stack([triangles.reshape(-1), corner_uv.reshape(-1, 2)])
    points, corners = np.unique(keys, axis=0, return_inverse=True)
    welded = corners.reshape(-1, 3)
    pairs = np.concatenate([welded[:, [0, 1]], welded[:, [1, 2]]])
    graph = coo_array((np.ones(len(pairs)), pairs.T), shape=(len(points), len(points)))
    islands = connected_components(graph, directed=False)[1][welded[:, 0]]
    qc, flipped = np.full(len(triangles), np.nan), np.zeros(len(triangles), bool)
    for island in range(islands.max() + 1):
        chosen = np.flatnonzero(islands == island)
        used, local = np.unique(welded[chosen], return_inverse=True)
        uv = points[used, 1:]
        local = local.reshape(-1, 3)
        area = signed_areas(uv[local]).sum()
        if area == 0:
            continue
        if area < 0:
            uv = uv * (-1, 1)
        result = spectral_conformal.distortion(vertices[points[used, 0].astype(int)], local, uv)
        qc[chosen], flipped[chosen] = result.qc, result.flipped
    return islands, qc, flipped


def triangle_areas(corners: np.ndarray) -> np.ndarray:
    """Return the areas (F,) of triangles in space (F,3,3)."""
    sides = corners[:, 1:] - corners[:, :1]
    return np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2


def signed_areas(corners: np.ndarray) -> np.ndarray:
    """Return the signed areas (F,) of triangles in the plane (F,3,2)."""
    sides = corners[:, 1:] - corners[:, :1]
    return (sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]) / 2


def draw_layout(corner_uv: np.ndarray, qc: np.ndarray, row: dict, path: Path) -> None:
    """Draw the UV layout, with every triangle in the color of its QC."""
    low, high = corner_uv.min(axis=(0, 1)), corner_uv.max(axis=(0, 1))
    proportion = float(np.clip((high - low)[0] / (high - low)[1], 0.6, 1.8))
    figure, axes = plt.subplots(figsize=(7.4 * proportion + 2, 8.2), dpi=150, layout="constrained")
    # Nearly all triangles lie close to 1; the few above the last percentile share the last color.
    limit = max(1.0 + 1e-6, row["p99_qc"])
    faces = PolyCollection(corner_uv, array=qc, cmap="viridis", clim=(1.0, limit), edgecolors="face", linewidths=0.15)
    axes.add_collection(faces)
    border = 0.02 * (high - low).max()
    axes.set(xlim=(low[0] - border, high[0] + border), ylim=(low[1] - border, high[1] + border), aspect="equal")
    axes.set(xlabel="u", ylabel="v")
    axes.set_title(
        f"{row['method']}: mean QC {row['mean_qc']:.4f}, max {row['max_qc']:.2f}, {row['flips']} flips, "
        f"{row['islands']} islands"
    )
    bar = figure.colorbar(faces, ax=axes, extend="max", shrink=0.9)
    bar.set_label("QC, quasi-conformal distortion: 1 keeps all angles (arrow: the last percent)")
    figure.savefig(path)


if __name__ == "__main__":
    main()
