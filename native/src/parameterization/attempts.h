#pragma once

#include "geometry/tolerances.h"
#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// s is well above the rounding of 1e-16 in the diagonal of L, and well below lambda for a patch of a million vertices.
constexpr Attempt first_attempt{1e-12, 10 * epsilon, {1.0, 1200, 0}};

/// The given map of the first attempt. If it fails its checks and another attempt can help, the map of a second attempt
/// at the same problem, with a larger shift and another start.
SpectralMap retried_map(SpectralProblem& problem, SpectralMap map, const SolveOptions& options, const Pins& attractors,
                        const Progress& progress, Timings& timings);

/// The map of the first attempt, retried.
SpectralMap attempted_map(SpectralProblem& problem, const SolveOptions& options, const Pins& attractors,
                          const Progress& progress, Timings& timings);

/// Stage: the map of the first attempt, shaped by extenders and soft pins.
PatchMap spectral(const SolveTask& task, PatchMap map, const Progress& progress);

/// Stage: retries that map.
PatchMap retried(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
