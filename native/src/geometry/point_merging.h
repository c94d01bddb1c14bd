#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Moves each of the points (V,) by at most its radius, to the first point within it, if any. Contacts up to rounding
/// then become exact. If two triangles moved in this way do not meet, they overlapped before by at most twice the
/// largest radius across some side: the least depth of two convex polygons is attained across one of their sides, and
/// each corner changes it by at most its motion. radii: (V,), equal for coincident points. O(n log n) if neighbors have
/// similar radii.
ComplexVector merge_points(const ComplexVector& points, const std::vector<double>& radii);

}  // namespace spectral_conformal
