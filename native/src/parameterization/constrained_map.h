#pragma once

#include <vector>

#include "parameterization/normalized_patch.h"
#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/step.h"

namespace spectral_conformal {

/// The map of Eq. 5 under SolveOptions::constraints (constrained_eigenproblem.h), placed without a turn, which the
/// constraints exclude: its mean at the origin along every axis that they leave free, and the area in 3D.
SpectralMap constrained_map(const SpectralProblem& problem, const SolveOptions& options, const Progress& progress,
                            Timings& timings);

/// What equations contradict: an edge or a triangle that would have no extent in any map that meets them. A step with
/// Rejection::none if there is none.
Step contradiction(const NormalizedPatch& patch, const LinearEquations& equations);

/// A contradiction with other numbers for the vertices; none: the same.
Step with_vertices(Step contradiction, const std::vector<int>& vertices);

/// Stage: that map, where there are constraints.
PatchMap constrained(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
