#include <doctest/doctest.h>

#include <vector>

#include "rebake/border_sides.h"

namespace spectral_conformal::test {
namespace {

std::vector<int> sides_of(const std::vector<int>& triangles) {
  return border_sides(triangles.data(), static_cast<int>(triangles.size() / 3));
}

}  // namespace

TEST_SUITE_BEGIN("border_sides");

TEST_CASE("a side that two triangles have is inside, whatever its direction") {
  CHECK(sides_of({0, 1, 2}) == std::vector<int>{0, 1, 2});
  CHECK(sides_of({0, 1, 2, 2, 1, 3}) == std::vector<int>{0, 2, 4, 5});
  CHECK(sides_of({0, 1, 2, 1, 2, 3}) == std::vector<int>{0, 2, 4, 5});
}

TEST_CASE("a closed surface has none, and neither has nothing") {
  CHECK(sides_of({0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0}).empty());
  CHECK(sides_of({}).empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
