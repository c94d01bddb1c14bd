#include <doctest/doctest.h>

#include "packing/packing_by_boxes.h"

namespace spectral_conformal::test {
namespace {

PackingProblem upright_boxes(int n) {
  PackingProblem problem;
  for (int k = 0; k < n; ++k) {
    const std::vector<Complex> corners{{0, 0}, {1, 0}, {1, 2}, {0, 2}};
    IslandOutline outline;
    for (std::size_t i = 0; i < 4; ++i) outline.edges.push_back({corners[i], corners[(i + 1) % 4]});
    outline.area = 2;
    problem.islands.push_back(outline);
    problem.region.push_back(-1);
  }
  return problem;
}

}  // namespace

TEST_SUITE_BEGIN("packing_by_boxes");

TEST_CASE("boxes fill a tile that they divide, but for the margin") {
  PackingOptions options;
  options.regions = {{{0, 0}, {101, 101}}};
  options.margin = 1;
  const auto packing = packing_by_boxes(upright_boxes(8), options);
  // Four by two: each as wide as a quarter of 100 less a margin of 1.
  CHECK(packing.scale == doctest::Approx(24).epsilon(0.01));
  // The scale s at which the areas, 8 (s + 1) (2 s + 1), are that of the tile.
  CHECK(largest_scale_of_boxes(upright_boxes(8), options) == doctest::Approx(24.253).epsilon(1e-4));
  options.margin = 200;
  CHECK(largest_scale_of_boxes(upright_boxes(8), options) == 0);
}

TEST_CASE("not for several regions, obstacles or fixed scales") {
  PackingOptions options;
  options.regions = {{{0, 0}, {101, 101}}};
  PackingProblem problem = upright_boxes(8);
  options.scales = false;
  CHECK(packing_by_boxes(problem, options).scale == 0);
  options.scales = true;
  problem.obstacles = problem.islands.front();
  CHECK(packing_by_boxes(problem, options).scale == 0);
  problem.obstacles = {};
  CHECK(packing_by_boxes(problem, options).scale > 0);
  options.regions.push_back(options.regions.front());
  CHECK(packing_by_boxes(problem, options).scale == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
