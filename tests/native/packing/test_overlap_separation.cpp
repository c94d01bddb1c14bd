#include <doctest/doctest.h>

#include <algorithm>
#include <memory>

#include "packing/overlap_separation.h"
#include "packing/packing_turns.h"

namespace spectral_conformal::test {
namespace {

IslandOutline box_outline(double width, double height) {
  IslandOutline outline{{}, width * height};
  const std::vector<Complex> corners{{0, 0}, {width, 0}, {width, height}, {0, height}};
  for (std::size_t i = 0; i < 4; ++i) outline.edges.push_back({corners[i], corners[(i + 1) % 4]});
  return outline;
}

/// Counts how many rasters and obstacles cover the cells of a grid.
int max_cover(const OverlapSeparation& separation, const PackingGrid& grid, int n) {
  std::vector<int> cover(static_cast<std::size_t>(grid.space().width() * grid.space().height()));
  const auto add = [&](const std::vector<CellSpan>& spans, CellPosition at) {
    for (const CellSpan& span : spans) {
      for (int x = span.begin; x < span.end; ++x) {
        ++cover.at(static_cast<std::size_t>((at.y + span.row) * grid.space().width() + at.x + x));
      }
    }
  };
  add(grid.space().taken(), {});
  for (int i = 0; i < n; ++i) add(separation.raster(i).spans(), separation.position(i));
  return *std::max_element(cover.begin(), cover.end());
}

}  // namespace

TEST_SUITE_BEGIN("overlap_separation");

TEST_CASE("bars that overlap each other and an obstacle come apart within their regions") {
  PackingProblem problem;
  problem.islands.assign(5, box_outline(50, 12));
  problem.region = {-1, -1, -1, -1, 1};
  problem.obstacles = box_outline(30, 30);
  const std::vector<PackingRegion> regions{{{0, 0}, {64, 64}}, {{64, 0}, {128, 40}}};
  const PackingGrid grid(regions, 2, problem.obstacles, 1);
  for (const PackingTurns turning : {PackingTurns::none, PackingTurns::quarters, PackingTurns::free}) {
    const std::vector<std::vector<Complex>> turns(5, turns_of(hull_of(problem.islands.front()), turning, 32));
    // The first two islands turn by quarters.
    OverlapSeparation separation(problem, grid, turns, {true, true, false, false, false}, MoveRange::anywhere, 3);
    const auto rasters = std::make_shared<CachedRasters>(problem.islands, turns, 0.8, grid.border());
    REQUIRE(separation.start(rasters, std::vector<IslandPose>(5, {0, Complex(30, 20)})));
    CHECK(max_cover(separation, grid, 5) > 1);
    int passes = 0;
    while (!separation.pass()) REQUIRE(++passes < 500);
    CHECK(separation.n_overlapping_cells() == 0);
    CHECK(max_cover(separation, grid, 5) == 1);
    CHECK(separation.position(4).y >= grid.bands()[1].bottom);
    const int quarter = std::max<int>(1, static_cast<int>(turns.front().size()) / 4);
    for (std::size_t i = 0; i < 2; ++i) CHECK(separation.poses()[i].turn % quarter == 0);
  }
}

TEST_CASE("an island larger than its region is refused") {
  PackingProblem problem;
  problem.islands = {box_outline(50, 12)};
  problem.region = {-1};
  const PackingGrid grid({{{0, 0}, {64, 64}}}, 2, {}, 1);
  const std::vector<std::vector<Complex>> turns{{1}};
  OverlapSeparation separation(problem, grid, turns, {false}, MoveRange::anywhere, 0);
  CHECK(separation.start(std::make_shared<CachedRasters>(problem.islands, turns, 1, 1), {{0, 0}}));
  CHECK_FALSE(separation.start(std::make_shared<CachedRasters>(problem.islands, turns, 2, 1), {{0, 0}}));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
