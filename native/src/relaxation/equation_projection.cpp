#include "relaxation/equation_projection.h"

#include <Eigen/SparseCore>
#include <utility>
#include <vector>

namespace spectral_conformal {
namespace {

/// Displacements of what is held are 0.
LinearEquations homogeneous(LinearEquations equations) {
  for (auto& [coordinate, value] : equations.held) value = 0;
  return equations;
}

}  // namespace

EquationProjection EquationProjection::of(LinearEquations equations, int n_vertices, FactorizationBackend backend) {
  EquationProjection result;
  result.constraints_ = LinearConstraints::of(homogeneous(std::move(equations)), n_vertices);
  const Eigen::Index n = result.constraints_.n_unknowns();
  if (n == 0) return result;
  const Eigen::SparseMatrix<double> p = result.constraints_.expansion();
  const Eigen::SparseMatrix<double> square = p.transpose() * p;
  std::vector<Eigen::Triplet<Complex>> entries;
  for (Eigen::Index k = 0; k < n; ++k) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(square, k); entry; ++entry) {
      if (entry.row() >= k) entries.emplace_back(static_cast<int>(entry.row()), static_cast<int>(k), entry.value());
    }
  }
  const HermitianMatrix matrix = lower_triangle(n, entries);
  result.factorization_ = make_factorization(backend, n);
  result.factorization_->analyze(matrix);
  result.factorization_->factorize(matrix);
  return result;
}

void EquationProjection::apply(ComplexVector& z) const {
  if (constraints_.n_unknowns() == 0) {
    z.setZero();
    return;
  }
  ComplexVector w = constraints_.gathered(z).cast<Complex>();
  factorization_->solve(w, w);
  z = constraints_.expanded(w.real());
}

}  // namespace spectral_conformal
