#include "conformal/constrained_eigenproblem.h"

#include <Spectra/SymEigsSolver.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "conformal/correction.h"
#include "conformal/shifted_factor.h"
#include "conformal/start_vector.h"

namespace spectral_conformal {
namespace {

using Eigen::VectorXd;

/// The unknown of a coordinate, and its sign.
struct Unknown {
  int index;
  double sign;
};

Unknown unknown_of(const LinearConstraints& constraints, int coordinate) {
  const auto i = static_cast<std::size_t>(coordinate);
  return {constraints.unknown[i], static_cast<double>(constraints.sign[i])};
}

/// The lower triangle of P^T L P, where L acts on real coordinates: an entry a + i b of the complex form in row i and
/// column j stands for the block [a, -b; b, a].
HermitianMatrix reduced_matrix(const ConformalEnergy& energy, const LinearConstraints& constraints) {
  const HermitianMatrix matrix = energy.matrix();
  std::vector<Eigen::Triplet<Complex>> entries;
  entries.reserve(static_cast<std::size_t>(4 * matrix.nonZeros()));
  const auto add = [&](int row, int column, double value) {
    const Unknown p = unknown_of(constraints, row);
    const Unknown q = unknown_of(constraints, column);
    if (p.index < 0 || q.index < 0) return;
    // Off the diagonal the entry stands for its mirror image as well.
    const double twice = row != column && p.index == q.index ? 2 : 1;
    entries.emplace_back(std::max(p.index, q.index), std::min(p.index, q.index), twice * p.sign * q.sign * value);
  };
  for (int j = 0; j < matrix.outerSize(); ++j) {
    for (HermitianMatrix::InnerIterator it(matrix, j); it; ++it) {
      const int i = static_cast<int>(it.row());
      add(2 * i, 2 * j, it.value().real());
      add(2 * i + 1, 2 * j + 1, it.value().real());
      if (i == j) continue;
      add(2 * i, 2 * j + 1, -it.value().imag());
      add(2 * i + 1, 2 * j, it.value().imag());
    }
  }
  return lower_triangle(constraints.n_unknowns, entries);
}

/// P^T M P, diagonal.
BoundaryForm reduced_form(const BoundaryForm& form, const LinearConstraints& constraints) {
  VectorXd mass = VectorXd::Zero(constraints.n_unknowns);
  for (std::size_t i = 0; i < form.vertices.size(); ++i) {
    for (const int c : {2 * form.vertices[i], 2 * form.vertices[i] + 1}) {
      const int unknown = unknown_of(constraints, c).index;
      if (unknown >= 0) mass[unknown] += form.mass[static_cast<Eigen::Index>(i)];
    }
  }
  BoundaryForm result;
  for (int w = 0; w < mass.size(); ++w) {
    if (mass[w] > 0) result.vertices.push_back(w);
  }
  result.mass.resize(static_cast<Eigen::Index>(result.vertices.size()));
  for (std::size_t i = 0; i < result.vertices.size(); ++i) {
    result.mass[static_cast<Eigen::Index>(i)] = mass[result.vertices[i]];
  }
  return result;
}

/// The operator T of eigenproblem.h on the unknowns that carry mass, in real numbers.
class ConstrainedOperator {
 public:
  using Scalar = double;

  ConstrainedOperator(Factorization& factorization, const BoundaryForm& form, const std::vector<VectorXd>& constants,
                      Progress progress)
      : factorization_(factorization), form_(form), progress_(std::move(progress)), root_mass_(form.mass.cwiseSqrt()) {
    for (const VectorXd& constant : constants) {
      VectorXd y = root_mass_.cwiseProduct(VectorXd(constant(form.vertices)));
      if (y.norm() > 0) constants_.push_back(y.normalized());
    }
    factorization_.select(form.vertices);
  }

  Eigen::Index rows() const { return form_.mass.size(); }
  Eigen::Index cols() const { return rows(); }
  int solves() const { return solves_; }
  bool interrupted() const { return interrupted_; }
  void project(Eigen::Ref<VectorXd> y) const {
    for (const VectorXd& constant : constants_) y -= constant.dot(y) * constant;
  }
  /// w = (P^T (L + s M) P)^-1 S M^1/2 y.
  VectorXd extend(const VectorXd& y) const {
    weighted_ = root_mass_.cwiseProduct(y).cast<Complex>();
    factorization_.solve_from_selected(weighted_, solved_);
    ++solves_;
    return solved_.real();
  }
  void perform_op(const double* x, double* y) const {
    try {
      report(progress_, 1.0 - 1.0 / (1.0 + 0.1 * solves_), "eigenproblem");
      VectorXd in = Eigen::Map<const VectorXd>(x, rows());
      project(in);
      weighted_ = root_mass_.cwiseProduct(in).cast<Complex>();
      factorization_.solve_selected(weighted_, solved_);
      ++solves_;
      Eigen::Map<VectorXd> out(y, rows());
      out = root_mass_.cwiseProduct(solved_.real());
      project(out);
    } catch (...) {
      interrupted_ = true;
      throw;
    }
  }

 private:
  Factorization& factorization_;
  const BoundaryForm& form_;
  Progress progress_;
  VectorXd root_mass_;
  std::vector<VectorXd> constants_;
  // Spectra takes the operator by const reference.
  mutable ComplexVector weighted_;
  mutable ComplexVector solved_;
  mutable int solves_ = 0;
  mutable bool interrupted_ = false;
};

/// The eigenvector of the largest eigenvalue; empty if it was not found.
VectorXd largest_eigenvector(const ConstrainedOperator& op, VectorXd start) {
  constexpr int dense_limit = 24;  // as in eigenproblem.cpp
  const Eigen::Index n = op.rows();
  if (n <= dense_limit) {
    Eigen::MatrixXd dense(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const VectorXd unit = VectorXd::Unit(n, j);
      op.perform_op(unit.data(), dense.col(j).data());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (dense + dense.transpose()));
    return solver.eigenvectors().col(n - 1);
  }
  const EigenproblemOptions options;
  op.project(start);
  Spectra::SymEigsSolver<ConstrainedOperator> solver(const_cast<ConstrainedOperator&>(op), 1, options.krylov_dimension);
  solver.init(start.data());
  try {
    solver.compute(Spectra::SortRule::LargestAlge, options.max_restarts, options.tolerance);
  } catch (const std::runtime_error&) {
    if (op.interrupted()) throw;
    return {};
  }
  if (solver.info() != Spectra::CompInfo::Successful) return {};
  return solver.eigenvectors(1);
}

}  // namespace

ConstrainedEigenpair solve_constrained_eigenproblem(const ConformalEnergy& energy, const BoundaryForm& form,
                                                    const LinearConstraints& constraints, const Positions& positions,
                                                    double relative_shift, FactorizationBackend backend,
                                                    const Progress& progress) {
  ConstrainedEigenpair result;
  const BoundaryForm reduced = reduced_form(form, constraints);
  Positions at = Positions::Zero(constraints.n_unknowns, 3);
  for (int c = 0; c < static_cast<int>(constraints.unknown.size()); ++c) {
    const int unknown = unknown_of(constraints, c).index;
    if (unknown >= 0) at.row(unknown) = positions.row(c / 2);
  }
  const ShiftedFactor factor = factor_shifted(reduced_matrix(energy, constraints), at, reduced, relative_shift, backend,
                                              part(progress, 0.0, 0.6));
  result.shift = factor.shift;
  result.is_factored = factor.factorization != nullptr;
  if (!result.is_factored) return result;

  std::vector<VectorXd> constants;
  for (const int axis : {0, 1}) {
    VectorXd along = constraints.translation(axis);
    if (along.size() > 0) constants.push_back(std::move(along));
  }
  ConstrainedOperator op(*factor.factorization, reduced, constants, part(progress, 0.6, 1.0));
  ComplexVector circle = ComplexVector::Zero(energy.n_vertices());
  const ComplexVector on_boundary = start_vector(form, 0);
  for (std::size_t i = 0; i < form.vertices.size(); ++i) {
    circle[form.vertices[i]] = std::sqrt(form.mass[static_cast<Eigen::Index>(i)]) * on_boundary[i];
  }
  VectorXd start = VectorXd(constraints.gathered(circle)(reduced.vertices)).cwiseQuotient(reduced.mass.cwiseSqrt());
  VectorXd y = largest_eigenvector(op, std::move(start));
  result.pair.solves = op.solves();
  if (y.size() == 0) return result;
  op.project(y);
  VectorXd w = op.extend(y.normalized());

  // As in correction.h: removes the shift and the rounding of the factor, until the changes no longer fall.
  constexpr int max_corrections = 10;
  const QuotientForm quotient = quotient_form(form);
  ComplexVector residual;
  ComplexVector solved;
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; k < max_corrections; ++k) {
    for (const VectorXd& constant : constants) w -= constant.dot(w) / constant.squaredNorm() * constant;
    result.pair.vector = constraints.expanded(w);
    const double lambda = eigen_residual(energy, quotient, result.pair.vector, residual);
    result.pair.mu = 1 / lambda;
    factor.factorization->solve(constraints.gathered(residual).cast<Complex>(), solved);
    ++result.pair.solves;
    VectorXd change = solved.real();
    for (const VectorXd& constant : constants) change -= constant.dot(change) / constant.squaredNorm() * constant;
    result.change = change.norm() / w.norm();
    if (!(result.change < before) || result.change < 0.01 * resolved_change) break;
    before = result.change;
    w -= change;
  }
  result.pair.solves = std::max(result.pair.solves, op.solves());
  result.pair.residual = result.change;
  result.pair.converged = result.change < resolved_change && result.pair.vector.allFinite();
  return result;
}

}  // namespace spectral_conformal
