#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "packing/overlap_map.h"

namespace spectral_conformal::test {
namespace {

constexpr std::int64_t no_limit = std::int64_t{1} << 60;

/// A triangle, which has a span of another length in each row.
IslandRaster triangle_raster() {
  IslandOutline outline;
  outline.edges = {{{0, 0}, {9, 2}}, {{9, 2}, {3, 8}}, {{3, 8}, {0, 0}}};
  return IslandRaster::of(outline, 1, 0);
}

}  // namespace

TEST_SUITE_BEGIN("overlap_map");

TEST_CASE("the weight under a raster is the sum over its cells, of what lies in the window") {
  const CellWindow window{5, 45, 3, 33};
  const IslandRaster raster = triangle_raster();
  std::vector<std::vector<int>> weights(60, std::vector<int>(60));
  OverlapMap map;
  map.begin(window);
  std::mt19937 chance(1);
  const auto below = [&](int n) { return static_cast<int>(chance() % static_cast<unsigned>(n)); };
  for (int k = 0; k < 20; ++k) {
    const CellPosition at{below(60) - 5, below(50) - 5};
    const int weight = 1 + below(9);
    map.add(raster.spans(), at, weight);
    for (const CellSpan& span : raster.spans()) {
      for (int x = at.x + span.begin; x < at.x + span.end; ++x) {
        const int y = at.y + span.row;
        const bool is_inside = x >= window.x_begin && x < window.x_end && y >= window.y_begin && y < window.y_end;
        if (is_inside) weights[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] += weight;
      }
    }
  }
  map.sum_rows();
  for (int y = window.y_begin; y + raster.height() <= window.y_end; ++y) {
    for (int x = window.x_begin; x + raster.width() <= window.x_end; ++x) {
      std::int64_t expected = 0;
      for (const CellSpan& span : raster.spans()) {
        for (int c = span.begin; c < span.end; ++c) {
          expected += weights[static_cast<std::size_t>(y + span.row)][static_cast<std::size_t>(x + c)];
        }
      }
      REQUIRE(map.under(raster, {x, y}, no_limit) == expected);
      const std::int64_t limit = std::max<std::int64_t>(1, expected / 2);
      CHECK((map.under(raster, {x, y}, limit) >= limit) == (expected >= limit));
    }
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
