#pragma once

#include <vector>

#include "parameterization/spectral_solver.h"
#include "relaxation/isometric_relaxation.h"
#include "spectral_conformal/metric.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// The metric that gives up angles for areas (section 4.3).
struct AreaBlend {
  std::vector<TriangleMetric> metric;  ///< per triangle of the patch, virtual ones included
  double scale_deviation_before = 0;   ///< Distortion::log2_scale_deviation of the conformal map
  IsometricMap relaxed;                ///< that map, relaxed towards an isometry
};

/// Relaxes the spectral map of a patch towards an isometry (isometric_relaxation.h) and blends the metric of that map
/// with the identity: `amount` 0 to 1. Throws SolveFailure where there is no spectral map.
AreaBlend blend_area(const SpectralSolver& solver, double amount, const Progress& progress);

}  // namespace spectral_conformal
