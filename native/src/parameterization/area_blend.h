#pragma once

#include <optional>
#include <vector>

#include "parameterization/patch_map.h"
#include "relaxation/isometric_relaxation.h"
#include "spectral_conformal/metric.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// The metric that gives up angles for areas (section 4.3).
struct AreaBlend {
  std::optional<Step> rejection;       ///< why there is no spectral map to relax, and no metric
  std::vector<TriangleMetric> metric;  ///< per triangle of the patch, virtual ones included
  double scale_deviation_before = 0;   ///< Distortion::log2_scale_deviation of the conformal map
  IsometricMap relaxed;                ///< that map, relaxed towards an isometry
};

/// Relaxes the spectral map of a patch towards an isometry (isometric_relaxation.h) and blends the metric of that map
/// with the identity: `amount` 0 to 1.
AreaBlend blend_area(const SpectralProblem& problem, double amount, const Progress& progress);

/// Stage: gives the patch the metric of PatchOptions::area_blend, once. All or nothing: where memory runs out, the next
/// solve begins with what was there.
PatchMap blended(const SolveTask& task, PatchMap map, const Progress& progress);

/// Stage: measures what the blend did to the map, and says so where it lowered the spread of scale (log2) by less than
/// a fifth of what it asks for. Spreads below 0.05 (a factor of 1.035 in length) are not worth a word.
PatchMap measured_blend(const SolveTask& task, PatchMap map);

}  // namespace spectral_conformal
