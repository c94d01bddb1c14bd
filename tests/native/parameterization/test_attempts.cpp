#include <doctest/doctest.h>

#include "parameterization/attempts.h"
#include "problems.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("attempts");

TEST_CASE("an accepted map is kept, a rejected one is tried again once") {
  SpectralProblem problem = problem_of(Patch(rounded_grid(20, 0.5)));
  Timings timings;
  SpectralMap first = spectral_map(problem, {}, {}, first_attempt, {}, timings);
  REQUIRE(first.rejection != Rejection::none);
  const SpectralMap second = retried_map(problem, first, {}, {}, {}, timings);
  CHECK((first.attempts == 1 && second.attempts == 2));
  CHECK(problem.relative_shift > first_attempt.relative_shift);
  CHECK(retried_map(problem, second, {}, {}, {}, timings).whole == second.whole);
  SolveOptions once;
  once.second_attempt = false;
  CHECK(retried_map(problem, first, once, {}, {}, timings).attempts == 1);
  SpectralProblem good = problem_of(Patch(bumpy_grid(6, 5)));
  CHECK(attempted_map(good, {}, {}, {}, timings).attempts == 1);
}

TEST_CASE("the stages keep a map that passes its checks") {
  PreparedPatch patch = prepared(problem_of(Patch(bumpy_grid(6, 5))));
  const SolveTask task{patch, {}, {}, {}, {}};
  const PatchMap map = retried(task, spectral(task, {}, {}), {});
  CHECK((!map.rejection && map.result.steps.empty() && map.result.attempts == 1));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
