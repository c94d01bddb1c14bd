#include <doctest/doctest.h>

#include <vector>

#include "packing/overlapping_islands.h"

namespace spectral_conformal::test {
namespace {

/// Squares with these lower left corners and sides, one island each.
struct SquareIslands {
  ComplexVector points;
  std::vector<int> face_offsets{0};
  std::vector<int> corners;
  std::vector<int> island_of_face;

  explicit SquareIslands(const std::vector<std::pair<Complex, double>>& squares) {
    points.resize(static_cast<Eigen::Index>(4 * squares.size()));
    for (const auto& [at, side] : squares) {
      for (const Complex z : {Complex(0, 0), Complex(1, 0), Complex(1, 1), Complex(0, 1)}) {
        points[static_cast<Eigen::Index>(corners.size())] = at + side * z;
        corners.push_back(static_cast<int>(corners.size()));
      }
      face_offsets.push_back(static_cast<int>(corners.size()));
      island_of_face.push_back(static_cast<int>(island_of_face.size()));
    }
  }
  std::vector<int> groups() const {
    return overlapping_islands(points, face_offsets, corners, island_of_face, static_cast<int>(island_of_face.size()));
  }
};

}  // namespace

TEST_SUITE_BEGIN("overlapping_islands");

TEST_CASE("islands that cross, contain or coincide are one group, also by way of others") {
  const SquareIslands crossing(
      {{{0, 0}, 2}, {{10, 0}, 1}, {{1.5, 1}, 2}, {{3, 2}, 2}, {{10.2, 0.2}, 0.1}, {{10, 0}, 1}});
  CHECK(crossing.groups() == std::vector<int>{0, 1, 0, 0, 1, 1});
}

TEST_CASE("islands that only touch are apart, also where single precision has rounded them") {
  const SquareIslands touching({{{0, 0}, 1}, {{1, 0}, 1}, {{0, 1 - 1e-7}, 1}, {{2, 1}, 1}});
  CHECK(touching.groups() == std::vector<int>{0, 1, 2, 3});
}

TEST_CASE("faces of no island group nothing") {
  SquareIslands islands({{{0, 0}, 1}, {{0.5, 0}, 3}, {{3, 0}, 1}});
  islands.island_of_face = {0, -1, 1};
  CHECK(overlapping_islands(islands.points, islands.face_offsets, islands.corners, islands.island_of_face, 2) ==
        std::vector<int>{0, 1});
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
