#pragma once

#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "relaxation/lbfgs.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// A map of lower mean QC (polish.h), with its number of steps; fewer steps, or none, where the map would otherwise
/// overlap itself more than before. The given map if no step lowers the mean QC, or if it is mirrored.
/// inverse: see polish.h. is_eigenvector: whether `residual` of the result is to measure how far it is from one.
SpectralMap polished_map(const SpectralProblem& problem, const Lbfgs::Inverse& inverse, SpectralMap map,
                         bool is_eigenvector, const Progress& progress, Timings& timings);

/// Stage: polishes the map if SolveOptions::polish requests it and nothing but held vertices and linear
/// constraints, which the polished map keeps, are requested of its shape.
/// With rigid holes it also polishes the map with free holes, and takes it if its mean QC is then lower.
PatchMap polished(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
