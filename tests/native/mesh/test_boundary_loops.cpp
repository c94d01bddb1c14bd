#include <doctest/doctest.h>

#include <algorithm>

#include "mesh/boundary_loops.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

/// Distances along the edges between all vertices (Floyd and Warshall).
Eigen::MatrixXd all_distances(const Patch& patch) {
  const Eigen::Index n = patch.positions.rows();
  Eigen::MatrixXd distance = Eigen::MatrixXd::Constant(n, n, 1e30);
  distance.diagonal().setZero();
  for (const auto& triangle : patch.chart.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangle[k];
      const int b = triangle[(k + 1) % 3];
      distance(a, b) = distance(b, a) = (patch.positions.row(a) - patch.positions.row(b)).norm();
    }
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    for (Eigen::Index i = 0; i < n; ++i) {
      distance.row(i) = distance.row(i).cwiseMin((distance.row(k).array() + distance(i, k)).matrix());
    }
  }
  return distance;
}

}  // namespace

TEST_SUITE_BEGIN("boundary_loops");

TEST_CASE("length of a closed loop") {
  Positions square(4, 3);
  square << 0, 0, 0, 2, 0, 0, 2, 0, 3, 0, 0, 3;
  CHECK(loop_length({0, 1, 2, 3}, square) == doctest::Approx(10).epsilon(1e-15));
  CHECK(loop_length({0, 2}, square) == doctest::Approx(2 * std::sqrt(13.0)).epsilon(1e-15));
}

TEST_CASE("the outer loop is the longest in 3D, not the one with most vertices; the first of equal ones") {
  Positions positions(8, 3);
  positions << 0, 0, 0, 9, 0, 0, 0, 9, 0, 1, 1, 0, 2, 1, 0, 2, 2, 0, 1, 2, 0, 1, 1.5, 0;
  const BoundaryLoop large{0, 1, 2};
  const BoundaryLoop small{3, 4, 5, 6, 7};
  CHECK(outer_loop({small, large}, positions) == 1);
  CHECK(outer_loop({large, small, large}, positions) == 0);
  const Patch patch(perforated_grid(9, 9));
  REQUIRE(patch.chart.boundary_loops.size() == 10);
  CHECK(patch.outer().size() == 36);
}

TEST_CASE("the farthest boundary vertices: none is farther from either, and only rarely are others farther apart") {
  for (const auto& mesh : {bumpy_grid(12, 3), perforated_grid(9, 9), perforated_grid(12, 4)}) {
    const Patch patch(mesh);
    const Eigen::MatrixXd distance = all_distances(patch)(patch.outer(), patch.outer());
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    const auto pair = farthest_boundary_vertices(patch.outer(), patch.positions, energy.matrix());
    std::array<Eigen::Index, 2> place;
    for (int k = 0; k < 2; ++k) {
      const auto found = std::find(patch.outer().begin(), patch.outer().end(), pair[k]);
      REQUIRE(found != patch.outer().end());
      place[k] = found - patch.outer().begin();
    }
    const double apart = distance(place[0], place[1]);
    for (const Eigen::Index p : place) CHECK(distance.row(p).maxCoeff() == doctest::Approx(apart).epsilon(1e-12));
    CHECK(apart > 0.99 * distance.maxCoeff());
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
