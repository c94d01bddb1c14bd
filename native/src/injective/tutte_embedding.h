#pragma once

#include <array>
#include <vector>

#include "linear_algebra/factorization.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A Tutte embedding of a disk, holes allowed, into the unit circle: the outer loop lies on the circle, by its lengths
/// in 3D, or in equal arcs where it has none, and every other vertex at a weighted mean of its neighbors, with
/// positive weights; each hole is closed by a vertex in its middle. By Tutte's theorem (How to Draw a Graph, 1963), for
/// weighted means by Floater (Parametrization and Smooth Approximation of Surface Triangulations, 1997; One-to-One
/// Piecewise Linear Mappings over Triangulations, 2003), it is one-to-one: no triangle is flipped, as far as double
/// precision resolves what shrinks towards the middle. The weights begin equal and are then lowered along edges that
/// became short for their length in 3D, a few times, which the theorem allows and which spreads the vertices. Where
/// that leaves flips, because long limbs shrink below double precision, the weights begin anew, near zero between
/// vertices equally many edges away from the circle.
///
/// triangles (F, 3): one triangulation of the chart, counter-clockwise; loops: as in Chart, `outer` the index of the
/// outer one; positions (V, 3) finite. Returns (V,), or nothing where the Tutte system cannot be solved
/// in double precision even once. Throws Cancelled, and what Factorization throws.
ComplexVector tutte_embedding(const std::vector<std::array<int, 3>>& triangles, const std::vector<BoundaryLoop>& loops,
                              int outer, const Eigen::Ref<const Positions>& positions, FactorizationBackend backend,
                              const Progress& progress = {});

}  // namespace spectral_conformal
