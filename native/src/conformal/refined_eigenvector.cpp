#include "conformal/refined_eigenvector.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "conformal/correction.h"
#include "conformal/davidson.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

Eigenvector eigenvector_of(Eigenpair&& pair) {
  Eigenvector result;
  result.z = std::move(pair.vector);
  result.solves = pair.solves;
  result.residual = pair.residual;
  result.change = pair.residual;
  result.converged = pair.converged;
  return result;
}

/// Removes the shift and the rounding of the factor.
void correct(Eigenvector& v, ReducedFactor& factor, const ConformalEnergy& energy, const QuotientForm& quotient,
             bool exact_steps) {
  CorrectionOptions corrections;
  // Each leaves (lambda + s) / (lambda_2 + s) of the error, with the next eigenvalue lambda_2.
  corrections.max_corrections = 40;
  // The first change is the rounding of the factor, the last ones that of the residual.
  corrections.negligible = 100 * sum_rounding;
  const ComplexVector uncorrected = exact_steps ? v.z : ComplexVector{};
  Correction correction = correct(factor, energy, quotient, corrections, v.z);
  v.solves += correction.solves;
  if (exact_steps && !(correction.change < single_epsilon)) {
    // With entries near 1e12, the rounding of the factor is as large as lambda. Whole corrections then move away from
    // z, at a rate that differs between BLAS kernels; a measured step always lowers the quotient.
    v.z = uncorrected;
    corrections.max_corrections = 100;  // measured: up to 72
    // Each leaves up to 0.9 of the error; rounding stops them at 1e-9.
    corrections.negligible = 0.1 * single_epsilon;
    corrections.exact_step = true;
    correction = correct(factor, energy, quotient, corrections, v.z);
    v.solves += correction.solves;
  }
  v.change = correction.change;
}

/// Separates close eigenvalues smaller than the shift, as on long strips.
void resolve(Eigenvector& v, const ConformalEnergy& energy, const BoundaryForm& mass, ReducedFactor& factor,
             const QuotientForm& quotient, const Progress& progress) {
  DavidsonResult resolved = solve_by_davidson(factor, energy, mass, quotient, insignificant, progress);
  v.solves += resolved.solves;
  if (!(resolved.change < v.change_limit)) return;
  v.z = std::move(resolved.z);
  v.change = resolved.change;
  v.converged = true;
}

}  // namespace

EigenproblemOptions eigenproblem_options(const Attempt& attempt, double tolerance) {
  EigenproblemOptions options;
  options.tolerance = tolerance * attempt.tolerance_factor;
  options.start = attempt.start;
  options.krylov_dimension = attempt.krylov_dimension;
  return options;
}

Eigenvector refined_eigenvector(Eigenpair pair, const ConformalEnergy& energy, const EigenproblemForm& form,
                                ReducedFactor& factor, const Attempt& attempt, double tolerance,
                                const Progress& progress) {
  // Not if the rounding of L exceeds the shift, as with the huge entries of thin triangles; nor in a space that complex
  // combinations leave.
  const bool may_resolve =
      !attempt.exact_steps && factor.space().is_complex() && epsilon * factor.max_diagonal() < attempt.relative_shift;
  Eigenvector v = eigenvector_of(std::move(pair));
  if (form.extended) {
    const ExtendedForm& extended = *form.extended;
    v.change_limit = std::max(single_epsilon, tolerance * attempt.tolerance_factor);
    if (may_resolve && !(v.converged && v.change < v.change_limit)) {
      resolve(v, energy, form.boundary, factor, quotient_form(extended), progress);
    }
    if (v.converged) v.lambda = energy.value(v.z) / extended.value(extended.restrict(v.z));
  } else if (form.is_area) {
    if (may_resolve && !v.converged) resolve(v, energy, form.boundary, factor, area_quotient(energy), progress);
    if (v.converged) v.lambda = energy.value(v.z) / energy.area_form(v.z);
  } else {
    const QuotientForm quotient = quotient_form(form.boundary);
    if (v.converged) correct(v, factor, energy, quotient, attempt.exact_steps);
    if (may_resolve && !(v.converged && v.change < v.change_limit)) {
      resolve(v, energy, form.boundary, factor, quotient, progress);
    }
    if (v.converged) {
      ComplexVector r;
      v.lambda = eigen_residual(energy, quotient, v.z, r);  // Eq. 5
      v.residual = r.norm() / (factor.max_diagonal() * v.z.norm());
    }
  }
  return v;
}

}  // namespace spectral_conformal
