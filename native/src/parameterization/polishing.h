#pragma once

#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// A map of lower mean QC (polish.h), and the number of steps to it; not the whole way, or none of it, where more of
/// the map would lie on itself than before. The given map where no step lowers it. Needs the factor of the map.
SpectralMap polished_map(const SpectralProblem& problem, SpectralMap map, const Progress& progress, Timings& timings);

/// Stage: polishes the map where PatchOptions::polish asks for it and nothing else is asked of its shape. Of a patch
/// with holes that of free holes, too: it is taken where the lead of rigid ones is less than what polishing takes away.
PatchMap polished(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
