#include "conformal/extended_eigenproblem.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "conformal/correction.h"
#include "conformal/start_vector.h"

namespace spectral_conformal {
namespace {

using Matrix = Eigen::MatrixXcd;

/// The subspace of the Rayleigh-Ritz method for B_S G w = mu w in the inner product of G.
class RitzSpace {
 public:
  RitzSpace(Factorization& factorization, const ExtendedForm& form) : factorization_(factorization), form_(form) {
    factorization_.select(form.support());
  }

  /// Takes the vectors of an earlier space with the same factor and support.
  void take(const RitzBasis& basis) {
    vectors_ = basis.vectors;
    images_ = basis.images;
    forces_.resize(images_.rows(), images_.cols());
    ComplexVector force;
    for (Eigen::Index j = 0; j < images_.cols(); ++j) {
      form_.apply(images_.col(j), force);
      forces_.col(j) = force;
    }
    rayleigh_ritz();
  }

  /// Adds a direction w. Returns its length in G before orthogonalization; 0 if nothing was added.
  double grow(ComplexVector w) {
    for (int pass = 0; pass < 2; ++pass) {
      // The constant has length 1/s in G: its rounding error would drown the rest.
      w.array() -= w.mean();
      if (size() > 0) w -= vectors_ * (images_.adjoint() * w);
    }
    ComplexVector y;
    factorization_.solve_selected(w, y);
    ++solves_;
    y.array() -= y.mean();
    if (size() > 0) {
      const ComplexVector along = vectors_.adjoint() * y;
      w -= vectors_ * along;
      y -= images_ * along;
    }
    const double square = w.dot(y).real();
    if (!(square > 0) || !std::isfinite(square)) return 0;
    const double length = std::sqrt(square);
    const Eigen::Index n = size();
    vectors_.conservativeResize(w.size(), n + 1);
    images_.conservativeResize(w.size(), n + 1);
    forces_.conservativeResize(w.size(), n + 1);
    vectors_.col(n) = w / length;
    images_.col(n) = y / length;
    ComplexVector force;
    form_.apply(images_.col(n), force);
    forces_.col(n) = force;
    rayleigh_ritz();
    return length;
  }

  /// Keeps the best `count` Ritz vectors.
  void restart(Eigen::Index count) {
    const Matrix best = coefficients_.rightCols(std::min(count, size()));
    vectors_ = (vectors_ * best).eval();
    images_ = (images_ * best).eval();
    forces_ = (forces_ * best).eval();
    rayleigh_ritz();
  }

  Eigen::Index size() const { return vectors_.cols(); }
  int solves() const { return solves_; }
  double mu() const { return mu_; }
  /// B_S y - mu w of the best vector.
  ComplexVector residual() const { return force() - mu_ * (vectors_ * coefficients_.rightCols(1)); }
  /// B_S y of the best vector.
  ComplexVector force() const { return forces_ * coefficients_.rightCols(1); }
  RitzBasis basis() const { return {form_.support(), vectors_, images_}; }

 private:
  void rayleigh_ritz() {
    const Matrix projected = images_.adjoint() * forces_;
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(0.5 * (projected + projected.adjoint()));
    // Not assigned directly: Eigen 3.4 frees the old memory twice if there is none for the new size.
    coefficients_ = Matrix(solver.eigenvectors());
    mu_ = solver.eigenvalues().tail(1).value();
  }

  Factorization& factorization_;
  const ExtendedForm& form_;
  Matrix vectors_;       ///< w
  Matrix images_;        ///< y = G w
  Matrix forces_;        ///< B_S y
  Matrix coefficients_;  ///< of the Ritz vectors, ascending
  double mu_ = 0;
  int solves_ = 0;
};

/// Runs until the residual's length in G is below the tolerance or, because of rounding, no longer falls. Returns
/// whether it converged or, for tolerances below 1e-9, stopped near enough for the subsequent corrections.
bool converge(RitzSpace& space, const EigenproblemOptions& options, const Progress& progress) {
  const int max_solves = options.max_restarts * options.krylov_dimension;
  // About six restarts without halving the residual: rounding is the limit.
  const int patience = 20 * options.krylov_dimension;
  double best = infinity;
  int best_at = space.solves();
  while (space.solves() < max_solves && space.solves() - best_at < patience) {
    report(progress, 1.0 - 1.0 / (1.0 + 0.1 * space.solves()), "eigenproblem");
    const double length = space.grow(space.residual());
    if (!std::isfinite(space.mu())) return false;
    if (space.mu() > 0) {
      const double relative = length / space.mu();
      if (relative <= options.tolerance) return true;
      if (relative < 0.5 * best) {
        best = relative;
        best_at = space.solves();
      }
    }
    if (space.size() >= 4 * options.krylov_dimension) space.restart(options.krylov_dimension);
  }
  // The corrections still gain two digits.
  return best <= 0.01 * resolved_change;
}

}  // namespace

QuotientForm quotient_form(const ExtendedForm& form) {
  return {[&form](const ComplexVector& z) { return form.value(form.restrict(z)); },
          [&form](const ComplexVector& z, double factor, ComplexVector& sum) { form.add_applied(z, factor, sum); }};
}

std::vector<ComplexVector> starts_of(const ExtendedForm& form, const BoundaryForm& boundary, unsigned start,
                                     const ComplexVector& earlier) {
  ComplexVector circle = ComplexVector::Zero(static_cast<Eigen::Index>(form.support().size()));
  circle.head(boundary.mass.size()) =
      start_vector(boundary, start).cwiseQuotient(boundary.mass.cwiseSqrt().cast<Complex>());
  std::vector<ComplexVector> starts{std::move(circle)};
  if (earlier.size() > 0) starts.push_back(form.restrict(earlier));
  return starts;
}

Eigenpair solve_extended_eigenproblem(Factorization& factorization, const ConformalEnergy& energy,
                                      const ExtendedForm& form, const EigenproblemOptions& options,
                                      const std::vector<ComplexVector>& starts, RitzBasis& basis,
                                      const Progress& progress) {
  Eigenpair result;
  RitzSpace space(factorization, form);
  if (basis.support == form.support()) {
    space.take(basis);
  } else {
    ComplexVector force;
    for (const ComplexVector& start : starts) {
      form.apply(start, force);
      space.grow(force);
    }
  }
  result.residual = infinity;
  const bool converged = space.size() > 0 && converge(space, options, progress);
  result.solves = space.solves();
  if (!converged) return result;
  result.mu = space.mu();
  factorization.solve_from_selected(space.force(), result.vector);
  ++result.solves;
  result.vector.array() -= result.vector.mean();
  result.vector /= result.mu;
  space.restart(options.krylov_dimension);
  basis = space.basis();

  CorrectionOptions corrections;
  corrections.max_corrections = 12;  // a bound: exact steps stop when they reach rounding
  corrections.negligible = 0.1 * options.tolerance;
  corrections.exact_step = true;
  const Correction correction = correct(factorization, energy, quotient_form(form), corrections, result.vector);
  result.solves += correction.solves;
  result.residual = correction.change;
  result.converged =
      std::isfinite(result.residual) && result.vector.allFinite() && form.value(form.restrict(result.vector)) > 0;
  return result;
}

}  // namespace spectral_conformal
