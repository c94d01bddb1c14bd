#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Points (V,), each moved by at most its radius: to the first one that it is near, if there is one. What meets up to
/// rounding then meets exactly. Where two triangles that are moved so do not meet, some side of one of them had them
/// overlap by at most twice the largest radius: the least depth of two convex polygons is that across one of their
/// sides, and each corner changes it by at most what it is moved. radii (V,): the same at the same place. O(n log n)
/// where radii of neighbors are about the same.
ComplexVector merge_points(const ComplexVector& points, const std::vector<double>& radii);

}  // namespace spectral_conformal
