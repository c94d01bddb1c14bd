#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <utility>

#include "conformal/ritz_space.h"

namespace spectral_conformal::test {
namespace {

/// B y = mu E y with dense real matrices, E and K positive definite and B indefinite.
template <bool own_energy>
struct DenseProblem {
  using Scalar = double;
  static constexpr bool has_own_energy = own_energy;
  Eigen::MatrixXd b, e, k;

  explicit DenseProblem(int n) {
    const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(n, 0, 1);
    b = (7 * t * t.transpose()).array().sin();
    k = (-(t.replicate(1, n) - t.transpose().replicate(n, 1)).array().square()).exp();
    k.diagonal().array() += 0.5;
    e = k;
    if (own_energy) e.diagonal() += t;
  }
  Eigen::VectorXd metric(const Eigen::VectorXd& y, const Eigen::VectorXd&) const { return k * y; }
  Eigen::VectorXd force(const Eigen::VectorXd& y) const { return b * y; }
  void renew(const Eigen::VectorXd& y, Eigen::VectorXd& image) const { image = e * y; }

  /// Grows a space by K^-1 times the residual of its best vector.
  void grow(RitzSpace<DenseProblem>& space, const Eigen::VectorXd& residual) const {
    const Eigen::VectorXd y = k.llt().solve(residual);
    space.add(y, e * y);
    CHECK(space.solve());
  }
};

template <class Problem>
void check_largest(const Problem& problem) {
  Problem copy = problem;
  RitzSpace<Problem> space(copy);
  problem.grow(space, Eigen::VectorXd::Ones(problem.b.rows()));
  for (int step = 0; step < 60; ++step) {
    problem.grow(space, space.without_images(problem.force(space.vector()) - space.mu() * space.image()));
    if (space.size() >= max_dimension) space.restart(max_dimension / 2);
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> expected(problem.b, problem.e);
  const Eigen::Index last = problem.b.rows() - 1;
  CHECK(space.mu() == doctest::Approx(expected.eigenvalues()[last]).epsilon(1e-10));
  CHECK(space.mu(1) <= expected.eigenvalues()[last - 1] * (1 + 1e-9));
  const Eigen::VectorXd z = space.vector();
  CHECK((problem.b * z - space.mu() * problem.e * z).norm() < 1e-6 * (problem.b * z).norm());
  CHECK((problem.e * z - space.image()).norm() < 1e-9 * space.image().norm());
  CHECK((space.vectors().transpose() * problem.k * space.vectors()).isIdentity(1e-8));
}

}  // namespace

TEST_SUITE_BEGIN("ritz_space");

TEST_CASE("it finds the largest eigenvalue, in the inner product of the pencil or another one") {
  check_largest(DenseProblem<false>(40));
  check_largest(DenseProblem<true>(40));
}

TEST_CASE("an empty space has no vector") {
  // As where a start and its correction both vanish.
  DenseProblem<true> own(5);
  CHECK_FALSE(RitzSpace<DenseProblem<true>>(own).solve());
  DenseProblem<false> other(5);
  CHECK_FALSE(RitzSpace<DenseProblem<false>>(other).solve());
}

TEST_CASE("what lies in the space is not added; a form positive for nothing has no vector") {
  DenseProblem<true> problem(12);
  problem.b = -Eigen::MatrixXd::Identity(12, 12);
  RitzSpace<DenseProblem<true>> space(problem);
  const Eigen::VectorXd y = Eigen::VectorXd::LinSpaced(12, 1, 2);
  CHECK(space.add(y, problem.e * y) == doctest::Approx(std::sqrt(y.dot(problem.k * y))));
  CHECK(space.add(3 * y, 3 * problem.e * y) > 0);
  CHECK(space.size() == 1);
  CHECK_FALSE(space.solve());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
