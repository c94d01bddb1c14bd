#include "conformal/constrained_lscm.h"

namespace spectral_conformal {

namespace {

/// P^T L x = P^T force for x = P w + offset, or with springs P^T (L + S) x = P^T (force + S targets). Returns the norm
/// of the gradient that is left.
double solve_reduced(const ConformalEnergy& energy, const ComplexVector& offset, const ComplexVector* force,
                     ConstrainedFactor& factor, const Progress& progress, PinnedSolution& result) {
  const LinearConstraints& constraints = factor.constraints();
  Eigen::VectorXd w = Eigen::VectorXd::Zero(constraints.n_unknowns());
  result.vector = offset;
  ComplexVector gradient;
  double norm = 0;
  double before = infinity;
  while (true) {
    report(progress, 0.8, "solve");
    energy.apply(result.vector, gradient);
    if (force) gradient -= *force;
    const auto& [targets, stiffness] = factor.springs();
    // A response has its ends at rest.
    for (const auto& [vertex, target] : targets) {
      gradient[vertex] += stiffness * (result.vector[vertex] - (force ? Complex(0) : target));
    }
    norm = constraints.gathered(gradient).norm();
    if (!(norm < 0.5 * before)) break;  // rounding is reached
    before = norm;
    const Eigen::VectorXd step = factor.solve(gradient);
    w -= step;
    result.vector = constraints.expanded(w) + offset;
    result.change = constraints.expanded(step).norm() / (result.vector.array() - result.vector.mean()).matrix().norm();
  }
  return norm;
}

}  // namespace

PinnedSolution solve_constrained_lscm(const ConformalEnergy& energy, ConstrainedFactor& factor,
                                      const Progress& progress) {
  PinnedSolution result;
  const ComplexVector offset = factor.constraints().offset();
  const double norm = solve_reduced(energy, offset, nullptr, factor, progress, result);
  const double unit = energy.max_diagonal() * (result.vector.array() - result.vector.mean()).abs().maxCoeff();
  result.residual = unit > 0 ? norm / unit : 0;
  return result;
}

PinnedSolution constrained_response(const ConformalEnergy& energy, const ComplexVector& force,
                                    ConstrainedFactor& factor, const Progress& progress) {
  PinnedSolution result;
  const ComplexVector origin = ComplexVector::Zero(energy.n_vertices());
  solve_reduced(energy, origin, &force, factor, progress, result);
  return result;
}

}  // namespace spectral_conformal
