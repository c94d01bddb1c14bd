#pragma once

#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The map of pinned LSCM (section 2.2) with the energy of a problem. Two or more pins are held exactly; with fewer the
/// two farthest boundary vertices are, and the map is placed (placement.h). `eigenvalue` is the quotient of Eq. 5 of
/// the map, `residual` that of solve_lscm. Throws InvalidMesh where all pins have the same position.
SpectralMap pinned_map(const SpectralProblem& problem, const Pins& pins, const Progress& progress, Timings& timings);

/// Stage: the pinned map of Method::lscm.
PatchMap pinned(const SolveTask& task, PatchMap map, const Progress& progress);

/// Stage: moves the map onto its pins, unless it is held by them. One or two hard pins are met exactly; for soft pins
/// the similarity is that of the least deviation. Throws InvalidMesh where all pins have the same position.
PatchMap fitted_to_pins(const SolveTask& task, PatchMap map);

}  // namespace spectral_conformal
