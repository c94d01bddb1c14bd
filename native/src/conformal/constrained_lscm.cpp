#include "conformal/constrained_lscm.h"

#include <algorithm>
#include <limits>

namespace spectral_conformal {

PinnedSolution solve_constrained_lscm(const ConformalEnergy& energy, ConstrainedFactor& factor,
                                      const Progress& progress) {
  // The first solve and its refinements, which stop when they reach rounding; a shift takes a few more.
  constexpr int max_solves = 10;
  const LinearConstraints& constraints = factor.constraints();
  PinnedSolution result;
  Eigen::VectorXd w = Eigen::VectorXd::Zero(constraints.n_unknowns());
  result.vector = constraints.offset();
  ComplexVector gradient;
  double norm = 0;
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; k < max_solves; ++k) {
    report(progress, 0.8, "solve");
    energy.apply(result.vector, gradient);
    norm = constraints.gathered(gradient).norm();
    if (!(norm < 0.5 * before)) break;  // rounding is reached
    before = norm;
    const Eigen::VectorXd step = factor.solve(gradient);
    w -= step;
    result.vector = constraints.expanded(w) + constraints.offset();
    result.change = constraints.expanded(step).norm() / (result.vector.array() - result.vector.mean()).matrix().norm();
  }
  const HermitianMatrix& matrix = energy.matrix();
  double largest_diagonal = 0;
  for (int v = 0; v < energy.n_vertices(); ++v) {
    largest_diagonal = std::max(largest_diagonal, matrix.valuePtr()[matrix.outerIndexPtr()[v]].real());
  }
  const double extent = (result.vector.array() - result.vector.mean()).abs().maxCoeff();
  result.residual = extent > 0 && largest_diagonal > 0 ? norm / (largest_diagonal * extent) : 0;
  return result;
}

}  // namespace spectral_conformal
