#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/signed_area.h"
#include "geometry/tolerances.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A triangle in the plane, with the data that pair tests need.
struct PlaneTriangle {
  std::array<Complex, 3> corners;
  std::array<Complex, 3> inwards;  ///< unit normal of each side; 0 for a side of length 0
  std::array<double, 3> height;    ///< over each side, negative for a clockwise triangle
  double size;                     ///< longest side
  double reach;                    ///< largest coordinate

  explicit PlaneTriangle(const std::array<Complex, 3>& c) : corners(c), size(0), reach(0) {
    for (int k = 0; k < 3; ++k) {
      const Complex side = c[(k + 1) % 3] - c[k];
      const double length = std::abs(side);
      inwards[k] = length > 0 ? Complex(0, 1) * (side / length) : Complex(0);
      height[k] = over_side(k, c[(k + 2) % 3]);
      size = std::max(size, length);
      reach = std::max({reach, std::abs(c[k].real()), std::abs(c[k].imag())});
    }
  }
  double over_side(int k, Complex p) const { return dot(inwards[k], p - corners[k]); }
};

/// Whether the two overlap by at most `tolerance` across one of the sides of `a`. A collapsed triangle overlaps none.
inline bool separated_by_side(const PlaneTriangle& a, const PlaneTriangle& b, double tolerance) {
  for (int k = 0; k < 3; ++k) {
    if (a.inwards[k] == 0.0) continue;
    const double first = a.over_side(k, b.corners[0]);
    const double second = a.over_side(k, b.corners[1]);
    const double third = a.over_side(k, b.corners[2]);
    const double top = std::min(std::max({first, second, third}), std::max(a.height[k], 0.0));
    const double bottom = std::max(std::min({first, second, third}), std::min(a.height[k], 0.0));
    if (top - bottom <= tolerance) return true;
  }
  return false;
}

/// Whether the two overlap by more than `tolerance` across each of their sides.
inline bool overlap_by_more(const PlaneTriangle& a, const PlaneTriangle& b, double tolerance) {
  return !separated_by_side(a, b, tolerance) && !separated_by_side(b, a, tolerance);
}

/// Whether two triangles of a map, stored with this relative resolution, overlap. Neighbors share an edge up to
/// rounding of their heights, about 1e-16 of the coordinates; the tolerance allows for triangles a millionth of the
/// map's extent.
inline bool overlap_in_map(const PlaneTriangle& a, const PlaneTriangle& b, double resolution) {
  return overlap_by_more(a, b,
                         std::max(insignificant * std::min(a.size, b.size), resolution * std::max(a.reach, b.reach)));
}

}  // namespace spectral_conformal
