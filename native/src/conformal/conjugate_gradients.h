#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "conformal/subspace.h"
#include "geometry/tolerances.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Conjugate gradients, preconditioned by a factor, for long strips: there the factor's rounding or shift is as large
/// as the smallest eigenvalues of L. L is applied triangle by triangle, which resolves them. Returns the remaining
/// error, relative to the map.
///
/// A system has the members
///   Vector residual()                     force - L z of the present map z, on what is free
///   Vector preconditioned(const Vector&)  the factor's solution
///   double curvature(const Vector& p)     p^T L p, for the same p as the next call of
///   void move(double alpha)               z += alpha p
///   double relative(const Vector& step)   the size of a step relative to that of z
///   void poll(int k)             of step k
template <class Vector, class System>
double conjugate_gradients(System& system) {
  Eigen::VectorXd diagonal;
  Eigen::VectorXd beside;
  Vector r, before, w, p;
  double rho = 0;
  double alpha = 0;
  double change = infinity;
  Halving halving(0);
  const auto dot = [](const Vector& a, const Vector& b) { return std::real(a.dot(b)); };
  for (int k = 0; halving.goes_on(k); ++k) {
    system.poll(k);
    before.swap(r);
    r = system.residual();
    w = system.preconditioned(r);
    // Polak-Ribiere: the residual is recomputed from z, not updated.
    const double rho_before = rho;
    rho = dot(r, w);
    if (rho == 0) return 0;
    const double beta = k == 0 ? 0 : std::max(0.0, rho - dot(before, w)) / rho_before;
    // The Lanczos matrix of the same steps approximates the eigenvalues of the preconditioned L, including the
    // smallest.
    if (k > 0) {
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
      solver.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
      change = system.relative(w) / solver.eigenvalues()[0];
      if (!(change > insignificant)) return change;
      halving.add(change, k);
      beside.conservativeResize(k);
      beside[k - 1] = std::sqrt(beta) / alpha;
    }
    p = k == 0 ? w : Vector(w + beta * p);
    const double last = k == 0 ? 0 : beta / alpha;
    alpha = dot(r, p) / system.curvature(p);
    if (!(alpha > 0) || !std::isfinite(alpha)) return change;
    diagonal.conservativeResize(k + 1);
    diagonal[k] = 1 / alpha + last;
    system.move(alpha);
  }
  return change;
}

}  // namespace spectral_conformal
