#pragma once

#include <vector>

#include "conformal/conformal_energy.h"
#include "spectral_conformal/linear_constraints.h"

namespace spectral_conformal {

/// The vertex that equations make the mirror image of each vertex about the upright axis, u_i = -u_j and v_i = v_j:
/// (n_vertices,), itself on the axis, -1 for none. Empty if they mirror nothing.
std::vector<int> mirror_images(const LinearEquations& equations, int n_vertices);

/// The energy of maps that mirror triangles onto each other: both of a pair get the geometric mean of their metrics,
///   A # B = (A + B) / sqrt(det(A + B))   for 2 x 2 with determinant 1 (Bhatia, Positive Definite Matrices, 2007).
/// An exactly mirrored map stretches at least one of two triangles of different shape, K_1 K_2 >= K(A, B). E_D - A with
/// their own metrics has that cost in proportion to the area of their image, so its minimum shrinks them to nothing.
/// With their mean the cost is gone, and a conformal map has K_1 = K_2 = sqrt(K(A, B)), the least possible. Where
/// the image of a triangle is none, as in another triangulation, that between the positions (V, 3) of the images of its
/// corners counts. Degenerate triangles keep their metric. image: of mirror_images.
ConformalEnergy mirrored_energy(const ConformalEnergy& energy, const Positions& positions,
                                const std::vector<int>& image);

}  // namespace spectral_conformal
