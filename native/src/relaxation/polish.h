#pragma once

#include <functional>
#include <utility>

#include "conformal/conformal_energy.h"
#include "relaxation/distortion_sum.h"
#include "relaxation/lbfgs.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

struct PolishOptions {
  int max_steps = 6;  ///< each takes a solve with the factor and usually one evaluation of the distortion
  /// After a few steps, stop when one removes less than this fraction of the excess over the least distortion.
  double tolerance = 1e-2;
  /// Whether a map is still allowed; the step that leaves these maps is shortened, and is the last. Empty: all are.
  std::function<bool(const ComplexVector&)> is_allowed = {};
};

/// Lowers the distortion of a map by a few steps of L-BFGS. The inverse of the conformal energy, whose factor is
/// available, approximates the inverse Hessian. No step flips a triangle; triangles already flipped or slivers in the
/// first map, and those without area in 3D, do not count. Both functions return the number of steps; if 0, z is
/// unchanged. They throw Cancelled, and as the inverse does.
class Polisher {
 public:
  /// inverse: of L, of L with a small shift, or of the part of L on the vertices that may move: vertices at which it
  /// always returns 0 stay exactly in place. z: the first map, (V,), finite, including virtual vertices, as below.
  static Polisher of(const ConformalEnergy& energy, Lbfgs::Inverse inverse, const ComplexVector& z);

  /// Lowers the mean quasi-conformal distortion. The conformal energy weights a triangle by its area in the map, but
  /// distortion matters on the surface. Starting from the minimum of the energy, the steps approach the minimum of the
  /// mean of s1 / s2 by area in 3D, smoothed at its kink.
  int even_out_angles(ComplexVector& z, const PolishOptions& options = {}, const Progress& progress = {});
  /// Evens out the sizes by the symmetric Dirichlet energy at the map's own scale: the inverse of the conformal energy
  /// prefers directions that hardly change angles.
  int even_out_sizes(ComplexVector& z, const PolishOptions& options = {}, const Progress& progress = {});

 private:
  Polisher(Lbfgs::Inverse inverse, DistortionSum distortion)
      : inverse_(std::move(inverse)), distortion_(std::move(distortion)) {}

  Lbfgs::Inverse inverse_;
  DistortionSum distortion_;
};

}  // namespace spectral_conformal
