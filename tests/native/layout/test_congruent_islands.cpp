#include <doctest/doctest.h>

#include <vector>

#include "layout/congruent_islands.h"

namespace spectral_conformal::test {
namespace {

/// An outline without symmetries, moved.
IslandOutline hook(const PlaneMotion& motion, double width = 1) {
  const std::vector<Complex> corners{{0, 0}, {4, 0}, {4, width}, {1, 1}, {1, 3}, {0, 3}};
  IslandOutline outline;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    outline.edges.push_back({motion(corners[i]), motion(corners[(i + 1) % corners.size()])});
  }
  outline.area = 6;
  return outline;
}

}  // namespace

TEST_SUITE_BEGIN("congruent_islands");

TEST_CASE("congruent islands are found where asked, and the motion lays one on the other") {
  const PlaneMotion turned{std::polar(1.0, 2.1), false, {7, -3}};
  const PlaneMotion mirrored{std::polar(1.0, -0.4), true, {-20, 1}};
  const std::vector<IslandOutline> islands{hook({}), hook(turned), hook(mirrored), hook({}, 1.2),
                                           hook({1, false, 0.001})};
  /// The first island of each one's stack.
  const auto stacks = [&](Congruence congruence) {
    std::vector<int> result;
    const auto stacked = congruent_islands(islands, congruence, 0.005);
    for (std::size_t i = 0; i < islands.size(); ++i) {
      const StackedIsland& at = stacked[i];
      const auto& onto = islands[static_cast<std::size_t>(at.representative)].edges;
      for (std::size_t k = 0; k < onto.size() && at.representative != static_cast<int>(i); ++k) {
        CHECK(std::abs(at.onto(islands[i].edges[k].from) - onto[k].from) < 0.01);
      }
      std::size_t first = 0;
      while (stacked[first].representative != at.representative) ++first;
      result.push_back(static_cast<int>(first));
    }
    return result;
  };
  CHECK(stacks(Congruence::in_place) == std::vector<int>{0, 1, 2, 3, 0});
  CHECK(stacks(Congruence::moved) == std::vector<int>{0, 0, 2, 3, 0});
  CHECK(stacks(Congruence::mirrored) == std::vector<int>{0, 0, 0, 3, 0});
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
