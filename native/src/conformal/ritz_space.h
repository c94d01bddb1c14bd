#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "conformal/eigenproblem.h"
#include "conformal/subspace.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Approximate eigenvectors of an earlier solve with the same factor, as a start for the next one: W^H G W = I and
/// images = G W up to translations.
template <class Scalar>
struct RitzBasis {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  std::vector<int> support;
  Matrix vectors;  ///< W (n, m)
  Matrix images;   ///< G W (n, m)
};

/// The subspace of the Rayleigh-Ritz method for B G w = mu w in the inner product of G, the largest mu. B is any
/// self-adjoint form on a few unknowns, its support; G the inverse of K, restricted to them. A Problem has
///   Scalar, of its vectors;
///   const std::vector<int>& support();
///   void solve(const Vector& w, Vector& y), y = G w;
///   void apply(const Vector& y, Vector& w), w = B y;
///   void remove_translations(Vector& w): of length 1/s in G, they would drown the rest in rounding.
template <class Problem>
class RitzSpace {
 public:
  using Scalar = typename Problem::Scalar;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  using Matrix = typename RitzBasis<Scalar>::Matrix;

  explicit RitzSpace(Problem& problem) : problem_(problem) {}

  /// Starts from the vectors of an earlier space with the same factor and support.
  void start_from(const RitzBasis<Scalar>& basis) {
    vectors_ = basis.vectors;
    images_ = basis.images;
    forces_.resize(images_.rows(), images_.cols());
    Vector force;
    for (Eigen::Index j = 0; j < images_.cols(); ++j) {
      problem_.apply(images_.col(j), force);
      forces_.col(j) = force;
    }
    rayleigh_ritz();
  }

  /// Adds a direction w. Returns its length in G before orthogonalization; 0 if nothing was added.
  double grow(Vector w) {
    for (int pass = 0; pass < 2; ++pass) {
      problem_.remove_translations(w);
      if (size() > 0) w -= vectors_ * (images_.adjoint() * w);
    }
    Vector y;
    problem_.solve(w, y);
    ++solves_;
    problem_.remove_translations(y);
    if (size() > 0) {
      const Vector along = vectors_.adjoint() * y;
      w -= vectors_ * along;
      y -= images_ * along;
    }
    const double square = Eigen::numext::real(w.dot(y));
    if (!(square > 0) || !std::isfinite(square)) return 0;
    const double length = std::sqrt(square);
    const Eigen::Index n = size();
    vectors_.conservativeResize(w.size(), n + 1);
    images_.conservativeResize(w.size(), n + 1);
    forces_.conservativeResize(w.size(), n + 1);
    vectors_.col(n) = w / length;
    images_.col(n) = y / length;
    Vector force;
    problem_.apply(images_.col(n), force);
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

  /// Runs until the residual's length in G is below the tolerance or, because of rounding, no longer falls. Returns
  /// whether it converged or stopped at a residual below `enough`.
  bool converge(const EigenproblemOptions& options, double enough, const Progress& progress) {
    const int max_solves = options.max_restarts * options.krylov_dimension;
    Halving halving(solves_);
    while (solves_ < max_solves && halving.goes_on(solves_)) {
      report(progress, 1.0 - 1.0 / (1.0 + 0.1 * solves_), "eigenproblem");
      const double length = grow(residual());
      if (!std::isfinite(mu_)) return false;
      if (mu_ > 0) {
        const double relative = length / mu_;
        if (relative <= options.tolerance) return true;
        halving.add(relative, solves_);
      }
      if (size() >= 4 * options.krylov_dimension) restart(options.krylov_dimension);
    }
    return halving.least() <= enough;
  }

  Eigen::Index size() const { return vectors_.cols(); }
  int solves() const { return solves_; }
  double mu() const { return mu_; }
  /// B y - mu w of the best vector.
  Vector residual() const { return force() - mu_ * (vectors_ * coefficients_.rightCols(1)); }
  /// B y of the best vector.
  Vector force() const { return forces_ * coefficients_.rightCols(1); }
  RitzBasis<Scalar> basis() const { return {problem_.support(), vectors_, images_}; }

 private:
  void rayleigh_ritz() {
    const Matrix projected = images_.adjoint() * forces_;
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(0.5 * (projected + projected.adjoint()));
    // Not assigned directly: Eigen 3.4 frees the old memory twice if there is none for the new size.
    coefficients_ = Matrix(solver.eigenvectors());
    mu_ = solver.eigenvalues().tail(1).value();
  }

  Problem& problem_;
  Matrix vectors_;       ///< w
  Matrix images_;        ///< y = G w
  Matrix forces_;        ///< B y
  Matrix coefficients_;  ///< of the Ritz vectors, ascending
  double mu_ = 0;
  int solves_ = 0;
};

}  // namespace spectral_conformal
