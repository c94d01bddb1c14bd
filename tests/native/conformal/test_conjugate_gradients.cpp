#include <doctest/doctest.h>

#include <Eigen/Core>

#include "conformal/conjugate_gradients.h"

namespace spectral_conformal::test {
namespace {

/// diag(values) z = force, with a preconditioner that takes all eigenvalues below `floor` for it, as a shifted factor
/// does.
struct DiagonalSystem {
  Eigen::VectorXd values, force, z;
  double floor = 0;
  int steps = 0;

  Eigen::VectorXd residual() { return force - values.cwiseProduct(z); }
  Eigen::VectorXd preconditioned(const Eigen::VectorXd& r) { return r.cwiseQuotient(values.cwiseMax(floor)); }
  double curvature(const Eigen::VectorXd& p) {
    direction = p;
    return p.dot(values.cwiseProduct(p));
  }
  void move(double alpha) { z += alpha * direction; }
  double relative(const Eigen::VectorXd& step) const { return step.norm() / z.norm(); }
  void poll(int k) { steps = k; }

 private:
  Eigen::VectorXd direction;
};

DiagonalSystem system_of(const Eigen::VectorXd& values, double floor) {
  DiagonalSystem system;
  system.values = values;
  system.force = Eigen::VectorXd::LinSpaced(values.size(), 1, 2);
  system.z = Eigen::VectorXd::Zero(values.size());
  system.floor = floor;
  return system;
}

}  // namespace

TEST_SUITE("conjugate_gradients") {
  TEST_CASE("eigenvalues below the factor's shift are resolved, in about one step for each") {
    Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(200, 1, 3);
    values.head(5) << 1e-7, 3e-7, 1e-6, 5e-6, 2e-5;
    DiagonalSystem system = system_of(values, 1e-3);
    const double change = conjugate_gradients<Eigen::VectorXd>(system);
    CHECK(change < 1e-10);
    CHECK(system.steps < 20);
    const Eigen::VectorXd exact = system.force.cwiseQuotient(values);
    CHECK((system.z - exact).norm() < 1e-8 * exact.norm());
  }

  TEST_CASE("a form that is not positive ends without a solution") {
    Eigen::VectorXd values = Eigen::VectorXd::Ones(4);
    values[2] = -1;
    DiagonalSystem system = system_of(values, 1);
    CHECK_FALSE(conjugate_gradients<Eigen::VectorXd>(system) < 1e-6);
  }

  TEST_CASE("without a force there is nothing to do") {
    DiagonalSystem system = system_of(Eigen::VectorXd::Ones(3), 1);
    system.force.setZero();
    CHECK(conjugate_gradients<Eigen::VectorXd>(system) == 0);
    CHECK(system.z.isZero());
  }
}

}  // namespace spectral_conformal::test
