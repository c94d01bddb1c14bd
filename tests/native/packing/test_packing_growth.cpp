#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "packing/packing_growth.h"

namespace spectral_conformal::test {
namespace {

/// Corners of three unit squares.
PackingProblem corners(int n) {
  PackingProblem problem;
  const std::vector<Complex> points{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  IslandOutline outline;
  for (std::size_t i = 0; i < 6; ++i) outline.edges.push_back({points[i], points[(i + 1) % 6]});
  outline.area = 3;
  problem.islands.assign(static_cast<std::size_t>(n), outline);
  problem.region.assign(static_cast<std::size_t>(n), -1);
  return problem;
}

/// In rows, each in a square of side 2.
Packing in_rows(int n, double side) {
  const int columns = static_cast<int>(std::ceil(std::sqrt(n)));
  Packing packing;
  packing.scale = side / columns / 2.1;
  for (int i = 0; i < n; ++i) {
    const Complex corner = side / columns * Complex(i % columns, i / columns);
    packing.motions.push_back({packing.scale, false, corner + Complex(1, 1)});
  }
  packing.has_room.assign(static_cast<std::size_t>(n), true);
  return packing;
}

}  // namespace

TEST_SUITE_BEGIN("packing_growth");

TEST_CASE("corners grow into each other, by the seed alone, and keep apart") {
  constexpr int n = 8;
  const PackingProblem problem = corners(n);
  PackingOptions options;
  options.regions = {{{0, 0}, {100, 100}}};
  options.margin = 1;
  const PackingGrid grid(options.regions, options.margin, {}, 1);
  const PackingGrid fine_grid(options.regions, options.margin, {}, 4);
  const Packing first = in_rows(n, 100);
  const auto grown = [&](unsigned seed) {
    options.seed = seed;
    PackingGrowth growth = PackingGrowth::begin(problem, options, grid, fine_grid, first, false);
    for (int k = 0; k < 60; ++k) growth.advance();
    return growth.packing();
  };
  const Packing packing = grown(1);
  CHECK(packing.scale > 1.1 * first.scale);
  const Packing again = grown(1);
  CHECK(again.scale == packing.scale);
  // With less than half of the margin around each, at 20 cells per pixel, no cell is taken twice.
  constexpr double resolution = 20;
  const PackingGrid check(options.regions, options.margin, {}, resolution);
  FreeSpace space = check.space();
  int cells = 0;
  for (std::size_t i = 0; i < n; ++i) {
    CHECK(again.motions[i].offset == packing.motions[i].offset);
    CHECK(std::abs(packing.motions[i].factor) == doctest::Approx(packing.scale));
    const Complex origin = resolution * (packing.motions[i].offset - check.bands()[0].origin);
    const auto spans = cell_spans(problem.islands[i].edges, resolution * packing.motions[i].factor, origin,
                                  check.border() - 1, space.height());
    for (const CellSpan& span : spans) cells += span.end - span.begin;
    space.occupy(spans, {});
  }
  for (const CellSpan& span : space.taken()) cells -= span.end - span.begin;
  CHECK(cells == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
