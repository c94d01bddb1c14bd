#include <doctest/doctest.h>

#include <vector>

#include "mesh/connected_faces.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("connected_faces");

TEST_CASE("faces that share vertices are connected, and numbered by their first faces") {
  // The second and the fourth face share a vertex, through which the last one is connected, too; the third has none.
  const std::vector<int> offsets{0, 3, 6, 6, 10, 12};
  const std::vector<int> corners{9, 8, 7, 2, 1, 0, 3, 2, 4, 5, 5, 6};
  CHECK(connected_faces(offsets.data(), corners.data(), 5, 10) == std::vector<int>{0, 1, -1, 1, 1});
  CHECK(connected_faces(offsets.data(), corners.data(), 0, 10).empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
