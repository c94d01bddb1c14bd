#pragma once

#include <array>
#include <functional>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Finds triangles of the plane whose interiors meet, by moving a line over them. Corners and sides may be common to
/// any number of triangles, lie on each other or coincide. For two triangles that meet, leave_out(first, second) names
/// the one that the line shall not meet any more, or a negative number to end the sweep; no two of the triangles that
/// stay meet. triangles: counter-clockwise. Exact. O((n + m) log n) for m calls, at most n; the line has triangles that
/// do not meet in one order, and of those that do, the first two become neighbors in it (Shamos and Hoey 1976,
/// "Geometric intersection problems", FOCS).
void sweep_triangles(const std::vector<std::array<Complex, 3>>& triangles,
                     const std::function<int(int first, int second)>& leave_out);

}  // namespace spectral_conformal
