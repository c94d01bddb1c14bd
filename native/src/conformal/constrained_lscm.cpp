#include "conformal/constrained_lscm.h"

#include <algorithm>
#include <limits>

namespace spectral_conformal {

namespace {

/// P^T L x = P^T force for x = P w + offset. Returns the norm of the gradient that is left.
double solve_reduced(const ConformalEnergy& energy, const ComplexVector& offset, const ComplexVector* force,
                     ConstrainedFactor& factor, const Progress& progress, PinnedSolution& result) {
  // The first solve and its refinements, which stop when they reach rounding; a shift takes a few more.
  constexpr int max_solves = 10;
  const LinearConstraints& constraints = factor.constraints();
  Eigen::VectorXd w = Eigen::VectorXd::Zero(constraints.n_unknowns());
  result.vector = offset;
  ComplexVector gradient;
  double norm = 0;
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; k < max_solves; ++k) {
    report(progress, 0.8, "solve");
    energy.apply(result.vector, gradient);
    if (force) gradient -= *force;
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
  const HermitianMatrix& matrix = energy.matrix();
  double largest_diagonal = 0;
  for (int v = 0; v < energy.n_vertices(); ++v) {
    largest_diagonal = std::max(largest_diagonal, matrix.valuePtr()[matrix.outerIndexPtr()[v]].real());
  }
  const double extent = (result.vector.array() - result.vector.mean()).abs().maxCoeff();
  result.residual = extent > 0 && largest_diagonal > 0 ? norm / (largest_diagonal * extent) : 0;
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
