#pragma once

#include "linear_algebra/factorization.h"
#include "parameterization/spectral_solver.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The map of pinned LSCM (section 2.2) with the energy of a SpectralSolver. Two or more pins are held exactly; with
/// fewer the two farthest boundary vertices are, and the map is placed (placement.h); a single pin is left to
/// move_onto_pin. `eigenvalue` is the quotient of Eq. 5 of the map, `residual` that of solve_lscm. Throws InvalidMesh
/// where all pins have the same position.
SpectralMap solve_pinned(const SpectralSolver& solver, const Pins& pins, const Progress& progress, Timings& timings);

/// Moves a map so that its only pin is met exactly.
void move_onto_pin(const Pins& pin, ComplexVector& z);

}  // namespace spectral_conformal
