#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "seams/relative_grid.h"

namespace spectral_conformal::test {
namespace {

Positions random_points(int n) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> between(-1, 1);
  Positions points(n, 3);
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = between(random);
  return points;
}

/// The points as they are, and fractions of their extent, many of them powers of two.
Positions points_and_fractions() {
  Positions points = random_points(300);
  points.row(0) << -1, -1, -1;
  points.row(1) << 1, 1, 1;
  for (int i = 2; i < 200; ++i) points.row(i) << i / 256.0 - 0.5, 1 / (3.0 * i), static_cast<float>(0.1 * i / 40);
  return points;
}

Positions on_grid(const Positions& points) { return RelativeGrid::over(points).coordinates(points); }

}  // namespace

TEST_SUITE_BEGIN("relative_grid");

TEST_CASE("a shape has the same coordinates at every scale and place") {
  const Positions points = points_and_fractions();
  for (const double scale : {3.0, 1e-6, 1e5, 0.1, 1 / 3.0, 1e-160, 1e150}) {
    CHECK(on_grid(scale * points) == on_grid(points));
    CHECK(RelativeGrid::over(scale * points).unit() ==
          doctest::Approx(scale * RelativeGrid::over(points).unit()).epsilon(1e-12));
  }
  CHECK(on_grid(points.rowwise() + Eigen::RowVector3d(0.3, -0.7, 2)) == on_grid(points));
}

TEST_CASE("mirrored points have mirrored coordinates") {
  const Positions points = points_and_fractions();
  CHECK(on_grid(-points) == -on_grid(points));
}

TEST_CASE("coordinates on the grid are the points to single precision") {
  const Positions points = points_and_fractions();
  const RelativeGrid grid = RelativeGrid::over(points);
  const Positions back = grid.unit() * grid.coordinates(points);
  const Eigen::RowVector3d moved = points.row(5) - back.row(5);
  CHECK((back.rowwise() + moved - points).cwiseAbs().maxCoeff() < 2e-8);
}

TEST_CASE("what is not finite does not count, and points at one place are one") {
  Positions points = points_and_fractions();
  const Positions expected = on_grid(points);
  points(7, 1) = infinity;
  points(8, 2) = std::numeric_limits<double>::quiet_NaN();
  const Positions found = on_grid(points);
  CHECK(std::isnan(found(7, 1)));
  CHECK(std::isnan(found(8, 2)));
  CHECK(found.topRows(7) == expected.topRows(7));
  const Positions same = Positions::Constant(4, 3, 2.5);
  CHECK(on_grid(same).isZero());
  CHECK(RelativeGrid::over(same).unit() == 0);
  CHECK(on_grid(Positions(0, 3)).rows() == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
