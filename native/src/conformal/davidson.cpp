#include "conformal/davidson.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "conformal/subspace.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

using Matrix = Eigen::MatrixXcd;

/// The Rayleigh-Ritz space: mean-free columns, orthonormal in L + s M.
class DavidsonSpace {
 public:
  DavidsonSpace(const ConformalEnergy& energy, const BoundaryForm& form, double shift, const QuotientForm& quotient)
      : energy_(energy), form_(form), shift_(shift), quotient_(quotient) {}

  /// Adds the part of w orthogonal to the space, unless nothing is left of it.
  void add(ComplexVector w) {
    ComplexVector image;
    for (int pass = 0; pass < 2; ++pass) {
      w.array() -= w.mean();
      const double before = shifted_norm(w, image);
      if (!(before > 0) || !std::isfinite(before)) return;
      w /= before;
      if (size() == 0) continue;
      image /= before;
      w -= vectors_ * (vectors_.adjoint() * image);
    }
    const double left = shifted_norm(w, image);
    if (!(left > insignificant)) return;  // a shorter remainder would no longer be orthogonal
    w /= left;
    const Eigen::Index n = size();
    vectors_.conservativeResize(w.size(), n + 1);
    vectors_.col(n) = w;
    energy_.apply(w, image);
    extend(projected_energy_, image);
    image.setZero();
    quotient_.add_applied(w, 1, image);
    extend(projected_form_, image);
  }

  /// Chooses the vector with the smallest positive quotient. Returns false if the form is positive for none.
  bool solve() {
    // Takes the largest mu of B c = mu (T + d) c in the eigenbasis of T, where tiny energies keep their accuracy.
    const Eigen::SelfAdjointEigenSolver<Matrix> by_energy(projected_energy_);
    // The rounding of T, whose eigenvalues lie between 0 and 1.
    const double d = 2 * max_dimension * epsilon;
    const Eigen::VectorXd scale = (by_energy.eigenvalues().cwiseMax(0.0).array() + d).sqrt().inverse();
    const Matrix basis = by_energy.eigenvectors() * scale.asDiagonal();
    const Matrix projected = basis.adjoint() * projected_form_ * basis;
    const Eigen::SelfAdjointEigenSolver<Matrix> by_quotient(0.5 * (projected + projected.adjoint()));
    const Eigen::VectorXd& mu = by_quotient.eigenvalues();
    const Eigen::Index last = size() - 1;
    if (!(mu[last] > 0) || !std::isfinite(mu[last])) return false;
    coefficients_ = basis * by_quotient.eigenvectors();
    // The factor reduces an error component to lambda / (lambda + s): take the smallest value other than that of z.
    const auto left = [this](double value) { return value > 0 ? 1 / (1 + shift_ * value) : 1.0; };
    gap_ = last > 0 ? left(mu[last - 1]) - left(mu[last]) : 0;
    return true;
  }
  ComplexVector best() const { return vectors_ * coefficients_.rightCols(1); }
  /// The least fraction of the best vector's error that (L + s M)^-1 (L - lambda B) removes, estimated in this space.
  double gap() const { return gap_; }

  void restart() {
    // Orthonormalize again, since the form may be indefinite.
    const Matrix best = vectors_ * coefficients_.rightCols(max_dimension / 2);
    vectors_.resize(0, 0);
    projected_energy_.resize(0, 0);
    projected_form_.resize(0, 0);
    for (Eigen::Index j = best.cols() - 1; j >= 0; --j) add(best.col(j));
  }
  Eigen::Index size() const { return vectors_.cols(); }

 private:
  /// The length of w in L + s M; image: (L + s M) w.
  double shifted_norm(const ComplexVector& w, ComplexVector& image) const {
    energy_.apply(w, image);
    form_.add_applied(w, shift_, image);
    return std::sqrt(w.dot(image).real());
  }

  /// Adds a row and a column for the last vector, given its image under a form.
  void extend(Matrix& projected, const ComplexVector& image) const {
    const Eigen::Index n = size() - 1;
    const ComplexVector column = vectors_.adjoint() * image;
    projected.conservativeResize(n + 1, n + 1);
    projected.col(n) = column;
    projected.row(n) = column.adjoint();
    projected(n, n) = column[n].real();
  }

  const ConformalEnergy& energy_;
  const BoundaryForm& form_;
  double shift_;
  const QuotientForm& quotient_;
  Matrix vectors_;
  Matrix projected_energy_;  ///< v^H L v
  Matrix projected_form_;    ///< v^H B v
  Matrix coefficients_;
  double gap_ = 0;
};

/// M e^(i k t), where t is the mass passed along the boundary, as an angle.
ComplexVector fourier_mode(const BoundaryForm& form, Eigen::Index n, int k) {
  ComplexVector mode = ComplexVector::Zero(n);
  double passed = 0;
  for (Eigen::Index i = 0; i < form.mass.size(); ++i) {
    mode[form.vertices[static_cast<std::size_t>(i)]] = std::polar(form.mass[i], k * 2 * pi * passed / form.total());
    passed += form.mass[i];
  }
  return mode;
}

}  // namespace

DavidsonResult solve_by_davidson(ReducedFactor& factor, const ConformalEnergy& energy, const BoundaryForm& form,
                                 const QuotientForm& quotient, double negligible, const Progress& progress) {
  DavidsonResult result;
  result.change = infinity;
  DavidsonSpace space(energy, form, factor.shift(), quotient);
  const auto grow = [&](const ComplexVector& direction) {
    report(progress, 1.0 - 1.0 / (1.0 + 0.05 * result.solves), "eigenproblem");
    ComplexVector w = factor.inverse(direction);
    ++result.solves;
    space.add(w);
    return w;
  };
  // A third of the space, to begin with: e^(ik t) for the lowest frequencies k and -k.
  for (int k = 1; k <= max_dimension / 6; ++k) {
    grow(fourier_mode(form, energy.n_vertices(), k));
    grow(fourier_mode(form, energy.n_vertices(), -k));
  }
  Halving halving(result.solves);
  ComplexVector r;
  while (space.size() > 0 && halving.goes_on(result.solves) && space.solve()) {
    result.z = space.best();
    eigen_residual(energy, quotient, result.z, r);
    if (space.size() >= max_dimension) space.restart();
    const ComplexVector w = grow(r);
    result.change = w.norm() / (result.z.norm() * space.gap());
    if (!(result.change > negligible)) break;
    halving.add(result.change, result.solves);
  }
  return result;
}

}  // namespace spectral_conformal
