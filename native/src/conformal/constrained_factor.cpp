#include "conformal/constrained_factor.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace spectral_conformal {
namespace {

using Eigen::VectorXd;
using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The lower triangle of P^T L P, where L acts on real coordinates.
HermitianMatrix reduced_matrix(const HermitianMatrix& matrix, const LinearConstraints& constraints) {
  const RowMatrix& p = constraints.expansion();
  std::vector<Eigen::Triplet<Complex>> entries;
  entries.reserve(static_cast<std::size_t>(2 * matrix.nonZeros()));
  // Inside the patch the imaginary parts cancel: u and v are coupled on its border only, and so is their factor.
  const auto add = [&](int row, int column, double value) {
    if (value == 0) return;
    for (RowMatrix::InnerIterator a(p, row); a; ++a) {
      for (RowMatrix::InnerIterator b(p, column); b; ++b) {
        const auto [low, high] = std::minmax({static_cast<int>(a.col()), static_cast<int>(b.col())});
        // An entry off the diagonal stands for its mirror image as well; on it, each pair (a, b) occurs twice.
        if (row == column && a.col() < b.col()) continue;
        const double twice = row != column && low == high ? 2 : 1;
        entries.emplace_back(high, low, twice * a.value() * b.value() * value);
      }
    }
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
  return lower_triangle(constraints.n_unknowns(), entries);
}

}  // namespace

ConstrainedFactor::ConstrainedFactor(const HermitianMatrix& matrix, LinearConstraints constraints,
                                     const BoundaryForm& form, const Positions& positions, double relative_shift,
                                     FactorizationBackend backend, const Progress& progress)
    : constraints_(std::move(constraints)), relative_shift_(relative_shift) {
  VectorXd mass = VectorXd::Zero(constraints_.n_unknowns());
  for (std::size_t i = 0; i < form.vertices.size(); ++i) {
    for (int axis = 0; axis < 2; ++axis) {
      for (RowMatrix::InnerIterator it(constraints_.expansion(), 2 * form.vertices[i] + axis); it; ++it) {
        mass[it.col()] += it.value() * it.value() * form.mass[static_cast<Eigen::Index>(i)];
      }
    }
  }
  BoundaryForm diagonal;
  for (int k = 0; k < constraints_.n_unknowns(); ++k) {
    if (mass[k] > 0) diagonal.vertices.push_back(k);
  }
  diagonal.mass.resize(static_cast<Eigen::Index>(diagonal.vertices.size()));
  for (Eigen::Index i = 0; i < diagonal.mass.size(); ++i) {
    diagonal.mass[i] = mass[diagonal.vertices[static_cast<std::size_t>(i)]];
  }
  factorize(reduced_matrix(matrix, constraints_), diagonal, positions, relative_shift, backend, progress);
}

ConstrainedFactor::ConstrainedFactor(const ConformalEnergy& energy, LinearConstraints constraints,
                                     const Positions& positions, FactorizationBackend backend, const Progress& progress)
    : constraints_(std::move(constraints)), relative_shift_(0) {
  HermitianMatrix matrix = reduced_matrix(energy.matrix(), constraints_);
  BoundaryForm diagonal{std::vector<int>(static_cast<std::size_t>(matrix.rows())), VectorXd(matrix.rows())};
  std::iota(diagonal.vertices.begin(), diagonal.vertices.end(), 0);
  for (int k = 0; k < matrix.rows(); ++k) diagonal.mass[k] = matrix.valuePtr()[matrix.outerIndexPtr()[k]].real();
  // Well above the rounding of the diagonal; the refinement of a solution removes it.
  constexpr double least_shift = 1e-14;
  factorize(std::move(matrix), diagonal, positions, least_shift, backend, progress);
}

void ConstrainedFactor::factorize(HermitianMatrix&& matrix, const BoundaryForm& diagonal, const Positions& positions,
                                  double relative_shift, FactorizationBackend backend, const Progress& progress) {
  Positions at(constraints_.n_unknowns(), 3);
  for (int k = 0; k < constraints_.n_unknowns(); ++k) {
    const int vertex = constraints_.coordinates()[static_cast<std::size_t>(k)] / 2;
    // The origin is anywhere.
    at.row(k) = positions.row(vertex < positions.rows() ? vertex : 0);
  }
  for (const int axis : {0, 1}) {
    VectorXd along = constraints_.translation(axis);
    if (along.size() > 0) translations_.push_back(std::move(along));
  }
  factor_ = factor_shifted(std::move(matrix), at, diagonal, relative_shift, backend, progress);
}

bool ConstrainedFactor::serves(const LinearConstraints& constraints, double relative_shift) const {
  const RowMatrix& a = constraints_.expansion();
  const RowMatrix& b = constraints.expansion();
  return relative_shift == relative_shift_ && a.rows() == b.rows() && a.cols() == b.cols() &&
         a.nonZeros() == b.nonZeros() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.rows() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr()) &&
         std::equal(a.valuePtr(), a.valuePtr() + a.nonZeros(), b.valuePtr());
}

void ConstrainedFactor::remove_translations(VectorXd& w) const {
  for (const VectorXd& along : translations_) w -= along.dot(w) / along.squaredNorm() * along;
}

VectorXd ConstrainedFactor::solve(const ComplexVector& b) {
  if (constraints_.n_unknowns() == 0) return {};
  VectorXd w = constraints_.gathered(b);
  factorization().solve(w, w);
  remove_translations(w);
  return w;
}

}  // namespace spectral_conformal
