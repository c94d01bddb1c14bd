#pragma once

#include "conformal/conformal_energy.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

struct PinnedSolution {
  bool is_factorized = true;  ///< false if the free part of L is not positive definite in double precision
  ComplexVector vector;       ///< (V,), pinned entries exactly as given
  double change = 0;          ///< remaining error, relative to the extent of z
  double residual = 0;        ///< |L z| over the free vertices / (largest diagonal entry x extent of the map)
};

/// Pinned LSCM, which is DCP (section 2.2): minimizes E_C with the pinned vertices held, L_ff z_f = -L_fp z_p, followed
/// by iterative refinement, or, if that does not resolve z, as on long strips, by conjugate gradients preconditioned by
/// the factor. Precondition: at least two pins. Throws Cancelled, and as Factorization does.
PinnedSolution solve_lscm(const ConformalEnergy& energy, const Pins& pins, FactorizationBackend backend,
                          const Progress& progress);

}  // namespace spectral_conformal
