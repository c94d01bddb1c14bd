#pragma once

#include <functional>

#include "conformal/boundary_form.h"
#include "conformal/conformal_energy.h"
#include "linear_algebra/factorization.h"
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
  double negligible = 0;  ///< ends below this change of z, relative to z
  /// Scales each correction to where the quotient is stationary to first order, which converges for indefinite B too;
  /// otherwise whole.
  bool exact_step = false;
  /// Leaves out a change that is not smaller than the one before, and ends there.
  bool only_falling = false;
};

/// Corrections that end below this change of z leave less than single precision, in which UVs are stored.
constexpr double resolved_change = 1e-7;

struct Correction {
  double change = 0;  ///< of the last step taken, relative to z; not a number or infinite where there was none to take
  int solves = 0;
};

/// lambda = z^H L z / z^H B z (Eq. 5) and r = L z - lambda B z. Returns lambda.
double eigen_residual(const ConformalEnergy& energy, const QuotientForm& form, const ComplexVector& z,
                      ComplexVector& r);

/// The corrections of an eigenvector by what its residual leaves,
///   z <- z - t (L + s M)^-1 (L z - lambda B z):
/// the eigenvectors of the unshifted problem are the fixed points, and because the residual is summed triangle by
/// triangle, more accurately than the factor is, they take out the shift and the rounding of the factor.
/// `factorization` holds L + s M; each correction is made mean-free: constants are the kernel of L.
Correction correct(Factorization& factorization, const ConformalEnergy& energy, const QuotientForm& form,
                   const CorrectionOptions& options, ComplexVector& z);

}  // namespace spectral_conformal
