#pragma once

#include "conformal/conformal_energy.h"
#include "conformal/eigenproblem.h"
#include "conformal/extended_form.h"
#include "conformal/reduced_factor.h"
#include "conformal/ritz_space.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// Eq. 5 with linear constraints (reduced_factor.h): x = P w reduces the real problem to
///   P^* L P w = lambda P^* B P w,
/// which is smaller and needs no weights, for the smallest positive lambda of a w that is not a translation. B may have
/// soft constraints; as in extended_eigenproblem.h,
///   B_S G f = mu f,   B_S = P_S^T B P_S,   G = S^T K^-1 S,   K = P^* L P + s diag(P^* M P),
/// on the unknowns S that the vertices of B depend on. Then the corrections of correction.h, in w, remove the shift.
/// vector: the map P w. residual: the last correction, relative to the map. The solve starts from `basis` if that has
/// the same support, otherwise from `start`, a map on the support of the form; `basis` is replaced. Precondition: the
/// factor is factored, and its constraints hold no coordinate. Throws Cancelled.
Eigenpair solve_constrained_eigenproblem(ReducedFactor& factor, const ConformalEnergy& energy, const ExtendedForm& form,
                                         const EigenproblemOptions& options, const ComplexVector& start,
                                         RitzBasis<double>& basis, const Progress& progress);

}  // namespace spectral_conformal
