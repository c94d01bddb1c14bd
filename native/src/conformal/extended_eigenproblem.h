#pragma once

#include <vector>

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/correction.h"
#include "conformal/eigenproblem.h"
#include "conformal/extended_form.h"
#include "conformal/reduced_factor.h"
#include "conformal/ritz_space.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// `form` must outlive the result.
QuotientForm quotient_form(const ExtendedForm& form);

/// Approximate eigenvectors of an earlier solve with the same factor, complex or real ones.
struct EarlierBasis {
  RitzBasis<Complex> complex;
  RitzBasis<double> real;
};

/// Starts on the support of the form: the start vector of `boundary` (start_vector.h), and `earlier`, a map of the same
/// patch, if it is not empty.
std::vector<ComplexVector> starts_of(const ExtendedForm& form, const BoundaryForm& boundary, unsigned start,
                                     const ComplexVector& earlier);

/// The eigenvector of the smallest positive eigenvalue of Eq. 5 on the maps z = P w,
///   P^* L P w = lambda P^* B P w,
/// other than translations, for the form B of section 4.2, definite or not, from the largest mu of
///   P^* B P w = mu K w,   mu > 0,
/// with the factor of K = P^* L P + s D. B acts only on the unknowns S that its support depends on, so this reduces to
///   B_S G f = mu f,   B_S = P_S^* B P_S,   G = S^* K^-1 S,
/// which is self-adjoint in the inner product of G; over the complex numbers, or, where equations or the form single
/// out directions, over the reals. A Rayleigh-Ritz subspace grows by the residual of its best vector, at the cost of
/// one reduced solve each, and is restarted from its best vectors. (From one start vector this is the Lanczos method;
/// from the vectors of an earlier solve, a locally optimal one.) Then the whole vector z is corrected (correction.h).
/// The factor keeps S selected. The solve starts from `basis` if that has the same S, otherwise from `starts`, maps on
/// the support; `basis` is replaced. options.max_restarts times krylov_dimension bounds the reduced solves. `residual`
/// of the result is the last relative change of z. Precondition: the factor is factored, and holds no coordinate.
/// Throws Cancelled.
Eigenpair solve_extended_eigenproblem(ReducedFactor& factor, const ConformalEnergy& energy, const ExtendedForm& form,
                                      const EigenproblemOptions& options, const std::vector<ComplexVector>& starts,
                                      EarlierBasis& basis, const Progress& progress);

}  // namespace spectral_conformal
