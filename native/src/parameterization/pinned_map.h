#pragma once

#include <vector>

#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "spectral_conformal/options.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The map of pinned LSCM (section 2.2) with the energy of a problem. Two or more pins are held exactly. With fewer,
/// the two farthest boundary vertices are pinned and the map is placed (placement.h). Extenders act as in
/// held_extenders.h. tolerance: see solve_lscm. `eigenvalue` is the map's quotient of Eq. 5, `residual` that of
/// solve_lscm. The problem keeps the factor for the next solve with the same pinned vertices. Throws InvalidMesh if all
/// pins have the same position.
SpectralMap pinned_map(SpectralProblem& problem, const Pins& pins, const std::vector<Extender>& extenders,
                       double tolerance, const Progress& progress, Timings& timings);

/// Sets z of a map to its `whole`, which is in the unit of the pins (at least two), with the pins exactly as given.
void set_on_pins(const SpectralProblem& problem, const Pins& pins, SpectralMap& map);

/// Stage: the pinned map of Method::lscm.
PatchMap pinned(const SolveTask& task, PatchMap map, const Progress& progress);

/// Stage: moves the map onto its pins, unless they held it in the solve. One or two hard pins are met exactly; for soft
/// pins the similarity minimizes the deviation. Throws InvalidMesh if all pins have the same position.
PatchMap fitted_to_pins(const SolveTask& task, PatchMap map);

}  // namespace spectral_conformal
