#include <doctest/doctest.h>

#include <algorithm>

#include "packing/packing_search.h"

namespace spectral_conformal::test {
namespace {

/// Right triangles: two of them make a square.
PackingProblem triangles(int n, double side = 1) {
  PackingProblem problem;
  for (int k = 0; k < n; ++k) {
    const Complex right(side, 0);
    const Complex top(0, side);
    problem.islands.push_back({{{0, right}, {right, top}, {top, 0}}, 0.5 * side * side});
    problem.region.push_back(-1);
  }
  return problem;
}

/// Triangles without a right angle, none like another.
PackingProblem slanted(int n) {
  PackingProblem problem = triangles(n);
  for (int k = 0; k < n; ++k) {
    IslandOutline& island = problem.islands[static_cast<std::size_t>(k)];
    const Complex top(0.3 + 0.4 * k / n, 1 + 0.7 * k / n);
    island = {{{{0, 0}, {1, 0}}, {{1, 0}, top}, {top, {0, 0}}}, 0.5 * top.imag()};
  }
  return problem;
}

PackingOptions unit_tile() {
  PackingOptions options;
  options.regions = {{{0, 0}, {100, 100}}};
  options.margin = 1;
  return options;
}

double area_of(const Packing& packing, std::size_t n) {
  return 0.5 * static_cast<double>(n) * packing.scale * packing.scale / 1e4;
}

}  // namespace

TEST_SUITE_BEGIN("packing_search");

TEST_CASE("turned triangles fill more than their boxes could") {
  const PackingProblem problem = triangles(8);
  const PackingOptions options = unit_tile();
  PackingSearch search(problem, options);
  REQUIRE(search.begin());
  CHECK(area_of(search.settled(), 8) > 0.55);
}

TEST_CASE("an island with a region lies there, the others fill all") {
  PackingProblem problem = triangles(9);
  PackingOptions options = unit_tile();
  options.regions.push_back({{100, 0}, {200, 100}});
  problem.region[4] = 1;
  PackingSearch search(problem, options);
  REQUIRE(search.begin());
  const Packing& packing = search.settled();
  const auto tile = [&](std::size_t i) { return packing.motions[i](Complex(0.3, 0.3)).real() > 100; };
  CHECK(tile(4));
  CHECK_FALSE(tile(0));
  CHECK(std::all_of(packing.has_room.begin(), packing.has_room.end(), [](bool has) { return has; }));
}

TEST_CASE("a finer grid fills more, and the search on it ends where there is no more (large)") {
  const PackingProblem problem = slanted(60);
  const PackingOptions options = unit_tile();
  PackingSearch search(problem, options);
  REQUIRE(search.begin());
  const double first = search.settled().scale;
  PackingSearch finer(problem, options, 2);
  CHECK(finer.grid().cells_per_pixel() == doctest::Approx(2 * search.grid().cells_per_pixel()));
  int trials = 1;
  while (!finer.narrow(first, 0.9 * first)) ++trials;
  CHECK(trials < 15);
  CHECK(finer.settled().scale > first);
  PackingSearch without_room(problem, options, 2);
  trials = 1;
  while (!without_room.narrow(3 * first, 2 * first)) ++trials;
  // Down by 3 / 2 in steps that double.
  CHECK(trials < 10);
  CHECK(without_room.settled().scale == 0);
}

TEST_CASE("the same seed repeats a search of room at a given scale") {
  // Not all of them find any.
  const PackingProblem problem = triangles(11, 40);
  const auto motions = [&](unsigned seed) {
    PackingOptions options = unit_tile();
    options.seed = seed;
    options.scales = false;
    PackingSearch search(problem, options);
    CHECK_FALSE(search.begin());
    for (int k = 0; k < 5; ++k) search.advance();
    std::vector<Complex> offsets;
    for (const PlaneMotion& motion : search.settled().motions) offsets.push_back(motion.offset);
    return offsets;
  };
  CHECK(motions(1) == motions(1));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
