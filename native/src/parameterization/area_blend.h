#pragma once

#include <optional>
#include <vector>

#include "parameterization/patch_map.h"
#include "relaxation/isometric_relaxation.h"
#include "spectral_conformal/metric.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// The metric that trades angles for areas (section 4.3).
struct AreaBlend {
  std::optional<Step> rejection;       ///< why there is no spectral map to relax, hence no metric
  std::vector<TriangleMetric> metric;  ///< per triangle of the patch, virtual ones included
  double scale_deviation_before = 0;   ///< Distortion::log2_scale_deviation of the conformal map
  IsometricMap relaxed;                ///< that map, relaxed toward an isometry
};

/// Relaxes the spectral map of a patch toward an isometry (isometric_relaxation.h) and blends the metric of the relaxed
/// map with the identity; `amount`: 0 to 1.
AreaBlend blend_area(const SpectralProblem& problem, double amount, const Progress& progress);

/// Gives the patch the metric of PatchOptions::area_blend, once. Returns why it could not, if so. All or nothing: if
/// memory runs out, the patch is unchanged for the next solve.
std::optional<Step> blend_once(PreparedPatch& patch, const Progress& progress);

/// Stage: measures the effect of the blend on the map, and reports it if the spread of scale (log2) fell by less than a
/// fifth of the requested amount. Spreads below 0.05 (a factor of 1.035 in length) are not reported.
PatchMap measured_blend(const SolveTask& task, PatchMap map);

}  // namespace spectral_conformal
