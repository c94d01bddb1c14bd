#pragma once

#include <vector>

#include "parameterization/normalized_patch.h"
#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/step.h"

namespace spectral_conformal {

/// The map of Eq. 5 under linear constraints that hold no coordinate, with soft constraints where there are any
/// (constrained_eigenproblem.h). attractors: soft pins. Like the next, the problem keeps the factor for solves with the
/// same constraints.
SpectralMap constrained_map(SpectralProblem& problem, const SolveOptions& options, const Pins& attractors,
                            const Attempt& attempt, const Progress& progress, Timings& timings);

/// The map of least energy under constraints that hold some coordinates, of about unit size (constrained_lscm.h), with
/// extenders (held_extenders.h).
SpectralMap held_constrained_map(SpectralProblem& problem, const LinearEquations& equations,
                                 const std::vector<Extender>& extenders, const Progress& progress, Timings& timings);

/// Places z, the (V,) of either: what is held exactly where it is, or, if nothing is, without a turn, which the
/// constraints exclude, with its mean at the origin along every axis that they leave free, and the area in 3D.
void place_constrained(const SolveTask& task, ComplexVector& z);

/// What equations contradict: an edge or a triangle that would have no extent in any map that meets them and the `held`
/// pins. A step with Rejection::none if there is none. Throws InvalidMesh if all that is held lies at one position.
Step contradiction(const NormalizedPatch& patch, const LinearEquations& equations, const Pins& held = {});

/// A contradiction with other numbers for the vertices; none: the same.
Step with_vertices(Step contradiction, const std::vector<int>& vertices);

/// Stage: where the map of Eq. 5 under constraints winds round several times or has flipped triangles, the map nearest
/// to the free one (nearest_map.h), if that is better.
PatchMap nearest_to_free(const SolveTask& task, PatchMap map, const Progress& progress);

/// Stage: the map that constraints hold, not yet placed; attempts.h makes those that they do not.
PatchMap held_by_constraints(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
