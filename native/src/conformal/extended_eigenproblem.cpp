#include "conformal/extended_eigenproblem.h"

#include <cmath>
#include <utility>
#include <vector>

#include "conformal/correction.h"
#include "conformal/start_vector.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

/// B_S G w = mu w, G = S^T (L + s M)^-1 S.
class ExtendedProblem {
 public:
  using Scalar = Complex;

  /// Precondition: the factorization has selected the support of the form.
  ExtendedProblem(Factorization& factorization, const ExtendedForm& form)
      : factorization_(factorization), form_(form) {}
  const std::vector<int>& support() const { return form_.support(); }
  void solve(const ComplexVector& w, ComplexVector& y) { factorization_.solve_selected(w, y); }
  void apply(const ComplexVector& y, ComplexVector& w) const { form_.apply(y, w); }
  void remove_translations(ComplexVector& w) const { w.array() -= w.mean(); }

 private:
  Factorization& factorization_;
  const ExtendedForm& form_;
};

}  // namespace

QuotientForm quotient_form(const ExtendedForm& form) {
  return {[&form](const ComplexVector& z) { return form.value(form.restrict(z)); },
          [&form](const ComplexVector& z, double factor, ComplexVector& sum) { form.add_applied(z, factor, sum); }};
}

std::vector<ComplexVector> starts_of(const ExtendedForm& form, const BoundaryForm& boundary, unsigned start,
                                     const ComplexVector& earlier) {
  ComplexVector circle = ComplexVector::Zero(static_cast<Eigen::Index>(form.support().size()));
  circle.head(boundary.mass.size()) =
      start_vector(boundary, start).cwiseQuotient(boundary.mass.cwiseSqrt().cast<Complex>());
  std::vector<ComplexVector> starts{std::move(circle)};
  if (earlier.size() > 0) starts.push_back(form.restrict(earlier));
  return starts;
}

Eigenpair solve_extended_eigenproblem(Factorization& factorization, const ConformalEnergy& energy,
                                      const ExtendedForm& form, const EigenproblemOptions& options,
                                      const std::vector<ComplexVector>& starts, RitzBasis<Complex>& basis,
                                      const Progress& progress) {
  Eigenpair result;
  factorization.select(form.support());
  ExtendedProblem problem(factorization, form);
  RitzSpace<ExtendedProblem> space(problem);
  if (basis.support == form.support()) {
    space.start_from(basis);
  } else {
    ComplexVector force;
    for (const ComplexVector& start : starts) {
      form.apply(start, force);
      space.grow(force);
    }
  }
  result.residual = infinity;
  // For tolerances below 1e-9, the corrections still gain two digits.
  const bool converged = space.size() > 0 && space.converge(options, 0.01 * single_epsilon, progress);
  result.solves = space.solves();
  if (!converged) return result;
  result.mu = space.mu();
  factorization.solve_from_selected(space.force(), result.vector);
  ++result.solves;
  result.vector.array() -= result.vector.mean();
  result.vector /= result.mu;
  space.restart(options.krylov_dimension);
  basis = space.basis();

  CorrectionOptions corrections;
  corrections.max_corrections = 12;  // a bound: exact steps stop when they reach rounding
  corrections.negligible = 0.1 * options.tolerance;
  corrections.exact_step = true;
  const Correction correction = correct(factorization, energy, quotient_form(form), corrections, result.vector);
  result.solves += correction.solves;
  result.residual = correction.change;
  result.converged =
      std::isfinite(result.residual) && result.vector.allFinite() && form.value(form.restrict(result.vector)) > 0;
  return result;
}

}  // namespace spectral_conformal
