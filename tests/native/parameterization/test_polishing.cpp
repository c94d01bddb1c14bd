#include <doctest/doctest.h>

#include "parameterization/polishing.h"
#include "problems.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("polishing");

TEST_CASE("a balanced map has more even sizes, at no more than half of what the mean QC gained") {
  const Patch patch(bumpy_grid(12, 9));
  SpectralProblem problem = problem_of(patch);
  Timings timings;
  const SpectralMap map = attempted_map(problem, {}, {}, {}, timings);
  const auto inverse = [&problem](const ComplexVector& b, ComplexVector& x) { x = problem.factor.inverse(b); };
  const auto measured = [&](const SpectralMap& of) { return chart_distortion(*problem.patch, of.whole); };
  const Distortion plain = measured(map);
  const Distortion angles = measured(polished_map(problem, inverse, map, Polish::angles, true, {}, timings));
  const Distortion balanced = measured(polished_map(problem, inverse, map, Polish::balanced, true, {}, timings));
  CHECK(balanced.log2_scale_deviation < angles.log2_scale_deviation);
  CHECK(balanced.mean_qc - angles.mean_qc < 0.6 * (plain.mean_qc - angles.mean_qc));
}

TEST_CASE("the stage says of which map the eigenvalue is") {
  PreparedPatch patch = prepared(problem_of(Patch(bumpy_grid(12, 9))));
  const SolveTask task{patch, {}, {}, {}, {}};
  const PatchMap map = polished(task, spectral(task, {}, {}), {});
  CHECK((map.result.polish_steps > 0 && map.result.eigenvalue_of == EigenvalueOf::map));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
