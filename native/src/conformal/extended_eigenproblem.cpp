#include "conformal/extended_eigenproblem.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "conformal/correction.h"
#include "conformal/start_vector.h"
#include "conformal/subspace.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

/// B_S G f = mu f, over the numbers over which it is linear.
template <class Number>
class ExtendedProblem {
 public:
  using Scalar = Number;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  ExtendedProblem(ReducedFactor& factor, const ExtendedForm& form)
      : factorization_(factor.factorization()),
        form_(form),
        space_(factor.space().restricted(form.support(), support_)) {
    factorization_.select(support_);
  }
  const std::vector<int>& support() const { return support_; }
  void solve(const Vector& f, Vector& y) {
    ComplexVector x;
    factorization_.solve_selected(as_complex(f), x);
    y = view_as<Scalar>(x);
  }
  void apply(const Vector& y, Vector& f) const { f = force(space_.expanded(as_complex(y))); }
  void remove_translations(Vector& f) const {
    ComplexVector x = as_complex(f);
    space_.remove_translations(x);
    f = view_as<Scalar>(x);
  }
  /// P_S^* B x, for x on the support of the form.
  Vector force(const ComplexVector& x) const {
    ComplexVector image;
    form_.apply(x, image);
    return view_as<Scalar>(space_.gathered(image));
  }

 private:
  Factorization& factorization_;
  const ExtendedForm& form_;
  std::vector<int> support_;  ///< S; before the space
  AffineSpace space_;         ///< P_S
};

/// Finds the largest mu and its map, which stays empty without convergence.
template <class Number>
void find_largest(ReducedFactor& factor, const ExtendedForm& form, const EigenproblemOptions& options,
                  const std::vector<ComplexVector>& starts, RitzBasis<Number>& basis, Eigenpair& pair,
                  const Progress& progress) {
  ExtendedProblem<Number> problem(factor, form);
  RitzSpace<ExtendedProblem<Number>> space(problem);
  if (!basis.support.empty() && basis.support == problem.support()) {
    space.start_from(basis);
  } else {
    for (const ComplexVector& start : starts) space.grow(problem.force(start));
  }
  // For tolerances below 1e-9, the corrections still gain two digits.
  const bool converged = space.size() > 0 && space.converge(options, 0.01 * single_epsilon, progress);
  pair.solves += space.solves();
  if (!converged) return;
  ComplexVector w;
  factor.factorization().solve_from_selected(as_complex(space.force()), w);
  ++pair.solves;
  factor.space().remove_translations(w);
  pair.mu = space.mu();
  w /= pair.mu;
  space.restart(options.krylov_dimension);
  basis = space.basis();
  pair.vector = factor.space().expanded(std::move(w));
}

/// Removes the shift and the factor's rounding: by exact steps, as the form may be indefinite; under equations by whole
/// ones first, since on flat patches, where lambda vanishes, no others can be measured. Returns the last change.
double corrected(ReducedFactor& factor, const ConformalEnergy& energy, const QuotientForm& quotient, double tolerance,
                 Eigenpair& pair) {
  CorrectionOptions options;
  options.max_corrections = 12;  // a bound: they stop when they reach rounding
  options.negligible = 0.1 * tolerance;
  if (!factor.space().is_complex()) {
    options.only_falling = true;
    const ComplexVector uncorrected = pair.vector;
    const Correction correction = correct(factor, energy, quotient, options, pair.vector);
    pair.solves += correction.solves;
    if (correction.change < std::max(single_epsilon, tolerance)) return correction.change;
    options.only_falling = false;
    pair.vector = uncorrected;
  }
  options.exact_step = true;
  const Correction correction = correct(factor, energy, quotient, options, pair.vector);
  pair.solves += correction.solves;
  return correction.change;
}

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

Eigenpair solve_extended_eigenproblem(ReducedFactor& factor, const ConformalEnergy& energy, const ExtendedForm& form,
                                      const EigenproblemOptions& options, const std::vector<ComplexVector>& starts,
                                      EarlierBasis& basis, const Progress& progress) {
  Eigenpair result;
  result.residual = infinity;
  const bool is_complex = factor.space().is_complex() && form.may_turn();
  if (is_complex) {
    find_largest(factor, form, options, starts, basis.complex, result, progress);
  } else {
    find_largest(factor, form, options, starts, basis.real, result, progress);
  }
  if (result.vector.size() == 0) return result;
  const QuotientForm quotient = quotient_form(form);
  result.residual = corrected(factor, energy, quotient, options.tolerance, result);
  result.converged = std::isfinite(result.residual) && result.vector.allFinite() && quotient.value(result.vector) > 0;
  return result;
}

}  // namespace spectral_conformal
