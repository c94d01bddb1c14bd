#include "conformal/nearest_map.h"

#include <Eigen/Eigenvalues>
#include <utility>

#include "conformal/reduced_factor.h"

namespace spectral_conformal {

ComplexVector nearest_map(const ConformalEnergy& energy, const LinearConstraints& constraints, const BoundaryForm& form,
                          const Positions& positions, double relative_shift, const ComplexVector& z,
                          FactorizationBackend backend, const Progress& progress) {
  // D of L = D - A (Eq. 3).
  HermitianMatrix dirichlet = energy.matrix();
  for (Complex& entry : dirichlet.coeffs()) entry.imag(0);
  const ComplexVector force = dirichlet.selfadjointView<Eigen::Lower>() * z;
  ReducedFactor factor =
      ReducedFactor::of(std::move(dirichlet), constraints, form, positions, relative_shift, backend, progress);
  if (!factor.is_factored()) return {};
  const AffineSpace& space = factor.space();
  const ComplexVector along = space.gathered(force);
  const ComplexVector across = space.gathered(Complex(0, 1) * force);
  const ComplexVector upright = factor.solve(along);
  const ComplexVector turned = factor.solve(across);
  // The difference is least where w^* P^* D P w = w^* P^* D (a z) is largest.
  const auto dot = [](const ComplexVector& a, const ComplexVector& b) { return a.dot(b).real(); };
  Eigen::Matrix2d gain;
  gain << dot(along, upright), dot(along, turned), dot(across, upright), dot(across, turned);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(0.5 * (gain + gain.transpose()));
  const Eigen::Vector2d turn = solver.eigenvectors().col(1);
  return space.expanded(turn[0] * upright + turn[1] * turned);
}

}  // namespace spectral_conformal
