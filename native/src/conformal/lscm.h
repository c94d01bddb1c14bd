#pragma once

#include "conformal/conformal_energy.h"
#include "conformal/reduced_factor.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

struct LscmSolution {
  ComplexVector vector;  ///< (V,)
  double energy = 0;     ///< x^* L x
  double change = 0;     ///< remaining error, relative to the extent of the map
  double residual = 0;   ///< |P^* L x| / (largest diagonal entry x extent of the map)
};

/// LSCM (Levy et al., Least Squares Conformal Maps, 2002), which is DCP (section 2.2): minimizes E_C over the maps x =
/// P w + c, with any vertices and coordinates held and under any linear equations,
///   P^* L P w = -P^* L c,
/// or with the springs of the factor the sum of both energies. Solves with the factor, followed by iterative refinement
/// with the exact residual, which removes its shift, or, if that does not resolve the map, as on long strips, by
/// conjugate gradients preconditioned by the factor. What is held is exact. If pins are the image of vertices in the
/// plane under a similarity, x is that similarity. By the contraction that the factor had before, the refinement ends
/// once double precision is reached, usually after two solves; or, with a tolerance coarser than single precision,
/// that, usually after one. Precondition: the factor is factored. Throws Cancelled.
LscmSolution solve_lscm(const ConformalEnergy& energy, ReducedFactor& factor, const Progress& progress,
                        double tolerance = 0);

/// The response to a force (V,), by the same solver: x = P w with P^* L P w = P^* force. Does not set `residual`.
LscmSolution lscm_response(const ConformalEnergy& energy, const ComplexVector& force, ReducedFactor& factor,
                           const Progress& progress, double tolerance = 0);

}  // namespace spectral_conformal
