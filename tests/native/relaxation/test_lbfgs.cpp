#include <doctest/doctest.h>

#include <cmath>

#include "meshes.h"
#include "relaxation/lbfgs.h"

namespace spectral_conformal::test {
namespace {

/// x -> x / diagonal, the inverse of a diagonal form.
Lbfgs::Inverse divided_by(const Eigen::VectorXd& diagonal) {
  return [&diagonal](const ComplexVector& b, ComplexVector& x) { x = b.cwiseQuotient(diagonal.cast<Complex>()); };
}

const Lbfgs::Inverse identity = [](const ComplexVector& b, ComplexVector& x) { x = b; };

}  // namespace

TEST_SUITE_BEGIN("lbfgs");

TEST_CASE("the inner product is that of real vectors") {
  const ComplexVector a = random_map(5, 1);
  const ComplexVector b = random_map(5, 2);
  CHECK(real_dot(a, b) == doctest::Approx(a.dot(b).real()));
  CHECK(real_dot(Complex(0, 1) * a, a) == doctest::Approx(0));
}

TEST_CASE("without steps the direction is that of the form: with the Hessian itself, Newton's") {
  Eigen::VectorXd hessian(4);
  hessian << 1, 10, 0.1, 3;
  const ComplexVector gradient = random_map(4);
  const ComplexVector expected = -gradient.cwiseQuotient(hessian.cast<Complex>());
  CHECK(difference(Lbfgs().descent(divided_by(hessian), gradient), expected) < 1e-15);
}

TEST_CASE("the last step is known exactly: its gradient change leads back along it") {
  Eigen::VectorXd hessian(6);
  hessian << 1, 2, 5, 10, 0.5, 3;
  Lbfgs lbfgs;
  ComplexVector step;
  ComplexVector change;
  for (unsigned seed = 1; seed < 4; ++seed) {
    step = random_map(6, seed);
    change = hessian.cast<Complex>().cwiseProduct(step);
    lbfgs.add(step, change);
  }
  CHECK(difference(lbfgs.descent(identity, change), -step) < 1e-12);
  lbfgs.clear();
  CHECK(difference(lbfgs.descent(identity, change), -change) < 1e-15);
}

TEST_CASE("steps without positive curvature are not taken, so that directions descend") {
  Lbfgs lbfgs;
  const ComplexVector step = random_map(6, 1);
  lbfgs.add(step, -step);
  lbfgs.add(step, Complex(0, 1) * step);
  const ComplexVector gradient = random_map(6, 2);
  CHECK(difference(lbfgs.descent(identity, gradient), -gradient) < 1e-15);
}

TEST_CASE("a quadratic function is minimized in a few of its dimensions' steps") {
  Eigen::VectorXd hessian(5);
  hessian << 1, 4, 9, 16, 25;
  ComplexVector z = random_map(5);
  Lbfgs lbfgs;
  ComplexVector gradient = hessian.cast<Complex>().cwiseProduct(z);
  const double begun = gradient.norm();
  for (int k = 0; k < 20; ++k) {
    const ComplexVector direction = lbfgs.descent(identity, gradient);
    const double second = real_dot(direction, hessian.cast<Complex>().cwiseProduct(direction));
    const ComplexVector step = (-real_dot(gradient, direction) / second) * direction;
    z += step;
    const ComplexVector next = hessian.cast<Complex>().cwiseProduct(z);
    lbfgs.add(step, next - gradient);
    gradient = next;
    if (gradient.norm() < 1e-10 * begun) break;
  }
  CHECK(gradient.norm() < 1e-10 * begun);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
