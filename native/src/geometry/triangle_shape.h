#pragma once

#include <Eigen/Core>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The shape of a triangle in its own plane: corners 0, x1 > 0 and x2 + i y2 with y2 > 0, counter-clockwise.
struct TriangleShape {
  double x1 = 1;
  double x2 = 0;
  double y2 = 1;
  double area() const { return 0.5 * x1 * y2; }
  /// Height over the longest side, relative to that side.
  double relative_height() const;
  /// The same shape, its height over the longest side raised to at least this part of that side.
  TriangleShape clamped_to(double least_height) const;
  /// Whether the shape was clamped, see local_isometric_frame.
  bool clamped = false;

  /// 4 |T| times the derivative f_z of the linear map with f(0) = 0, f(x1) = d1, f(x2 + i y2) = d2:
  /// i (d1 (x2 - i y2) - d2 x1). Written out, because complex multiplication by the standard looks for infinities.
  Complex holomorphic_part(Complex d1, Complex d2) const {
    return {d1.real() * y2 - d1.imag() * x2 + d2.imag() * x1, d1.real() * x2 + d1.imag() * y2 - d2.real() * x1};
  }
  /// 4 |T| times the derivative f_zbar of the same map: -i (d1 (x2 + i y2) - d2 x1). Its conformal energy is
  /// E_C = 2 |T| |f_zbar|^2.
  Complex antiholomorphic_part(Complex d1, Complex d2) const {
    return {d1.real() * y2 + d1.imag() * x2 - d2.imag() * x1, d1.imag() * y2 - d1.real() * x2 + d2.real() * x1};
  }

  /// Quasi-conformal distortion of the same map: larger over smaller singular value, (|f_z| + |f_zbar|) over
  /// ||f_z| - |f_zbar||; infinite where the image has no area.
  double quasi_conformal_distortion(Complex d1, Complex d2) const;

  /// The least height over the longest side, relative to that side.
  static constexpr double min_height = 1e-10;
};

/// Lays a triangle out in its plane. One whose height over its longest side is below min_height of that side gets
/// that height, so that its cotangents stay finite; one without extent becomes equilateral. Either is marked clamped.
TriangleShape local_isometric_frame(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Eigen::Vector3d& p2);

/// Area of a triangle in 3D.
double triangle_area(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Eigen::Vector3d& p2);

}  // namespace spectral_conformal
