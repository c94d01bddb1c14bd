#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "layout/placement.h"
#include "meshes.h"
#include "parameterization/spectral_solver.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("spectral_solver");

TEST_CASE("the map is the eigenvector of Eq. 5, and can be placed") {
  const Patch patch(bumpy_grid(9, 7));
  const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
  for (const auto backend : backends()) {
    SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, backend);
    Timings timings;
    SpectralMap map = solver.solve({}, {}, {}, timings);
    REQUIRE(map.rejection == Rejection::none);
    CHECK(map.z == map.whole.head(normalized.n_vertices));
    CHECK(solver.place(map.z));
    CHECK(solver.is_factored());
    CHECK((map.attempts == 1 && map.turning_number == 1 && map.residual < 1e-10));
    CHECK(difference_up_to_similarity(map.whole, map.z) < 1e-12);
    CHECK(signed_area(solver.energy(), map.z) ==
          doctest::Approx(solver.energy().area() * normalized.scale * normalized.scale));
    CHECK(map.eigenvalue ==
          doctest::Approx(solver.energy().value(map.z) / solver.form().value(map.z) / normalized.scale));
    // Smallest: a random map has a larger quotient.
    const ComplexVector other = random_map(map.z.size());
    CHECK(map.eigenvalue * normalized.scale < solver.energy().value(other) / solver.form().value(other));
  }
}

TEST_CASE("a map without positive area is not placed") {
  const Patch patch(flat_grid(4, 3));
  const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
  SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  Timings timings;
  const ComplexVector mirrored = solver.solve({}, {}, {}, timings).z.conjugate();
  ComplexVector z = mirrored;
  CHECK_FALSE(solver.place(z));
  CHECK(z == mirrored);
}

TEST_CASE("another metric or clamped triangles take the factor away") {
  const Patch patch(flat_grid(6, 5));
  const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
  SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  CHECK(solver.factorize({}).rejection == Rejection::none);
  CHECK(solver.is_factored());
  CHECK(solver.clamp(1e-5) == 0);
  CHECK_FALSE(solver.is_factored());
  solver.factorize({});
  std::vector<TriangleMetric> metric(patch.chart.triangles.size());
  for (TriangleMetric& g : metric) g = {2, 0.5, 1};
  solver.stretch(metric);
  CHECK_FALSE(solver.is_factored());
  const SpectralSolver other(solver, Weights::inverse_area, BoundaryMeasure::vertex);
  CHECK(other.energy().weights() == Weights::inverse_area);
  CHECK(other.boundary() == BoundaryMeasure::vertex);
  CHECK(other.energy().energy_shapes()[3].x1 == solver.energy().energy_shapes()[3].x1);
}

TEST_CASE("outcomes are typed: winding under an extender needs no second attempt, no energy has no factor") {
  const Patch patch(bumpy_grid(8, 8));
  const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
  SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  SolveOptions options;
  options.extenders = {{{20}, {60}, -1000}};
  Timings timings;
  const SpectralMap wound = solver.solve(options, {}, {}, timings);
  CHECK(wound.rejection == Rejection::winding);
  CHECK((wound.turning_number == 2 && wound.attempts == 1));
  NormalizedPatch empty = normalized;
  empty.triangle_weights = std::vector<double>(empty.triangles.size(), 0.0);
  SpectralSolver none(empty, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  CHECK(none.solve({}, {}, {}, timings).rejection != Rejection::none);
}

TEST_CASE("the numbers of a map do not depend on a factor") {
  const Patch patch(bumpy_grid(5, 4));
  const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
  SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  const ComplexVector map = random_map(normalized.n_vertices);
  const double without = solver.numbers(map).residual;
  CHECK((std::isfinite(without) && without > 0));
  solver.factorize({});
  CHECK(solver.numbers(map).residual == without);
}

TEST_CASE("an outer loop without length is refused") {
  const Patch patch(bumpy_grid(3, 3));
  NormalizedPatch point = normalized_patch(patch.chart, patch.positions, false);
  for (const int v : point.outer) point.positions.row(v).setZero();
  CHECK_THROWS_AS(SpectralSolver(point, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic),
                  InvalidMesh);
  // By vertex it has a form, from which none by length can be made.
  const SpectralSolver by_vertex(point, Weights::uniform, BoundaryMeasure::vertex, FactorizationBackend::automatic);
  CHECK_THROWS_AS(SpectralSolver(by_vertex, Weights::uniform, BoundaryMeasure::length), InvalidMesh);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
