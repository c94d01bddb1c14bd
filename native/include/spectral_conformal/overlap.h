#pragma once

#include <array>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// For each triangle of a map, whether its interior meets that of another triangle. Candidates come from CGAL's box
/// intersection, O(n log^2 n + pairs); a pair overlaps when no side of either separates them. Contacts less deep than
/// 1e-9 of the smaller triangle's size do not count. z (V,) must be finite.
std::vector<bool> overlapping_triangles(const std::vector<std::array<int, 3>>& triangles, const ComplexVector& z);

}  // namespace spectral_conformal
