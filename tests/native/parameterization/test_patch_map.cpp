#include <doctest/doctest.h>

#include "parameterization/patch_map.h"
#include "problems.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("patch_map");

TEST_CASE("rejections name the constraints that the map was solved with") {
  SpectralMap map;
  map.rejection = Rejection::winding;
  map.turning_number = 2;
  map.attempts = 2;
  const Step plain = rejected(map, {});
  CHECK((plain.kind == StepKind::rejected && plain.reason == Rejection::winding));
  CHECK((plain.count == 2 && plain.attempts == 2 && plain.constraint == Constraint::none));
  SolveOptions forced;
  forced.hole_rigidity = 1;
  CHECK(rejected(map, forced).constraint == Constraint::rigidity);
  forced.extenders = {{{0}, {1}, 1.0}};
  CHECK(rejected(map, forced).constraint == Constraint::extenders_and_rigidity);
  forced.hole_rigidity.reset();
  CHECK(rejected(map, forced).constraint == Constraint::extenders);
  CHECK(rejected(map, {Method::lscm}).constraint == Constraint::pins);
}

TEST_CASE("a map is taken with its numbers, and with a step for a second attempt and for a winding border") {
  SpectralMap found;
  found.z = random_map(5);
  found.eigenvalue = 3;
  found.turning_number = 1;
  PatchMap map;
  map.rejection = Step{};
  map.set(SpectralMap(found), {});
  CHECK((!map.rejection && map.result.z == found.z && map.result.eigenvalue == 3 && map.result.steps.empty()));
  found.attempts = 2;
  found.turning_number = -2;
  PatchMap other;
  other.set(SpectralMap(found), {});
  REQUIRE(other.result.steps.size() == 2);
  CHECK(other.result.steps[0].kind == StepKind::retried);
  CHECK((other.result.steps[1].kind == StepKind::winds && other.result.steps[1].count == -2));
  found.rejection = Rejection::no_area;
  other.set(std::move(found), {});
  REQUIRE(other.rejection);
  CHECK(other.rejection->reason == Rejection::no_area);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
