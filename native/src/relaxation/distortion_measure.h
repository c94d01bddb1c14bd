#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/tolerances.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// f_z and f_zbar of a triangle's image, half the squared norm |f_z|^2 + |f_zbar|^2 and the determinant
/// |f_z|^2 - |f_zbar|^2.
struct MapJacobian {
  Complex holomorphic;
  Complex antiholomorphic;
  double half_square;
  double determinant;
  bool is_sliver() const { return !(determinant > sliver * half_square); }
  /// Of the image scaled by a factor.
  MapJacobian scaled(double factor) const {
    const double square = factor * factor;
    return {factor * holomorphic, factor * antiholomorphic, square * half_square, square * determinant};
  }
  /// The barrier of a sliver, or of an image of insignificant scale, would dominate the energy of all other triangles.
  bool has_area() const { return !is_sliver() && determinant > insignificant * insignificant; }
};

/// The determinant regularized (see DistortionElement), and its derivative.
struct RegularizedDeterminant {
  double value;
  double slope;
  RegularizedDeterminant(double determinant, double regularization) : value(determinant), slope(1) {
    if (regularization == 0) return;
    if (std::isinf(regularization)) {
      value = infinity;
      slope = 0;
      return;
    }
    const double root = std::hypot(determinant, regularization);
    value = determinant > 0 ? 0.5 * (determinant + root) : 0.5 * regularization * regularization / (root - determinant);
    slope = value / root;
  }
};

/// A quadratic form weight (holomorphic |f_z|^2 + antiholomorphic |f_zbar|^2) of one triangle, the weight left out.
struct DistortionStiffness {
  double holomorphic;
  double antiholomorphic;
};

/// The distortion of a triangle as a function of the singular values s1 >= s2 of its Jacobian, unbounded as the
/// triangle loses its image area: either
///   (1 - sizes) (s1 / s2 + s2 / s1) + sizes (s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2),
/// a blend of the conformal distortion, which any similarity minimizes (Hormann and Greiner, MIPS: An Efficient Global
/// Parametrization Method, 2000), and the symmetric Dirichlet energy, which only an isometry minimizes (Smith and
/// Schaefer, Bijective Parameterization with Free Boundaries, 2015); or the quasi-conformal distortion
///   s1 / s2 = c + sqrt(c^2 - 1), where c = (s1 / s2 + s2 / s1) / 2,
/// whose kink at similarities is smoothed to c + sqrt(c^2 - 1 + squared_smoothing).
struct DistortionMeasure {
  double sizes = 1;               ///< from 0, angles alone, to 1
  double squared_smoothing = -1;  ///< negative: not the quasi-conformal distortion

  bool is_quasi_conformal() const { return squared_smoothing >= 0; }
  double infimum() const { return is_quasi_conformal() ? 1 + std::sqrt(squared_smoothing) : 2 + 2 * sizes; }

  /// A distortion and its derivatives with respect to half_square and the determinant.
  struct Density {
    double value;
    double by_square;
    double by_determinant;
  };
  Density density(double regularization, const MapJacobian& j) const;
  /// A positive definite form that approximates the Hessian of the triangle's distortion.
  DistortionStiffness stiffness(double regularization, const MapJacobian& j) const;

  /// The smoothed root, without cancellation near similarities. inverse: of the determinant.
  static double smoothed_root(const MapJacobian& j, double inverse, double squared_smoothing) {
    const double p = std::norm(j.holomorphic) * inverse;
    const double q = std::norm(j.antiholomorphic) * inverse;
    return std::sqrt(4 * p * q + squared_smoothing);
  }

  static const DistortionMeasure symmetric_dirichlet;
  static const DistortionMeasure conformal;
};
inline constexpr DistortionMeasure DistortionMeasure::symmetric_dirichlet{1};
inline constexpr DistortionMeasure DistortionMeasure::conformal{0};

inline DistortionMeasure::Density DistortionMeasure::density(double regularization, const MapJacobian& j) const {
  const double squares = 2 * j.half_square;  // s1^2 + s2^2
  if (std::isinf(regularization)) return {squares, 2, 0};
  const RegularizedDeterminant determinant(j.determinant, regularization);
  const double inverse = 1 / determinant.value;
  if (is_quasi_conformal()) {
    const double c = j.half_square * inverse;
    const double root = smoothed_root(j, inverse, squared_smoothing);
    const double by_square = (1 + c / root) * inverse;
    return {c + root, by_square, -by_square * c * determinant.slope};
  }
  // With the determinant D = s1 s2: squares times (1 - sizes) / D + sizes (1 + 1 / D^2).
  const double angles = (1 - sizes) * inverse;
  const double areas = sizes * inverse * inverse;
  const double factor = angles + sizes + areas;
  return {squares * factor, 2 * factor, -squares * (angles + 2 * areas) * inverse * determinant.slope};
}

}  // namespace spectral_conformal
