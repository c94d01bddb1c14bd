#include "conformal/held_extenders.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "conformal/quotient_form.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

/// d z of all pairs, in real coordinates.
Eigen::VectorXd differences(const std::vector<Extender>& extenders, const ComplexVector& z) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(2 * extenders.size()));
  for (std::size_t k = 0; k < extenders.size(); ++k) {
    const Complex difference = barycenter(extenders[k].from, z) - barycenter(extenders[k].to, z);
    result[static_cast<Eigen::Index>(2 * k)] = difference.real();
    result[static_cast<Eigen::Index>(2 * k + 1)] = difference.imag();
  }
  return result;
}

/// d^T times a unit, (n_vertices,).
ComplexVector force(const Extender& extender, Complex unit, Eigen::Index n_vertices) {
  ComplexVector result = ComplexVector::Zero(n_vertices);
  spread_evenly(extender.from, unit, result);
  spread_evenly(extender.to, -unit, result);
  return result;
}

}  // namespace

void push_and_pull(const std::vector<Extender>& given, const HeldInverse& inverse, bool may_turn, double max_diagonal,
                   ComplexVector& z) {
  std::vector<Extender> extenders;
  for (const Extender& extender : given) {
    if (extender.strength != 0) extenders.push_back(extender);
  }
  if (extenders.empty()) return;
  const Complex quarter(0, 1);
  const auto n = static_cast<Eigen::Index>(2 * extenders.size());
  std::vector<ComplexVector> responses;  // to unit forces along u and v
  for (const Extender& extender : extenders) {
    responses.push_back(inverse(force(extender, 1, z.size())));
    responses.push_back(may_turn ? ComplexVector(quarter * responses.back())
                                 : inverse(force(extender, quarter, z.size())));
  }
  Eigen::MatrixXd compliance(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    compliance.col(k) = differences(extenders, responses[static_cast<std::size_t>(k)]);
  }
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(n);  // stiffness
  Eigen::VectorXd push = Eigen::VectorXd::Zero(n);  // force per difference
  for (std::size_t k = 0; k < extenders.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(2 * k);
    const Eigen::Matrix2d own = compliance.block<2, 2>(at, at);
    const double softest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(own).eigenvalues()[1];
    if (!(softest > insignificant / max_diagonal)) continue;
    const double strength = extenders[k].strength / extenders[k].half;
    (strength > 0 ? push : pull).segment<2>(at).setConstant(std::abs(strength) / softest);
  }
  // The differences under the pulls: those before, plus what all forces add.
  Eigen::MatrixXd stiffened = compliance * pull.asDiagonal();
  stiffened.diagonal().array() += 1;
  const Eigen::PartialPivLU<Eigen::MatrixXd> solver(stiffened);
  const Eigen::VectorXd free = differences(extenders, z);
  const Eigen::VectorXd pulled = solver.solve(free);
  const Eigen::VectorXd pushes = push.cwiseProduct(pulled);
  const Eigen::VectorXd pushed = solver.solve(free + compliance * pushes);
  const Eigen::VectorXd forces = pushes - pull.cwiseProduct(pushed);
  for (Eigen::Index k = 0; k < n; ++k) z += forces[k] * responses[static_cast<std::size_t>(k)];
}

}  // namespace spectral_conformal
