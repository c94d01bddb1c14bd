#pragma once

#include "conformal/conformal_energy.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

struct PolishOptions {
  int max_steps = 6;        ///< each takes a solve with the factor and, as a rule, one evaluation of the distortion
  double tolerance = 1e-2;  ///< stop, after a few, where one takes away less than this fraction of the excess over 1
};

/// Lowers the mean quasi-conformal distortion of a map. The conformal energy counts a triangle by its area in the map;
/// its distortion is felt on the surface. Starting from the minimum of the one, a few steps of L-BFGS go towards that
/// of the other: the mean of s1 / s2 by area in 3D, smoothed where it has a kink. The inverse of the conformal energy,
/// whose factor is there, stands for that of the Hessian. No step flips a triangle; those that are flipped or slivers
/// in the map already, and those without area in 3D, do not count.
///
/// factor: of L, or of L with a small shift. z (V,) finite, virtual vertices included. Returns the number of steps; 0
/// leaves z as it is. Throws Cancelled, and what Factorization throws.
int polish(const ConformalEnergy& energy, Factorization& factor, ComplexVector& z, const PolishOptions& options = {},
           const Progress& progress = {});

}  // namespace spectral_conformal
