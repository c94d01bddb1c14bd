#include <doctest/doctest.h>

#include "layout/placement.h"
#include "parameterization/spectral_map.h"
#include "problems.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("spectral_map");

TEST_CASE("the map is the eigenvector of Eq. 5, placed") {
  const Patch patch(bumpy_grid(9, 7));
  for (const auto backend : backends()) {
    SpectralProblem problem = problem_of(patch, backend);
    Timings timings;
    const SpectralMap solved = spectral_map(problem, {}, {}, first_attempt, {}, timings);
    CHECK(solved.z.size() == 0);
    const SpectralMap map = placed_map(problem, solved, timings);
    REQUIRE(map.rejection == Rejection::none);
    CHECK(problem.is_factored());
    CHECK((map.attempts == 1 && map.turning_number == 1 && map.residual < 1e-10));
    CHECK(difference_up_to_similarity(map.whole, map.z) < 1e-12);
    const double scale = problem.patch->scale;
    CHECK(signed_area(problem.energy, map.z) == doctest::Approx(problem.energy.area() * scale * scale));
    CHECK(map.eigenvalue == doctest::Approx(problem.energy.value(map.z) / problem.form.value(map.z) / scale));
    // Smallest: a random map has a larger quotient.
    const ComplexVector other = random_map(map.z.size());
    CHECK(map.eigenvalue * scale < problem.energy.value(other) / problem.form.value(other));
    // The factor is kept, and what was solved before changes nothing.
    const Factorization* const kept = &problem.factor.factorization();
    CHECK(spectral_map(problem, {}, {}, first_attempt, {}, timings).whole == map.whole);
    CHECK(&problem.factor.factorization() == kept);
  }
}

TEST_CASE("outcomes are typed: a map that winds is kept whole, without an energy there is none") {
  const Patch patch(bumpy_grid(8, 8));
  SpectralProblem problem = problem_of(patch);
  SolveOptions options;
  options.extenders = {{{20}, {60}, -1000}};
  Timings timings;
  const SpectralMap wound = spectral_map(problem, options, {}, first_attempt, {}, timings);
  CHECK(wound.rejection == Rejection::winding);
  CHECK((wound.turning_number == 2 && wound.whole.size() > 0));
  CHECK(placed_map(problem, wound, timings).z.size() == 0);
  NormalizedPatch empty = *problem.patch;
  empty.triangles = {};
  empty.triangle_weights = {};
  for (const auto method : {Method::spectral, Method::fiedler, Method::area}) {
    SpectralProblem none = problem_of(empty);
    options = {};
    options.method = method;
    CHECK(spectral_map(none, options, {}, first_attempt, {}, timings).rejection != Rejection::none);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
