#include "conformal/constrained_eigenproblem.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "conformal/correction.h"
#include "conformal/extended_eigenproblem.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

using Eigen::VectorXd;

/// The real view of complex numbers.
Eigen::Map<const VectorXd> real_view(const ComplexVector& w) {
  return {reinterpret_cast<const double*>(w.data()), 2 * w.size()};
}
Eigen::Map<const ComplexVector> complex_view(const VectorXd& w) {
  return {reinterpret_cast<const Complex*>(w.data()), w.size() / 2};
}

/// B_S G f = mu f. Unlike that of extended_eigenproblem.h, it is linear over the reals only.
class ConstrainedProblem {
 public:
  using Scalar = double;

  ConstrainedProblem(ReducedFactor& factor, const ExtendedForm& form)
      : factorization_(factor.factorization()),
        form_(form),
        space_(factor.space().restricted(form.support(), support_)) {
    factorization_.select(support_);
  }

  const std::vector<int>& support() const { return support_; }
  void solve(const VectorXd& f, VectorXd& y) {
    ComplexVector x;
    factorization_.solve_selected(complex_view(f), x);
    y = real_view(x);
  }
  void apply(const VectorXd& y, VectorXd& f) const {
    ComplexVector image;
    form_.apply(space_.expanded(complex_view(y)), image);
    f = gathered(image);
  }
  void remove_translations(VectorXd& f) const {
    ComplexVector x = complex_view(f);
    space_.remove_translations(x);
    f = real_view(x);
  }
  /// P_S^* x for x on the support of the form.
  VectorXd gathered(const ComplexVector& x) const { return real_view(space_.gathered(x)); }

 private:
  Factorization& factorization_;
  const ExtendedForm& form_;
  std::vector<int> support_;  ///< the unknowns S; before the space
  AffineSpace space_;         ///< P_S
};

}  // namespace

Eigenpair solve_constrained_eigenproblem(ReducedFactor& factor, const ConformalEnergy& energy, const ExtendedForm& form,
                                         const EigenproblemOptions& options, const ComplexVector& start,
                                         RitzBasis<double>& basis, const Progress& progress) {
  Eigenpair result;
  result.residual = infinity;
  ConstrainedProblem problem(factor, form);
  RitzSpace<ConstrainedProblem> space(problem);
  if (!basis.support.empty() && basis.support == problem.support()) {
    space.start_from(basis);
  } else {
    ComplexVector force;
    form.apply(start, force);
    space.grow(problem.gathered(force));
  }
  // For tolerances below 1e-9, the corrections still gain two digits.
  const bool converged = space.size() > 0 && space.converge(options, 0.01 * single_epsilon, progress);
  result.solves = space.solves();
  if (!converged) return result;
  ComplexVector w;
  factor.factorization().solve_from_selected(complex_view(space.force()), w);
  ++result.solves;
  factor.space().remove_translations(w);
  result.vector = factor.space().expanded(w) / space.mu();
  space.restart(options.krylov_dimension);
  basis = space.basis();

  const Inverse inverse = [&factor](const ComplexVector& r, ComplexVector& d) { d = factor.inverse(r); };
  const QuotientForm quotient = quotient_form(form);
  CorrectionOptions corrections;
  corrections.max_corrections = 12;  // a bound: they stop when they reach rounding
  corrections.negligible = 0.1 * options.tolerance;
  corrections.only_falling = true;
  const ComplexVector uncorrected = result.vector;
  Correction correction = correct(inverse, energy, quotient, corrections, result.vector);
  result.solves += correction.solves;
  if (!(correction.change < std::max(single_epsilon, options.tolerance))) {
    // Of an indefinite form. On flat patches, where lambda vanishes, only whole corrections can be measured.
    corrections.only_falling = false;
    corrections.exact_step = true;
    result.vector = uncorrected;
    correction = correct(inverse, energy, quotient, corrections, result.vector);
    result.solves += correction.solves;
  }
  result.residual = correction.change;
  result.converged = std::isfinite(result.residual) && result.vector.allFinite() && quotient.value(result.vector) > 0;
  result.mu = quotient.value(result.vector) / energy.value(result.vector);
  return result;
}

}  // namespace spectral_conformal
