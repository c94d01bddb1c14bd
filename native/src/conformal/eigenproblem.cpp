#include "conformal/eigenproblem.h"

#include <Spectra/SymEigsSolver.h>
#include <Spectra/SymGEigsSolver.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "concurrency/listening.h"
#include "conformal/correction.h"
#include "conformal/lanczos.h"
#include "conformal/start_vector.h"
#include "conformal/subspace.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

/// The operator T of solve_eigenproblem on the vertices that carry mass, which the factorization must have selected.
class ReducedOperator {
 public:
  using Scalar = double;  // Spectra sees the real view

  ReducedOperator(Factorization& factorization, const BoundaryForm& form, const Progress& progress)
      : factorization_(factorization),
        form_(form),
        progress_(progress),
        root_mass_(form.mass.cwiseSqrt().cast<Complex>()),
        constant_(root_mass_ / root_mass_.norm()) {}

  Eigen::Index size() const { return form_.mass.size(); }
  Eigen::Index rows() const { return 2 * size(); }
  Eigen::Index cols() const { return rows(); }
  int solves() const { return solves_; }

  void project(Eigen::Ref<ComplexVector> y) const {
    const Complex along = constant_.dot(y);
    y -= along * constant_;
  }

  /// z = (L + s M)^-1 S M^1/2 y.
  void extend(const ComplexVector& y, ComplexVector& z) const {
    weighted_ = root_mass_.cwiseProduct(y);
    factorization_.solve_from_selected(weighted_, z);
    ++solves_;
  }

  /// M^1/2 S^T z, projected.
  void restrict_to_mass(const ComplexVector& z, Eigen::Ref<ComplexVector> y) const {
    for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = root_mass_[i] * z[form_.vertices[i]];
    project(y);
  }

  /// y = T x, both on the real view.
  void perform_op(const double* x, double* y) const {
    Eigen::Map<ComplexVector> result(reinterpret_cast<Complex*>(y), size());
    interruption_.guard([&] {
      report(progress_, 1.0 - 1.0 / (1.0 + 0.1 * solves_), "eigenproblem");
      weighted_ = Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(x), size());
      project(weighted_);
      weighted_ = root_mass_.cwiseProduct(weighted_).eval();
      factorization_.solve_selected(weighted_, solved_);  // S^T (L + s M)^-1 S of Eq. 7, reduced
      ++solves_;
      result = root_mass_.cwiseProduct(solved_);
      project(result);
    });
  }
  bool interrupted() const { return interruption_.happened(); }

 private:
  Factorization& factorization_;
  const BoundaryForm& form_;
  const Progress& progress_;
  ComplexVector root_mass_;
  ComplexVector constant_;
  // Work space; mutable because Spectra takes the operator by const reference.
  mutable ComplexVector weighted_;
  mutable ComplexVector solved_;
  mutable int solves_ = 0;
  mutable Interruption interruption_;
};

// The operators of Spectra's regular inverse mode, B z = mu (L + s M) z, on the real view.

/// B = A.
class AreaOperator {
 public:
  using Scalar = double;
  AreaOperator(const ConformalEnergy& energy, std::shared_ptr<const HermitianMatrix> matrix)
      : energy_(energy), matrix_(std::move(matrix)) {}
  Eigen::Index rows() const { return 2 * matrix_->rows(); }
  Eigen::Index cols() const { return rows(); }
  /// A z, where A is minus the imaginary part of L: A_ij = -i Im L_ij.
  void apply(const ComplexVector& z, ComplexVector& result) const {
    result.setZero(z.size());
    for (int column = 0; column < matrix_->outerSize(); ++column) {
      for (HermitianMatrix::InnerIterator it(*matrix_, column); it; ++it) {
        const Complex entry(0, -it.value().imag());
        if (it.row() == column || entry == 0.0) continue;
        result[it.row()] += entry * z[column];
        result[column] += std::conj(entry) * z[it.row()];
      }
    }
  }
  double value(const ComplexVector& z) const { return energy_.area_form(z); }
  void perform_op(const double* x, double* y) const {
    const ComplexVector in = Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(x), matrix_->rows());
    ComplexVector out;
    apply(in, out);
    Eigen::Map<ComplexVector>(reinterpret_cast<Complex*>(y), matrix_->rows()) = out;
  }

 private:
  const ConformalEnergy& energy_;
  std::shared_ptr<const HermitianMatrix> matrix_;  ///< L
};

/// L. Not copied: the constructor of Eigen's sparse matrix leaks if memory runs out.
std::shared_ptr<const HermitianMatrix> shared_matrix(const ConformalEnergy& energy) {
  auto result = std::make_shared<HermitianMatrix>();
  energy.matrix().swap(*result);
  return result;
}

QuotientForm quotient_form(const AreaOperator& area) {
  return {[area](const ComplexVector& z) { return area.value(z); },
          [area, image = ComplexVector()](const ComplexVector& z, double factor, ComplexVector& sum) mutable {
            area.apply(z, image);
            sum += factor * image;
          }};
}

class ShiftedOperator {
 public:
  using Scalar = double;
  ShiftedOperator(Factorization& factorization, const HermitianMatrix& matrix, const BoundaryForm& form, double shift,
                  const Progress& progress)
      : factorization_(factorization), matrix_(matrix), form_(form), shift_(shift), progress_(progress) {}
  Eigen::Index rows() const { return 2 * matrix_.rows(); }
  Eigen::Index cols() const { return rows(); }
  int solves() const { return solves_; }
  bool interrupted() const { return interruption_.happened(); }
  void solve(const double* x, double* y) const {
    interruption_.guard([&] { smooth(x, y); });
  }
  void perform_op(const double* x, double* y) const {
    const Eigen::Map<const ComplexVector> in(reinterpret_cast<const Complex*>(x), matrix_.rows());
    ComplexVector out = matrix_.selfadjointView<Eigen::Lower>() * in;
    for (std::size_t i = 0; i < form_.vertices.size(); ++i) {
      out[form_.vertices[i]] += shift_ * form_.mass[i] * in[form_.vertices[i]];
    }
    Eigen::Map<ComplexVector>(reinterpret_cast<Complex*>(y), matrix_.rows()) = out;
    interruption_.guard([&] { still_working(10 * static_cast<double>(matrix_.nonZeros())); });
  }

 private:
  void smooth(const double* x, double* y) const {
    report(progress_, 1.0 - 1.0 / (1.0 + 0.05 * solves_), "eigenproblem");
    const ComplexVector in = Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(x), matrix_.rows());
    ComplexVector out;
    factorization_.solve(in, out);
    // Constants carry no area, and the solve amplifies their rounding errors.
    out.array() -= out.mean();
    Eigen::Map<ComplexVector>(reinterpret_cast<Complex*>(y), matrix_.rows()) = out;
    ++solves_;
  }

  Factorization& factorization_;
  const HermitianMatrix& matrix_;
  const BoundaryForm& form_;
  double shift_;
  const Progress& progress_;
  // Spectra takes the operator by const reference.
  mutable int solves_ = 0;
  mutable Interruption interruption_;
};

}  // namespace

Eigenpair solve_eigenproblem(Factorization& factorization, const BoundaryForm& form, const EigenproblemOptions& options,
                             const Progress& progress) {
  factorization.select(form.vertices);
  ReducedOperator op(factorization, form, progress);
  const Eigen::Index n = op.size();
  Eigenpair result;
  ComplexVector y;
  if (n <= max_dimension) {
    // Column by column: as many solves as a few restarts of Lanczos, without its failures on tiny spaces.
    Eigen::MatrixXcd dense(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const ComplexVector unit = ComplexVector::Unit(n, j);
      op.perform_op(reinterpret_cast<const double*>(unit.data()), reinterpret_cast<double*>(dense.col(j).data()));
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(0.5 * (dense + dense.adjoint()));
    y = solver.eigenvectors().col(n - 1);
  } else {
    ComplexVector start = start_vector(form, options.start);
    op.project(start);
    Spectra::SymEigsSolver<ReducedOperator> solver(op, 1, options.krylov_dimension);
    solver.init(reinterpret_cast<const double*>(start.data()));
    const bool converged = converges(solver, op, options);
    result.solves = op.solves();
    if (!converged) return result;
    const Eigen::VectorXd real = solver.eigenvectors(1);
    y = Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(real.data()), n);
  }
  // One more application gives the values at the other vertices, and the residual.
  op.project(y);
  y.normalize();
  op.extend(y, result.vector);
  ComplexVector image(n);
  op.restrict_to_mass(result.vector, image);
  result.mu = y.dot(image).real();
  result.residual = (image - result.mu * y).norm() / result.mu;
  result.vector /= result.mu;
  result.solves = op.solves();
  result.converged = result.mu > 0 && std::isfinite(result.residual);
  return result;
}

Eigenpair solve_area_eigenproblem(ReducedFactor& factor, const ConformalEnergy& energy, const BoundaryForm& form,
                                  const EigenproblemOptions& options, const Progress& progress) {
  const Eigen::Index n = energy.n_vertices();
  const auto matrix = shared_matrix(energy);
  AreaOperator area(energy, matrix);  // Spectra wants it mutable
  ShiftedOperator shifted(factor.factorization(), *matrix, form, factor.shift(), progress);
  const ComplexVector on_boundary = start_vector(form, options.start);
  ComplexVector start = ComplexVector::Zero(n);
  for (std::size_t i = 0; i < form.vertices.size(); ++i) start[form.vertices[i]] = on_boundary[i];
  Eigenpair result;
  // Negative eigenvalues occupy part of the space.
  const int dimension = std::min<int>(std::max(options.krylov_dimension, max_dimension / 2), static_cast<int>(2 * n));
  Spectra::SymGEigsSolver<AreaOperator, ShiftedOperator, Spectra::GEigsMode::RegularInverse> solver(area, shifted, 1,
                                                                                                    dimension);
  ComplexVector smooth(n);
  shifted.solve(reinterpret_cast<const double*>(start.data()), reinterpret_cast<double*>(smooth.data()));
  solver.init(reinterpret_cast<const double*>(smooth.data()));
  const bool converged = converges(solver, shifted, options);
  result.solves = shifted.solves();
  if (!converged) return result;
  const Eigen::VectorXd real = solver.eigenvectors(1);
  result.vector = Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(real.data()), n);
  result.mu = solver.eigenvalues()[0];
  const QuotientForm quotient = quotient_form(area);
  CorrectionOptions corrections;
  corrections.max_corrections = 30;                   // a bound: they stop when they no longer fall
  corrections.negligible = 0.01 * options.tolerance;  // so that the error of Lanczos does not show in the result
  corrections.only_falling = true;  // negative eigenvalues larger than mu in magnitude make the changes grow
  const Correction correction = correct(factor, energy, quotient, corrections, result.vector);
  result.solves += correction.solves;
  result.residual = correction.change;
  result.converged = result.residual < single_epsilon && result.vector.allFinite() && area.value(result.vector) > 0;
  return result;
}

QuotientForm area_quotient(const ConformalEnergy& energy) {
  return quotient_form(AreaOperator(energy, shared_matrix(energy)));
}

}  // namespace spectral_conformal
