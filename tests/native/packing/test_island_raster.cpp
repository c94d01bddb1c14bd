#include <doctest/doctest.h>

#include "packing/island_raster.h"

namespace spectral_conformal::test {
namespace {

IslandOutline rectangle(double width, double height, Complex corner) {
  const std::vector<Complex> corners{{0, 0}, {width, 0}, {width, height}, {0, height}};
  IslandOutline outline;
  for (std::size_t i = 0; i < 4; ++i) outline.edges.push_back({corner + corners[i], corner + corners[(i + 1) % 4]});
  return outline;
}

}  // namespace

TEST_SUITE_BEGIN("island_raster");

TEST_CASE("a raster begins at the first cell, and knows where the island lies in it") {
  const Complex corner(-37.2, 11.7);
  const IslandRaster raster = IslandRaster::of(rectangle(5.5, 2.5, corner), 2, 1.25);
  CHECK(raster.width() == 14);
  CHECK(raster.height() == 8);
  CHECK(std::abs(2.0 * corner + raster.origin() - Complex(1.25, 1.25)) < 1e-5);
}

TEST_CASE("two spans of a power of two cover each span, the longest first") {
  const IslandRaster raster = IslandRaster::of(rectangle(30, 8, 0), std::polar(1.0, 0.3), 1);
  REQUIRE(raster.longest_first().size() == raster.spans().size());
  int before = 1 << 30;
  for (const CoveredSpan& span : raster.longest_first()) {
    const int length = span.second + (1 << span.level) - span.first;
    CHECK(length <= before);
    CHECK(length >= 1 << span.level);
    CHECK(length < 2 << span.level);
    before = length;
  }
}

TEST_CASE("half a turn of a rectangle has the same cells, a quarter has not") {
  const IslandOutline island = rectangle(5.5, 2.5, {3, 4});
  const IslandRaster raster = IslandRaster::of(island, 1, 1);
  CHECK(raster.has_same_cells(IslandRaster::of(island, -1, 1)));
  CHECK_FALSE(raster.has_same_cells(IslandRaster::of(island, Complex(0, 1), 1)));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
