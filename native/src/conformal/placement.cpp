#include "conformal/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/signed_area.h"

namespace spectral_conformal {
namespace {

double dot(Complex a, Complex b) { return std::real(std::conj(a) * b); }

// Hull and calipers are our own, not CGAL's convex_hull_2 and min_rectangle_2: those compare exactly, so that among the
// equal rectangles of a symmetric or regular outline rounding would choose, and with it how the map is turned.

/// Andrew's monotone chain: counter-clockwise, no three points in a line.
std::vector<Complex> convex_hull(std::vector<Complex> points) {
  const auto before = [](Complex a, Complex b) {
    return a.real() != b.real() ? a.real() < b.real() : a.imag() < b.imag();
  };
  std::sort(points.begin(), points.end(), before);
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

/// The unit direction of the longer side of the smallest rectangle around the hull, by rotating calipers: one of its
/// sides lies on an edge of the hull.
Complex smallest_rectangle(const std::vector<Complex>& hull) {
  const std::size_t n = hull.size();
  if (n < 2) return 1;
  if (n == 2) return (hull[1] - hull[0]) / std::abs(hull[1] - hull[0]);
  Complex best = 1;
  double best_area = std::numeric_limits<double>::infinity();
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
    const double width = along(right) - along(left);
    const double area = width * height(top);
    // The first of equal rectangles: areas that differ by less than 1e-9 differ by the rounding of z (about 1e-12).
    if (area < best_area * (1 - 1e-9)) {
      best_area = area;
      best = width >= height(top) ? direction : direction * Complex(0, 1);
    }
  }
  return best;
}

}  // namespace

double signed_area(const ConformalEnergy& energy, const ComplexVector& z) {
  double area = 0;
  const auto& triangles = energy.triangles();
  for (std::size_t t = 0; t + energy.n_virtual() < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    area += energy.triangle_weights()[t] * signed_area(z[a], z[b], z[c]);
  }
  return area;
}

bool place(ComplexVector& z, const ConformalEnergy& energy, const BoundaryLoop& outer_loop,
           const Eigen::Ref<const Positions>& positions, double area) {
  const double unscaled = signed_area(energy, z);
  if (!(unscaled > 0) || !std::isfinite(unscaled)) return false;
  z.array() -= z.mean();
  std::vector<Complex> boundary;
  boundary.reserve(outer_loop.size());
  for (const int vertex : outer_loop) boundary.push_back(z[vertex]);
  const Complex horizontal = smallest_rectangle(convex_hull(std::move(boundary)));
  z *= std::conj(horizontal) * std::sqrt(area / unscaled);
  const Eigen::RowVector3d centre = positions.colwise().mean();
  const Eigen::VectorXd height = positions.col(2).array() - centre[2];
  const Eigen::VectorXd width = positions.col(0).array() - centre[0];
  const double rise = z.imag().dot(height);
  // Of upright and upside down neither where they differ by less than single precision, in which meshes are stored.
  const double tie = 1e-6 * z.norm() * positions.rowwise().norm().norm();
  const double run = z.real().dot(width);
  if (std::abs(rise) > tie ? rise < 0 : run < -tie) z = -z;
  return true;
}

}  // namespace spectral_conformal
