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
using Expansion = LinearConstraints::Expansion;

/// B_S G f = mu f. Unlike that of extended_eigenproblem.h, it is linear over the reals only.
class ConstrainedProblem {
 public:
  using Scalar = double;

  static ConstrainedProblem of(ConstrainedFactor& factor, const ExtendedForm& form) {
    ConstrainedProblem result(factor, form);
    const LinearConstraints& constraints = factor.constraints();
    std::vector<int> number(static_cast<std::size_t>(constraints.n_unknowns()), -1);
    std::vector<Eigen::Triplet<double>> entries;
    int row = 0;
    for (const int vertex : form.support()) {
      for (const int coordinate : {2 * vertex, 2 * vertex + 1}) {
        for (Expansion::InnerIterator it(constraints.expansion(), coordinate); it; ++it) {
          int& column = number[static_cast<std::size_t>(it.col())];
          if (column < 0) {
            column = static_cast<int>(result.support_.size());
            result.support_.push_back(static_cast<int>(it.col()));
          }
          entries.emplace_back(row, column, it.value());
        }
        ++row;
      }
    }
    result.p_.resize(row, static_cast<Eigen::Index>(result.support_.size()));
    if (result.p_.cols() > 0) result.p_.setFromTriplets(entries.begin(), entries.end());
    for (const VectorXd& whole : factor.translations()) {
      VectorXd along(result.p_.cols());
      for (Eigen::Index k = 0; k < along.size(); ++k) along[k] = whole[result.support_[static_cast<std::size_t>(k)]];
      result.translations_.push_back(std::move(along));
    }
    factor.select(result.support_);
    return result;
  }

  const std::vector<int>& support() const { return support_; }
  void solve(const VectorXd& f, VectorXd& y) { factor_.solve_selected(f, y); }
  void apply(const VectorXd& y, VectorXd& f) const {
    const VectorXd x = p_ * y;
    ComplexVector image;
    form_.apply(Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(x.data()), x.size() / 2), image);
    f = gathered(image);
  }
  void remove_translations(VectorXd& f) const {
    for (const VectorXd& along : translations_) f -= along.dot(f) / along.squaredNorm() * along;
  }
  /// P_S^T x for x on the support of the form.
  VectorXd gathered(const ComplexVector& x) const {
    return p_.transpose() * Eigen::Map<const VectorXd>(reinterpret_cast<const double*>(x.data()), 2 * x.size());
  }

 private:
  ConstrainedProblem(ConstrainedFactor& factor, const ExtendedForm& form) : factor_(factor), form_(form) {}

  ConstrainedFactor& factor_;
  const ExtendedForm& form_;
  Expansion p_;               ///< P_S, (2 form.support().size(), support().size())
  std::vector<int> support_;  ///< the unknowns S
  std::vector<VectorXd> translations_;
};

}  // namespace

Eigenpair solve_constrained_eigenproblem(ConstrainedFactor& factor, const ConformalEnergy& energy,
                                         const ExtendedForm& form, const EigenproblemOptions& options,
                                         const ComplexVector& start, RitzBasis<double>& basis,
                                         const Progress& progress) {
  Eigenpair result;
  result.residual = infinity;
  ConstrainedProblem problem = ConstrainedProblem::of(factor, form);
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
  VectorXd w = factor.solve_from_selected(space.force());
  ++result.solves;
  factor.remove_translations(w);
  result.vector = factor.constraints().expanded(w) / space.mu();
  space.restart(options.krylov_dimension);
  basis = space.basis();

  const Inverse inverse = [&factor](const ComplexVector& r, ComplexVector& d) {
    d = factor.constraints().expanded(factor.solve(r));
  };
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
