"""An independent reference: the paper's matrices from coordinates, by other formulas and other libraries."""

from __future__ import annotations

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg


def gradients(vertices, triangles):
    """Sparse (F, V) derivatives along two orthonormal axes of every triangle's plane, and the areas."""
    p0, p1, p2 = (vertices[triangles[:, k]] for k in range(3))
    normal = np.cross(p1 - p0, p2 - p0)
    double_area = np.linalg.norm(normal, axis=1)
    normal = normal / double_area[:, None]
    first = (p1 - p0) / np.linalg.norm(p1 - p0, axis=1)[:, None]
    second = np.cross(normal, first)
    derivatives = []
    for axis in (first, second):
        entries = []
        for k in range(3):
            opposite = vertices[triangles[:, (k + 2) % 3]] - vertices[triangles[:, (k + 1) % 3]]
            # Gradient of the hat function of corner k: the opposite edge turned by 90 degrees, over 2 |T|.
            entries.append((np.cross(normal, opposite) * axis).sum(1) / double_area)
        rows = np.repeat(np.arange(len(triangles)), 3)
        derivatives.append(
            sp.csr_matrix((np.stack(entries, 1).ravel(), (rows, triangles.ravel())), (len(triangles), len(vertices)))
        )
    return derivatives[0], derivatives[1], double_area / 2


def conformal_energy_matrix(vertices, triangles, weights="uniform"):
    """L with z^H L z / 2 = sum of w |T| |d_1 z + i d_2 z|^2 / 2: the Cauchy-Riemann (LSCM) form of E_C."""
    d1, d2, area = gradients(vertices, triangles)
    weight = area if weights == "uniform" else np.ones_like(area)
    cauchy_riemann = d1 + 1j * d2
    return (cauchy_riemann.conj().T @ sp.diags(weight) @ cauchy_riemann).tocsc()


def boundary_loops(triangles):
    edges = {(int(t[k]), int(t[(k + 1) % 3])) for t in triangles for k in range(3)}
    following = {a: b for a, b in edges if (b, a) not in edges}
    loops = []
    while following:
        start, vertex = following.popitem()
        loop = [start]
        while vertex != start:
            loop.append(vertex)
            vertex = following.pop(vertex)
        loops.append(np.array(loop))
    return loops


def outer_loop(vertices, triangles):
    return max(
        boundary_loops(triangles),
        key=lambda loop: np.linalg.norm(vertices[np.roll(loop, -1)] - vertices[loop], axis=1).sum(),
    )


def boundary_masses(vertices, triangles, boundary="length"):
    loop = outer_loop(vertices, triangles)
    mass = np.zeros(len(vertices))
    if boundary == "vertex":
        mass[loop] = 1
        return mass
    length = np.linalg.norm(vertices[np.roll(loop, -1)] - vertices[loop], axis=1)
    np.add.at(mass, loop, length / 2)
    np.add.at(mass, np.roll(loop, -1), length / 2)
    return mass


def smallest_eigenpair(matrix, mass):
    """The smallest nonzero eigenvalue of L z = lambda M z and its vector, by dense algebra on the vertices that carry
    mass: the others are eliminated (Schur complement), the constant is deflated by a large multiple of (M 1)(M 1)^T."""
    carriers = np.flatnonzero(mass)
    others = np.flatnonzero(mass == 0)
    boundary_block = matrix[carriers][:, carriers].toarray()
    lift = np.zeros((len(others), len(carriers)), complex)
    if len(others):
        lu = scipy.sparse.linalg.splu(matrix[others][:, others].tocsc())
        lift = -lu.solve(matrix[others][:, carriers].toarray())
        boundary_block = boundary_block + matrix[carriers][:, others] @ lift
    m = mass[carriers]
    scaled = boundary_block / np.sqrt(np.outer(m, m))
    constant = np.sqrt(m / m.sum())
    scaled = (scaled + scaled.conj().T) / 2 + np.abs(scaled).max() * np.outer(constant, constant)
    values, vectors = scipy.linalg.eigh(scaled, subset_by_index=[0, 0])
    z = np.zeros(len(mass), complex)
    z[carriers] = vectors[:, 0] / np.sqrt(m)
    z[others] = lift @ z[carriers]
    return rayleigh_quotient(matrix, mass, z), z


def rayleigh_quotient(matrix, mass, z):
    centered = z - (mass * z).sum() / mass.sum()
    return np.vdot(centered, matrix @ centered).real / (mass * np.abs(centered) ** 2).sum()


def quasi_conformal_distortion(vertices, triangles, uv):
    """(F,) ratio of the singular values by SVD of every triangle's Jacobian, and the areas in 3D."""
    d1, d2, area = gradients(vertices, triangles)
    jacobians = np.stack([d1 @ uv, d2 @ uv], axis=2)
    singular = np.linalg.svd(jacobians, compute_uv=False)
    return singular[:, 0] / singular[:, 1], area
