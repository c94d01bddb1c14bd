#pragma once

#include <array>
#include <vector>

#include "linear_algebra/factorization.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// An embedding of a disk, holes allowed, into the unit circle: the outer loop lies on the circle, by its lengths in
/// 3D, and every other vertex at a weighted mean of its neighbours, with positive weights; holes are closed by a vertex
/// in their middle. It is one-to-one by theorem (Tutte, How to Draw a Graph, 1963; Floater, One-to-One Piecewise Linear
/// Mappings over Triangulations, 2003), so that no triangle is flipped, as far as double precision tells apart what
/// shrinks towards the middle. The weights begin equal and are then lowered along edges that became short for their
/// length in 3D, a few times, which the theorem allows and which spreads the vertices. Where that leaves flips, because
/// long limbs shrink beyond double precision, the weights begin anew, near zero between vertices equally many edges
/// away from the outer loop.
///
/// triangles: one triangulation of the patch, counter-clockwise; loops: as in Chart; positions (V, 3) finite.
/// Returns (V,). Throws SolveFailure when the equations cannot be solved in double precision, Cancelled, and what
/// Factorization throws.
ComplexVector convex_embedding(const std::vector<std::array<int, 3>>& triangles, const std::vector<BoundaryLoop>& loops,
                               int outer, const Eigen::Ref<const Positions>& positions, FactorizationBackend backend,
                               const Progress& progress = {});

}  // namespace spectral_conformal
