#pragma once

#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "relaxation/lbfgs.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// A map of lower mean QC and, if balanced, of more even sizes (polish.h), with its number of steps; it moves less far,
/// or not at all, if it would otherwise overlap itself more than before. The given map if no step lowers the mean QC,
/// or if it is mirrored. inverse: see polish.h. is_eigenvector: whether the residual of the result measures its
/// distance from an eigenvector.
SpectralMap polished_map(const SpectralProblem& problem, const Lbfgs::Inverse& inverse, SpectralMap map, Polish polish,
                         bool is_eigenvector, const Progress& progress, Timings& timings);

/// Stage: polishes the map; held vertices and linear constraints stay met. With rigid holes it also polishes the map
/// with free holes, and takes that if its mean QC is lower.
PatchMap polished(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
