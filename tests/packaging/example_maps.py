# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs with the Python of any system: solve the meshes of a file, write the results to another.

Meshes come as a file: those that a system makes by itself differ in their last digits.
"""

import sys
import threading

import numpy as np
import spectral_conformal as sc


def solve(meshes) -> dict:
    """Return maps, eigenvalues and measures by name; `meshes` has arrays named <mesh>_vertices and <mesh>_triangles."""
    results = {}
    for name in sorted(key.removesuffix("_vertices") for key in meshes.files if key.endswith("_vertices")):
        vertices, triangles = meshes[f"{name}_vertices"], meshes[f"{name}_triangles"]
        solution = sc.parameterize(vertices, triangles)
        results[f"{name} uv"] = solution.uv
        results[f"{name} eigenvalue"] = solution.eigenvalue
        measured = sc.distortion(vertices, triangles, solution.uv)
        results[f"{name} quality"] = np.array([measured.mean_qc, np.count_nonzero(measured.flipped)])
        if len(vertices) > 10000:
            continue
        results[f"{name} fold free"] = sc.parameterize(vertices, triangles, fold_free=True).uv
        results[f"{name} blend"] = sc.parameterize(vertices, triangles, area_blend=0.5).uv
        results[f"{name} extender"] = sc.Solver(vertices, triangles).solve(extenders=[(3, 30, 2.0)]).uv
        offsets = np.arange(0, 3 * len(triangles) + 1, 3)
        results[f"{name} seams"] = sc.suggest_seams(vertices, offsets, triangles.ravel()).seam_edges
    return results


def check_threads(meshes) -> None:
    """Solve the largest mesh in four threads at once: all get the same map, bit by bit."""
    name = max((key for key in meshes.files if key.endswith("_vertices")), key=lambda key: len(meshes[key]))
    mesh = meshes[name], meshes[name.replace("_vertices", "_triangles")]
    maps = []
    threads = [threading.Thread(target=lambda: maps.append(sc.parameterize(*mesh).uv.tobytes())) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(maps) == 4 and len(set(maps)) == 1, "threads that solve the same mesh at once get different maps"


source, target = sys.argv[1:]
with np.load(source) as given:
    np.savez(target, **solve(given))
    check_threads(given)
print(sc.build_info())
