#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "meshes.h"
#include "parameterization/fallbacks.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("fallbacks");

TEST_CASE("of the maps without flips that with the least mean QC stands in") {
  for (const Mesh& mesh : {rounded_grid(40, 1.0 / 20), rounded_grid(20, 0.5)}) {
    const Patch patch(mesh);
    const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
    SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
    Timings timings;
    const SpectralMap rejected = solver.solve({}, {}, {}, timings);
    REQUIRE(rejected.rejection != Rejection::none);
    CHECK((rejected.whole.size() > 0) == (rejected.rejection == Rejection::winding));
    int attempts = 2;
    const std::optional<FallbackMap> best = solve_fallback(solver, rejected, {}, {}, 0, {}, timings, attempts);
    REQUIRE(best);
    CHECK(attempts > 2);
    CHECK(best->unfolded.has_value() ==
          (best->fallback == Fallback::unfolded || best->fallback == Fallback::tutte_embedding));
    const ComplexVector& z = best->unfolded ? best->unfolded->fold_free.z : best->map.z;
    CHECK(count_flipped(patch, z) == 0);
    const double mean_qc = chart_distortion(normalized, z).mean_qc;
    CHECK(mean_qc <= chart_distortion(normalized, unfold(solver, {}, rejected.whole, {}, {}).fold_free.z).mean_qc);
    SpectralSolver clamped(solver, Weights::uniform, BoundaryMeasure::length);
    clamped.clamp(1e-5);
    SpectralSolver vertex(solver, Weights::uniform, BoundaryMeasure::vertex);
    SpectralSolver inverse_area(solver, Weights::inverse_area, BoundaryMeasure::length);
    for (SpectralSolver* other : {&clamped, &vertex, &inverse_area}) {
      const SpectralMap map = other->solve({}, {}, {}, timings);
      if (map.rejection != Rejection::none || count_flipped(patch, map.z) > 0) continue;
      CHECK(mean_qc <= chart_distortion(normalized, map.z).mean_qc);
    }
  }
}

TEST_CASE("a patch that is thin to a point is solved with clamped triangles where a blend leaves no other way") {
  const Patch patch(rounded_grid(40, 1.0 / 20));
  const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
  SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  Timings timings;
  const SpectralMap rejected = solver.solve({}, {}, {}, timings);
  CHECK(rejected.rejection == Rejection::unresolved);
  int attempts = 2;
  const std::optional<FallbackMap> other = solve_fallback(solver, rejected, {}, {}, 0.5, {}, timings, attempts);
  REQUIRE(other);
  CHECK(other->fallback == Fallback::clamped_triangles);
  CHECK((other->clamped_triangles > 0 && other->blend));
  CHECK((other->weights == Weights::uniform && other->boundary == BoundaryMeasure::length));
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

TEST_CASE("a boundary without length has no fallback by length") {
  const Patch patch(bumpy_grid(6, 6));
  NormalizedPatch point = normalized_patch(patch.chart, patch.positions, false);
  for (const int v : point.outer) point.positions.row(v).setZero();
  const SpectralSolver solver(point, Weights::uniform, BoundaryMeasure::vertex, FactorizationBackend::automatic);
  Timings timings;
  int attempts = 0;
  const auto other = solve_fallback(solver, {}, {}, {{0, {0, 0}}, {9, {1, 2}}, {30, {3, 1}}}, 0, {}, timings, attempts);
  CHECK((!other || other->boundary == BoundaryMeasure::vertex));
}

TEST_CASE("without any map there is no fallback") {
  const Patch patch(bumpy_grid(4, 4));
  NormalizedPatch empty = normalized_patch(patch.chart, patch.positions, false);
  empty.triangle_weights = std::vector<double>(empty.triangles.size(), 0.0);
  const SpectralSolver solver(empty, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  Timings timings;
  int attempts = 0;
  CHECK_FALSE(solve_fallback(solver, {}, {}, {}, 0, {}, timings, attempts));
  CHECK(attempts > 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
