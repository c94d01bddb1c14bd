#include "conformal/lscm.h"

#include <cmath>
#include <utility>

#include "conformal/conjugate_gradients.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

/// A solution in progress: P^* L x = P^* force for x = P w + offset, or with springs P^* (L + S) x = P^* (force + S
/// targets).
class LscmSystem {
 public:
  LscmSystem(const ConformalEnergy& energy, ComplexVector offset, const ComplexVector* force, ReducedFactor& factor,
             const Progress& progress)
      : energy_(energy), force_(force), factor_(factor), progress_(progress), x_(std::move(offset)) {}

  LscmSolution solve(double tolerance) {
    LscmSolution result;
    result.change = refine(tolerance > single_epsilon ? single_epsilon : epsilon);
    if (!(result.change < single_epsilon)) result.change = conjugate_gradients<ComplexVector>(*this);
    result.residual = is_residual_current_ ? residual_norm_ : residual().norm();
    result.energy = value_;
    result.vector = std::move(x_);
    return result;
  }

  // Of conjugate_gradients.h.
  ComplexVector residual() {
    value_ = energy_.apply(x_, gradient_);
    if (force_) gradient_ -= *force_;
    const auto& [targets, stiffness] = factor_.springs();
    // The displacement that answers a force has none.
    for (const auto& [vertex, target] : targets) {
      gradient_[vertex] += stiffness * (x_[vertex] - (force_ ? Complex(0) : target));
    }
    ComplexVector r = -factor_.space().gathered(gradient_);
    residual_norm_ = r.norm();
    is_residual_current_ = true;
    return r;
  }
  ComplexVector preconditioned(const ComplexVector& r) { return factor_.solve(r); }
  double curvature(const ComplexVector& p) {
    direction_ = p;
    const ComplexVector whole = factor_.space().expanded(p);
    double result = energy_.apply(whole, gradient_);
    for (const auto& [vertex, target] : factor_.springs().targets) {
      result += factor_.springs().stiffness * std::norm(whole[vertex]);
    }
    return result;
  }
  void move(double alpha) { add(alpha * direction_); }
  double relative(const ComplexVector& step) const {
    const AffineSpace& space = factor_.space();
    return (space.is_complex() ? step.norm() : space.expanded(step).norm()) / (x_.array() - x_.mean()).matrix().norm();
  }
  void poll(int k) const { report(progress_, 1.0 - 0.2 / (1.0 + 0.05 * k), "solve"); }

 private:
  /// Takes whole steps until the error is below a limit, or while they halve the residual. Returns the error.
  double refine(double limit) {
    double before = infinity;
    double change = infinity;
    while (true) {
      report(progress_, 0.8, "solve");
      const ComplexVector r = residual();
      if (!(residual_norm_ < 0.5 * before)) return change;  // rounding is reached
      before = residual_norm_;
      const ComplexVector step = factor_.solve(r);
      add(step);
      const double last = std::exchange(change, relative(step));
      if (std::isfinite(last) && !std::isfinite(factor_.contraction())) factor_.set_contraction(change / last);
      const double error = change * factor_.contraction();
      if (error < limit) return error;
    }
  }
  void add(const ComplexVector& step) {
    factor_.space().add_expanded(step, x_);
    is_residual_current_ = false;
  }

  const ConformalEnergy& energy_;
  const ComplexVector* force_;  ///< or none
  ReducedFactor& factor_;
  const Progress& progress_;
  ComplexVector x_;
  ComplexVector gradient_;
  ComplexVector direction_;  ///< of conjugate gradients
  double residual_norm_ = 0;
  double value_ = 0;  ///< x^* L x
  bool is_residual_current_ = false;
};

}  // namespace

LscmSolution solve_lscm(const ConformalEnergy& energy, ReducedFactor& factor, const Progress& progress,
                        double tolerance) {
  LscmSolution result = LscmSystem(energy, factor.space().offset(), nullptr, factor, progress).solve(tolerance);
  const double unit = factor.max_diagonal() * (result.vector.array() - result.vector.mean()).abs().maxCoeff();
  result.residual = unit > 0 ? result.residual / unit : 0;
  return result;
}

LscmSolution lscm_response(const ConformalEnergy& energy, const ComplexVector& force, ReducedFactor& factor,
                           const Progress& progress, double tolerance) {
  return LscmSystem(energy, ComplexVector::Zero(energy.n_vertices()), &force, factor, progress).solve(tolerance);
}

}  // namespace spectral_conformal
