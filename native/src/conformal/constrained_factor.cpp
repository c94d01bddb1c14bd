#include "conformal/constrained_factor.h"

#include <algorithm>
#include <utility>

#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

using Eigen::VectorXd;
using Expansion = LinearConstraints::Expansion;

/// Adds numbers on real unknowns to parts of complex ones.
void add_to_part(double value, bool is_imaginary, Complex& sum) {
  sum += is_imaginary ? Complex(0, value) : Complex(value);
}
double part_of(const Complex& value, bool is_imaginary) { return is_imaginary ? value.imag() : value.real(); }

}  // namespace

bool Springs::match(const Springs& others) const {
  const auto have_same_end = [](const auto& a, const auto& b) { return a.first == b.first; };
  return stiffness == others.stiffness &&
         std::equal(targets.begin(), targets.end(), others.targets.begin(), others.targets.end(), have_same_end);
}

ConstrainedFactor ConstrainedFactor::of(const HermitianMatrix& matrix, LinearConstraints constraints,
                                        const BoundaryForm& form, const Positions& positions, double relative_shift,
                                        FactorizationBackend backend, const Progress& progress) {
  ConstrainedFactor result;
  result.adopt(std::move(constraints));
  result.relative_shift_ = relative_shift;
  result.factorize(matrix, &form, positions, relative_shift, backend, progress);
  return result;
}

ConstrainedFactor ConstrainedFactor::of_held(const ConformalEnergy& energy, LinearConstraints constraints,
                                             const Positions& positions, FactorizationBackend backend,
                                             const Progress& progress, Springs springs) {
  HermitianMatrix matrix = energy.matrix();
  // The diagonal comes first in each column.
  for (const auto& spring : springs.targets)
    matrix.valuePtr()[matrix.outerIndexPtr()[spring.first]] += springs.stiffness;
  ConstrainedFactor result;
  result.adopt(std::move(constraints), std::move(springs));
  // Well above the rounding of the diagonal; the refinement of a solution removes it.
  result.factorize(matrix, nullptr, positions, 100 * epsilon, backend, progress);
  return result;
}

void ConstrainedFactor::factorize(const HermitianMatrix& matrix, const BoundaryForm* form, const Positions& positions,
                                  double relative_shift, FactorizationBackend backend, const Progress& progress) {
  for (const int axis : {0, 1}) {
    VectorXd along = constraints_.translation(axis);
    if (along.size() > 0 && springs_.targets.empty()) translations_.push_back(std::move(along));
  }
  if (constraints_.n_unknowns() == 0) return;
  std::unique_ptr<Factorization> factorization = make_factorization(backend, constraints_.n_unknowns());
  report(progress, 0.0, "ordering");
  unknowns_ = mixed_unknowns(constraints_, matrix, positions, *factorization);
  HermitianMatrix reduced = mixed_matrix(matrix, constraints_, unknowns_);
  VectorXd mass = VectorXd::Zero(reduced.rows());
  if (form) {
    for (std::size_t i = 0; i < form->vertices.size(); ++i) {
      for (int axis = 0; axis < 2; ++axis) {
        for (Expansion::InnerIterator it(constraints_.expansion(), 2 * form->vertices[i] + axis); it; ++it) {
          if (unknowns_.is_imaginary[it.col()]) continue;
          mass[unknowns_.row[it.col()]] += it.value() * it.value() * form->mass[static_cast<Eigen::Index>(i)];
        }
      }
    }
  } else {
    for (int k = 0; k < reduced.rows(); ++k) mass[k] = reduced.valuePtr()[reduced.outerIndexPtr()[k]].real();
  }
  BoundaryForm diagonal;
  for (int k = 0; k < mass.size(); ++k) {
    if (mass[k] > 0) diagonal.vertices.push_back(k);
  }
  diagonal.mass = mass(diagonal.vertices);
  if (unknowns_.is_ordered) {
    factorization->analyze_in_order(reduced, unknowns_.is_real);
  } else {
    Positions at(constraints_.n_unknowns(), 3);
    for (int k = 0; k < constraints_.n_unknowns(); ++k) {
      const int vertex = constraints_.coordinates()[static_cast<std::size_t>(k)] / 2;
      at.row(k) = positions.row(vertex < positions.rows() ? vertex : 0);  // the origin is anywhere
    }
    factorization->analyze(reduced, &at);
  }
  factor_ = factor_shifted(std::move(reduced), positions, diagonal, relative_shift, backend, progress,
                           std::move(factorization));
}

bool ConstrainedFactor::serves(const LinearConstraints& constraints, double relative_shift) const {
  const Expansion& a = constraints_.expansion();
  const Expansion& b = constraints.expansion();
  return relative_shift == relative_shift_ && a.rows() == b.rows() && a.cols() == b.cols() &&
         a.nonZeros() == b.nonZeros() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.rows() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr()) &&
         std::equal(a.valuePtr(), a.valuePtr() + a.nonZeros(), b.valuePtr());
}

void ConstrainedFactor::remove_translations(VectorXd& w) const {
  for (const VectorXd& along : translations_) w -= along.dot(w) / along.squaredNorm() * along;
}

VectorXd ConstrainedFactor::solve_unknowns(const VectorXd& f) {
  if (constraints_.n_unknowns() == 0) return {};
  ComplexVector x = ComplexVector::Zero(unknowns_.size());
  for (Eigen::Index k = 0; k < f.size(); ++k) {
    add_to_part(f[k], unknowns_.is_imaginary[k], x[unknowns_.row[k]]);
  }
  factor_.factorization->solve(x, x);
  VectorXd w = unknowns_of(x);
  remove_translations(w);
  return w;
}

void ConstrainedFactor::select(const std::vector<int>& unknowns) {
  selected_ = unknowns;
  row_of_selected_.clear();
  std::vector<int> rows;
  std::vector<int> index(static_cast<std::size_t>(unknowns_.size()), -1);
  for (const int k : unknowns) {
    int& at = index[unknowns_.row[k]];
    if (at < 0) {
      at = static_cast<int>(rows.size());
      rows.push_back(unknowns_.row[k]);
    }
    row_of_selected_.push_back(at);
  }
  n_rows_ = static_cast<Eigen::Index>(rows.size());
  factor_.factorization->select(std::move(rows));
}

ComplexVector ConstrainedFactor::on_rows(const VectorXd& f) const {
  ComplexVector result = ComplexVector::Zero(n_rows_);
  for (Eigen::Index i = 0; i < f.size(); ++i) {
    add_to_part(f[i], unknowns_.is_imaginary[selected_[i]], result[row_of_selected_[i]]);
  }
  return result;
}

void ConstrainedFactor::solve_selected(const VectorXd& f, VectorXd& y) {
  ComplexVector x;
  factor_.factorization->solve_selected(on_rows(f), x);
  y.resize(f.size());
  for (Eigen::Index i = 0; i < y.size(); ++i)
    y[i] = part_of(x[row_of_selected_[i]], unknowns_.is_imaginary[selected_[i]]);
}

VectorXd ConstrainedFactor::solve_from_selected(const VectorXd& f) {
  ComplexVector x;
  factor_.factorization->solve_from_selected(on_rows(f), x);
  return unknowns_of(x);
}

VectorXd ConstrainedFactor::unknowns_of(const ComplexVector& rows) const {
  VectorXd w(constraints_.n_unknowns());
  for (Eigen::Index k = 0; k < w.size(); ++k) w[k] = part_of(rows[unknowns_.row[k]], unknowns_.is_imaginary[k]);
  return w;
}

}  // namespace spectral_conformal
