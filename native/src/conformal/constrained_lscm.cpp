#include "conformal/constrained_lscm.h"

#include "conformal/conjugate_gradients.h"

namespace spectral_conformal {

namespace {

/// A solution in progress: P^T L x = P^T force for x = P w + offset, or with springs P^T (L + S) x = P^T (force + S
/// targets).
class ConstrainedSystem {
 public:
  ConstrainedSystem(const ConformalEnergy& energy, const ComplexVector& offset, const ComplexVector* force,
                    ConstrainedFactor& factor, const Progress& progress)
      : energy_(energy),
        offset_(offset),
        force_(force),
        factor_(factor),
        progress_(progress),
        w_(Eigen::VectorXd::Zero(factor.constraints().n_unknowns())),
        x_(offset) {}

  /// Takes whole steps, or, if these do not resolve the map, as on long strips, conjugate gradients.
  PinnedSolution solve() {
    PinnedSolution result;
    double before = infinity;
    while (true) {
      report(progress_, 0.8, "solve");
      const Eigen::VectorXd r = residual();
      result.residual = r.norm();
      if (!(result.residual < 0.5 * before)) break;  // rounding is reached
      before = result.residual;
      const Eigen::VectorXd step = preconditioned(r);
      w_ += step;
      x_ = expanded(w_) + offset_;
      result.change = relative(step);
    }
    if (!(result.change < single_epsilon)) {
      result.change = conjugate_gradients<Eigen::VectorXd>(*this);
      result.residual = residual().norm();
    }
    result.vector = x_;
    return result;
  }

  // Of conjugate_gradients.h.
  Eigen::VectorXd residual() {
    energy_.apply(x_, gradient_);
    if (force_) gradient_ -= *force_;
    const auto& [targets, stiffness] = factor_.springs();
    // A response has its ends at rest.
    for (const auto& [vertex, target] : targets) {
      gradient_[vertex] += stiffness * (x_[vertex] - (force_ ? Complex(0) : target));
    }
    return -factor_.constraints().gathered(gradient_);
  }
  Eigen::VectorXd preconditioned(const Eigen::VectorXd& r) { return factor_.solve_unknowns(r); }
  double curvature(const Eigen::VectorXd& p) {
    direction_ = p;
    const ComplexVector whole = expanded(p);
    double result = energy_.apply(whole, gradient_);
    for (const auto& [vertex, target] : factor_.springs().targets) {
      result += factor_.springs().stiffness * std::norm(whole[vertex]);
    }
    return result;
  }
  void move(double alpha) {
    w_ += alpha * direction_;
    x_ = expanded(w_) + offset_;
  }
  double relative(const Eigen::VectorXd& step) const {
    return expanded(step).norm() / (x_.array() - x_.mean()).matrix().norm();
  }
  void still_working(int k) const { report(progress_, 1.0 - 0.2 / (1.0 + 0.05 * k), "solve"); }

 private:
  ComplexVector expanded(const Eigen::VectorXd& w) const { return factor_.constraints().expanded(w); }

  const ConformalEnergy& energy_;
  const ComplexVector& offset_;
  const ComplexVector* force_;  ///< or none
  ConstrainedFactor& factor_;
  const Progress& progress_;
  Eigen::VectorXd w_;
  ComplexVector x_;
  ComplexVector gradient_;
  Eigen::VectorXd direction_;  ///< of conjugate gradients
};

}  // namespace

PinnedSolution solve_constrained_lscm(const ConformalEnergy& energy, ConstrainedFactor& factor,
                                      const Progress& progress) {
  PinnedSolution result = ConstrainedSystem(energy, factor.constraints().offset(), nullptr, factor, progress).solve();
  const double unit = energy.max_diagonal() * (result.vector.array() - result.vector.mean()).abs().maxCoeff();
  result.residual = unit > 0 ? result.residual / unit : 0;
  return result;
}

PinnedSolution constrained_response(const ConformalEnergy& energy, const ComplexVector& force,
                                    ConstrainedFactor& factor, const Progress& progress) {
  const ComplexVector origin = ComplexVector::Zero(energy.n_vertices());
  return ConstrainedSystem(energy, origin, &force, factor, progress).solve();
}

}  // namespace spectral_conformal
