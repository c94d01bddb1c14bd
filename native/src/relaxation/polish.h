#pragma once

#include <functional>

#include "conformal/conformal_energy.h"
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

/// Lowers the mean quasi-conformal distortion of a map. The conformal energy weights a triangle by its area in the map,
/// but distortion matters on the surface. Starting from the minimum of the energy, a few steps of L-BFGS approach the
/// minimum of the mean of s1 / s2 by area in 3D, smoothed at its kink. The inverse of the conformal energy, whose
/// factor is available, approximates the inverse Hessian. No step flips a triangle; triangles already flipped or
/// slivers in the map, and those without area in 3D, do not count.
///
/// inverse: of L, of L with a small shift, or of the part of L on the vertices that may move: vertices at which it
/// always returns 0 stay exactly in place. z: (V,), finite, including virtual vertices. Returns the number of steps; if
/// 0, z is unchanged. Throws Cancelled, and as the inverse does.
int polish(const ConformalEnergy& energy, const Lbfgs::Inverse& inverse, ComplexVector& z,
           const PolishOptions& options = {}, const Progress& progress = {});

/// Evens out the sizes of a map by the same steps on the symmetric Dirichlet energy at the map's own scale: the inverse
/// of the conformal energy prefers directions that hardly change angles.
int even_out(const ConformalEnergy& energy, const Lbfgs::Inverse& inverse, ComplexVector& z,
             const PolishOptions& options, const Progress& progress = {});

}  // namespace spectral_conformal
