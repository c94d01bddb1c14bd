#include "relaxation/distortion_measure.h"

#include <algorithm>
#include <cmath>

namespace spectral_conformal {

DistortionStiffness DistortionMeasure::stiffness(double regularization, const MapJacobian& j) const {
  if (is_quasi_conformal()) {
    // Scale by the slope of this distortion over the conformal one, 2 c.
    const double inverse = 1 / RegularizedDeterminant(j.determinant, regularization).value;
    const double slope = 0.5 * (1 + j.half_square * inverse / smoothed_root(j, inverse, squared_smoothing));
    const auto [holomorphic, antiholomorphic] = conformal.stiffness(regularization, j);
    return {slope * holomorphic, slope * antiholomorphic};
  }
  // s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2 of an isometry.
  const double isometry = symmetric_dirichlet.infimum();
  if (std::isinf(regularization)) return {isometry, isometry};
  const double determinant = RegularizedDeterminant(j.determinant, regularization).value;
  if (sizes == 0) {
    if (regularization > 0) {
      const double both = 4 / determinant * (1 + j.half_square / determinant);
      return {both, both};
    }
    // The second derivatives of 2 (a^2 + b^2) / (a^2 - b^2) with respect to a = |f_z| and b = |f_zbar|. The first
    // vanishes for similarities; a fraction of the second, too small to slow the others down, keeps the form definite.
    constexpr double min_fraction = 1e-3;
    const double a = std::norm(j.holomorphic);
    const double b = std::norm(j.antiholomorphic);
    const double cube = determinant * determinant * determinant;
    const double antiholomorphic = 8 * a * (a + 3 * b) / cube;
    return {8 * b * (3 * a + b) / cube + min_fraction * antiholomorphic, antiholomorphic};
  }
  // Any share of sizes: the weight of the symmetric Dirichlet energy bounds that of the conformal distortion too.
  const double larger = std::abs(j.holomorphic) + std::abs(j.antiholomorphic);
  // SLIM's weight (Rabinovich et al. 2017, Table 1): the slope of s^2 + 1 / s^2 over s - 1, halved. The smaller
  // singular value has the larger weight, which majorizes.
  const double inverse = larger / determinant;
  const double local_global = 1 + inverse * (1 + inverse * (1 + inverse));
  // It aims at s = 1 in one step, which would compress the neighbors of very small image triangles until their barriers
  // cut the step short. With this weight such a triangle grows to about 1 + 1 / 0.1 times its size in one step.
  const double growth = 0.1 * (inverse * inverse) * (inverse * inverse);
  const double both = isometry * std::max(local_global, growth);
  return {both, both};
}

}  // namespace spectral_conformal
