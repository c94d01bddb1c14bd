#include <doctest/doctest.h>

#include "meshes.h"
#include "parameterization/pinned_map.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("pinned_map");

TEST_CASE("pins are held exactly in any unit, fewer than two leave the map to be placed") {
  const Patch patch(bumpy_grid(6, 5));
  const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
  const SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  Timings timings;
  const Pins pins{{0, {1, 2}}, {6, {7, 2}}, {41, {7, 8}}};
  const SpectralMap map = solve_pinned(solver, pins, {}, timings);
  REQUIRE(map.rejection == Rejection::none);
  for (const auto& [vertex, position] : pins) CHECK(map.z[vertex] == position);
  Pins large;
  for (const auto& [vertex, position] : pins) large[vertex] = 1e200 * position;
  CHECK(difference(solve_pinned(solver, large, {}, timings).z / 1e200, map.z) < 1e-12);
  const ComplexVector free = solve_pinned(solver, {}, {}, timings).z;
  CHECK(std::abs(free.mean()) < 1e-12);
  CHECK(solve_pinned(solver, {{3, 5.0}}, {}, timings).z == free);
  CHECK_THROWS_AS(solve_pinned(solver, {{0, 1.0}, {3, 1.0}}, {}, timings), InvalidMesh);
}

TEST_CASE("a single pin is met exactly by moving the map") {
  ComplexVector z = random_map(5);
  const Complex side = z[1] - z[0];
  move_onto_pin({{3, {1e3, 7}}}, z);
  CHECK(z[3] == Complex(1e3, 7));
  CHECK(std::abs(z[1] - z[0] - side) < 1e-12);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
