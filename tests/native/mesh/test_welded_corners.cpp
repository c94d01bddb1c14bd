#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "mesh/welded_corners.h"

namespace spectral_conformal::test {
namespace {

/// Four corners at one vertex and one at another.
struct Corners {
  std::vector<int> vertices{0, 0, 0, 1, 0};
  std::vector<int> islands{0, 0, 1, 0, 0};
  std::vector<Complex> uv{{1, 2}, {1, 2}, {1, 2}, {1, 2}, {3, 2}};

  WeldedCorners welded() const {
    return welded_corners(vertices.data(), islands.data(), uv.data(), static_cast<int>(vertices.size()), 2);
  }
};

}  // namespace

TEST_SUITE("welded_corners") {
  TEST_CASE("corners are joined if they have the same vertex, island and UV") {
    const WeldedCorners welded = Corners().welded();
    CHECK(welded.first_corner.size() == 4);
    CHECK(welded.point[0] == welded.point[1]);
    for (const int other : {2, 3, 4}) CHECK(welded.point[static_cast<std::size_t>(other)] != welded.point[0]);
    for (std::size_t c = 0; c < welded.point.size(); ++c) {
      const auto first = static_cast<std::size_t>(welded.first_corner[static_cast<std::size_t>(welded.point[c])]);
      CHECK(Corners().vertices[first] == Corners().vertices[c]);
    }
  }

  TEST_CASE("both zeros are one UV, and a UV that is no number is one, too") {
    Corners corners;
    corners.uv = {{0.0, NAN}, {-0.0, NAN}, {0, 0}, {0, 0}, {0, NAN}};
    const WeldedCorners welded = corners.welded();
    CHECK(welded.point[0] == welded.point[1]);
    CHECK(welded.point[0] == welded.point[4]);
    CHECK(welded.first_corner.size() == 3);
  }
}

}  // namespace spectral_conformal::test
