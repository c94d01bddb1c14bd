#pragma once

#include "conformal/conformal_energy.h"
#include "conformal/constrained_factor.h"
#include "conformal/lscm.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// Pinned LSCM (lscm.h) under linear constraints that hold any coordinates: minimizes E_C over the maps x = P w + c,
///   P^T L P w = -P^T L c,
/// or with the springs of the factor the sum of both energies, by the factor, followed by iterative refinement with the
/// exact residual, which removes its shift, or, if that does not resolve the map, as on long strips, by conjugate
/// gradients preconditioned by the factor. `residual`: that of P^T L x. Precondition: the factor is factored. Throws
/// Cancelled.
PinnedSolution solve_constrained_lscm(const ConformalEnergy& energy, ConstrainedFactor& factor,
                                      const Progress& progress);

/// The response to a force (V,), by the same solver: x = P w with P^T L P w = P^T force. Does not set `residual`.
PinnedSolution constrained_response(const ConformalEnergy& energy, const ComplexVector& force,
                                    ConstrainedFactor& factor, const Progress& progress);

}  // namespace spectral_conformal
