#include "spectral_conformal/overlap.h"

#include <CGAL/Box_intersection_d/Box_with_handle_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>

namespace spectral_conformal {
namespace {

using Corners = std::array<Complex, 3>;

/// Whether a line along one of the sides of `a` separates the two (they may touch it).
bool separated_by_side(const Corners& a, const Corners& b, double tolerance) {
  for (int k = 0; k < 3; ++k) {
    const Complex side = a[(k + 1) % 3] - a[k];
    const double length = std::abs(side);
    if (!(length > 0)) continue;
    const auto distance = [&](Complex p) { return std::imag(std::conj(side) * (p - a[k])) / length; };
    // Positive on the side of a's own third corner.
    const double inwards = distance(a[(k + 2) % 3]) < 0 ? -1 : 1;
    const double deepest = std::max({inwards * distance(b[0]), inwards * distance(b[1]), inwards * distance(b[2])});
    if (deepest <= tolerance) return true;
  }
  return false;
}

}  // namespace

std::vector<bool> overlapping_triangles(const std::vector<std::array<int, 3>>& triangles, const ComplexVector& z) {
  using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 2, const std::array<int, 3>*>;
  std::vector<Box> boxes;
  boxes.reserve(triangles.size());
  for (const auto& triangle : triangles) {
    double low[2] = {z[triangle[0]].real(), z[triangle[0]].imag()};
    double high[2] = {low[0], low[1]};
    for (int k = 1; k < 3; ++k) {
      const double p[2] = {z[triangle[k]].real(), z[triangle[k]].imag()};
      for (int axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
      }
    }
    boxes.emplace_back(low, high, &triangle);
  }
  std::vector<bool> result(triangles.size(), false);
  const auto corners = [&](const std::array<int, 3>& t) { return Corners{z[t[0]], z[t[1]], z[t[2]]}; };
  const auto size = [](const Corners& c) {
    return std::max({std::abs(c[1] - c[0]), std::abs(c[2] - c[1]), std::abs(c[0] - c[2])});
  };
  CGAL::box_self_intersection_d(
      boxes.begin(), boxes.end(),
      [&](const Box& first, const Box& second) {
        const Corners a = corners(*first.handle());
        const Corners b = corners(*second.handle());
        const double tolerance = 1e-9 * std::min(size(a), size(b));
        if (separated_by_side(a, b, tolerance) || separated_by_side(b, a, tolerance)) return;
        result[static_cast<std::size_t>(first.handle() - triangles.data())] = true;
        result[static_cast<std::size_t>(second.handle() - triangles.data())] = true;
      },
      std::ptrdiff_t{10}, CGAL::Box_intersection_d::HALF_OPEN);
  return result;
}

}  // namespace spectral_conformal
