#include "seams/triangle_forest.h"

#include <algorithm>
#include <array>
#include <utility>

namespace spectral_conformal {
namespace {

PlaneBox box_of(const PlaneTriangle& t) { return PlaneBox::of({t.corners[0], t.corners[1], t.corners[2]}); }

double least_height(const PlaneTriangle& t) {
  return std::max(*std::min_element(t.height.begin(), t.height.end()), 0.0);
}

/// The least and the greatest x of the part of a moved triangle within `depth` of the line y = 0; infinity and
/// -infinity if it has no such part.
std::array<double, 2> extent_along(const PlaneTriangle& t, const PlaneMotion& motion, double depth) {
  std::array<double, 2> extent{infinity, -infinity};
  for (int k = 0; k < 3; ++k) {
    const Complex from = motion(t.corners[k]);
    const Complex step = motion(t.corners[(k + 1) % 3]) - from;
    const double in = (-depth - from.imag()) / step.imag();
    const double out = (depth - from.imag()) / step.imag();
    // For a side along a limit, one of them is NaN, which max and min ignore.
    const double first = std::max(0.0, std::min(in, out));
    const double last = std::min(1.0, std::max(in, out));
    if (first > last) continue;
    for (const double at : {first, last}) {
      extent[0] = std::min(extent[0], from.real() + at * step.real());
      extent[1] = std::max(extent[1], from.real() + at * step.real());
    }
  }
  return extent;
}

}  // namespace

void TriangleForest::add(std::vector<PlaneTriangle>&& triangles) {
  while (!trees_.empty() && trees_.back().triangles.size() <= 2 * triangles.size()) {
    std::vector<PlaneTriangle>& smaller = trees_.back().triangles;
    triangles.insert(triangles.end(), smaller.begin(), smaller.end());
    trees_.pop_back();
  }
  std::vector<PlaneBox> boxes;
  boxes.reserve(triangles.size());
  for (const PlaneTriangle& t : triangles) boxes.push_back(box_of(t));
  trees_.push_back({std::move(triangles), BoxTree::over(boxes)});
}

bool TriangleForest::overlaps(const PlaneTriangle& triangle, double tolerance) const {
  bool found = false;
  for (const Tree& tree : trees_) {
    tree.boxes.for_each_meeting(box_of(triangle), [&](int i) {
      const PlaneTriangle& other = tree.triangles[i];
      const double overlap = tolerance * std::min(least_height(other), least_height(triangle));
      found = overlap_by_more(other, triangle, overlap);
      return !found;
    });
    if (found) return true;
  }
  return false;
}

bool TriangleForest::is_wider_along(Complex from, Complex to, double depth, double widest) const {
  const double length = std::abs(to - from);
  const Complex direction = (to - from) / length;
  const Complex middle = 0.5 * (from + to);
  const PlaneMotion onto_axis{std::conj(direction), false, -std::conj(direction) * middle};
  const Complex across = direction * Complex(0, depth);
  const Complex along = direction * widest;
  const PlaneBox box = PlaneBox::of(
      {middle + along + across, middle + along - across, middle - along + across, middle - along - across});
  double low = -0.5 * length;
  double high = 0.5 * length;
  for (const Tree& tree : trees_) {
    tree.boxes.for_each_meeting(box, [&](int i) {
      const auto [first, last] = extent_along(tree.triangles[i], onto_axis, depth);
      if (first <= widest && last >= -widest) {
        low = std::min(low, std::max(first, -widest));
        high = std::max(high, std::min(last, widest));
      }
      return high - low <= widest;
    });
  }
  return high - low > widest;
}

std::vector<PlaneTriangle> TriangleForest::moved(const PlaneMotion& motion) const {
  std::vector<PlaneTriangle> result;
  for (const Tree& tree : trees_) {
    for (const PlaneTriangle& t : tree.triangles) {
      const auto& [a, b, c] = t.corners;
      result.emplace_back(std::array<Complex, 3>{motion(a), motion(b), motion(c)});
    }
  }
  return result;
}

}  // namespace spectral_conformal
