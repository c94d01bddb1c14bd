#pragma once

#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// s is well above the 1e-16 that rounding takes from the diagonal of L, well below the lambda of a patch of a million
/// vertices.
constexpr Attempt first_attempt{1e-12, 0, 6, 1.0, false};

/// A map as the first attempt left it, or, where it fails its checks and another attempt can help, that of a second one
/// at the same problem with a larger shift and another start.
SpectralMap retried_map(SpectralProblem& problem, SpectralMap map, const SolveOptions& options, const Pins& attractors,
                        const Progress& progress, Timings& timings);

/// The map of the first attempt, retried.
SpectralMap attempted_map(SpectralProblem& problem, const SolveOptions& options, const Pins& attractors,
                          const Progress& progress, Timings& timings);

/// Stage: the map of the first attempt; extenders and soft pins shape it. Not of a patch that is pinned (pinned_map.h)
/// or has rigid holes (hole_rigidity.h).
PatchMap spectral(const SolveTask& task, PatchMap map, const Progress& progress);

/// Stage: retries it.
PatchMap retried(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
