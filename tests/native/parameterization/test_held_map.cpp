#include <doctest/doctest.h>

#include "parameterization/held_map.h"
#include "problems.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("held_map");

TEST_CASE("pins are held exactly in any unit, and fewer than two leave the map to be placed") {
  const Patch grid(bumpy_grid(6, 5));
  PreparedPatch patch = prepared(problem_of(grid));
  const auto held_by = [&](const Pins& pins) {
    SolveTask task{patch, {}, {}, {}, {}};
    task.options.method = Method::lscm;
    task.held = pins.size() > 1 ? pins : Pins{};
    const PatchMap map = held(task, {}, {});
    REQUIRE_FALSE(map.rejection);
    ComplexVector z = map.found.whole;
    if (task.is_held()) place_held(task, z);
    return z;
  };
  const Pins pins{{0, {1, 2}}, {6, {7, 2}}, {41, {7, 8}}};
  const ComplexVector z = held_by(pins);
  for (const auto& [vertex, position] : pins) CHECK(z[vertex] == position);
  Pins large;
  Pins far;
  for (const auto& [vertex, position] : pins) {
    large[vertex] = 1e200 * position;
    far[vertex] = 1024.0 * position + Complex(1e7, -2e7);
  }
  CHECK(difference(held_by(large) / 1e200, z) < 1e-12);
  const ComplexVector moved = held_by(far).array() - Complex(1e7, -2e7);
  CHECK(difference(moved / 1024, z) < 1e-9);
  CHECK(held_by({{3, 5.0}}) == held_by({}));
  CHECK_THROWS_AS(held_by({{0, 1.0}, {3, 1.0}}), InvalidMesh);
  // The mean of equal numbers is rounded.
  CHECK_THROWS_AS(held_by({{0, 0.1}, {3, 0.1}, {5, 0.1}}), InvalidMesh);
}

TEST_CASE("a single pin is met exactly by moving the map") {
  PreparedPatch patch = prepared(problem_of(Patch(bumpy_grid(6, 5))));
  SolveTask task{patch, {}, {}, {}, {}};
  task.options.method = Method::lscm;
  task.pins[3] = Complex(1e3, 7);
  PatchMap map = held(task, {}, {});
  CHECK((!map.rejection && map.result.eigenvalue_of == EigenvalueOf::map));
  map.result.z = map.found.whole;
  const ComplexVector& z = fitted_to_pins(task, map).result.z;
  CHECK(z[3] == Complex(1e3, 7));
  CHECK(std::abs(z[1] - z[0] - (map.result.z[1] - map.result.z[0])) < 1e-12);
}

TEST_CASE("soft pins are fitted by a similarity") {
  PreparedPatch patch = prepared(problem_of(Patch(bumpy_grid(6, 5))));
  PatchMap map;
  map.result.z = flat_map(patch.problem.patch->positions);
  const ComplexVector& z = map.result.z;
  const Pins twice{{0, 2.0 * z[0]}, {5, 2.0 * z[5]}, {20, 2.0 * z[20]}};
  SolveTask soft{patch, {}, {}, {}, {}};
  soft.pins = soft.attractors = twice;
  CHECK(difference(fitted_to_pins(soft, map).result.z, 2.0 * z) < 1e-12);
  SolveTask equal{patch, {}, {}, {}, {}};
  equal.pins = {{0, 1.0}, {5, 1.0}};
  CHECK_THROWS_AS(fitted_to_pins(equal, map), InvalidMesh);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
