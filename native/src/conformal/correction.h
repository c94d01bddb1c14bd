#pragma once

#include <functional>

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "conformal/reduced_factor.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The form B of L z = lambda B z, on whole vectors z (V,).
struct QuotientForm {
  std::function<double(const ComplexVector& z)> value;  ///< z^H B z
  /// result += factor B z
  std::function<void(const ComplexVector& z, double factor, ComplexVector& result)> add_applied;
};

/// B^ of Eq. 7. `form` must outlive the result.
QuotientForm quotient_form(const BoundaryForm& form);

struct CorrectionOptions {
  int max_corrections = 0;
  double negligible = 0;  ///< stops below this change of z, relative to z; below single_epsilon UVs are resolved
  /// Scales each correction to where the quotient is stationary to first order, which converges for indefinite B too.
  /// Otherwise takes whole corrections.
  bool exact_step = false;
  /// Stops at a change that is not smaller than the previous one, without applying it.
  bool only_falling = false;
};

struct Correction {
  double change = 0;  ///< of the last step, relative to z; NaN or infinite if there was none
  int solves = 0;
};

/// lambda = z^H L z / z^H B z (Eq. 5) and r = L z - lambda B z. Returns lambda.
double eigen_residual(const ConformalEnergy& energy, const QuotientForm& form, const ComplexVector& z,
                      ComplexVector& r);

/// Corrects an eigenvector by its residual,
///   z <- z - t P (P^* L P + s M)^-1 P^* (L z - lambda B z)
/// without translations, the kernel of L: the fixed points are the eigenvectors of the unshifted problem. The residual,
/// summed triangle by triangle, is more accurate than the factor, so the corrections remove the shift and the rounding
/// of the factor.
Correction correct(ReducedFactor& factor, const ConformalEnergy& energy, const QuotientForm& form,
                   const CorrectionOptions& options, ComplexVector& z);

}  // namespace spectral_conformal
