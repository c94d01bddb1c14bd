#include <doctest/doctest.h>

#include "packing/cell_outline.h"
#include "packing/island_raster.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("cell_outline");

TEST_CASE("crossing edges give way to the border of what they cover, which covers no less and little more") {
  // Strips across a square with a hole, on each other in both directions.
  IslandOutline crossing{{}, 7};
  const auto add_box = [&](Complex low, Complex high) {
    const Complex corners[] = {low, {high.real(), low.imag()}, high, {low.real(), high.imag()}};
    for (int k = 0; k < 4; ++k) crossing.edges.push_back({corners[k], corners[(k + 1) % 4]});
  };
  for (int k = 0; k < 20; ++k) {
    const double shift = 0.01 * k;
    add_box({0, shift}, {3, 0.8 + shift});
    add_box({0, 2 + shift}, {3, 2.8 + shift});
    add_box({shift, 0}, {0.8 + shift, 3});
    add_box({2 + shift, 0}, {2.8 + shift, 3});
  }
  const IslandOutline border = without_inner_edges(crossing);
  CHECK(border.area == 7);
  double length = 0;
  for (const OutlineEdge& edge : border.edges) length += std::abs(edge.to - edge.from);
  CHECK(length < 19);
  const auto cells_of = [](const IslandOutline& outline) {
    const IslandRaster raster = IslandRaster::of(outline, std::polar(30.0, 0.3), 1);
    double cells = 0;
    for (const CellSpan& span : raster.spans()) cells += span.end - span.begin;
    return cells;
  };
  CHECK(cells_of(border) >= cells_of(crossing));
  CHECK(cells_of(border) < 1.02 * cells_of(crossing));
}

TEST_CASE("an outline without inner edges stays") {
  const IslandOutline square{{{{0, 0}, {1, 0}}, {{1, 0}, {1, 1}}, {{1, 1}, {0, 1}}, {{0, 1}, {0, 0}}}, 1};
  CHECK(without_inner_edges(square).edges.size() == 4);
  IslandOutline stack;
  for (int k = 0; k < 6; ++k) add(stack, square, {});
  CHECK(without_inner_edges(stack, 6).edges.size() == 24);
  CHECK(without_inner_edges({}).edges.empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
