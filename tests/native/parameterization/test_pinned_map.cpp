#include <doctest/doctest.h>

#include "parameterization/pinned_map.h"
#include "problems.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("pinned_map");

TEST_CASE("pins are held exactly in any unit, fewer than two leave the map to be placed") {
  const Patch patch(bumpy_grid(6, 5));
  SpectralProblem problem = problem_of(patch);
  Timings timings;
  const Pins pins{{0, {1, 2}}, {6, {7, 2}}, {41, {7, 8}}};
  const SpectralMap map = pinned_map(problem, pins, {}, 0, {}, timings);
  REQUIRE(map.rejection == Rejection::none);
  for (const auto& [vertex, position] : pins) CHECK(map.z[vertex] == position);
  Pins large;
  for (const auto& [vertex, position] : pins) large[vertex] = 1e200 * position;
  CHECK(difference(pinned_map(problem, large, {}, 0, {}, timings).z / 1e200, map.z) < 1e-12);
  CHECK(problem.pinned_factor->holds(pins));
  const ComplexVector free = pinned_map(problem, {}, {}, 0, {}, timings).z;
  CHECK(std::abs(free.mean()) < 1e-12);
  CHECK(pinned_map(problem, {{3, 5.0}}, {}, 0, {}, timings).z == free);
  CHECK_THROWS_AS(pinned_map(problem, {{0, 1.0}, {3, 1.0}}, {}, 0, {}, timings), InvalidMesh);
}

TEST_CASE("a single pin is met exactly by moving the map") {
  PreparedPatch patch = prepared(problem_of(Patch(bumpy_grid(6, 5))));
  SolveTask task{patch, {}, {}, {}, {}};
  task.options.method = Method::lscm;
  task.pins[3] = Complex(1e3, 7);
  const PatchMap map = pinned(task, {}, {});
  CHECK((!map.rejection && map.result.eigenvalue_of == EigenvalueOf::map));
  const ComplexVector& z = fitted_to_pins(task, map).result.z;
  CHECK(z[3] == Complex(1e3, 7));
  CHECK(std::abs(z[1] - z[0] - (map.result.z[1] - map.result.z[0])) < 1e-12);
}

TEST_CASE("soft pins are fitted by a similarity, hard ones leave the map as it is") {
  PreparedPatch patch = prepared(problem_of(Patch(bumpy_grid(6, 5))));
  PatchMap map;
  map.result.z = flat_map(patch.problem.patch->positions);
  const ComplexVector& z = map.result.z;
  const Pins twice{{0, 2.0 * z[0]}, {5, 2.0 * z[5]}, {20, 2.0 * z[20]}};
  SolveTask soft{patch, {}, {}, {}, {}};
  soft.pins = soft.attractors = twice;
  CHECK(difference(fitted_to_pins(soft, map).result.z, 2.0 * z) < 1e-12);
  SolveTask hard{patch, {}, {}, {}, {}};
  hard.options.method = Method::lscm;
  hard.pins = hard.held = twice;
  CHECK(fitted_to_pins(hard, map).result.z == z);
  SolveTask equal{patch, {}, {}, {}, {}};
  equal.pins = {{0, 1.0}, {5, 1.0}};
  CHECK_THROWS_AS(fitted_to_pins(equal, map), InvalidMesh);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
