#pragma once

#include <memory>

#include "conformal/boundary_form.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The factor of L + s M of Eq. 7.
struct ShiftedFactor {
  std::unique_ptr<Factorization> factorization;  ///< null where L + s M is not positive definite in double precision
  double shift = 0;                              ///< s, the last one tried
  double max_diagonal = 0;                       ///< largest diagonal entry of L
};

/// Factors L + s M with s = relative_shift times the median of L_ii / M_ii over the vertices with mass, raised a
/// hundredfold, at most four times, while rounding breaks the factorization. L is singular (L 1 = 0), so that a
/// form without mass has no factor; the shift by the form itself leaves the eigenvectors of Eq. 5 as they are. Throws
/// Cancelled, and what Factorization throws.
/// matrix: L, used up. positions: (V, 3), of its rows. analyzed: of a matrix with the structure of L, to be used
/// again, with its order and its memory; or null.
ShiftedFactor factor_shifted(HermitianMatrix&& matrix, const Positions& positions, const BoundaryForm& form,
                             double relative_shift, FactorizationBackend backend, const Progress& progress,
                             std::unique_ptr<Factorization> analyzed = nullptr);

}  // namespace spectral_conformal
