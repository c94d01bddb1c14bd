#include <doctest/doctest.h>

#include <cmath>

#include "packing/growth_stage.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("growth_stage");

TEST_CASE("a square grows until it fills its region, then the stage is exhausted") {
  const IslandOutline square{{{{0, 0}, {1, 0}}, {{1, 0}, {1, 1}}, {{1, 1}, {0, 1}}, {{0, 1}, {0, 0}}}, 1};
  PackingProblem problem{{square}, {-1}, {}};
  PackingOptions options;
  options.regions = {{{0, 0}, {100, 100}}};
  options.margin = 1;
  const PackingGrid grid(options.regions, options.margin, {}, 2);
  const Packing first{70, {PlaneMotion{70, false, Complex(5, 5)}}, {true}};
  GrowthEffort effort;
  effort.range = MoveRange::nearby;
  effort.first_step = 1.05;
  effort.last_step = 1.005;
  effort.patience = 3;
  const auto stage = GrowthStage::begin(problem, options, grid, effort, first);
  CHECK(stage->scale() == 0);
  CHECK(stage->packing().scale == 0);
  for (int k = 0; k < 300 && !stage->is_exhausted(); ++k) stage->advance();
  CHECK(stage->is_exhausted());
  CHECK(stage->passes_since() > 0);
  CHECK(stage->scale() > 0.97 * 98);
  CHECK(stage->scale() <= 98);
  CHECK(stage->packing().has_room == std::vector<bool>{true});
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
