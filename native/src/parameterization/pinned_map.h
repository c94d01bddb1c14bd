#pragma once

#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The map of pinned LSCM (section 2.2) with the energy of a problem. Two or more pins are held exactly. With fewer,
/// the two farthest boundary vertices are pinned and the map is placed (placement.h). `eigenvalue` is the map's
/// quotient of Eq. 5, `residual` that of solve_lscm. Throws InvalidMesh if all pins have the same position.
SpectralMap pinned_map(const SpectralProblem& problem, const Pins& pins, const Progress& progress, Timings& timings);

/// Stage: the pinned map of Method::lscm.
PatchMap pinned(const SolveTask& task, PatchMap map, const Progress& progress);

/// Stage: moves the map onto its pins, unless they held it in the solve. One or two hard pins are met exactly; for soft
/// pins the similarity minimizes the deviation. Throws InvalidMesh if all pins have the same position.
PatchMap fitted_to_pins(const SolveTask& task, PatchMap map);

}  // namespace spectral_conformal
