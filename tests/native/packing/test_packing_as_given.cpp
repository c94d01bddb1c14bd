#include <doctest/doctest.h>

#include "packing/packing_as_given.h"

namespace spectral_conformal::test {
namespace {

IslandOutline box_at(double x, double y) {
  const Complex corners[] = {{x, y}, {x + 40, y}, {x + 40, y + 90}, {x, y + 90}};
  IslandOutline box{{}, 3600};
  for (int k = 0; k < 4; ++k) box.edges.push_back({corners[k], corners[(k + 1) % 4]});
  return box;
}

}  // namespace

TEST_SUITE_BEGIN("packing_as_given");

TEST_CASE("islands stay where they keep the margin, get a little smaller for it, or are refused") {
  PackingOptions options;
  options.regions = {{{0, 0}, {100, 100}}};
  options.margin = 4;
  PackingProblem problem{{box_at(4, 4), box_at(49, 5)}, {-1, -1}, {}};
  const PackingGrid grid(options.regions, options.margin, {}, 40);
  const Packing kept = packing_as_given(problem, options, grid, 1, 0.5);
  CHECK(kept.scale == 1);
  CHECK(kept.motions.back()(Complex(49, 5)) == Complex(49, 5));
  CHECK(packing_as_given(problem, options, grid, 1, 1).scale == 0);
  // A tenth of a pixel too close to each other and to the border.
  problem.islands.back() = box_at(47.95, 5);
  const Packing smaller = packing_as_given(problem, options, grid, 1, 0.5);
  CHECK(smaller.scale > 0.99);
  CHECK(smaller.scale < 1);
  options.scales = false;
  CHECK(packing_as_given(problem, options, grid, 1, 0.5).scale == 0);
  options.scales = true;
  problem.islands.back() = box_at(45, 5);
  CHECK(packing_as_given(problem, options, grid, 1, 0.5).scale == 0);
  problem.islands.back() = box_at(49, 5);
  problem.obstacles = box_at(70, 7);
  CHECK(packing_as_given(problem, options, grid, 1, 0.5).scale == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
