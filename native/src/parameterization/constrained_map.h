#pragma once

#include <vector>

#include "parameterization/normalized_patch.h"
#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/step.h"

namespace spectral_conformal {

/// The map of Eq. 5 under linear constraints that hold no coordinate, and under soft constraints if there are any
/// (constrained_eigenproblem.h). attractors: soft pins. The problem keeps the factor for solves with the same
/// constraints.
SpectralMap constrained_map(SpectralProblem& problem, const SolveOptions& options, const Pins& attractors,
                            const Attempt& attempt, const Progress& progress, Timings& timings);

/// Places z (V,) of that map. It is not turned, which the constraints exclude; its mean moves to the origin along each
/// axis that they leave free, and it gets the area in 3D.
void place_constrained(const SolveTask& task, ComplexVector& z);

/// The contradiction in equations: an edge or triangle without extent in every map that meets them and the `held` pins.
/// A step with Rejection::none if there is none. Throws InvalidMesh if all that is held lies at one position.
Step contradiction(const NormalizedPatch& patch, const LinearEquations& equations, const Pins& held = {});

/// Renumbers the vertices of a contradiction by `vertices`, unless these are empty.
Step with_vertices(Step contradiction, const std::vector<int>& vertices);

/// Stage: if the map of Eq. 5 under constraints winds around several times, folds over or has flipped triangles, takes
/// the map nearest to the free one (nearest_map.h), if that is better.
PatchMap nearest_to_free(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
