#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <numeric>
#include <vector>

#include "conformal/ritz_space.h"

namespace spectral_conformal::test {
namespace {

/// B G w = mu w with dense real matrices, G positive definite and B indefinite.
struct DenseProblem {
  using Scalar = double;

  Eigen::MatrixXd g;
  Eigen::MatrixXd b;
  std::vector<int> numbers;

  explicit DenseProblem(int n) : numbers(static_cast<std::size_t>(n)) {
    std::iota(numbers.begin(), numbers.end(), 0);
    const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(n, 0, 1);
    b = (7 * t * t.transpose()).array().sin();
    g = (-(t.replicate(1, n) - t.transpose().replicate(n, 1)).array().square()).exp();
    g.diagonal().array() += 0.5;
  }
  const std::vector<int>& support() const { return numbers; }
  void solve(const Eigen::VectorXd& w, Eigen::VectorXd& y) const { y = g * w; }
  void apply(const Eigen::VectorXd& y, Eigen::VectorXd& w) const { w = b * y; }
  void remove_translations(Eigen::VectorXd&) const {}
};

}  // namespace

TEST_SUITE("ritz_space") {
  TEST_CASE("it finds the largest eigenvalue, and from its own basis at once") {
    DenseProblem problem(40);
    RitzSpace<DenseProblem> space(problem);
    space.grow(Eigen::VectorXd::Ones(40));
    REQUIRE(space.converge({}, 0, {}));
    // B G is similar to G^1/2 B G^1/2.
    const Eigen::MatrixXd root = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(problem.g).operatorSqrt();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> expected(root * problem.b * root);
    CHECK(space.mu() == doctest::Approx(expected.eigenvalues()[39]).epsilon(1e-10));
    RitzSpace<DenseProblem> again(problem);
    again.start_from(space.basis());
    REQUIRE(again.converge({}, 0, {}));
    CHECK(again.solves() <= 1);
    CHECK(again.mu() == doctest::Approx(space.mu()).epsilon(1e-12));
  }
}

}  // namespace spectral_conformal::test
