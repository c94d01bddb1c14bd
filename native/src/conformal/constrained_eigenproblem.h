#pragma once

#include <memory>

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/constrained_factor.h"
#include "conformal/eigenproblem.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Eq. 5 with linear constraints (constrained_factor.h): x = P w reduces the real problem to
///   P^T L P w = lambda P^T B P w,
/// which is smaller, needs no weights, and is solved for the smallest lambda of a w that is no translation. By Eq. 7,
/// as in eigenproblem.h, reduced to the vertices that carry mass,
///   T y = Q M^1/2 P K^-1 P^T M^1/2 Q y = mu y,   w = K^-1 P^T M^1/2 y,   K = P^T L P + s diag(P^T M P).
/// The corrections of correction.h, in w, remove the shift. vector: the map P w.
struct ConstrainedEigenpair {
  Eigenpair pair;                             ///< vector, (V,): the map; mu: 1 / lambda
  double change = 0;                          ///< the last correction, relative to the map
  std::unique_ptr<ConstrainedFactor> factor;  ///< never null; not factored: there is no map
};

/// constraints: without held coordinates. positions: (V, 3), which help to order the factorization. Throws Cancelled,
/// and as Factorization does.
ConstrainedEigenpair solve_constrained_eigenproblem(const ConformalEnergy& energy, const BoundaryForm& form,
                                                    LinearConstraints constraints, const Positions& positions,
                                                    double relative_shift, FactorizationBackend backend,
                                                    const Progress& progress);

}  // namespace spectral_conformal
