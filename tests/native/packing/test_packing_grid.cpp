#include <doctest/doctest.h>

#include "packing/packing_grid.h"

namespace spectral_conformal::test {
namespace {

IslandRaster cell_raster() {
  IslandOutline point;
  point.edges.push_back({0, 0});
  return IslandRaster::of(point, 1, 0.25);
}

}  // namespace

TEST_SUITE_BEGIN("packing_grid");

TEST_CASE("regions are bands with a taken row between them, narrow ones end where they end") {
  const PackingGrid grid({{{0, 0}, {68, 36}}, {{100, 0}, {120, 20}}}, 4, {}, 0.5);
  REQUIRE(grid.bands().size() == 2);
  CHECK(grid.bands()[0].width == 32);
  CHECK(grid.bands()[0].top == 16);
  CHECK(grid.bands()[1].bottom == 17);
  CHECK(grid.bands()[1].width == 8);
  CHECK(grid.border() == 1);
  CHECK(grid.band_of_row(3) == 0);
  CHECK(grid.band_of_row(17) == 1);
  CHECK(grid.pixels({1, 18}, 1) == Complex(104, 4));
  const IslandRaster cell = cell_raster();
  const FreeSpace& space = grid.space();
  CHECK_FALSE(space.lowest(cell, {0, 31, 16, 16}));
  CHECK(space.lowest(cell, {7, 31, 17, 17}));
  CHECK_FALSE(space.lowest(cell, {8, 31, 17, 17}));
}

TEST_CASE("an obstacle takes its cells with half a margin") {
  const IslandOutline obstacle{{{{10, 10}, {20, 10}}, {{20, 10}, {20, 20}}, {{20, 20}, {10, 20}}, {{10, 20}, {10, 10}}},
                               100};
  const PackingGrid grid({{{0, 0}, {40, 40}}}, 2, obstacle, 1);
  // Cell x lies at pixel x + 1.
  const IslandRaster cell = cell_raster();
  const auto is_free = [&](int x) { return grid.space().lowest(cell, {x, x, 15, 15}).has_value(); };
  CHECK(is_free(6));
  CHECK_FALSE(is_free(8));
  CHECK_FALSE(is_free(14));
  CHECK_FALSE(is_free(19));
  CHECK(is_free(21));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
