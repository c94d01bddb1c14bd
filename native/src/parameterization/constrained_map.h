#pragma once

#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// The map of Eq. 5 under SolveOptions::constraints (constrained_eigenproblem.h), placed without a turn, which the
/// constraints exclude: its mean at the origin along every axis that they leave free, and the area in 3D.
SpectralMap constrained_map(const SpectralProblem& problem, const SolveOptions& options, const Progress& progress,
                            Timings& timings);

/// Stage: that map, where there are constraints.
PatchMap constrained(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
