#include <doctest/doctest.h>

#include "packing/settling.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("settling");

TEST_CASE("two squares grow by what coarse cells have lost; at a given scale they stay") {
  const IslandOutline square{{{{0, 0}, {1, 0}}, {{1, 0}, {1, 1}}, {{1, 1}, {0, 1}}, {{0, 1}, {0, 0}}}, 1};
  const PackingProblem problem{{square, square, square}, {-1, -1, -1}, {}};
  const std::vector<PackingRegion> regions{{{0, 0}, {41, 41}}};
  const PackingGrid grid(regions, 1, {}, 1);
  const PackingGrid fine(regions, 1, {}, refinement);
  // With the margin, 19.2 cells wide: twenty, of forty.
  const IslandRaster raster = IslandRaster::of(square, 18.2, grid.border());
  const GridLayout layout{18.2, {&raster, &raster, nullptr}, {{0, 0}, {20, 0}, {0, 0}}};
  const Packing packing = settled(problem, grid, fine, layout, true, 1e-3);
  CHECK(packing.scale > 1.02 * layout.scale);
  CHECK(packing.scale <= 19);
  CHECK(packing.has_room == std::vector<bool>{true, true, false});
  CHECK(packing.motions[1](0).real() - packing.motions[0](1).real() >= 1);
  CHECK(settled(problem, grid, fine, layout, false, 1e-3).scale == layout.scale);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
