# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether looser limits ever give longer seams.

    build/venv/bin/python -m tests.benchmarks.seam_limits [mesh ...] [--shortest]

Suggests seams for one limit after the other, from strict to loose, with the others as they are by default. Prints the
lengths, over the root of the area, and the pairs of neighboring limits of which the looser has the longer seams. Some
of the meshes are in ../shared/meshes.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np
import spectral_conformal as sc

from tests.module import hard_surfaces, meshes
from tests.module.test_suggest_seams import box, closed_creature, knot, length, polygon_areas, tube

Arrays = tuple[np.ndarray, np.ndarray, np.ndarray]
LIMITS = {
    "energy_limit": (4.01, 4.02, 4.05, 4.1, 4.3, 5.0, 10.0),
    "qc_limit": (1.0, 1.02, 1.05, 1.1, 1.2, 1.5, 3.0),
    "scale_limit": (1.05, 1.15, 1.25, 1.5, 2.0, 4.0),
}
SHARED = Path(__file__).resolve().parents[3] / "shared" / "meshes"
OPTCUTS = ("cathead", "cat", "hand1", "girl1", "bone_lowres_noInputUV")
REAL = ("fish_quads_closed", "spot_quads_closed", "fox_gc", "hand_lowres", "face_lscm_ssloy")
LONGER = 1 + 1e-9


def torus(n: int, m: int, radius: float) -> Arrays:
    """A torus of n x m quads around a circle of radius 1."""
    u, v = np.meshgrid(2 * np.pi * np.arange(n) / n, 2 * np.pi * np.arange(m) / m, indexing="ij")
    ring = 1 + radius * np.cos(v)
    vertices = np.stack([ring * np.cos(u), ring * np.sin(u), radius * np.sin(v)], axis=-1).reshape(-1, 3)
    number = np.arange(n * m).reshape(n, m)
    along, around = np.roll(number, -1, 0), np.roll(number, -1, 1)
    quads = np.stack([number, along, np.roll(along, -1, 1), around], axis=-1).reshape(-1, 4)
    return vertices, *meshes.polygons(quads)


def shapes() -> dict[str, Arrays]:
    """Return meshes of some tests, and those of ../shared that are there."""
    ball, *ball_faces = box((1, 1, 1), 8)
    bulge, quads = meshes.bulge(16, 2.0)
    found = {
        "creature": closed_creature(6),
        "ball": (ball / np.linalg.norm(ball, axis=1, keepdims=True), *ball_faces),
        "bulge": (bulge, *meshes.polygons(quads)),
        "plank": box((3, 1, 0.4), 4),
        "torus": torus(32, 16, 0.4),
        "knot": tube(knot(80, 2, 3), 0.25, 10),
        "limbs": meshes.limbs(1200, 8, 3),
    }
    for name in ("pipe", "block", "rounded block"):
        vertices, faces = hard_surfaces.HARD_SURFACES[name].make()
        found[name] = (vertices, *meshes.polygons(faces))
    for name in OPTCUTS:
        path = SHARED / "optcuts" / f"{name}.npz"
        if path.exists():
            with np.load(path) as arrays:
                found[name] = tuple(arrays[key] for key in ("vertices", "face_offsets", "corner_vertices"))
    for name in REAL:
        path = SHARED / "real" / f"{name}.obj"
        if path.exists():
            vertices, faces = meshes.read_obj(path)
            found[name] = (vertices, *meshes.polygons(faces))
    return found


def main() -> int:
    """Print the lengths, and return 1 if any is longer than at a stricter limit."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="*", metavar="mesh", help="names; all by default")
    parser.add_argument("--shortest", action="store_true", help="the shortest seams within the limits")
    options = parser.parse_args()
    n_pairs, longer, total, start = 0, [], 0.0, time.process_time()
    found = shapes()
    for name in options.meshes or found:
        vertices, *faces = found[name]
        root = np.sqrt(polygon_areas(vertices[faces[1]], faces[0]).sum())
        for limit, values in LIMITS.items():
            lengths = [
                length(vertices, sc.suggest_seams(vertices, *faces, shortest=options.shortest, **{limit: v}).seam_edges)
                / root
                for v in values
            ]
            total += sum(lengths)
            n_pairs += len(lengths) - 1
            worse = [k for k in range(1, len(lengths)) if lengths[k] > lengths[k - 1] * LONGER]
            longer += [(name, limit, values[k], lengths[k] / lengths[k - 1]) for k in worse]
            row = ", ".join(f"{v:g}: {one:.3f}{' !' * (k in worse)}" for k, (v, one) in enumerate(zip(values, lengths)))
            print(f"{name:24}{limit:14}{row}", flush=True)
    print(f"\nOf {n_pairs} pairs, {len(longer)} with longer seams at the looser limit.", end=" ")
    print(f"Length of all {total:.2f}; {time.process_time() - start:.1f} s of processor.")
    for name, limit, value, ratio in longer:
        print(f"  {name}, {limit} {value:g}: {ratio:.3f} times as long")
    return 1 if longer else 0


if __name__ == "__main__":
    sys.exit(main())
