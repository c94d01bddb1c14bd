#pragma once

#include <vector>

#include "conformal/conformal_energy.h"
#include "spectral_conformal/linear_constraints.h"

namespace spectral_conformal {

/// The mirror image of each vertex about the upright axis by the equations u_i = -u_j and v_i = v_j: (n_vertices,), the
/// vertex itself on the axis, -1 for none. Empty if they mirror no pair.
std::vector<int> mirror_images(const LinearEquations& equations, int n_vertices);

/// The energy for maps that mirror triangles onto each other: both of a pair get the geometric mean of their metrics,
///   A # B = (A + B) / sqrt(det(A + B))   for 2 x 2 with determinant 1 (Bhatia, Positive Definite Matrices, 2007).
/// An exactly mirrored map stretches at least one of two triangles of different shape, K_1 K_2 >= K(A, B). With their
/// own metrics, E_D - A charges this stretch in proportion to the area of their image, so its minimum shrinks them to
/// nothing. With the mean metric the charge is gone, and a conformal map has K_1 = K_2 = sqrt(K(A, B)), the least
/// possible. If the images of a triangle's corners do not form a triangle of the mesh, the triangle between their
/// positions (V, 3) counts instead. Degenerate triangles keep their metric. image: from mirror_images.
ConformalEnergy mirrored_energy(const ConformalEnergy& energy, const Positions& positions,
                                const std::vector<int>& image);

}  // namespace spectral_conformal
