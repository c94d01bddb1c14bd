#pragma once

#include <array>
#include <functional>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Finds triangles of the plane with intersecting interiors, by a line sweep. Any number of triangles may share corners
/// and sides, which may also overlap or coincide. For two triangles that meet, leave_out(first, second) returns the one
/// to remove from the sweep, or a negative number to end it; no two of the remaining triangles meet. triangles:
/// counterclockwise. Exact. O((n + m) log n) for m calls, at most n. Disjoint triangles have one order along the line,
/// and the first two that meet become neighbors in it (Shamos and Hoey 1976, "Geometric intersection problems", FOCS).
void sweep_triangles(const std::vector<std::array<Complex, 3>>& triangles,
                     const std::function<int(int first, int second)>& leave_out);

}  // namespace spectral_conformal
