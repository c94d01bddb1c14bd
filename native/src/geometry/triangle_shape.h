#pragma once

#include <Eigen/Core>
#include <array>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A triangle in its local isometric frame: corners 0, x1 > 0 and x2 + i y2 with y2 > 0, counterclockwise.
struct TriangleShape {
  double x1 = 1;
  double x2 = 0;
  double y2 = 1;
  double area() const { return 0.5 * x1 * y2; }
  /// Height over the longest side, relative to that side.
  double relative_height() const;
  /// The same shape, its relative height clamped from below.
  TriangleShape clamped_to(double height) const;
  TriangleShape scaled(double factor) const { return {factor * x1, factor * x2, factor * y2, clamped}; }
  /// Whether the shape was clamped, see local_isometric_frame.
  bool clamped = false;

  /// 4 |T| times the derivative f_z of the linear map with f(0) = 0, f(x1) = d1, f(x2 + i y2) = d2: i (d1 (x2 - i y2) -
  /// d2 x1). Written out, because standard complex multiplication checks for infinities.
  Complex holomorphic_part(Complex d1, Complex d2) const {
    return {d1.real() * y2 - d1.imag() * x2 + d2.imag() * x1, d1.real() * x2 + d1.imag() * y2 - d2.real() * x1};
  }
  /// 4 |T| times the derivative f_zbar of the same map: -i (d1 (x2 + i y2) - d2 x1). Its conformal energy is
  /// E_C = 2 |T| |f_zbar|^2.
  Complex antiholomorphic_part(Complex d1, Complex d2) const {
    return {d1.real() * y2 + d1.imag() * x2 - d2.imag() * x1, d1.imag() * y2 - d1.real() * x2 + d2.real() * x1};
  }

  /// The adjoint of these two parts: adds the derivatives of a function of them by the images of the corners to a
  /// gradient, given its derivatives g by the holomorphic and h by the antiholomorphic part (f_u + i f_v for f by u + i
  /// v). With p = x2 + i y2: by d1, -i p g + i conj(p) h; by d2, i x1 (g - h); by the first corner, minus both.
  void add_gradient(const std::array<int, 3>& corners, Complex g, Complex h, Complex* gradient) const {
    const Complex by_d1(x2 * (g.imag() - h.imag()) + y2 * (g.real() + h.real()),
                        x2 * (h.real() - g.real()) + y2 * (g.imag() + h.imag()));
    const Complex by_d2(x1 * (h.imag() - g.imag()), x1 * (g.real() - h.real()));
    add_gradient_by_sides(corners, by_d1, by_d2, gradient);
  }
  /// The same with g = 0, for conformal energies.
  void add_gradient(const std::array<int, 3>& corners, Complex h, Complex* gradient) const {
    const Complex by_d1(y2 * h.real() - x2 * h.imag(), x2 * h.real() + y2 * h.imag());
    const Complex by_d2(x1 * h.imag(), -x1 * h.real());
    add_gradient_by_sides(corners, by_d1, by_d2, gradient);
  }

  /// Cotangents of the angles at the corners, times 2 |T|: the dot products of the two sides at each corner.
  std::array<double, 3> scaled_cotangents() const { return {x1 * x2, x1 * (x1 - x2), x2 * (x2 - x1) + y2 * y2}; }

  /// Quasi-conformal distortion of the same map: larger over smaller singular value, (|f_z| + |f_zbar|) over
  /// ||f_z| - |f_zbar||; infinite where the image has no area.
  double quasi_conformal_distortion(Complex d1, Complex d2) const;

  /// The relative height below which a triangle is degenerate: cotangents reach its inverse, and 1e10 leaves six of
  /// sixteen digits in a sum with terms of order 1.
  static constexpr double min_height = 1e-10;

 private:
  static void add_gradient_by_sides(const std::array<int, 3>& corners, Complex by_d1, Complex by_d2,
                                    Complex* gradient) {
    gradient[corners[1]] += by_d1;
    gradient[corners[2]] += by_d2;
    gradient[corners[0]] -= by_d1 + by_d2;
  }
};

/// The local isometric frame of a triangle in 3D. A triangle with a relative height below min_height gets that height,
/// so that its cotangents stay finite; one without extent becomes equilateral, with side 1. Both are marked as clamped.
TriangleShape local_isometric_frame(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Eigen::Vector3d& p2);

/// Area of a triangle in 3D.
double triangle_area(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Eigen::Vector3d& p2);

}  // namespace spectral_conformal
