#include <doctest/doctest.h>

#include <limits>

#include "parameterization/area_blend.h"
#include "problems.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("area_blend");

TEST_CASE("the full blend's metric is that of the relaxed map, none's is the identity") {
  const Patch patch(bumpy_grid(8, 6));
  SpectralProblem problem = problem_of(patch);
  const AreaBlend none = blend_area(problem, 0, {});
  for (const TriangleMetric& g : none.metric) CHECK((g.xx == 1 && g.xy == 0 && g.yy == 1));
  const AreaBlend full = blend_area(problem, 1, {});
  CHECK(full.metric.size() == patch.chart.triangles.size());
  CHECK(full.relaxed.status == RelaxationStatus::converged);
  CHECK(full.scale_deviation_before > chart_distortion(*problem.patch, full.relaxed.z).log2_scale_deviation);
  problem.stretch(full.metric);
  CHECK(problem.energy.value(full.relaxed.z) < 1e-20);
}

TEST_CASE("a patch is blended once; its map says what the blend did where that is little") {
  PreparedPatch patch = prepared(problem_of(Patch(bumpy_grid(8, 6))));
  const SolveTask task{patch, {}, {}, {}, {}};
  CHECK_FALSE(blend_once(patch, {}));
  CHECK_FALSE(patch.blend);
  patch.options.area_blend = 1;
  CHECK_FALSE(blend_once(patch, {}));
  REQUIRE(patch.blend);
  const std::vector<TriangleShape> shapes = patch.problem.energy.energy_shapes();
  blend_once(patch, {});
  CHECK(patch.problem.energy.energy_shapes()[5].x1 == shapes[5].x1);
  PatchMap map;
  map.result.relaxation = patch.blend->status;
  map.result.z = conformal_map(Patch(bumpy_grid(8, 6)));
  const double deviation = chart_distortion(*patch.problem.patch, map.result.z).log2_scale_deviation;
  const auto said = [&](double amount, double before) {
    patch.options.area_blend = amount;
    map.result.scale_deviation_before = before;
    const PatchMap measured = measured_blend(task, map);
    CHECK(measured.result.scale_deviation == deviation);
    return measured.result.steps;
  };
  CHECK(said(1, 0.04).empty());
  CHECK(said(1, std::numeric_limits<double>::infinity()).empty());
  REQUIRE(deviation > 0.05);
  CHECK(said(1, 3 * deviation).empty());
  CHECK(said(0.1, 1.05 * deviation).empty());
  const std::vector<Step> little = said(1, 1.05 * deviation);
  REQUIRE(little.size() == 1);
  CHECK((little[0].kind == StepKind::blended_little && little[0].after == deviation && little[0].relaxation));
}

TEST_CASE("a patch without a spectral map has no blend") {
  const AreaBlend none = blend_area(problem_of(Patch(rounded_grid(20, 0.5))), 0.5, {});
  REQUIRE(none.rejection);
  CHECK(none.metric.empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
