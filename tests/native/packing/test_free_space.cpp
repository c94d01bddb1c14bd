#include <doctest/doctest.h>

#include <random>
#include <vector>

#include "packing/free_space.h"

namespace spectral_conformal::test {
namespace {

IslandRaster box_raster(double width, double height) {
  IslandOutline outline;
  const std::vector<Complex> corners{{0, 0}, {width, 0}, {width, height}, {0, height}};
  for (std::size_t i = 0; i < 4; ++i) outline.edges.push_back({corners[i], corners[(i + 1) % 4]});
  return IslandRaster::of(outline, 1, 0);
}

/// The same search, cell by cell.
std::optional<CellPosition> lowest_by_cells(const std::vector<std::vector<bool>>& taken, const IslandRaster& raster) {
  const int rows = static_cast<int>(taken.size());
  const int columns = static_cast<int>(taken.front().size());
  for (int y = 0; y + raster.height() <= rows; ++y) {
    for (int x = 0; x + raster.width() <= columns; ++x) {
      bool fits = true;
      for (const CellSpan& span : raster.spans()) {
        for (int c = span.begin; c < span.end; ++c) {
          fits = fits && !taken[static_cast<std::size_t>(y + span.row)][static_cast<std::size_t>(x + c)];
        }
      }
      if (fits) return CellPosition{x, y};
    }
  }
  return std::nullopt;
}

}  // namespace

TEST_SUITE_BEGIN("free_space");

TEST_CASE("the lowest position is that of a search cell by cell") {
  std::mt19937 chance(1);
  for (const int width : {1, 63, 64, 65, 200}) {
    FreeSpace space(width, 40);
    std::vector<std::vector<bool>> taken(40, std::vector<bool>(static_cast<std::size_t>(width)));
    for (int k = 0; k < 60; ++k) {
      const IslandRaster raster =
          box_raster(0.5 + static_cast<double>(chance() % 30), 0.5 + static_cast<double>(chance() % 9));
      const auto found = space.lowest(raster, space.window(raster, 0, space.height()));
      const auto expected = lowest_by_cells(taken, raster);
      REQUIRE(found.has_value() == expected.has_value());
      if (!found) continue;
      CHECK(found->x == expected->x);
      CHECK(found->y == expected->y);
      space.occupy(raster.spans(), *found);
      for (const CellSpan& span : raster.spans()) {
        for (int c = span.begin; c < span.end; ++c) {
          taken[static_cast<std::size_t>(found->y + span.row)][static_cast<std::size_t>(found->x + c)] = true;
        }
      }
    }
  }
}

TEST_CASE("a window bounds the search, and cells outside of the grid are not taken") {
  FreeSpace space(100, 30);
  space.occupy({{-1, 0, 100}, {5, -7, 200}}, {});
  const IslandRaster raster = box_raster(9.5, 2.5);
  CHECK(space.lowest(raster, space.window(raster, 0, 30))->y == 0);
  const auto found = space.lowest(raster, {70, 80, 3, 20});
  REQUIRE(found);
  CHECK(found->x == 70);
  CHECK(found->y == 6);
  CHECK_FALSE(space.lowest(raster, {70, 80, 3, 5}));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
