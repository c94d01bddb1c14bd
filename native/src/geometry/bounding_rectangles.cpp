#include "geometry/bounding_rectangles.h"

#include <algorithm>
#include <cmath>

#include "geometry/orientation.h"
#include "geometry/plane_box.h"
#include "geometry/signed_area.h"

namespace spectral_conformal {
// Not CGAL's convex_hull_2 and min_rectangle_2: they compare exactly and return one rectangle, so rounding would choose
// among the equal ones of a symmetric or regular outline.

/// Andrew's monotone chain.
std::vector<Complex> convex_hull(std::vector<Complex> points) {
  std::sort(points.begin(), points.end(), is_left_of);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Complex> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t base = hull.size();
    for (const Complex p : points) {
      while (hull.size() >= base + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

Rectangle bounding_rectangle(const std::vector<Complex>& hull, Complex direction) {
  PlaneBox box;
  for (const Complex p : hull) box.include(p * std::conj(direction));
  return {direction, box.size().real(), box.size().imag()};
}

/// Rotating calipers.
std::vector<Rectangle> smallest_rectangles(const std::vector<Complex>& hull, double tolerance) {
  const std::size_t n = hull.size();
  if (n < 2) return {{}};
  if (n == 2) return {{(hull[1] - hull[0]) / std::abs(hull[1] - hull[0]), std::abs(hull[1] - hull[0]), 0}};
  std::vector<Rectangle> found;
  double smallest = infinity;
  std::size_t right = 1;
  std::size_t top = 1;
  std::size_t left = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const Complex origin = hull[i];
    const Complex edge = hull[(i + 1) % n] - origin;
    const Complex direction = edge / std::abs(edge);
    const auto along = [&](std::size_t k) { return dot(direction, hull[k % n] - origin); };
    const auto height = [&](std::size_t k) { return cross(direction, hull[k % n] - origin); };
    right = std::max(right, i + 1);
    while (right < i + n && along(right + 1) > along(right)) ++right;
    top = std::max(top, right);
    while (top < i + n && height(top + 1) > height(top)) ++top;
    left = std::max(left, top);
    while (left < i + n && along(left + 1) < along(left)) ++left;
    // For nearly collinear points, rounding can make small numbers negative.
    const Rectangle rectangle{direction, std::max(0.0, along(right) - along(left)), std::max(0.0, height(top))};
    found.push_back(rectangle);
    smallest = std::min(smallest, rectangle.width * rectangle.height);
  }
  const auto too_large = [&](const Rectangle& r) { return r.width * r.height > smallest * (1 + tolerance); };
  found.erase(std::remove_if(found.begin(), found.end(), too_large), found.end());
  return found;
}

}  // namespace spectral_conformal
