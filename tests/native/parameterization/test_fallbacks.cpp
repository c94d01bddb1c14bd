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
  const SpectralMap rejected = solver.solve({}, {}, {}, timings);
  CHECK(rejected.rejection == Rejection::unresolved);
  int attempts = 2;
  const std::optional<FallbackMap> other = solve_fallback(solver, rejected, {}, {}, 0, {}, timings, attempts);
  REQUIRE(other);
  CHECK(other->fallback == Fallback::clamped_triangles);
  CHECK((other->clamped_triangles > 0 && attempts > 2));
  CHECK((other->weights == Weights::uniform && other->boundary == BoundaryMeasure::length));
  CHECK(other->map.rejection == Rejection::none);
}

TEST_CASE("a map that winds twice is unfolded, or an embedding, unless another problem's has a lower mean QC") {
  const Patch patch(rounded_grid(20, 0.5));
  const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
  SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  Timings timings;
  const SpectralMap rejected = solver.solve({}, {}, {}, timings);
  CHECK(rejected.rejection == Rejection::winding);
  CHECK(rejected.whole.size() > 0);
  int attempts = 0;
  const std::optional<FallbackMap> best = solve_fallback(solver, rejected, {}, {}, 0, {}, timings, attempts);
  REQUIRE(best);
  const ComplexVector& z = best->unfolded ? best->unfolded->fold_free.z : best->map.z;
  CHECK(count_flipped(patch, z) == 0);
  const double mean_qc = chart_distortion(normalized, z).mean_qc;
  CHECK(mean_qc <= chart_distortion(normalized, unfold(solver, {}, rejected.whole, {}).fold_free.z).mean_qc);
  SpectralSolver other(solver, Weights::uniform, BoundaryMeasure::vertex);
  const SpectralMap map = other.solve({}, {}, {}, timings);
  if (map.rejection == Rejection::none && count_flipped(patch, map.z) == 0) {
    CHECK(mean_qc <= chart_distortion(normalized, map.z).mean_qc);
  }
}

TEST_CASE("with a blend only other problems are solved; the map says of which form its eigenvalue is") {
  const Patch patch(rounded_grid(20, 0.5));
  const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
  SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  Timings timings;
  const SpectralMap rejected = solver.solve({}, {}, {}, timings);
  int attempts = 0;
  const std::optional<FallbackMap> other = solve_fallback(solver, rejected, {}, {}, 1e-6, {}, timings, attempts);
  REQUIRE(other);
  CHECK(other->fallback == Fallback::other_boundary);
  CHECK(other->boundary == BoundaryMeasure::vertex);
  CHECK(other->clamped_triangles == 0);
  // The eigenvalue is that of the form named.
  const SpectralSolver named(solver, other->weights, other->boundary);
  CHECK(other->map.eigenvalue ==
        doctest::Approx(named.energy().value(other->map.z) / named.form().value(other->map.z)).epsilon(1e-3));
}

TEST_CASE("without any map there is no fallback") {
  const Patch patch(bumpy_grid(4, 4));
  NormalizedPatch empty = normalized_patch(patch.chart, patch.positions, false);
  std::fill(empty.triangle_weights.begin(), empty.triangle_weights.end(), 0.0);
  const SpectralSolver solver(empty, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  Timings timings;
  int attempts = 0;
  CHECK_FALSE(solve_fallback(solver, {}, {}, {}, 0, {}, timings, attempts));
  CHECK(attempts > 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
