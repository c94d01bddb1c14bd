#include <doctest/doctest.h>

#include <algorithm>
#include <utility>

#include "parameterization/fallbacks.h"
#include "parameterization/unfolding.h"
#include "problems.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("fallbacks");

namespace {

/// What a task ends with whose first map is rejected.
struct Replaced {
  PreparedPatch patch;
  SolveTask task;
  PatchMap refused;
  PatchMap map;
  Replaced(SpectralProblem&& problem, double area_blend, const Pins& attractors = {})
      : patch(prepared(std::move(problem))), task{patch} {
    task.pins = task.attractors = attractors;
    refused = retried(task, spectral(task, {}, {}), {});
    patch.options.area_blend = area_blend;
    map = refused.rejection ? replaced(task, refused, {}) : refused;
  }
};

}  // namespace

TEST_CASE("of the maps without flips that with the least mean QC stands in") {
  for (const Mesh& mesh : {rounded_grid(40, 0.5), rounded_grid(20, 0.5)}) {
    const Patch patch(mesh);
    const Replaced by(problem_of(patch), 0);
    const SpectralProblem& problem = by.patch.problem;
    REQUIRE(by.refused.rejection);
    CHECK((by.refused.found.whole.size() > 0) == (by.refused.rejection->reason == Rejection::winding));
    REQUIRE_FALSE(by.map.rejection);
    const Parameterization& result = by.map.result;
    CHECK(result.attempts > 2);
    REQUIRE(result.steps.size() >= 2);
    CHECK((result.steps[0].kind == StepKind::rejected && result.steps[0].attempts == 2));
    CHECK(result.fallback != Fallback::none);
    CHECK(count_flipped(patch, result.z) == 0);
    const double mean_qc = chart_distortion(*problem.patch, result.z).mean_qc;
    const UnfoldedMap unfolded = unfold(problem, {}, by.refused.found.whole, {}, {});
    CHECK(mean_qc <= chart_distortion(*problem.patch, unfolded.fold_free.z).mean_qc);
    SpectralProblem clamped = other_problem(problem, Weights::uniform, BoundaryMeasure::length);
    clamped.clamp(1e-5);
    SpectralProblem vertex = other_problem(problem, Weights::uniform, BoundaryMeasure::vertex);
    SpectralProblem inverse_area = other_problem(problem, Weights::inverse_area, BoundaryMeasure::length);
    Timings timings;
    for (SpectralProblem* other : {&clamped, &vertex, &inverse_area}) {
      const SpectralMap map = attempted_map(*other, {}, {}, {}, timings);
      if (map.rejection != Rejection::none || count_flipped(patch, map.whole) > 0) continue;
      CHECK(mean_qc <= chart_distortion(*problem.patch, map.whole).mean_qc);
    }
  }
}

TEST_CASE("a patch that is thin to a point needs none") {
  const Replaced by(problem_of(Patch(rounded_grid(40, 1.0 / 20))), 0);
  REQUIRE_FALSE(by.refused.rejection);
  CHECK(by.map.result.attempts == 1);
  CHECK(by.map.result.fallback == Fallback::none);
}

TEST_CASE("with a blend only other problems are solved; the map says of which form its eigenvalue is") {
  const Replaced by(problem_of(Patch(rounded_grid(20, 0.5))), 1e-6);
  REQUIRE_FALSE(by.map.rejection);
  const Parameterization& result = by.map.result;
  CHECK(result.fallback == Fallback::other_boundary);
  CHECK((result.boundary == BoundaryMeasure::vertex && result.steps[1].kind == StepKind::by_vertex));
  CHECK(result.clamped_triangles == 0);
  // The eigenvalue is that of the form named.
  const SpectralProblem named = other_problem(by.patch.problem, result.weights, result.boundary);
  CHECK(result.eigenvalue == doctest::Approx(named.energy.value(result.z) / named.form.value(result.z)).epsilon(1e-3));
}

TEST_CASE("a boundary without length has no fallback by length") {
  const Patch patch(bumpy_grid(6, 6));
  NormalizedPatch point = normalized_patch(patch.chart, patch.positions, false);
  for (const int v : point.outer) point.positions.row(v).setZero();
  const Replaced by(problem_of(point, BoundaryMeasure::vertex), 0, {{0, {0, 0}}, {9, {1, 2}}, {30, {3, 1}}});
  CHECK((by.map.rejection || by.map.result.boundary == BoundaryMeasure::vertex));
}

TEST_CASE("without any map the rejection stays") {
  const Patch patch(bumpy_grid(4, 4));
  NormalizedPatch empty = normalized_patch(patch.chart, patch.positions, false);
  empty.triangles = {};
  empty.triangle_weights = {};
  const Replaced by(problem_of(empty), 0);
  REQUIRE(by.map.rejection);
  CHECK(by.map.result.attempts > by.refused.result.attempts);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
