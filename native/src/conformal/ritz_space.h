#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "conformal/subspace.h"
#include "geometry/tolerances.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The Rayleigh-Ritz method for the largest mu of B y = mu E y, in a space whose basis Y is orthonormal in the inner
/// product of K. B is self-adjoint, E positive semidefinite, K positive definite. A Problem has
///   Scalar, of its vectors;
///   static constexpr bool has_own_energy: whether E is another form than K;
///   Vector metric(const Vector& y, const Vector& image): K y, given the image E y;
///   void renew(const Vector& y, Vector& image): computes the image anew, if E is another form than K. Differences of
///     long vectors consist of rounding, whose energy would otherwise not be theirs;
///   Vector force(const Vector& y): B y.
template <class Problem>
class RitzSpace {
 public:
  using Scalar = typename Problem::Scalar;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  explicit RitzSpace(Problem& problem) : problem_(problem) {}

  /// Adds what is orthogonal to the space of a vector y with the image E y, unless nothing is left. Returns the length
  /// of y in K. `solve` follows.
  double add(Vector y, Vector image) {
    double length = 0;
    double left = 1;
    while (true) {
      Vector dual = problem_.metric(y, image);
      const double square = std::real(y.dot(dual));
      const double norm = std::sqrt(square);
      const bool is_first = length == 0;
      if (is_first) length = norm;
      if (!(square > 0) || !std::isfinite(square)) return length;
      if (!is_first) left *= norm;
      // A shorter remainder would no longer be orthogonal.
      if (!(left > insignificant)) return length;
      // Not divided: Eigen would divide by a complex number.
      const double scale = 1 / norm;
      y *= scale;
      image *= scale;
      // Once is enough where little was taken away.
      if (size() == 0 || (!is_first && norm > 0.5)) break;
      if (is_first) {
        dual *= scale;
      } else {
        problem_.renew(y, image);
        dual = problem_.metric(y, image);
      }
      const Vector along = vectors_.adjoint() * dual;
      y -= vectors_ * along;
      image -= images_ * along;
    }
    const Eigen::Index n = size();
    vectors_.conservativeResize(y.size(), n + 1);
    images_.conservativeResize(y.size(), n + 1);
    vectors_.col(n) = y;
    images_.col(n) = image;
    extend(projected_form_, problem_.force(y));
    if constexpr (Problem::has_own_energy) extend(projected_energy_, image);
    return length;
  }

  /// Finds the Ritz vectors. Returns false if B is positive for no vector of the space.
  bool solve() {
    if (size() == 0) return false;
    // Not assigned directly: Eigen 3.4 frees the old memory twice if there is none for the new size.
    if constexpr (Problem::has_own_energy) {
      // In the eigenbasis of T = Y^* E Y, where tiny energies keep their accuracy, and raised by the rounding of T.
      const Eigen::SelfAdjointEigenSolver<Matrix> by_energy(projected_energy_);
      const double d = 2 * max_dimension * epsilon;
      const Eigen::VectorXd scale = (by_energy.eigenvalues().cwiseMax(0.0).array() + d).sqrt().inverse();
      const Matrix basis = by_energy.eigenvectors() * scale.asDiagonal();
      const Matrix projected = basis.adjoint() * projected_form_ * basis;
      const Eigen::SelfAdjointEigenSolver<Matrix> by_quotient(0.5 * (projected + projected.adjoint()));
      coefficients_ = Matrix(basis * by_quotient.eigenvectors());
      mu_ = Eigen::VectorXd(by_quotient.eigenvalues());
    } else {
      const Eigen::SelfAdjointEigenSolver<Matrix> solver(0.5 * (projected_form_ + projected_form_.adjoint()));
      coefficients_ = Matrix(solver.eigenvectors());
      mu_ = Eigen::VectorXd(solver.eigenvalues());
    }
    return mu() > 0 && std::isfinite(mu());
  }

  /// f without the images of the space, for which K^-1 f is orthogonal to it where E is K. What is subtracted after the
  /// solve instead leaves its rounding.
  Vector without_images(Vector f) const {
    for (int pass = 0; pass < 2 && size() > 0; ++pass) f -= images_ * (vectors_.adjoint() * f);
    return f;
  }

  Eigen::Index size() const { return vectors_.cols(); }
  /// The k-th largest.
  double mu(Eigen::Index k = 0) const { return k < size() ? mu_[size() - 1 - k] : -infinity; }
  /// Its Ritz vector z, and E z.
  Vector vector(Eigen::Index k = 0) const { return vectors_ * coefficients_.col(size() - 1 - k); }
  Vector image(Eigen::Index k = 0) const { return images_ * coefficients_.col(size() - 1 - k); }

  /// Keeps the `count` best Ritz vectors.
  void restart(Eigen::Index count) {
    count = std::min(count, size());
    const Matrix vectors = vectors_ * coefficients_.rightCols(count);
    const Matrix images = images_ * coefficients_.rightCols(count);
    clear();
    // Orthonormal only where E is K.
    for (Eigen::Index j = count - 1; j >= 0; --j) {
      Vector image = images.col(j);
      problem_.renew(vectors.col(j), image);
      add(vectors.col(j), std::move(image));
    }
    solve();
  }

  /// Y and E Y.
  const Matrix& vectors() const { return vectors_; }
  const Matrix& images() const { return images_; }

 private:
  void clear() {
    for (Matrix* each : {&vectors_, &images_, &projected_form_, &projected_energy_}) each->resize(0, 0);
  }
  /// Adds a row and a column to a projected form for the last vector, given its image.
  void extend(Matrix& projected, const Vector& image) const {
    const Eigen::Index n = size() - 1;
    const Vector column = vectors_.adjoint() * image;
    projected.conservativeResize(n + 1, n + 1);
    projected.col(n) = column;
    projected.row(n) = column.adjoint();
    projected(n, n) = std::real(column[n]);
  }

  Problem& problem_;
  Matrix vectors_;           ///< Y
  Matrix images_;            ///< E Y
  Matrix projected_form_;    ///< Y^* B Y
  Matrix projected_energy_;  ///< Y^* E Y, if E is not K
  Matrix coefficients_;      ///< of the Ritz vectors, ascending in mu
  Eigen::VectorXd mu_;
};

}  // namespace spectral_conformal
