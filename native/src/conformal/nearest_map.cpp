#include "conformal/nearest_map.h"

#include <Eigen/Eigenvalues>

#include "conformal/constrained_factor.h"

namespace spectral_conformal {

ComplexVector nearest_map(const ConformalEnergy& energy, const LinearConstraints& constraints, const BoundaryForm& form,
                          const Positions& positions, double relative_shift, const ComplexVector& z,
                          FactorizationBackend backend, const Progress& progress) {
  // D of L = D - A (Eq. 3).
  HermitianMatrix dirichlet = energy.matrix();
  for (Complex& entry : dirichlet.coeffs()) entry.imag(0);
  ConstrainedFactor factor =
      ConstrainedFactor::of(dirichlet, constraints, form, positions, relative_shift, backend, progress);
  if (!factor.is_factored()) return {};
  const ComplexVector force = dirichlet.selfadjointView<Eigen::Lower>() * z;
  const Complex quarter(0, 1);
  const ComplexVector quarter_force = quarter * force;
  const Eigen::VectorXd upright = factor.solve(force);
  const Eigen::VectorXd turned = factor.solve(quarter_force);
  // The difference is least where w^T P^T D P w = w^T P^T D (a z) is largest.
  const Eigen::VectorXd along = constraints.gathered(force);
  const Eigen::VectorXd across = constraints.gathered(quarter_force);
  Eigen::Matrix2d gain;
  gain << along.dot(upright), along.dot(turned), across.dot(upright), across.dot(turned);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(0.5 * (gain + gain.transpose()));
  const Eigen::Vector2d turn = solver.eigenvectors().col(1);
  return constraints.expanded(turn[0] * upright + turn[1] * turned);
}

}  // namespace spectral_conformal
