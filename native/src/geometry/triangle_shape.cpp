#include "geometry/triangle_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace spectral_conformal {

double triangle_area(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Eigen::Vector3d& p2) {
  return 0.5 * (p1 - p0).cross(p2 - p0).norm();
}

double TriangleShape::relative_height() const {
  const double second = x2 * x2 + y2 * y2;
  const double third = (x2 - x1) * (x2 - x1) + y2 * y2;
  return x1 * y2 / std::max({x1 * x1, second, third});
}

double TriangleShape::quasi_conformal_distortion(Complex d1, Complex d2) const {
  const double conformal = modulus(holomorphic_part(d1, d2));
  const double anticonformal = modulus(antiholomorphic_part(d1, d2));
  const double smaller = std::abs(conformal - anticonformal);
  return smaller > 0 ? (conformal + anticonformal) / smaller : infinity;
}

namespace {

/// The triangle whose side opposite to `apex` has the given length, with the apex at `foot` along that side, measured
/// from the next corner, and at `height` above it.
TriangleShape over_side(int apex, double length, double foot, double height) {
  std::array<Complex, 3> z;
  z[apex] = Complex(foot, height);
  z[(apex + 1) % 3] = 0.0;
  z[(apex + 2) % 3] = length;
  const Complex side = z[1] - z[0];
  const Complex third = (z[2] - z[0]) * std::conj(side);
  TriangleShape shape;
  shape.x1 = std::abs(side);
  shape.x2 = third.real() / shape.x1;
  shape.y2 = height * length / shape.x1;
  return shape;
}

/// Moves the corner opposite to the longest side away from that side.
TriangleShape clamped_frame(const std::array<Eigen::Vector3d, 3>& p) {
  const double lengths[3] = {(p[2] - p[1]).norm(), (p[0] - p[2]).norm(), (p[1] - p[0]).norm()};
  const int apex = static_cast<int>(std::max_element(lengths, lengths + 3) - lengths);
  const double length = lengths[apex];
  TriangleShape shape;
  if (length > 0) {
    const Eigen::Vector3d& base = p[(apex + 1) % 3];
    const double foot = (p[apex] - base).dot(p[(apex + 2) % 3] - base) / length;
    shape = over_side(apex, length, foot, TriangleShape::min_height * length);
  } else {
    shape.x2 = 0.5;
    shape.y2 = std::sqrt(0.75);
  }
  shape.clamped = true;
  return shape;
}

}  // namespace

TriangleShape TriangleShape::clamped_to(double height) const {
  if (!(relative_height() < height)) return *this;
  const std::array<Complex, 3> z = {0.0, x1, Complex(x2, y2)};
  const double lengths[3] = {std::abs(z[2] - z[1]), std::abs(z[2]), x1};
  const int apex = static_cast<int>(std::max_element(lengths, lengths + 3) - lengths);
  const double length = lengths[apex];
  const Complex base = z[(apex + 1) % 3];
  const double foot = std::real(std::conj(z[(apex + 2) % 3] - base) * (z[apex] - base)) / length;
  TriangleShape shape = over_side(apex, length, foot, height * length);
  shape.clamped = clamped;
  return shape;
}

TriangleShape local_isometric_frame(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Eigen::Vector3d& p2) {
  const Eigen::Vector3d e1 = p1 - p0;
  const Eigen::Vector3d e2 = p2 - p0;
  const double double_area = e1.cross(e2).norm();
  const double longest_squared = std::max({e1.squaredNorm(), e2.squaredNorm(), (p2 - p1).squaredNorm()});
  if (!(double_area > TriangleShape::min_height * longest_squared)) return clamped_frame({p0, p1, p2});
  TriangleShape shape;
  shape.x1 = e1.norm();
  shape.x2 = e1.dot(e2) / shape.x1;
  shape.y2 = double_area / shape.x1;
  return shape;
}

}  // namespace spectral_conformal
