#include <doctest/doctest.h>

#include <cmath>

#include "parameterization/unfolding.h"
#include "problems.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("unfolding");

TEST_CASE("a map without folds is left as it is, one with a fold is unfolded, none is replaced by an embedding") {
  const Patch patch(bumpy_grid(6, 6));
  SpectralProblem problem = problem_of(patch);
  Timings timings;
  const ComplexVector z = attempted_map(problem, {}, {}, {}, timings).whole;
  const UnfoldedMap same = unfold(problem, {}, z, {}, {});
  CHECK_FALSE(same.changed);
  CHECK(same.mean_qc == same.mean_qc_before);
  ComplexVector flipped = z;
  flipped[24] += 1.5 * (z[25] - z[24]);
  const UnfoldedMap unfolded = unfold(problem, {}, flipped, {}, {});
  CHECK(unfolded.changed);
  CHECK_FALSE(unfolded.fold_free.is_embedding);
  CHECK(unfolded.fold_free.flipped_before > 0);
  CHECK(unfolded.fold_free.flipped == 0);
  CHECK(unfolded.turning_number == 1);
  CHECK(unfolded.mean_qc == doctest::Approx(chart_distortion(*problem.patch, unfolded.fold_free.z).mean_qc));
  CHECK(unfolded.eigenvalue > 0);
  const UnfoldedMap embedded = unfold(problem, {}, {}, {}, {});
  CHECK((embedded.changed && embedded.fold_free.is_embedding));
  CHECK(std::isnan(embedded.mean_qc_before));
}

TEST_CASE("distortion is that of the surface, without virtual triangles") {
  const Patch patch(perforated_grid(7, 7));
  const NormalizedPatch open = normalized_patch(patch.chart, patch.positions, false);
  const NormalizedPatch filled = normalized_patch(patch.chart, patch.positions, true);
  const ComplexVector z = flat_map(patch.positions);
  CHECK(chart_distortion(filled, z).qc == chart_distortion(open, z).qc);
}

TEST_CASE("steps say what unfolding cost and what it left") {
  PreparedPatch patch = prepared(problem_of(Patch(bumpy_grid(6, 6))));
  SolveTask task{patch, {}, {}, {}, {}};
  const auto steps_of = [&](const FoldFreeMap& fold_free, int turns, bool is_rejected) {
    UnfoldedMap unfolded;
    unfolded.fold_free = fold_free;
    unfolded.mean_qc_before = 1.25;
    unfolded.mean_qc = 1.5;
    PatchMap map;
    map.result.turning_number = turns;
    if (is_rejected) map.rejection = rejected(Rejection::no_area);
    const PatchMap result = with_unfolded(task, map, std::move(unfolded));
    CHECK_FALSE(result.rejection);
    return result.result.steps;
  };
  FoldFreeMap map;
  map.is_locally_injective = true;
  CHECK(steps_of(map, 1, false).empty());
  map.flipped_before = 3;
  map.flipped = 2;
  std::vector<Step> steps = steps_of(map, 1, false);
  REQUIRE(steps.size() == 2);
  CHECK((steps[0].kind == StepKind::unfolded && steps[0].count == 1));
  CHECK((steps[0].before == 1.25 && steps[0].after == 1.5));
  CHECK((steps[1].kind == StepKind::still_flipped && steps[1].count == 2));
  CHECK(steps[1].constraint == Constraint::none);
  map = {};
  steps = steps_of(map, 2, false);
  REQUIRE(steps.size() == 1);
  CHECK((steps[0].kind == StepKind::not_injective && steps[0].count == 2));
  task.held = {{0, 0.0}, {3, 1.0}};
  CHECK(steps_of(map, 1, false)[0].constraint == Constraint::pins);
  map.is_embedding = map.is_locally_injective = true;
  steps = steps_of(map, 1, true);
  REQUIRE(steps.size() == 2);
  CHECK(steps[0].kind == StepKind::rejected);
  CHECK((steps[1].kind == StepKind::embedded && std::isnan(steps[1].before)));
  CHECK(steps_of(map, 1, false)[0].before == 1.25);
  map.is_embedding = false;
  map.covered_itself = true;
  CHECK(steps_of(map, 1, false)[0].kind == StepKind::moved_apart);
  map.came_apart_embedded = true;
  CHECK(steps_of(map, 1, false)[0].kind == StepKind::moved_apart_embedded);
  map.covers_itself = true;
  CHECK(steps_of(map, 1, false)[0].kind == StepKind::covers_itself);
}

TEST_CASE("the stage embeds what has no map") {
  PreparedPatch patch = prepared(problem_of(Patch(bumpy_grid(6, 6))));
  const SolveTask task{patch, {}, {}, {}, {}};
  PatchMap map;
  map.rejection = rejected(Rejection::no_area);
  const PatchMap embedded = unfolded(task, map, {});
  CHECK((!embedded.rejection && embedded.result.is_embedding));
  CHECK(embedded.result.fallback == Fallback::tutte_embedding);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
