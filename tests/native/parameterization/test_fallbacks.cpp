#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "meshes.h"
#include "parameterization/fallbacks.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("fallbacks");

TEST_CASE("a patch that is thin to a point is solved with clamped triangles") {
  const Patch patch(rounded_grid(40, 1.0 / 20));
  const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
  SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  Timings timings;
  CHECK(solver.solve({}, {}, {}, timings).rejection == Rejection::unresolved);
  int attempts = 2;
  const std::optional<FallbackMap> other = solve_fallback(solver, {}, {}, 0, {}, timings, attempts);
  REQUIRE(other);
  CHECK(other->fallback == Fallback::clamped_triangles);
  CHECK((other->clamped_triangles > 0 && attempts > 2));
  CHECK((other->weights == Weights::uniform && other->boundary == BoundaryMeasure::length));
  CHECK(other->map.rejection == Rejection::none);
}

TEST_CASE("a map that winds twice gives way to the one of the other boundary form, and says of which") {
  const Patch patch(rounded_grid(20, 0.5));
  const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
  SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  Timings timings;
  CHECK(solver.solve({}, {}, {}, timings).rejection == Rejection::winding);
  int attempts = 0;
  const std::optional<FallbackMap> other = solve_fallback(solver, {}, {}, 0, {}, timings, attempts);
  REQUIRE(other);
  CHECK(other->fallback == Fallback::other_boundary);
  CHECK(other->boundary == BoundaryMeasure::vertex);
  CHECK(other->clamped_triangles == 0);
  // The eigenvalue is that of the form named.
  const SpectralSolver named(solver, other->weights, other->boundary);
  CHECK(other->map.eigenvalue ==
        doctest::Approx(named.energy().value(other->map.z) / named.form().value(other->map.z)));
}

TEST_CASE("without any map there is no fallback") {
  const Patch patch(bumpy_grid(4, 4));
  NormalizedPatch empty = normalized_patch(patch.chart, patch.positions, false);
  std::fill(empty.triangle_weights.begin(), empty.triangle_weights.end(), 0.0);
  const SpectralSolver solver(empty, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  Timings timings;
  int attempts = 0;
  CHECK_FALSE(solve_fallback(solver, {}, {}, 0, {}, timings, attempts));
  CHECK(attempts > 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
