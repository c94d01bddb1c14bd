#include <doctest/doctest.h>

#include "concurrency/parallel_calls.h"
#include "packing/cached_rasters.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("cached_rasters");

TEST_CASE("threads get the same raster, which is that of the turned island") {
  IslandOutline outline;
  outline.edges = {{{0, 0}, {4, 0}}, {{4, 0}, {0, 2}}, {{0, 2}, {0, 0}}};
  const std::vector<IslandOutline> islands{outline, outline};
  const std::vector<std::vector<Complex>> turns{{1}, {1, Complex(0, 1)}};
  const CachedRasters rasters(islands, turns, 3, 0.5);
  std::vector<const IslandRaster*> seen(8);
  run_in_parallel(
      8, [&](int k, const Progress&) { seen[static_cast<std::size_t>(k)] = &rasters.at(1, k % 2); }, {}, "");
  for (int k = 2; k < 8; ++k) CHECK(seen[static_cast<std::size_t>(k)] == seen[static_cast<std::size_t>(k % 2)]);
  CHECK(seen[0] != seen[1]);
  CHECK(rasters.at(1, 1).has_same_cells(IslandRaster::of(outline, Complex(0, 3), 0.5)));
  CHECK(rasters.at(0, 0).has_same_cells(rasters.at(1, 0)));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
