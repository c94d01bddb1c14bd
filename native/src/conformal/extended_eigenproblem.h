#pragma once

#include <vector>

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/correction.h"
#include "conformal/eigenproblem.h"
#include "conformal/extended_form.h"
#include "conformal/ritz_space.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// `form` must outlive the result.
QuotientForm quotient_form(const ExtendedForm& form);

/// Starts on the support of the form: the start vector of `boundary` (start_vector.h), and `earlier`, a map of the same
/// patch, if it is not empty.
std::vector<ComplexVector> starts_of(const ExtendedForm& form, const BoundaryForm& boundary, unsigned start,
                                     const ComplexVector& earlier);

/// The eigenvector of the smallest positive eigenvalue of L z = lambda B z for the form B of section 4.2, definite or
/// not, from the largest mu of
///   B z = mu (L + s M) z,   mu > 0.
/// B acts only on its support S, so this reduces to B_S G w = mu w, which is self-adjoint in the inner product of G. A
/// Rayleigh-Ritz subspace grows by the residual of its best vector, at the cost of one reduced solve each, and is
/// restarted from its best vectors. (From one start vector this is the Lanczos method; from the vectors of an earlier
/// solve, a locally optimal one.) Then the whole vector z is corrected by descent along (L + s M)^-1 (L z - lambda B z)
/// with the exact step, which removes the shift and the factor's rounding and converges for indefinite forms too.
/// `factorization` holds L + s M, and keeps the support selected. The solve starts from `basis` if that has the form's
/// support, otherwise from `starts`, maps on the support; `basis` is replaced. options.max_restarts times
/// krylov_dimension bounds the reduced solves. `residual` of the result is the last relative change of z.
Eigenpair solve_extended_eigenproblem(Factorization& factorization, const ConformalEnergy& energy,
                                      const ExtendedForm& form, const EigenproblemOptions& options,
                                      const std::vector<ComplexVector>& starts, RitzBasis<Complex>& basis,
                                      const Progress& progress);

}  // namespace spectral_conformal
