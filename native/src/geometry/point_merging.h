#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Moves each of the points (V,) by at most its radius, just below half of its tolerance, to the first point within it,
/// if any. Contacts up to rounding then become exact. If two triangles moved in this way do not meet, they overlapped
/// before by less than the largest tolerance across some side, and no triangle higher than that turns over: the least
/// depth of two convex polygons is attained across one of their sides, and each corner changes it by at most its
/// motion. tolerances: (V,), equal for coincident points. O(n log n) if neighbors have similar tolerances.
ComplexVector merge_points(const ComplexVector& points, const std::vector<double>& tolerances);

}  // namespace spectral_conformal
