#pragma once

#include <array>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The turning number of a boundary loop of a map: the sum of its exterior angles over 2 pi. +1 for a locally
/// injective, orientation-preserving map of a disk, -1 for its mirror image. An exterior angle is pi - (sum of the
/// image angles of the triangles at the vertex), which stays correct for sums above 2 pi. If one of these triangles is
/// flipped, it is the angle between the two boundary edges, in (-pi, pi]. triangles: counterclockwise in 3D;
/// triangle_weights: per triangle. Edges of length 0 are skipped; a map without extent has 0.
int turning_number(const BoundaryLoop& loop, const std::vector<std::array<int, 3>>& triangles,
                   const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& map);

}  // namespace spectral_conformal
