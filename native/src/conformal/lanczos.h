#pragma once

#include <Spectra/SymEigsSolver.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <optional>
#include <stdexcept>

#include "conformal/eigenproblem.h"
#include "conformal/subspace.h"

namespace spectral_conformal {

/// Keeps an exception that an operator threw while Spectra ran: from the progress function, a factorization or a lack
/// of memory. Spectra reports its own failures as std::runtime_error, so the type cannot tell them apart.
class Interruption {
 public:
  template <class Function>
  void guard(const Function& function) {
    try {
      function();
    } catch (...) {
      happened_ = true;
      throw;
    }
  }
  bool happened() const { return happened_; }

 private:
  bool happened_ = false;
};

/// Runs Lanczos. Spectra throws std::runtime_error if its small projected matrix is not finite or does not converge; an
/// exception of the operator passes through.
template <class Solver, class Operator>
bool converges(Solver& solver, const Operator& op, const EigenproblemOptions& options) {
  try {
    solver.compute(Spectra::SortRule::LargestAlge, options.max_restarts, options.tolerance);
  } catch (const std::runtime_error&) {
    if (op.interrupted()) throw;
    return false;
  }
  return solver.info() == Spectra::CompInfo::Successful;
}

/// The eigenvector of the largest eigenvalue of a self-adjoint operator on vectors of the type Operator::Vector, by
/// implicitly restarted Lanczos (Spectra) on their real view; small ones are formed densely, column by column. Empty if
/// it does not converge. The operator has size(), rows() of the real view, perform_op(x, y) on it and interrupted().
template <class Operator>
std::optional<typename Operator::Vector> largest_eigenvector(Operator& op, const typename Operator::Vector& start,
                                                             const EigenproblemOptions& options) {
  using Vector = typename Operator::Vector;
  using Dense = Eigen::Matrix<typename Vector::Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  const Eigen::Index n = op.size();
  // Costs as many solves as a few restarts of Lanczos, without its failures on tiny spaces.
  if (n <= max_dimension) {
    Dense dense(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const Vector unit = Vector::Unit(n, j);
      op.perform_op(reinterpret_cast<const double*>(unit.data()), reinterpret_cast<double*>(dense.col(j).data()));
    }
    const Eigen::SelfAdjointEigenSolver<Dense> solver(0.5 * (dense + dense.adjoint()));
    return Vector(solver.eigenvectors().col(n - 1));
  }
  const int dimension = std::min<int>(options.krylov_dimension, static_cast<int>(op.rows()));
  Spectra::SymEigsSolver<Operator> solver(op, 1, dimension);
  solver.init(reinterpret_cast<const double*>(start.data()));
  if (!converges(solver, op, options)) return std::nullopt;
  const Eigen::VectorXd real = solver.eigenvectors(1);
  return Vector(Eigen::Map<const Vector>(reinterpret_cast<const typename Vector::Scalar*>(real.data()), n));
}

}  // namespace spectral_conformal
