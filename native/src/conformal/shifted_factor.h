#pragma once

#include <memory>

#include "conformal/boundary_form.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The factor of L + s M of Eq. 7.
struct ShiftedFactor {
  std::unique_ptr<Factorization> factorization;  ///< null if L + s M is not positive definite in double precision
  double shift = 0;                              ///< s, the last one tried
  double max_diagonal = 0;                       ///< largest diagonal entry of L
};

/// Factors L + s M with s = relative_shift times the median of L_ii / M_ii over the vertices with mass, raised from 0
/// to the rounding of these, and a hundredfold, while rounding breaks the factorization and s M is less than half of L.
/// L is singular (L 1 = 0), so a form without mass has no factor. The shift by the form itself preserves the
/// eigenvectors of Eq. 5. Throws Cancelled, and as Factorization does. matrix: L, consumed. positions: (V, 3), of its
/// rows. analyzed: a factorization of a matrix with the structure of L, whose order and memory are reused; or null.
ShiftedFactor factor_shifted(HermitianMatrix&& matrix, const Positions& positions, const BoundaryForm& form,
                             double relative_shift, FactorizationBackend backend, const Progress& progress,
                             std::unique_ptr<Factorization> analyzed = nullptr);

}  // namespace spectral_conformal
