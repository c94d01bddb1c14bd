"""How much degenerate triangles move the rest of a patch, for several treatments.

    build/venv/bin/python -m tests.benchmarks.degenerate_triangles

Maps the clean mesh with and without added degenerate triangles, and aligns the two by a similarity. Each figure is the
largest displacement of a vertex of the clean mesh, as a fraction of the map's extent.

"module" is what the module does. It raises the height of a triangle to 1e-10 of the longest side, and corrects the map
by the residual, summed triangle by triangle. The other columns show the treatments alone, without this correction, by
dense Cholesky factorization in extended precision, where the platform has it:

- heights raised to other fractions of the longest side;
- intrinsic mollification (Sharp and Crane 2020), which lengthens all edges equally until each triangle inequality holds
  by a fraction of the mean length;
- mollification followed by intrinsic Delaunay triangulation, compared with the same for the clean mesh.
"""

from __future__ import annotations

import igl
import numpy as np
import spectral_conformal as sc

from tests.module import degenerate, meshes, reference

REAL, COMPLEX = np.longdouble, np.clongdouble
CLAMPS = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
MOLLIFICATIONS = (1e-5, 1e-8)


def edge_lengths(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return (F, 3) lengths, each opposite to its corner."""
    corners = vertices.astype(REAL)[triangles]
    return np.stack([np.sqrt(((corners[:, (k + 2) % 3] - corners[:, (k + 1) % 3]) ** 2).sum(1)) for k in range(3)], 1)


def cotangents(lengths: np.ndarray) -> np.ndarray:
    """Return (F, 3) cotangents of the angles opposite to the edges; Kahan's area."""
    a, b, c = np.sort(lengths, axis=1)[:, ::-1].T
    area = np.sqrt(np.maximum((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)), 0)) / 4
    squares = lengths**2
    return (squares.sum(1, keepdims=True) - 2 * squares) / (4 * area[:, None])


def clamped_cotangents(vertices: np.ndarray, triangles: np.ndarray, least: float) -> np.ndarray:
    """Return the cotangents of the triangles, heights over their longest sides at least `least` of these."""
    lengths = edge_lengths(vertices, triangles)
    corners = vertices.astype(REAL)[triangles]
    result = np.empty_like(lengths)
    for face, sides in enumerate(lengths):
        apex = int(np.argmax(sides))
        first, second = (apex + 1) % 3, (apex + 2) % 3
        side = sides[apex]
        if side == 0:
            result[face] = 1 / np.sqrt(REAL(3))
            continue
        along = (corners[face, second] - corners[face, first]) / side
        foot = (corners[face, apex] - corners[face, first]).dot(along)
        height = np.sqrt(((corners[face, apex] - corners[face, first] - foot * along) ** 2).sum())
        height = max(height, least * side)
        result[face, first], result[face, second] = foot / height, (side - foot) / height
        result[face, apex] = (height**2 - foot * (side - foot)) / (height * side)
    return result


def mollified(lengths: np.ndarray, part: float) -> np.ndarray:
    """Return the lengths, raised equally until every triangle inequality has a slack of `part` of the mean."""
    slack = part * lengths.mean()
    return lengths + max(0, (slack - (lengths.sum(1, keepdims=True) - 2 * lengths)).max())


def energy_matrix(n: int, triangles: np.ndarray, cotangent: np.ndarray) -> np.ndarray:
    """Return the dense Hermitian matrix of the conformal energy, Eq. 3 and the area form."""
    matrix = np.zeros((n, n), COMPLEX)
    for k in range(3):
        i, j, half = triangles[:, (k + 1) % 3], triangles[:, (k + 2) % 3], cotangent[:, k] / 2
        np.add.at(matrix, (i, i), half)
        np.add.at(matrix, (j, j), half)
        np.add.at(matrix, (i, j), -half + 0.5j)
        np.add.at(matrix, (j, i), -half - 0.5j)
    return matrix


def spectral_map(matrix: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """Return the map, (V,) complex, by inverse iteration on a dense Cholesky factor."""
    n = len(mass)
    factor = matrix + np.diag(1e-9 * mass).astype(COMPLEX)
    for k in range(n):
        factor[k, k] = np.sqrt(factor[k, k].real)
        factor[k + 1 :, k] /= factor[k, k]
        factor[k + 1 :, k + 1 :] -= np.outer(factor[k + 1 :, k], factor[k + 1 :, k].conj())
    rng = np.random.default_rng(0)
    z = np.where(mass > 0, rng.normal(size=n) + 1j * rng.normal(size=n), 0).astype(COMPLEX)
    for _ in range(14):
        z -= (mass * z).sum() / mass.sum()
        z *= mass
        for k in range(n):
            z[k] /= factor[k, k]
            z[k + 1 :] -= factor[k + 1 :, k] * z[k]
        for k in reversed(range(n)):
            z[k] = (z[k] - (factor[k + 1 :, k].conj() * z[k + 1 :]).sum()) / factor[k, k]
        z /= np.sqrt((mass * np.abs(z) ** 2).sum())
    return z


def treatments(vertices: np.ndarray, triangles: np.ndarray, mass: np.ndarray) -> dict[str, np.ndarray]:
    """Return the map (V, 2) of every treatment."""
    n = len(vertices)
    lengths = edge_lengths(vertices, triangles)
    unwrapped = sc.unwrap(vertices, np.arange(0, triangles.size + 1, 3), triangles.ravel())
    module = np.zeros((n, 2))
    module[triangles.ravel()] = unwrapped.uv
    maps = {"module": module}
    with np.errstate(all="ignore"):
        for least in CLAMPS:
            matrix = energy_matrix(n, triangles, clamped_cotangents(vertices, triangles, REAL(least)))
            maps[f"height {least:g}"] = as_uv(spectral_map(matrix, mass))
        for part in MOLLIFICATIONS:
            raised = mollified(lengths, REAL(part))
            matrix = energy_matrix(n, triangles, cotangents(raised))
            maps[f"mollified {part:g}"] = as_uv(spectral_map(matrix, mass))
            delaunay_lengths, delaunay = igl.intrinsic_delaunay_triangulation(raised.astype(float), triangles)[:2]
            matrix = energy_matrix(n, delaunay, cotangents(delaunay_lengths.astype(REAL)))
            maps[f"Delaunay {part:g}"] = as_uv(spectral_map(matrix, mass))
    return maps


def as_uv(z: np.ndarray) -> np.ndarray:
    """Return a complex map as (V, 2) float64."""
    return np.stack([z.real, z.imag], 1).astype(np.float64)


def main() -> None:
    """Print the table."""
    clean = meshes.bumpy_disk(170)
    mass = reference.boundary_masses(*clean)
    middles = degenerate.with_middles(*clean)
    expected = {False: treatments(*clean, mass)}
    expected[True] = treatments(*middles, np.r_[mass, np.zeros(len(middles[0]) - len(mass))])
    print(f"{'':16}" + "".join(f"{name:>16}" for name in expected[False]))
    kinds = {"caps": degenerate.caps, "needles": degenerate.needles, "points": degenerate.points}
    for kind, make in kinds.items():
        for height in (0.0, 1e-14, 1e-9, 1e-6):
            vertices, triangles = make(*clean, height)
            padded = np.r_[mass, np.zeros(len(vertices) - len(mass))]
            maps = treatments(vertices, triangles, padded)
            row = [
                meshes.similarity_deviation(maps[name][: len(mass)], of_clean[: len(mass)])
                for name, of_clean in expected[kind == "points"].items()
            ]
            print(f"{kind + ' ' + format(height, 'g'):16}" + "".join(f"{value:16.1e}" for value in row), flush=True)


if __name__ == "__main__":
    main()
